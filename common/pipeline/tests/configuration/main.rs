//! Configurations: what is read, in which units, and what each mistake is told.

mod events;
mod lines;
mod messages;
mod output;
mod papers;
mod rules;
mod text;
mod values;

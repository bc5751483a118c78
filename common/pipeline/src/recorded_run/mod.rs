//! A recorded run: one or more files, of which the first stands for all. The file `..._000.mcap` goes on in `..._001.mcap` and so on.
//!
//! A file that begins in the middle of its run holds states of the estimators, from which they go on.

mod comparison;
mod course;
mod files;
mod folder;
mod playback;
mod start;

pub use comparison::{Comparison, Likeness};
pub use course::Course;
pub use files::{Files, about, is_one};
pub use folder::first_file;
pub use playback::Playback;
pub use start::Start;

/// The topic of an area's adoptions: at which sample a parameter set took effect.
pub fn adoption_topic(area: &str) -> String {
    format!("area/{area}/adoption")
}

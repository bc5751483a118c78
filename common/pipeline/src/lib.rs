//! Configuration, data sources, the offline loop and what it writes.

pub mod alarm;
pub mod configuration;
pub mod deformation_file;
pub mod lane;
pub mod offline;
pub mod recorded_run;
pub mod recording;
pub mod resumed;
pub mod solution_file;
pub mod source;
pub mod summary;
pub mod zero;

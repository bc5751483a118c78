//! A recorded run: one or more files, of which the first stands for all. The file `..._000.mcap` goes on in `..._001.mcap` and so on.

mod comparison;
mod course;
mod files;
mod playback;

pub use comparison::{Comparison, Likeness};
pub use course::Course;
pub use files::{Files, about, is_one};
pub use playback::Playback;

/// The topic of an area's adoptions: at which sample a parameter set took effect.
pub fn adoption_topic(area: &str) -> String {
    format!("area/{area}/adoption")
}

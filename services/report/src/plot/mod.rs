//! Charts as HTML with SVG inside. Lines and areas stretch with the page and take their colours from its style sheet, and numbers stay letters
//! of the page, so that a chart reads on a telephone, in the dark and on paper. A drawing library that draws pictures of fixed size does none of this.

mod axis;
mod chart;
mod lanes;
mod layer;

pub use axis::{Axis, Ticks, clock, signed};
pub use chart::{Chart, Height, Key, Panel};
pub use lanes::{Lane, lanes};
pub use layer::{Layer, Place};

//! Identification of the flexure model by a relevance vector machine.
//!
//! Source: paper 000 section 3 (eq 16-33), corrected: the data are increments of the relative attitude, rebuilt over the whole
//! window with the latest constant, so that the product of ship's rate and flexure that eq 16 drops is not in them.
//!
//! | step | file |
//! |---|---|
//! | points at 10 Hz, gaps, when to fire | [`window`] |
//! | relative rate of the window | [`chain`] |
//! | its autocovariance at some lags | [`autocovariance`] |
//! | damped and undamped sinusoids | [`dictionary`] |
//! | which of them are in the autocovariance | [`relevance`] |
//! | the three tied parameters of the model | [`refinement`] |
//! | one axis from rates to parameters | [`axis`] |
//! | what a filter may safely use | [`safety`] |
//! | all together as an [`Identifier`](crate::Identifier) | [`Rvm`] |

pub mod autocovariance;
pub mod axis;
pub mod chain;
pub mod dictionary;
pub mod expectation;
mod fixed;
pub mod refinement;
pub mod relevance;
mod rvm;
pub mod safety;
pub mod window;

pub use fixed::Fixed;
pub use rvm::Rvm;

/// When an identifier works and on what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Longest stretch of data that is used, s.
    pub window_s: f64,
    /// From one parameter set to the next, s of data time.
    pub period_s: f64,
    /// From the end of the window to the time at which its parameters take effect, s.
    pub lead_s: f64,
    /// Least length of the first window, s.
    pub minimum_s: f64,
    /// Multiplies the number of atoms of the dictionary, and about so the solver's time; 1 is enough.
    pub dictionary: usize,
    /// Index of the area, copied into the parameters.
    pub area: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self { window_s: 600.0, period_s: 60.0, lead_s: 1.0, minimum_s: 30.0, dictionary: 1, area: 0 }
    }
}

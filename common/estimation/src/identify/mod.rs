//! Identification of the flexure model from a window of data: the methods of papers 000 and 003, and rivals.
//!
//! The data are those of paper 000 section 3 (eq 16-24), corrected: increments of the relative attitude, rebuilt over the whole
//! window with the latest constant, so that the product of ship's rate and flexure that eq 16 drops is not in them. Paper 003
//! identifies the angle itself; [`Series`] is either.
//!
//! | step | file |
//! |---|---|
//! | points at 10 Hz, gaps, when to fire | [`window`] |
//! | relative rate of the window | [`chain`] |
//! | whether the flexure has become another, and when | [`change`], `onset` |
//! | rates without the blows of a sea that hits the hull | `blows` |
//! | what each rate says that those before it did not | `innovation` |
//! | one axis by a method | [`method`] |
//! | what a filter may safely use | [`safety`] |
//! | all together as an [`Identifier`](crate::Identifier) | [`Windowed`] |
//! | what no method can beat | [`bound`] |
//!
//! | method | files |
//! |---|---|
//! | relevance vector machine, damped sinusoids (000) | [`axis`], [`autocovariance`], [`dictionary`], [`relevance`], [`refinement`], [`expectation`] |
//! | relevance vector machine, Gaussian kernel (000) | [`gaussian`], [`tied`] |
//! | support vector regression (000's rival) | [`support_vector`], [`tied`] |
//! | whale and particle swarm optimisation (000's rivals) | [`whale`], [`particle_swarm`], [`swarm`], [`tied`] |
//! | Tufts-Kumaresan (003), Yule-Walker, matrix pencil | [`tufts_kumaresan`], [`yule_walker`], [`matrix_pencil`], [`poles`] |
//! | Whittle's maximum likelihood | [`whittle`], [`periodogram`] |
//! | none | [`Fixed`] |

pub mod autocovariance;
pub mod axis;
mod blows;
pub mod bound;
pub mod chain;
pub mod change;
pub mod dictionary;
pub mod expectation;
mod fixed;
pub mod gaussian;
mod innovation;
pub mod lagged;
pub mod matrix_pencil;
pub mod method;
mod onset;
pub mod particle_swarm;
pub mod periodogram;
pub mod poles;
pub mod refinement;
pub mod relevance;
pub mod safety;
pub mod series;
pub mod support_vector;
pub mod swarm;
pub mod tied;
pub mod tufts_kumaresan;
pub mod whale;
pub mod whittle;
pub mod window;
mod windowed;
pub mod yule_walker;

pub use axis::Identified;
pub use fixed::Fixed;
pub use method::{Method, identify_axis};
pub use series::{Kind, Series};
pub use windowed::Windowed;

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
    /// How an axis is identified.
    pub method: Method,
    /// Whether the safety rule is applied to what the method finds; without it a filter gets the method's own numbers.
    pub safety: bool,
    /// Whether the filter will run over the first minutes again with better parameters: then a short window may be believed where it shows an
    /// oscillation, for what it gets wrong is undone.
    pub provisional: bool,
    /// Whether a second mode is looked for in windows that are not short: only where the filter has the states for it.
    pub second_mode: bool,
    /// Index of the area, copied into the parameters.
    pub area: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            window_s: 600.0,
            period_s: 60.0,
            lead_s: 1.0,
            minimum_s: 30.0,
            dictionary: 1,
            method: Method::Rvm,
            safety: true,
            provisional: false,
            second_mode: false,
            area: 0,
        }
    }
}

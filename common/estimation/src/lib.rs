//! The mathematics of deck deformation: pure steps without clock, file, thread, log or transport.
//!
//! Samples of two units go through [`synchronise`], which gives pairs; an [`Estimator`] turns each pair into a solution; an
//! [`Identifier`] learns the flexure model from pairs and solutions at its own slow rate.

pub mod align;
pub mod allan;
pub mod estimator;
pub mod evaluate;
pub mod filter;
pub mod flexure;
pub mod identify;
pub mod matching;
mod scatter;
mod state;
pub mod synchronise;

pub use state::{Frozen, StateError};

use messages::{FlexureParams, ImuPair, Solution};

/// The fast stage: one solution a pair.
pub trait Estimator {
    /// Offers a parameter set; it takes effect with the first pair at or after its `effective_from_ns`.
    fn offer(&mut self, params: FlexureParams);
    /// Handles one pair.
    fn step(&mut self, pair: &ImuPair) -> Solution;
    /// Goes on from a solution that another estimator of the same run gave last, instead of registering; for before the first pair. One that cannot
    /// registers all the same.
    fn resume(&mut self, _last: &Solution) {}
    /// Copies everything that the solutions to come depend on, but for pairs and parameter sets to come; `None` while there is no filter yet.
    fn freeze(&self) -> Option<Frozen>;
    /// Goes on from the bytes of a state, to the bit as the estimator that it is of.
    ///
    /// # Errors
    /// The state is of another version or other settings, or cannot be read; then the estimator is as it was.
    fn thaw(&mut self, state: &[u8]) -> Result<(), StateError>;
}

/// The slow stage: now and then a parameter set.
pub trait Identifier {
    /// Takes a pair with the solution of the same sample number.
    fn step(&mut self, pair: &ImuPair, solution: &Solution) -> Option<FlexureParams>;
    /// How often a gap made the window start anew.
    fn restarted_windows(&self) -> u64;
}

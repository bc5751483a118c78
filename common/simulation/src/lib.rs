//! The ship, its bending hull and its inertial units: what a filter may never see.
//!
//! Source: paper 000 section 5, with its equations corrected. A [`Scenario`] describes a run completely: the same scenario gives
//! the same bits, and no clock is ever read.
//!
//! | what | how |
//! |---|---|
//! | ship | roll, pitch and heading sway as sines (000 eq 79); constant speed; `n` turns against inertial space at a constant rate |
//! | hull | `C_s^m(t) = Exp(theta(t)) C_Phi`, each component of theta a second-order Gauss-Markov process (000 eq 3), stepped exactly |
//! | lever arm | `r = r0 + g theta x r0` (000 eq 6), `g` the gain that the scenario gives |
//! | increments | exact rotation vectors between true attitudes, and specific force turned with the attitude half way |
//! | errors | constant bias, scale and misalignment of a run, and white noise |
//! | wire | late, drifting and noisy stamps, own sampling instants, loss, duplicates, swaps |
//!
//! ```
//! use simulation::{Scenario, Simulator};
//! let mut simulator = Simulator::new(&Scenario { duration_s: Some(0.05), ..Scenario::default() });
//! let mut epochs = 0;
//! while let Some(epoch) = simulator.step() {
//!     assert_eq!((epoch.main.header.sequence, epoch.truth.len(), epoch.sub.len()), (epochs, 1, 1));
//!     epochs += 1;
//! }
//! assert_eq!(epochs, 6);
//! ```

mod deck;
mod gauss_markov;
mod hull;
mod imu;
mod random;
mod sampling;
mod scenario;
mod sea;
mod simulator;
mod wire;

pub use scenario::{Area, GaussMarkov, InsErrors, Oscillation, Scenario, Ship, Unit, Wire};
pub use simulator::{Epoch, Simulator};

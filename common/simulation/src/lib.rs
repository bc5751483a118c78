//! The ship, its bending hull and its inertial units: what a filter may never see.
//!
//! Source: the scenarios of papers 000 to 004, with their equations corrected; the defaults are 000 section 5. A [`Scenario`] describes a run completely: the same scenario gives
//! the same bits, and no clock is ever read.
//!
//! | what | how |
//! |---|---|
//! | ship | roll, pitch and heading each a sine (000 eq 79), many tones (002) or a Gauss-Markov process (003 eq 30), band-limited or not; turns (004); a sea that grows; constant speed; `n` turns against inertial space at a constant rate |
//! | hull | `C_s^m(t) = Exp(theta(t)) Exp(q(t)) C_Phi`: [`Area`] defines it; each component of theta a second-order Gauss-Markov process (000 eq 3), stepped exactly, whose model can change (002) and whose waves can be impulsive (000), and a second such process on top |
//! | coupling | flexure in step with the ship's swing (004), late or through a resonator: [`Coupling`] defines it |
//! | lever arm | `r = r0 + g theta x r0` (000 eq 6), `g` the gain that the scenario gives |
//! | increments | exact rotation vectors between true attitudes, and specific force turned with the attitude half way |
//! | errors | constant bias, scale and misalignment of a run, white noise, a first-order Gauss-Markov bias (001), outliers (000) |
//! | wire | late, drifting and noisy stamps, own sampling instants, loss, duplicates, swaps |
//! | troubles | dead accelerometers, a stuck gyro, a gap, a step of the delay, each at its time: [`Event`] defines them |
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

mod area;
mod coupling;
mod deck;
mod gauss_markov;
mod hull;
mod impulses;
mod imu;
mod knots;
mod process;
mod processes;
mod random;
mod resonator;
mod sampling;
mod scenario;
mod sea;
mod sea_change;
mod ship;
mod simulator;
mod swing;
mod troubles;
mod turns;
mod wire;

pub use area::{Area, Coupling, Event, FlexureChange, GaussMarkov, Impulses, QuasiStatic, Response, Trouble};
pub use scenario::{InsErrors, Outliers, Scenario, Unit, Wander, Wire};
pub use ship::{Oscillation, RandomSwing, SeaChange, Ship, Swing, Tones, Turns};
pub use simulator::{Epoch, Simulator};

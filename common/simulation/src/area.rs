//! A deck area, as plain data.

use crate::{Unit, Wire};
use frames::unit::ARCMIN;
use frames::{Main, Rot, Sub, Vec3};

/// A deck area with its sub unit.
///
/// What is true is a product of rotations, never a sum of angles:
/// `C_s^m(t) = Exp(theta(t)) Exp(q(t)) C_Phi`, theta the dynamic flexure, q the quasi-static drift, `C_Phi` the installation.
/// The static part that an estimator should find is `Exp(q(t)) C_Phi`.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// From the main to the sub unit while the hull is not bent, m.
    pub lever_arm: Vec3<Main>,
    /// Gain g of the bent lever arm `r = r0 + g theta x r0`: 1 as in 000 eq 6, 0 for a lever arm that does not bend.
    pub dynamic_lever_arm: f64,
    /// The static part `C_Phi` of the deformation, which includes how the unit was installed.
    pub installation: Rot<Main, Sub>,
    /// How the static part drifts.
    pub quasi_static: QuasiStatic,
    /// Which realisation of the flexure; without a number it is the area's own, which no other area has.
    ///
    /// Areas of one number whose flexure and sampling instants are the same bend alike, as two units on one plate do.
    pub hull: Option<u32>,
    /// The flexure about x, y, z of m.
    pub flexure: [GaussMarkov; 3],
    /// Models that take the place of the first one, in the order of their times; angle and rate go on from where they are.
    pub flexure_changes: Vec<FlexureChange>,
    /// A second mode of the hull about x, y, z of m, independent of the first one and added to it; it has no changes.
    pub second_flexure: Option<[GaussMarkov; 3]>,
    /// Whether the flexure is zero until t = 0, or else stationary from the start.
    pub starts_at_rest: bool,
    /// Gusts in what drives the flexure.
    pub impulses: Option<Impulses>,
    /// Flexure that goes with the ship's motion, on top of the rest.
    pub coupling: Option<Coupling>,
    /// The sub unit.
    pub unit: Unit<Sub>,
    /// What happens to its samples on their way.
    pub wire: Wire,
    /// What goes wrong with the unit and its wire, in any order.
    pub events: Vec<Event>,
}

/// 000 section 5, (3).
impl Default for Area {
    fn default() -> Self {
        Self {
            lever_arm: Vec3::new(10.0, 10.0, 2.0),
            dynamic_lever_arm: 1.0,
            installation: Rot::exp(Vec3::new(10.0 * ARCMIN, 10.0 * ARCMIN, 30.0 * ARCMIN)),
            quasi_static: QuasiStatic::default(),
            hull: None,
            flexure: [
                GaussMarkov::critical(10.0, 6.0 * ARCMIN),
                GaussMarkov::critical(10.0, 6.0 * ARCMIN),
                GaussMarkov::critical(30.0, 10.0 * ARCMIN),
            ],
            flexure_changes: Vec::new(),
            second_flexure: None,
            starts_at_rest: false,
            impulses: None,
            coupling: None,
            unit: Unit::default(),
            wire: Wire::default(),
            events: Vec::new(),
        }
    }
}

/// `q_k(t) = amplitude_k sin(2 pi t / period + phase_k)`, a rotation vector in m; 001 section IV. The default is none.
///
/// It turns the sub unit, but does not move it: its lever arm is that of the flexure alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct QuasiStatic {
    /// rad.
    pub amplitude: [f64; 3],
    /// s; without a positive period there is no drift.
    pub period: f64,
    /// rad.
    pub phase: [f64; 3],
}

/// Flexure of one axis, 000 eq 3: `x'' + 2 mu x' + b^2 x = w`, density of w `4 mu b^2 sigma^2`, stationary from the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussMarkov {
    /// Damping, 1/s.
    pub mu: f64,
    /// Natural frequency, rad/s.
    pub b: f64,
    /// Standard deviation, rad.
    pub sigma: f64,
}

impl GaussMarkov {
    /// Critically damped, with an autocovariance that has fallen to 1/e after `tau` s: `mu = b = 2.146 / tau`.
    pub const fn critical(tau: f64, sigma: f64) -> Self {
        let beta = 2.146 / tau;
        Self { mu: beta, b: beta, sigma }
    }

    /// Damped by `mu` (1/s) with the damped frequency `lambda / 2 pi` in Hz, as 001 table 1 gives it: `b^2 = mu^2 + lambda^2`.
    pub fn damped(mu: f64, frequency_hz: f64, sigma: f64) -> Self {
        Self { mu, b: mu.hypot(std::f64::consts::TAU * frequency_hz), sigma }
    }
}

/// Another model from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexureChange {
    /// s.
    pub at_s: f64,
    /// The flexure about x, y, z of m from there.
    pub flexure: [GaussMarkov; 3],
}

/// Something that goes wrong with a sub unit at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// s; the first sample that it concerns is the first one that truly ends then or later.
    pub at_s: f64,
    /// What goes wrong.
    pub trouble: Trouble,
}

/// What goes wrong. What the unit would have felt and how it would have erred otherwise stays as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    /// The accelerometers read zero from there on.
    DeadAccelerometers,
    /// The gyro of a case axis, 0 to 2, repeats its last increment from there on.
    StuckGyro(usize),
    /// No sample that ends within so many s from there comes; their sequence numbers are missing.
    Gap(f64),
    /// The stamps are later by so many s from there on than before, earlier if negative.
    DelayStep(f64),
}

/// Impulsive waves, 000 section 5: time is cut into cells, and in some of them the noise that drives the flexure is `factor`
/// times as strong, on all axes; over all cells its variance stays that of the model.
///
/// The cells belong to the sea and not to a unit: the sampling rate changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulses {
    /// How many times as strong.
    pub factor: f64,
    /// Probability of a cell.
    pub probability: f64,
    /// Length of a cell, s.
    pub cell_s: f64,
}

/// Flexure in step with the ship's swing s = (pitch, roll, -heading sway), which is the wave part of the integral of `w_im_m`;
/// turns of the course are no part of it. 004 section 3.
///
/// `theta_c = -[e x] s` and the hull's [`Response`] to s, whose gains are drawn once a run: each axis has the standard deviation
/// `share * sigma` of the first flexure model of that axis, shared at random among the products that the response names,
/// scaled to one deviation as if they were independent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Standard deviation of the coherent flexure over that of the model.
    pub share: f64,
    /// How the flexure follows the swing.
    pub response: Response,
    /// e, rad: to the gyros the same as a static rotation by e.
    pub in_phase_rotation: Vec3<Main>,
}

/// How a hull follows the swing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Response {
    /// `(1 + a) (cos p u + sin p v)`, with `u = K1 s + K2 s90`, `v = K1 s90 - K2 s`; s90 is s a quarter of a period late.
    /// The gain's a and the phase's p (rad) are slow critically damped Gauss-Markov processes of each axis.
    Phase {
        /// Standard deviation of a and p.
        wander: f64,
        /// Time after which their autocovariance has fallen to 1/e, s; positive unless wander is 0.
        wander_tau: f64,
    },
    /// `K s(t - delay)`: the same lag at every frequency. Before t = 0 the swing goes on as a straight line.
    Delayed {
        /// s, from 0 on; a few seconds at most, for the sake of that line.
        delay_s: f64,
    },
    /// `K y`, `y'' + 2 mu y' + b^2 y = b^2 s`. At the start y has its stationary deviations, drawn apart from the swing's:
    /// what is wrong with that dies away as `exp(-mu t)`.
    Resonant {
        /// Damping, 1/s; positive and less than b.
        mu: f64,
        /// Natural frequency, rad/s.
        b: f64,
    },
}

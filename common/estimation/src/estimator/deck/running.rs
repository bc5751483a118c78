//! The filter at work: the model of [`crate::matching::deck`] with its covariance.

use super::DeckSettings;
use super::slam;
use super::surprise::Surprise;
use crate::filter::{sequential, symmetrise};
use crate::flexure::Hull;
use crate::matching::deck::{Covariance, Deck, ROWS, STATES, VELOCITY_ROW, place};
use crate::matching::increment::Increment;
use crate::matching::{Matching, Observation};
use frames::unit;
use nalgebra::SMatrix;
use serde::{Deserialize, Serialize};

/// Beyond this standard deviation (rad) the constant is not worth keeping.
const BROKEN: f64 = 0.1;

/// A velocity that is off by so many deviations is not one to learn from: accelerometers have failed for a moment.
const LOST: f64 = 30.0;

/// How far back innovations count, s, and what their mean square may be.
const SURPRISE_S: f64 = 60.0;
const LARGEST_SURPRISE: f64 = 3.0;

/// The noise of a comparison stands for what is left out of the model, which lasts, and does not become less by comparing more often than this, Hz.
const NOISE_HZ: f64 = 10.0;

/// Model and covariance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Running {
    /// The nominal state.
    pub deck: Deck,
    /// Covariance of its error.
    pub p: Covariance,
    begin_ns: i64,
    last_ns: i64,
    begun: bool,
    coasting: bool,
    surprise: Surprise,
}

impl Running {
    /// Starts at an instant.
    pub fn new((deck, p): (Deck, Covariance), begin_ns: i64, period_s: f64) -> Self {
        let surprise = Surprise::new(SURPRISE_S / period_s, LARGEST_SURPRISE);
        Self { deck, p, begin_ns, last_ns: begin_ns, begun: false, coasting: true, surprise }
    }

    /// Whether its data agree with it.
    pub fn surprise(&self) -> Surprise {
        self.surprise
    }

    /// Whether the attitudes of both units are missing now.
    pub fn is_coasting(&self) -> bool {
        self.coasting
    }

    /// The last instant, ns.
    pub fn last_ns(&self) -> i64 {
        self.last_ns
    }

    /// Time since the start, s.
    pub fn elapsed_s(&self) -> f64 {
        unit::seconds(self.last_ns - self.begin_ns)
    }

    /// Replaces the flexure model from now on.
    pub fn set_flexure(&mut self, hull: Hull) {
        self.deck.set_flexure(hull);
    }

    /// The attitudes to come have other starting axes.
    pub fn leave_epoch(&mut self) {
        self.deck.restart();
        self.begun = false;
    }

    /// Lets the time come, with what both units felt up to then if that is known; `None` when the numbers have become useless.
    pub fn step(&mut self, time_ns: i64, felt: Option<&Increment>, settings: &DeckSettings) -> Option<()> {
        self.deck.coast(unit::seconds(time_ns - self.last_ns).max(0.0));
        self.last_ns = time_ns;
        let due = self.deck.pending_s() >= settings.period_s();
        let elapsed_s = self.elapsed_s();
        self.coasting = !felt.is_some_and(|step| self.deck.advance(elapsed_s, step));
        if self.coasting {
            if due {
                self.predict();
            }
            return self.is_sound();
        }
        if !self.begun {
            self.predict();
            self.start_epoch();
        } else if due {
            let noise = self.predict();
            if self.chain_is_broken() {
                self.start_epoch();
            }
            let mut seen = self.deck.observe();
            if self.has_lost_velocity(&seen) {
                self.deck.forget_velocity();
                seen = self.deck.observe();
            }
            let left_out = (self.left_out(), self.deck.left_out(&self.p));
            for axis in 0..3 {
                seen.noise[(axis, axis)] += left_out.0;
                seen.noise[(VELOCITY_ROW + axis, VELOCITY_ROW + axis)] += left_out.1[axis];
            }
            seen.noise *= (settings.area.filter_hz / NOISE_HZ).max(1.0);
            // a filter that is surprised all the time has a wrong model, not a rough sea
            let correction = slam::update(&mut self.p, &seen, &noise, self.surprise.is_small())?;
            self.deck.inject(&correction.error);
            self.surprise.take(correction.surprise);
        }
        self.is_sound()
    }

    fn has_lost_velocity(&self, seen: &Observation<STATES, ROWS>) -> bool {
        (VELOCITY_ROW..ROWS).any(|k| {
            let row = seen.matrix.row(k);
            let variance = (row * self.p * row.transpose())[0] + seen.noise[(k, k)];
            seen.residual[k].powi(2) > LOST * LOST * variance
        })
    }

    /// Variance about each axis of what a matching that is linear in its errors leaves out, rad^2: flexure and static part's error do not commute.
    /// With degrees of doubt that is many times the matching's own noise, and a filter that does not know it is lost in its first seconds.
    fn left_out(&self) -> f64 {
        let sum = |first: usize| self.p.diagonal().fixed_rows::<3>(first).sum();
        let flexure = self.deck.so3().flexed().0.norm_squared() + sum(place::FLEXURE) + sum(place::SECOND);
        0.5 * flexure * sum(place::STATIC)
    }

    /// Forgets the constant: it is defined anew by what static part and flexure are believed to be.
    fn start_epoch(&mut self) {
        if let Some(transition) = self.deck.start_epoch() {
            self.p = transition * self.p * transition.transpose();
            symmetrise(&mut self.p);
            self.begun = true;
        }
    }

    /// Whether the constant is known so badly that a linear update would do harm, and worse than what it could be defined by.
    fn chain_is_broken(&self) -> bool {
        let trace = |rows: SMatrix<f64, 3, STATES>| (rows * self.p * rows.transpose()).trace();
        let chain = trace(self.deck.deformation_rows());
        chain > BROKEN * BROKEN && chain > 4.0 * trace(self.deck.view(true).rows)
    }

    /// Propagates the covariance; gives what it added.
    fn predict(&mut self) -> Covariance {
        let prediction = self.deck.propagate();
        self.p = sequential::carried(&prediction.transition, &self.p) + prediction.noise;
        prediction.noise
    }

    fn is_sound(&self) -> Option<()> {
        let sound = self.p.diagonal().iter().all(|v| v.is_finite() && *v >= 0.0);
        (sound && self.deck.deformation().log().is_finite()).then_some(())
    }
}

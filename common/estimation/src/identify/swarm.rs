//! What the swarm searches share: what is identified, where they search, how many they are, and numbers that are the same in every run.
//!
//! What is minimised is the sum of squares of [`super::tied`] over `ln mu` and `ln b`, the variance projected out.

use super::axis::Identified;
use super::lagged::Lagged;
use super::poles::identified;
use super::refinement::{DAMPING, FREQUENCY};
use super::series::Series;
use super::tied::{LONGEST_S, SPACING_S, Tied};
use nalgebra::DVector;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Searchers, and rounds of each: those of 000's rivals.
pub const AGENTS: usize = 30;
/// Rounds.
pub const ROUNDS: usize = 100;
/// The same data give the same result.
const SEED: u64 = 1;

/// A place in the box of `ln mu`, `ln b`.
pub type Place = [f64; 2];

/// Even random numbers.
#[derive(Clone, Debug)]
pub struct Dice(Pcg64);

impl Default for Dice {
    fn default() -> Self {
        Self(Pcg64::seed_from_u64(SEED))
    }
}

impl Dice {
    /// From 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A place in the box.
    pub fn place(&mut self) -> Place {
        std::array::from_fn(|axis| {
            let (low, high) = limits(axis);
            low + (high - low) * self.unit()
        })
    }

    /// One of the searchers.
    pub fn agent(&mut self) -> usize {
        ((self.unit() * AGENTS as f64) as usize).min(AGENTS - 1)
    }
}

/// Identifies an axis by a search of the cheapest place; `None` if no model fits with a positive variance.
pub fn identify(series: &Series, search: impl Fn(&dyn Fn(&Place) -> f64) -> Best) -> Option<Identified> {
    let lagged = Lagged::new(series, SPACING_S, LONGEST_S)?;
    let (tied, target) = (Tied::new(series, &lagged), DVector::from_column_slice(&lagged.values));
    let best = search(&|place| tied.cost(&target, place[0].exp(), place[1].exp()));
    identified(series, tied.flexure(&target, best.place[0].exp(), best.place[1].exp())?)
}

/// Least and largest value of an axis of the box.
pub fn limits(axis: usize) -> (f64, f64) {
    let (low, high) = if axis == 0 { DAMPING } else { FREQUENCY };
    (low.ln(), high.ln())
}

/// The place in the box next to this one.
pub fn bounded(place: Place) -> Place {
    std::array::from_fn(|axis| {
        let (low, high) = limits(axis);
        place[axis].clamp(low, high)
    })
}

/// Places and costs; those of less cost replace what is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best {
    /// Where.
    pub place: Place,
    /// How much it costs.
    pub cost: f64,
}

impl Best {
    /// Keeps the cheaper one.
    pub fn offer(&mut self, place: Place, cost: f64) {
        if cost < self.cost {
            *self = Self { place, cost };
        }
    }

    /// Nothing found yet.
    pub fn none() -> Self {
        Self { place: [0.0; 2], cost: f64::INFINITY }
    }
}

//! Particle swarm optimisation: a search that 000 cites for the same task.
//!
//! Source: M. Clerc and J. Kennedy (2002), inertia 0.7298 and both pulls 1.4962, with as many particles and rounds as the whales.
//! What is minimised is the sum of squares of [`super::tied`] over `ln mu` and `ln b`, the variance projected out.

use super::axis::Identified;
use super::lagged::Lagged;
use super::poles::identified;
use super::series::Series;
use super::swarm::{AGENTS, Best, Dice, Place, ROUNDS, bounded};
use super::tied::{LONGEST_S, SPACING_S, Tied};
use nalgebra::DVector;

/// What is kept of a particle's speed.
const INERTIA: f64 = 0.729_8;
/// The pull towards the particle's own best place, and towards that of all.
const PULL: f64 = 1.496_2;

/// Identifies an axis; `None` if no model fits with a positive variance.
pub fn identify(series: &Series) -> Option<Identified> {
    let lagged = Lagged::new(series, SPACING_S, LONGEST_S)?;
    let (tied, target) = (Tied::new(series, &lagged), DVector::from_column_slice(&lagged.values));
    let best = search(|place| tied.cost(&target, place[0].exp(), place[1].exp()));
    identified(series, tied.flexure(&target, best.place[0].exp(), best.place[1].exp())?)
}

/// The cheapest place found.
pub fn search(cost: impl Fn(&Place) -> f64) -> Best {
    let mut dice = Dice::default();
    let mut particles: Vec<(Place, Place, Best)> =
        (0..AGENTS).map(|_| (dice.place(), [0.0; 2], Best::none())).collect();
    let mut best = Best::none();
    for _ in 0..ROUNDS {
        for (place, _, own) in &mut particles {
            let paid = cost(place);
            own.offer(*place, paid);
            best.offer(*place, paid);
        }
        for (place, speed, own) in &mut particles {
            for axis in 0..2 {
                let (to_own, to_best) = (own.place[axis] - place[axis], best.place[axis] - place[axis]);
                speed[axis] = INERTIA * speed[axis] + PULL * (dice.unit() * to_own + dice.unit() * to_best);
                place[axis] += speed[axis];
            }
            *place = bounded(*place);
        }
    }
    best
}

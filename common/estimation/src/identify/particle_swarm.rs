//! Particle swarm optimisation: a search that 000 cites for the same task.
//!
//! Source: M. Clerc and J. Kennedy (2002), inertia 0.7298 and both pulls 1.4962, with as many particles and rounds as the whales.

use super::axis::Identified;
use super::series::Series;
use super::swarm::{self, AGENTS, Best, Dice, Place, ROUNDS, bounded};

/// What is kept of a particle's speed.
const INERTIA: f64 = 0.729_8;
/// The pull towards the particle's own best place, and towards that of all.
const PULL: f64 = 1.496_2;

/// Identifies an axis; `None` if no model fits with a positive variance.
pub fn identify(series: &Series) -> Option<Identified> {
    swarm::identify(series, |cost| search(cost))
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

//! Whale optimisation: the search of 000's rival WOAM.
//!
//! Source: paper 000 section 5 names it without equations; these are those of S. Mirjalili and A. Lewis (2016) with 30 agents and
//! 100 rounds.
//!
//! | number | meaning |
//! |---|---|
//! | `a` | falls from 2 to 0 over the rounds |
//! | `A = 2 a r - a`, `C = 2 r` | a step towards the best (`A` below 1) or a random agent |
//! | `l` in -1 to 1 | place on the spiral around the best, half of the time |
//!
//! Correction: `A` and `C` are drawn anew for each axis, as the authors' programme does and the equations leave open.

use super::axis::Identified;
use super::series::Series;
use super::swarm::{self, AGENTS, Best, Dice, Place, ROUNDS, bounded};
use std::f64::consts::TAU;

/// Identifies an axis; `None` if no model fits with a positive variance.
pub fn identify(series: &Series) -> Option<Identified> {
    swarm::identify(series, |cost| search(cost))
}

/// The cheapest place found.
pub fn search(cost: impl Fn(&Place) -> f64) -> Best {
    let mut dice = Dice::default();
    let mut whales: Vec<Place> = (0..AGENTS).map(|_| dice.place()).collect();
    let mut best = Best::none();
    for round in 0..ROUNDS {
        for whale in &whales {
            best.offer(*whale, cost(whale));
        }
        let a = 2.0 * (1.0 - round as f64 / ROUNDS as f64);
        for k in 0..AGENTS {
            whales[k] = bounded(moved(&whales, k, &best.place, a, &mut dice));
        }
    }
    best
}

fn moved(whales: &[Place], k: usize, best: &Place, a: f64, dice: &mut Dice) -> Place {
    let here = whales[k];
    if dice.unit() < 0.5 {
        let turn = 2.0 * dice.unit() - 1.0;
        let spiral = turn.exp() * (TAU * turn).cos();
        return std::array::from_fn(|axis| (best[axis] - here[axis]).abs() * spiral + best[axis]);
    }
    let other = whales[dice.agent()];
    std::array::from_fn(|axis| {
        let (step, share) = (2.0 * a * dice.unit() - a, 2.0 * dice.unit());
        let leader = if step.abs() < 1.0 { best[axis] } else { other[axis] };
        leader - step * (share * leader - here[axis]).abs()
    })
}

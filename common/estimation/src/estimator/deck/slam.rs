//! A wave that hits the hull: in an instant the flexure changes by many times what its model expects.
//!
//! A filter that does not know it takes part of the blow for its other states: one wave of paper 000's impulsive sea moved the delay by three deviations. The
//! data say it themselves, for nothing else makes every value of an update so unlikely at once after minutes of agreement. So the flexure's own noise since the
//! last update is raised until the update is one that could happen: the variance of a kick by its likelihood, but for a factor below two.

use crate::filter::sequential::{self, Correction};
use crate::matching::Observation;
use crate::matching::deck::{Covariance, ROWS, STATES, place};

/// What says that the hull was hit: the mean square of an update's innovations in terms of their variance. Of three values, the fewest that there are, it is
/// more than this once in a hundred thousand updates.
const UNLIKELY: f64 = 8.0;
/// By how much the variance is raised from one attempt to the next, and how often at most.
const RAISE: f64 = 2.0;
const ATTEMPTS: i32 = 16;

/// The part of a covariance that is the flexure's.
fn of_flexure(noise: &Covariance) -> Covariance {
    let is_flexure = |i: usize| {
        let begins = [place::FLEXURE, place::FLEXURE_RATE, place::SECOND, place::SECOND_RATE];
        begins.into_iter().any(|begin| (begin..begin + 3).contains(&i))
    };
    Covariance::from_fn(|i, j| if is_flexure(i) && is_flexure(j) { noise[(i, j)] } else { 0.0 })
}

/// An update of the error state's covariance `p`, to which `noise` was added since the last one. Where that is unlikely the hull has been hit, if it `may`. The
/// surprise is that of a hull that has not.
pub fn update(
    p: &mut Covariance,
    seen: &Observation<STATES, ROWS>,
    noise: &Covariance,
    may: bool,
) -> Option<Correction<STATES>> {
    let before = *p;
    let calm = sequential::update(p, &seen.residual, &seen.matrix, &seen.noise)?;
    if !may || calm.surprise <= UNLIKELY {
        return Some(calm);
    }
    let blow = of_flexure(noise);
    let mut hit = calm;
    for attempt in 1..=ATTEMPTS {
        *p = before + blow * (RAISE.powi(attempt) - 1.0);
        hit = sequential::update(p, &seen.residual, &seen.matrix, &seen.noise)?;
        if hit.surprise <= 1.0 {
            break;
        }
    }
    Some(Correction { surprise: calm.surprise, ..hit })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;

    /// A flexure about x beside a static angle, of which the sum is seen.
    fn seen(off: f64) -> Observation<STATES, ROWS> {
        let mut seen = Observation {
            residual: SVector::zeros(),
            matrix: nalgebra::SMatrix::zeros(),
            noise: nalgebra::SMatrix::identity(),
        };
        seen.residual[0] = off;
        (seen.matrix[(0, place::STATIC)], seen.matrix[(0, place::FLEXURE)]) = (1.0, 1.0);
        seen
    }

    /// Both are known to one; the flexure has got a hundredth of that since the last update.
    fn known() -> (Covariance, Covariance) {
        let (mut p, mut noise) = (Covariance::zeros(), Covariance::zeros());
        (p[(place::STATIC, place::STATIC)], p[(place::FLEXURE, place::FLEXURE)]) = (1.0, 1.0);
        (noise[(place::STATIC, place::STATIC)], noise[(place::FLEXURE, place::FLEXURE)]) = (0.01, 0.01);
        (p, noise)
    }

    #[test]
    fn what_is_likely_is_an_update_as_any() {
        let (p, noise) = known();
        let (mut one, mut other) = (p, p);
        let seen = seen(4.0);
        let ours = update(&mut one, &seen, &noise, true).expect("sound");
        let usual = sequential::update(&mut other, &seen.residual, &seen.matrix, &seen.noise).expect("sound");
        assert_eq!((one, ours.error, ours.surprise), (other, usual.error, usual.surprise));
    }

    #[test]
    fn a_blow_is_the_flexures_and_known_as_such() {
        let (mut p, noise) = known();
        let hit = update(&mut p, &seen(30.0), &noise, true).expect("sound");
        assert!(hit.error[place::FLEXURE] > 28.0 && hit.error[place::STATIC] < 0.1, "{:?}", hit.error);
        assert!(p[(place::STATIC, place::STATIC)] > 0.99);
        assert_eq!(hit.surprise, 300.0);
    }

    #[test]
    fn where_it_may_not_be_a_blow_it_is_none() {
        let (mut p, noise) = known();
        let calm = update(&mut p, &seen(30.0), &noise, false).expect("sound");
        assert!((calm.error[place::FLEXURE] - calm.error[place::STATIC]).abs() < 1e-9);
    }
}

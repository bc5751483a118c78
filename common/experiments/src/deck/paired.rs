//! Two methods on the same data.

use crate::Stretch;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// How often the trials are drawn anew for an interval.
const DRAWS: usize = 2000;
/// An interval is the same in every run.
const SEED: u64 = 1;
/// What an interval leaves out on either side.
const TAIL: f64 = 0.025;

/// Mean squares about each axis in one trial, at the instants at which both methods stand by their estimates, rad^2.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paired {
    /// Of the error of ours.
    pub ours: [f64; 3],
    /// Of the error of the other.
    pub other: [f64; 3],
    /// Of our standard deviation.
    pub variance: [f64; 3],
    /// Of the other's standard deviation.
    pub other_variance: [f64; 3],
}

impl Paired {
    /// Of the same span of two tracks with the same instants; `None` if there is no common one.
    pub(super) fn of(ours: Stretch, other: Stretch) -> Option<Self> {
        let mut sums = Self { ours: [0.0; 3], other: [0.0; 3], variance: [0.0; 3], other_variance: [0.0; 3] };
        let mut count = 0.0;
        for (one, two) in ours.points.iter().zip(other.points).filter(|(one, two)| one.valid && two.valid) {
            count += 1.0;
            let sigma = [one.sigma(), two.sigma()];
            for axis in 0..3 {
                sums.ours[axis] += one.error[axis].powi(2);
                sums.other[axis] += two.error[axis].powi(2);
                sums.variance[axis] += sigma[0][axis].powi(2);
                sums.other_variance[axis] += sigma[1][axis].powi(2);
            }
        }
        let mean = |sums: [f64; 3]| sums.map(|sum| sum / count);
        (count > 0.0).then(|| Self {
            ours: mean(sums.ours),
            other: mean(sums.other),
            variance: mean(sums.variance),
            other_variance: mean(sums.other_variance),
        })
    }
}

/// Root mean square over the trials of a mean square of theirs.
pub(super) fn root(trials: &[Paired], axis: usize, figure: fn(&Paired) -> [f64; 3]) -> f64 {
    (trials.iter().map(|trial| figure(trial)[axis]).sum::<f64>() / trials.len() as f64).sqrt()
}

/// The RMSE of ours over that of the other, pooled over trials and axes. Axes count by the variance that ours expects of them, so that
/// none hides the others.
pub(super) fn ratio(trials: &[Paired], axes: &[usize]) -> f64 {
    let (mut ours, mut other) = (0.0, 0.0);
    for &axis in axes {
        let sum = |figure: fn(&Paired) -> [f64; 3]| trials.iter().map(|trial| figure(trial)[axis]).sum::<f64>();
        let weight = 1.0 / sum(|trial| trial.variance);
        ours += weight * sum(|trial| trial.ours);
        other += weight * sum(|trial| trial.other);
    }
    (ours / other).sqrt()
}

/// The same of a single trial.
pub(super) fn of_one(trial: &Paired, axes: &[usize]) -> f64 {
    ratio(std::slice::from_ref(trial), axes)
}

/// The 95 % interval of [`ratio`] by the bootstrap over trials; NaN with fewer than two.
pub(super) fn interval(trials: &[Paired], axes: &[usize]) -> [f64; 2] {
    if trials.len() < 2 {
        return [f64::NAN; 2];
    }
    let mut source = Pcg64Mcg::seed_from_u64(SEED);
    let draw = |_| {
        let drawn: Vec<Paired> = trials.iter().map(|_| trials[source.random_range(0..trials.len())]).collect();
        ratio(&drawn, axes)
    };
    let mut ratios: Vec<f64> = (0..DRAWS).map(draw).collect();
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios[(share * (DRAWS - 1) as f64).round() as usize];
    [at(TAIL), at(1.0 - TAIL)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_distr::{Distribution, StandardNormal};

    fn trials(seed: u64, count: usize, factor: f64) -> Vec<Paired> {
        let mut source = Pcg64Mcg::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut source) };
        let one = |_| {
            let shared = [normal(), normal(), normal()];
            let ours = [0, 1, 2].map(|axis| (factor * shared[axis] + 0.2 * normal()).powi(2));
            Paired { ours, other: shared.map(|v| v * v), variance: [1.0; 3], other_variance: [1.0; 3] }
        };
        (0..count).map(one).collect()
    }

    #[test]
    fn axes_count_alike_whatever_their_size() {
        let one = Paired {
            ours: [4.0, 1e6, 1.0],
            other: [1.0, 1e6, 1.0],
            variance: [1.0, 1e6, 1.0],
            other_variance: [1.0; 3],
        };
        assert_eq!(ratio(&[one], &[0]), 2.0);
        assert!((ratio(&[one], &[0, 1, 2]) - 2f64.sqrt()).abs() < 1e-12);
    }

    /// The interval of a true ratio of `hypot(1.2, 0.2)` holds it in about 95 of 100 ensembles.
    #[test]
    fn the_interval_holds_the_true_ratio() {
        let truth = 1.2f64.hypot(0.2);
        let held = (0..100).filter(|&seed| {
            let [low, high] = interval(&trials(seed, 30, 1.2), &[0, 1, 2]);
            low <= truth && truth <= high
        });
        let held = held.count();
        assert!((86..=100).contains(&held), "{held}");
        assert!(interval(&trials(1, 1, 1.0), &[0])[0].is_nan());
    }
}

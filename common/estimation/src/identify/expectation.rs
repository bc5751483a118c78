//! What the autocovariance of detrended rates is expected to be.
//!
//! Paper 000 eq 17 and 20 with the factor of eq 17 the right way up: `r(h) = (2 R(h) - R(h - H) - R(h + H)) / H^2`, which holds
//! for any damping. The removal of mean and trend takes the slowest part of a short window with it, so the expectation is that
//! of `P y` with `P` the projection off both: `P S P`, its diagonals summed in closed form from sums over the sequence.

use crate::flexure::Flexure;
use nalgebra::Vector2;

/// Autocovariance of the mean rates over steps of `step_s` at the lags 0 to `count` - 1 steps, rad^2/s^2.
pub fn rate_autocovariance(model: &Flexure, count: usize, step_s: f64) -> Vec<f64> {
    // The autocovariance of the angle obeys the flexure's own equation, from [variance, 0] on.
    let transition = model.transition(step_s);
    let mut state = Vector2::new(model.sigma * model.sigma, 0.0);
    let mut next = transition * state;
    let mut before = next[0];
    let scale = 1.0 / (step_s * step_s);
    let mut rates = Vec::with_capacity(count);
    for _ in 0..count {
        rates.push((2.0 * state[0] - before - next[0]) * scale);
        before = state[0];
        state = next;
        next = transition * state;
    }
    rates
}

/// Expectation of the unbiased estimate at `lags` after mean and trend have been removed from as many rates as `sequence` has
/// lags from 0 on.
pub fn detrended(sequence: &[f64], lags: &[usize]) -> Vec<f64> {
    let n = sequence.len();
    let count = n as f64;
    let middle = (count - 1.0) / 2.0;
    let square = count * (count * count - 1.0) / 12.0;
    let mut totals = Vec::with_capacity(n);
    let mut moments = Vec::with_capacity(n);
    let (mut total, mut moment) = (0.0, 0.0);
    for (k, r) in sequence.iter().enumerate() {
        total += r;
        moment += k as f64 * r;
        totals.push(total);
        moments.push(moment);
    }
    // Sums over the points up to each one of: S 1, S x, x S x, x^2; S the covariance, x the centred index.
    let mut sums: Vec<[f64; 4]> = Vec::with_capacity(n);
    let mut sum = [0.0; 4];
    for k in 0..n {
        let x = k as f64 - middle;
        let mean = totals[k] + totals[n - 1 - k] - sequence[0];
        let trend = x * mean + moments[n - 1 - k] - moments[k];
        sum = [sum[0] + mean, sum[1] + trend, sum[2] + x * trend, sum[3] + x * x];
        sums.push(sum);
    }
    let (of_mean, of_trend) = (sum[0] / (count * count), sum[2] / (square * square));
    let at = |&h: &usize| {
        let lag = h as f64;
        let [mean, trend, along, squares] = sums[n - 1 - h];
        let left = count - lag;
        // The sum of x over the first n - h points is -h (n - h) / 2.
        let products = squares - lag * lag * left / 2.0;
        let removed = 2.0 * mean / count + 2.0 * (along + lag * trend) / square - of_mean * left - of_trend * products;
        sequence[h] - removed / left
    };
    lags.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::super::autocovariance::detrend;
    use super::*;
    use nalgebra::DMatrix;

    const CASES: [Flexure; 4] = [
        Flexure { mu: 0.0715, b: 0.0715, sigma: 3e-3 },
        Flexure { mu: 0.1, b: 0.6, sigma: 1e-3 },
        Flexure { mu: 0.8, b: 0.3, sigma: 2e-3 },
        Flexure { mu: 2.0, b: 5.0, sigma: 1e-5 },
    ];

    #[test]
    fn the_sequence_is_the_second_difference_of_the_angles_autocovariance() {
        for model in CASES {
            let h = 0.096;
            let sequence = rate_autocovariance(&model, 300, h);
            for (k, found) in sequence.iter().enumerate() {
                let r = |lag: usize| model.autocovariance(lag as f64 * h);
                let wanted = (2.0 * r(k) - r(k.abs_diff(1)) - r(k + 1)) / (h * h);
                assert!((found - wanted).abs() < 1e-9 * sequence[0], "{model:?} {k}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn detrended_is_the_projected_covariance() {
        for (model, n) in CASES.into_iter().zip([80, 121, 200, 33]) {
            let sequence = rate_autocovariance(&model, n, 0.1);
            let mut projection = DMatrix::<f64>::identity(n, n);
            projection.column_iter_mut().for_each(|mut column| detrend(column.as_mut_slice()));
            let covariance = DMatrix::from_fn(n, n, |i, j| sequence[i.abs_diff(j)]);
            let projected = &projection * covariance * projection.transpose();
            let lags: Vec<usize> = (0..n / 2).collect();
            for (&h, found) in lags.iter().zip(detrended(&sequence, &lags)) {
                let wanted = (0..n - h).map(|j| projected[(j, j + h)]).sum::<f64>() / (n - h) as f64;
                assert!((found - wanted).abs() < 1e-10 * sequence[0], "{model:?} {h}: {found} {wanted}");
            }
        }
    }
}

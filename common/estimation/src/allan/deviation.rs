//! The overlapping Allan variance itself.

/// The variance at one averaging time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Averaged {
    /// Averaging time in sampling intervals.
    pub factor: usize,
    /// Averaging time, s.
    pub tau: f64,
    /// Allan variance, square of the rate's unit.
    pub variance: f64,
}

/// At averaging times of 1, 2, 4, ... intervals, up to a third of the longest stretch.
pub(super) fn averaged(stretches: &[&[f64]], interval: f64) -> Vec<Averaged> {
    let summed: Vec<Vec<f64>> = stretches.iter().map(|stretch| summed(stretch, interval)).collect();
    let longest = stretches.iter().map(|stretch| stretch.len()).max().unwrap_or(0);
    let factors = std::iter::successors(Some(1), |factor| Some(2 * factor)).take_while(|factor| 3 * factor <= longest);
    factors.map(|factor| at(&summed, factor, interval)).collect()
}

/// Angle or velocity at the ends of the samples. The mean rate does not matter to the variance, but its sum would cost digits.
fn summed(stretch: &[f64], interval: f64) -> Vec<f64> {
    let mean = stretch.iter().sum::<f64>() / stretch.len().max(1) as f64;
    let mut sum = 0.0;
    let sums = stretch.iter().map(|rate| {
        sum += (rate - mean) * interval;
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}

/// Stretches that are too short for the averaging time give nothing.
fn at(summed: &[Vec<f64>], factor: usize, interval: f64) -> Averaged {
    let (mut square, mut count) = (0.0, 0usize);
    for x in summed {
        let Some(ends) = x.get(2 * factor..) else { continue };
        let sum: f64 = ends.iter().zip(&x[factor..]).zip(x).map(|((c, b), a)| (c - 2.0 * b + a).powi(2)).sum();
        square += sum;
        count += ends.len();
    }
    let tau = factor as f64 * interval;
    Averaged { factor, tau, variance: square / (2.0 * tau * tau * count as f64) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// allantools 2024.6: `oadev` of the series of the golden test in `tests/allan.rs` stands there; here is what can be reckoned by hand.
    #[test]
    fn a_step_and_a_ramp_have_known_variances() {
        let step: Vec<f64> = (0..12).map(|k| if k < 6 { 0.0 } else { 1.0 }).collect();
        let points = averaged(&[&step], 0.5);
        assert_eq!(points.iter().map(|p| p.factor).collect::<Vec<_>>(), [1, 2, 4]);
        // one of eleven differences is 1
        assert!((points[0].variance - 1.0 / 22.0).abs() < 1e-15);
        let ramp: Vec<f64> = (0..100).map(|k| 3.0 * f64::from(k)).collect();
        for point in averaged(&[&ramp], 1.0) {
            // a slope of 3 a second: 3 tau / sqrt 2
            assert!((point.variance / (4.5 * point.tau * point.tau) - 1.0).abs() < 1e-9, "{point:?}");
        }
    }

    #[test]
    fn stretches_are_pooled_and_no_difference_reaches_over_a_break() {
        let (low, high) = ([1.0, -1.0, 1.0, -1.0, 1.0], [1e6, 1e6 + 2.0, 1e6, 1e6 + 2.0]);
        let points = averaged(&[&low, &high, &[5.0]], 1.0);
        assert!((points[0].variance - 2.0).abs() < 1e-6, "{points:?}");
    }

    #[test]
    fn nothing_gives_nothing() {
        assert!(averaged(&[], 1.0).is_empty() && averaged(&[&[1.0, 2.0]], 1.0).is_empty());
    }
}

//! Equivalent degrees of freedom of an overlapping Allan variance, and the confidence bars that follow.
//!
//! The formulas are those of NIST SP 1065, table 5. An estimated variance times its degrees of freedom over the true variance is
//! taken to be chi-square distributed.

/// The kind of noise that rules at an averaging time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noise {
    /// White noise of the angle, which quantisation makes: slope -1 of the deviation.
    Quantisation,
    /// White noise of the rate: slope -1/2.
    White,
    /// Flicker noise of the rate: level.
    Flicker,
    /// Random walk of the rate: slope +1/2.
    Walk,
}

/// Degrees of freedom of stretches with these numbers of angle values (one more than of rates), averaged over `factor` intervals.
pub(super) fn pooled(lengths: &[usize], factor: usize, noise: Noise) -> f64 {
    let long_enough = lengths.iter().filter(|&&length| length > 2 * factor);
    let sum: f64 = long_enough.map(|&length| of_stretch(length as f64, factor as f64, noise)).sum();
    sum.max(1.0)
}

fn of_stretch(n: f64, m: f64, noise: Noise) -> f64 {
    let freedom = match noise {
        Noise::Quantisation => (n + 1.0) * (n - 2.0 * m) / (2.0 * (n - m)),
        Noise::White => (1.5 * (n - 1.0) / m - 2.0 * (n - 2.0) / n) * 4.0 * m * m / (4.0 * m * m + 5.0),
        Noise::Flicker if m == 1.0 => 2.0 * (n - 2.0).powi(2) / (2.3 * n - 4.9),
        Noise::Flicker => 1.25 * n * n / (m * (n + 3.0 * m)),
        Noise::Walk => (n - 2.0) / m * ((n - 1.0).powi(2) - 3.0 * m * (n - 1.0) + 4.0 * m * m) / (n - 3.0).powi(2),
    };
    freedom.max(0.0)
}

/// The ends of the bar of a deviation, as factors of it, out to `z` quantiles of the standard normal on each side.
pub(super) fn bar(freedom: f64, z: f64) -> (f64, f64) {
    let end = |z| (freedom / chi_square(freedom, z)).sqrt();
    (end(z), end(-z))
}

/// Wilson and Hilferty's approximation of the quantile that belongs to `z` of the standard normal. With two degrees of freedom it
/// is 1 % off at one sigma; the degrees of freedom themselves are not known better. Held above zero for very few of them.
fn chi_square(freedom: f64, z: f64) -> f64 {
    let share = 2.0 / (9.0 * freedom);
    freedom * (1.0 - share + z * share.sqrt()).max(0.1).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISES: [Noise; 4] = [Noise::Quantisation, Noise::White, Noise::Flicker, Noise::Walk];

    /// allantools 2024.6, `edf_simple(4097, m, alpha)` for alpha = 2, 0, -1, -2. Its flicker noise at m = 1 lacks the square of
    /// SP 1065 and is left out.
    #[test]
    fn degrees_of_freedom_are_those_of_allantools() {
        let expected = [
            (1, [2048.499755859375, 2729.7782116996173, f64::NAN, 4096.000732899003]),
            (2, [2047.9992673992674, 2339.04836291363, 2556.880483792347, 2046.500733018329]),
            (16, [2040.9666748345994, 380.14480054025165, 316.371550814234, 253.20105989939879]),
            (256, [1912.4355636552982, 22.000556696822247, 16.846866368512334, 13.259710911794613]),
            (1024, [1366.2222583794337, 4.0009715546098485, 2.8581393807648383, 2.001465798006734]),
        ];
        for (factor, row) in expected {
            for (noise, value) in NOISES.into_iter().zip(row).filter(|(_, value)| !value.is_nan()) {
                let found = pooled(&[4097], factor, noise);
                assert!((found / value - 1.0).abs() < 1e-12, "{factor} {noise:?}: {found} instead of {value}");
            }
        }
    }

    /// allantools 2024.6, `confidence_interval(1, edf, ci = 0.6827)`, by the exact chi-square distribution.
    #[test]
    fn bars_are_those_of_the_chi_square_distribution() {
        for (freedom, lower, upper, tolerance) in [
            (1.5, 0.722864909772399, 3.055722833728436, 0.03),
            (5.0, 0.7927328467824031, 1.5594608442307099, 0.003),
            (40.0, 0.9047051924841889, 1.1335292577316922, 2e-4),
            (3000.0, 0.9873361742035709, 1.0131639544740267, 1e-6),
        ] {
            let (below, above) = bar(freedom, 1.0);
            assert!((below / lower - 1.0).abs() < tolerance, "{freedom}: {below} instead of {lower}");
            assert!((above / upper - 1.0).abs() < tolerance, "{freedom}: {above} instead of {upper}");
        }
    }

    #[test]
    fn stretches_add_up_and_short_ones_give_nothing() {
        let one = pooled(&[1000], 8, Noise::White);
        assert!((pooled(&[1000, 1000, 16], 8, Noise::White) / (2.0 * one) - 1.0).abs() < 1e-12);
        assert_eq!(pooled(&[10], 8, Noise::White), 1.0);
        for (noise, z) in NOISES.into_iter().flat_map(|noise| [(noise, 1.0), (noise, 2.58)]) {
            let (below, above) = bar(pooled(&[4], 1, noise), z);
            assert!(below > 0.0 && above.is_finite(), "{noise:?} {z}: {below} {above}");
        }
    }
}

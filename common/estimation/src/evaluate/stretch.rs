//! Figures of a series over a stretch of time.

/// A series has to have been so far under its mean, in standard deviations, before its next way up counts: noise about the mean is no wave.
const UNDER: f64 = 0.05;

/// Figures of a series, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// How many values.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation.
    pub deviation: f64,
    /// The least.
    pub least: f64,
    /// The greatest.
    pub most: f64,
    /// Mean time from one way up through the mean to the next, s; `None` of fewer than two.
    pub period_s: Option<f64>,
}

impl Stretch {
    /// Of values with their times, s, in the order of time; no crossing is counted over a hole of more than `hole_s`. `None` of no value.
    pub fn of(series: &[(f64, f64)], hole_s: f64) -> Option<Self> {
        let count = series.len();
        if count == 0 {
            return None;
        }
        let mean = series.iter().map(|(_, value)| value).sum::<f64>() / count as f64;
        let square = series.iter().map(|(_, value)| (value - mean).powi(2)).sum::<f64>() / count as f64;
        let (least, most) = series
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &(_, value)| (least.min(value), most.max(value)));
        let deviation = square.sqrt();
        let period_s = period(series, mean, UNDER * deviation, hole_s);
        Some(Self { count, mean, deviation, least, most, period_s })
    }
}

/// Mean time from one way up through the mean to the next.
fn period(series: &[(f64, f64)], mean: f64, under: f64, hole_s: f64) -> Option<f64> {
    let (mut waves, mut length_s) = (0u32, 0.0);
    let (mut was_under, mut last_up): (bool, Option<f64>) = (false, None);
    for pair in series.windows(2) {
        let [(t0, before), (t1, now)] = [pair[0], pair[1]];
        if t1 - t0 > hole_s {
            (was_under, last_up) = (false, None);
            continue;
        }
        was_under |= before < mean - under;
        if was_under && before < mean && now >= mean {
            let up = t0 + (t1 - t0) * (mean - before) / (now - before);
            if let Some(last) = last_up {
                (waves, length_s) = (waves + 1, length_s + up - last);
            }
            (was_under, last_up) = (false, Some(up));
        }
    }
    (waves > 0).then(|| length_s / f64::from(waves))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn wave(period_s: f64, ripple: f64, seconds: usize) -> Vec<(f64, f64)> {
        let at = |i: usize| {
            let t = 0.01 * i as f64;
            (t, 3.0 + 2.0 * (TAU * t / period_s).sin() + ripple * (TAU * t / 0.04).sin())
        };
        (0..100 * seconds).map(at).collect()
    }

    #[test]
    fn the_figures_of_a_wave_are_known() {
        let Some(found) = Stretch::of(&wave(8.0, 0.0, 80), 0.05) else { panic!("there are values") };
        assert_eq!(found.count, 8000);
        assert!((found.mean - 3.0).abs() < 1e-9 && (found.deviation - 2f64.sqrt()).abs() < 1e-9, "{found:?}");
        assert!((found.most - 5.0).abs() < 1e-4 && (found.least - 1.0).abs() < 1e-4, "{found:?}");
        assert!(found.period_s.is_some_and(|period| (period - 8.0).abs() < 1e-3), "{found:?}");
    }

    #[test]
    fn ripples_about_the_mean_are_no_waves() {
        let Some(found) = Stretch::of(&wave(8.0, 0.02, 80), 0.05) else { panic!("there are values") };
        assert!(found.period_s.is_some_and(|period| (period - 8.0).abs() < 0.05), "{found:?}");
    }

    #[test]
    fn a_hole_ends_a_wave() {
        let mut series = wave(8.0, 0.0, 80);
        series.retain(|(t, _)| !(18.0..30.0).contains(t));
        let found = Stretch::of(&series, 0.05).and_then(|found| found.period_s);
        assert!(found.is_some_and(|period| (period - 8.0).abs() < 0.05), "{found:?}");
    }

    #[test]
    fn too_little_has_no_period_and_nothing_no_figures() {
        let Some(one) = Stretch::of(&[(0.0, 4.0)], 1.0) else { panic!("there is a value") };
        assert_eq!((one.mean, one.deviation, one.least, one.most, one.period_s), (4.0, 0.0, 4.0, 4.0, None));
        assert_eq!(Stretch::of(&wave(8.0, 0.0, 7), 0.05).and_then(|found| found.period_s), None);
        assert_eq!(Stretch::of(&[], 1.0), None);
    }
}

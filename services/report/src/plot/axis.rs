//! What stands along a chart's edges.

use std::ops::Range;

/// Steps of a time's axis, s.
const TIME_STEPS: [f64; 22] = [
    0.001, 0.01, 0.1, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 900.0, 1800.0, 3600.0, 7200.0,
    14_400.0, 21_600.0, 43_200.0, 86_400.0, 604_800.0,
];

/// How a number becomes a place.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    Linear,
    Logarithmic,
}

/// A range of numbers along an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    range: Range<f64>,
    scale: Scale,
}

/// Numbers with their places, as parts of the axis.
pub type Ticks = Vec<(f64, String)>;

impl Axis {
    /// From the least to the greatest of some numbers, a little widened; 0 to 1 without any.
    pub fn around(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = ends(values);
        let margin = if high > low { 0.06 * (high - low) } else { 0.5 * low.abs().max(1e-3) };
        let range = if low > high { 0.0..1.0 } else { low - margin..high + margin };
        Self { range, scale: Scale::Linear }
    }

    /// The same as logarithms; what is not positive is left out.
    pub fn decades(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = ends(values.filter(|value| *value > 0.0));
        let range = if low > high { 0.1..10.0 } else { low / 1.25..high * 1.25 };
        Self { range, scale: Scale::Logarithmic }
    }

    /// From 0 to a time, s.
    pub fn time(to_s: f64) -> Self {
        Self { range: 0.0..to_s.max(1e-3), scale: Scale::Linear }
    }

    /// Between two numbers as logarithms.
    pub fn between_decades(range: Range<f64>) -> Self {
        Self { range, scale: Scale::Logarithmic }
    }

    /// Where a number lies: 0 at the beginning, 1 at the end; beyond these outside.
    pub fn place(&self, value: f64) -> f64 {
        let Range { start, end } = self.range;
        match self.scale {
            Scale::Linear => (value - start) / (end - start),
            Scale::Logarithmic => (value.max(f64::MIN_POSITIVE) / start).ln() / (end / start).ln(),
        }
    }

    fn at(&self, values: impl Iterator<Item = f64>, text: impl Fn(f64) -> String) -> Ticks {
        values.map(|value| (self.place(value), text(value))).filter(|(place, _)| (0.0..=1.0).contains(place)).collect()
    }

    /// About so many numbers.
    pub fn ticks(&self, wanted: usize) -> Ticks {
        let Range { start, end } = self.range;
        if self.scale == Scale::Logarithmic {
            let decades = (end / start).log10();
            let factors: &[f64] = match decades / wanted.max(1) as f64 {
                dense if dense < 0.15 => &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
                dense if dense < 0.45 => &[1.0, 2.0, 5.0],
                _ => &[1.0],
            };
            let every = (decades / (wanted.max(1) as f64 * 1.5)).ceil().max(1.0) as i32;
            let powers = (-30..30).filter(|power: &i32| power.rem_euclid(every) == 0);
            return self.at(powers.flat_map(|power| factors.iter().map(move |f| f * 10f64.powi(power))), short);
        }
        let rough = (end - start) / wanted.max(1) as f64;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 2.5, 5.0, 10.0].map(|f| f * power).into_iter().find(|step| *step >= rough);
        let step = step.unwrap_or(10.0 * power);
        let decimals = (-(step * 1.0001).log10().floor()).max(0.0) as usize;
        let decimals = if (step / power - 2.5).abs() < 1e-6 && power <= 1.0 { decimals + 1 } else { decimals };
        let (first, last) = ((start / step).ceil(), (end / step).floor());
        let count = (last - first).clamp(-1.0, 100.0) as i64;
        let text = |value: f64| signed(format!("{:.decimals$}", value + 0.0));
        self.at((0..=count).map(|k| (first + k as f64) * step), text)
    }

    /// About so many numbers of a time's axis.
    pub fn times(&self, wanted: usize) -> Ticks {
        let rough = (self.range.end - self.range.start) / wanted.max(1) as f64;
        let step = TIME_STEPS.into_iter().find(|step| *step >= rough).unwrap_or(rough);
        let count = (self.range.end / step).floor().min(100.0) as i64;
        self.at((0..=count).map(|k| k as f64 * step), |t| clock(t, step))
    }
}

/// The least and the greatest; crossed of none.
fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

/// A time such as 12:30 (minutes and seconds) or 2:05:00; with decimals where steps are shorter than a second.
pub fn clock(t_s: f64, step_s: f64) -> String {
    if step_s < 1.0 {
        return format!("{}", (t_s * 1e3).round() / 1e3);
    }
    let seconds = t_s.round() as i64;
    let (h, min, s) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    if h > 0 { format!("{h}:{min:02}:{s:02}") } else { format!("{min}:{s:02}") }
}

/// A number of a logarithmic axis.
fn short(value: f64) -> String {
    if !(1e-4..1e6).contains(&value) {
        let text = format!("{value:.0e}");
        return signed(text);
    }
    signed(format!("{}", (value * 1e9).round() / 1e9))
}

/// With a minus sign that is as wide as a plus.
pub fn signed(text: String) -> String {
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        return text.trim_start_matches('-').to_owned();
    }
    text.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(ticks: Ticks) -> Vec<String> {
        ticks.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn numbers_are_round_and_lie_within() {
        let axis = Axis::around([-12.3, 31.0].into_iter());
        let ticks = axis.ticks(4);
        assert_eq!(texts(ticks.clone()), ["0", "20"]);
        assert!(ticks.iter().all(|(place, _)| (0.0..=1.0).contains(place)));
        assert_eq!(texts(Axis::around([-0.02, 0.031].into_iter()).ticks(4)), ["−0.02", "0.00", "0.02"]);
        assert_eq!(texts(Axis::between_decades(0.5..2000.0).ticks(4)), ["1", "10", "100", "1000"]);
        assert_eq!(texts(Axis::between_decades(1.0..8.0).ticks(4)), ["1", "2", "5"]);
    }

    #[test]
    fn times_are_those_of_a_clock() {
        assert_eq!(texts(Axis::time(90.0).times(6)), ["0:00", "0:15", "0:30", "0:45", "1:00", "1:15", "1:30"]);
        assert_eq!(
            texts(Axis::time(9000.0).times(5)),
            ["0:00", "0:30:00", "1:00:00"]
                .map(|t| t.replace("0:30:00", "30:00"))
                .into_iter()
                .chain(["1:30:00", "2:00:00", "2:30:00"].map(String::from))
                .collect::<Vec<_>>()
        );
    }

    #[test]
    fn whatever_the_numbers_there_is_an_axis() {
        for values in [vec![], vec![f64::NAN], vec![5.0], vec![0.0], vec![-1e300, 1e300], vec![1e-12, 2e-12]] {
            for axis in [Axis::around(values.iter().copied()), Axis::decades(values.iter().copied()), Axis::time(0.0)] {
                assert!(axis.ticks(5).len() < 40 && axis.times(5).len() < 110, "{values:?}");
                assert!(axis.ticks(5).iter().all(|(place, _)| place.is_finite()), "{values:?}");
            }
        }
    }
}

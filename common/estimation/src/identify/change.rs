//! Whether the flexure has become another one: the sea, the speed, the loading.
//!
//! The last minutes of a window are fitted by a model of their own. While nothing changes, that fits them better than the model of what came before by about
//! one in the posterior's logarithm a parameter; where it fits far better, what came before speaks of another hull, and the window is cut.
//!
//! A sea that slams is never the same for two minutes, though the hull is. So a part must differ far more than the parts before it differ from each other.

use super::series::{Kind, Series};
use super::whittle::{departure, fitted};

/// The lengths that are looked at, s.
const LENGTHS_S: [f64; 3] = [60.0, 90.0, 120.0];
/// A window must be so many times as long as what is looked at: the last is the part in question, the others show what is usual.
const PARTS: usize = 5;
/// By how much a part departs from another model while nothing changes, summed over the axes: four parameters each.
const EXPECTED: f64 = 12.0;
/// What says that the flexure has changed where the parts before depart as expected; it grows with the square of what is usual. A window is looked at some
/// hundred times an hour.
const DECISIVE: f64 = 50.0;

/// So much of the end of a window, whose rates (rad/s, `step_s` apart, an axis of m each) are given, is of another flexure, s; `None` if all of it is of the same.
pub fn changed(rates: &[Vec<f64>; 3], step_s: f64) -> Option<f64> {
    let mut best = None;
    for length_s in LENGTHS_S {
        let count = (length_s / step_s) as usize;
        if count * PARTS > rates[0].len() {
            break;
        }
        let (mut last, mut before) = (0.0, 0.0);
        for values in rates {
            let departures = departures(values, count, step_s)?;
            last += departures[0];
            before += departures[1..].iter().sum::<f64>() / (departures.len() - 1) as f64;
        }
        let evidence = last / (before / EXPECTED).max(1.0).powi(2);
        if evidence > best.map_or(DECISIVE, |(evidence, _)| evidence) {
            best = Some((evidence, length_s));
        }
    }
    best.map(|(_, length_s)| length_s)
}

/// How far parts of `count` rates about an axis depart from the model of all but the last part, the last part first.
fn departures(values: &[f64], count: usize, step_s: f64) -> Option<Vec<f64>> {
    let series = |values| Series { kind: Kind::Rates, values, step_s };
    let usual = fitted(&series(&values[..values.len() - count]))?;
    values.rchunks_exact(count).map(|part| departure(&series(part), &usual)).collect()
}

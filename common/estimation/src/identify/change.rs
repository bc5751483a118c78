//! Whether the flexure has become another one: the sea, the speed, the loading.
//!
//! The last minutes of a window are fitted by a model of their own. While nothing changes, that fits them better than the window's model by about one in
//! the posterior's logarithm a parameter; where it fits far better, what came before speaks of another hull, and the window is cut.

use super::series::{Kind, Series};
use super::whittle::{self, Settings};

/// The lengths that are looked at, s.
const LENGTHS_S: [f64; 4] = [60.0, 90.0, 120.0, 180.0];
/// A window must be so many times as long as what is looked at.
const LONGER: f64 = 2.0;
/// The sum over the axes that says so; 12 is expected with a deviation of 5, and a window is looked at some hundred times an hour.
const DECISIVE: f64 = 50.0;

/// So much of the end of a window, whose rates (rad/s, `step_s` apart, an axis of m each) are given, is of another flexure, s; `None` if all of it is of the same.
pub fn changed(rates: &[Vec<f64>; 3], step_s: f64) -> Option<f64> {
    let length_s = rates[0].len() as f64 * step_s;
    let lengths: Vec<f64> = LENGTHS_S.into_iter().filter(|part_s| part_s * LONGER <= length_s).collect();
    let lasts: Vec<usize> = lengths.iter().map(|part_s| (part_s / step_s) as usize).collect();
    let mut sums = vec![0.0; lasts.len()];
    for values in rates {
        let series = Series { kind: Kind::Rates, values, step_s };
        let departures = whittle::departures(&series, &lasts, &Settings::of(&series))?;
        sums.iter_mut().zip(departures).for_each(|(sum, departure)| *sum += departure);
    }
    let (place, largest) = sums.iter().enumerate().max_by(|one, other| one.1.total_cmp(other.1))?;
    (*largest > DECISIVE).then(|| lengths[place])
}

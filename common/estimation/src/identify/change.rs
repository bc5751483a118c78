//! Whether the flexure has become another one: the sea, the speed, the loading.
//!
//! The last minutes of a window are fitted by a model of their own. While nothing changes, that fits them better than the model of what came before by about
//! one in the posterior's logarithm a parameter; where it fits far better, what came before speaks of another hull, and the window is cut.
//!
//! When that was is then looked for closely: what is kept of the old hull, or taken for the new one, makes each minute's estimate wrong.
//!
//! A sea that slams is never the same for two minutes, though the hull is. So a part must differ far more than the parts before it differ from each other.

use super::innovation::Noisy;
use super::onset::onset;
use super::series::{Kind, Series};
use super::whittle::{Fitted, departure, fitted};

/// The lengths that are looked at, s.
const LENGTHS_S: [f64; 3] = [60.0, 90.0, 120.0];
/// A window must be so many times as long as what is looked at: the last is the part in question, the others show what is usual.
const PARTS: usize = 5;
/// By how much a part departs from another model while nothing changes, summed over the axes: four parameters each.
const EXPECTED: f64 = 12.0;
/// What says that the flexure has changed where the parts before depart as expected; it grows with the square of what is usual. A window is looked at some
/// hundred times an hour.
const DECISIVE: f64 = 50.0;

/// A change is placed so far back at most, and leaves so much of the new flexure at least, s.
const FARTHEST_S: f64 = 180.0;
const NEAREST_S: f64 = 20.0;
/// So often is the new model fitted to what the last placing says is new.
const PLACINGS: usize = 3;

/// A part that departs from the whole window's model by less is not looked at more closely.
const SUSPICIOUS: f64 = 25.0;

/// So much of the end of a window, whose rates (rad/s, `step_s` apart, an axis of m each) are given, is of another flexure, s; `None` if all of it is of the same.
pub fn changed(rates: &[Vec<f64>; 3], step_s: f64) -> Option<f64> {
    let axes = rates.each_ref().map(|values| Axis { values, step_s });
    let lengths = LENGTHS_S.map(|length_s| (length_s, (length_s / step_s) as usize));
    let mut lengths = lengths.into_iter().filter(|(_, count)| count * PARTS <= rates[0].len()).peekable();
    lengths.peek()?;
    let [x, y, z] = axes.each_ref().map(|axis| fitted(&axis.series(axis.values)));
    let whole = [x?, y?, z?];
    let mut best = None;
    for (length_s, count) in lengths {
        let mut departures = axes.iter().zip(&whole).map(|(axis, whole)| axis.last(count, whole));
        if departures.try_fold(0.0, |sum, departure| Some(sum + departure?))? < SUSPICIOUS {
            continue;
        }
        let evidence = evidence(&axes, count)?;
        if evidence > best.map_or(DECISIVE, |(evidence, _)| evidence) {
            best = Some((evidence, length_s));
        }
    }
    let (_, length_s) = best?;
    Some(placed(&axes, (length_s / step_s) as usize).map_or(length_s, |count| count as f64 * step_s))
}

/// How many of the last rates are of another flexure, if about the last `count` are; `None` where a model cannot be fitted.
fn placed(axes: &[Axis; 3], count: usize) -> Option<usize> {
    let (step_s, whole) = (axes[0].step_s, axes[0].values.len());
    let far = ((FARTHEST_S / step_s) as usize).min(whole);
    let near = (NEAREST_S / step_s) as usize;
    let mut count = count;
    for _ in 0..PLACINGS {
        let [x, y, z] = axes.each_ref().map(|axis| axis.split(count, far));
        count = far - onset(&[x?, y?, z?], step_s, near);
    }
    Some(count)
}

/// By how much the last part departs from the model of what came before, in terms of what the parts before do.
fn evidence(axes: &[Axis; 3], count: usize) -> Option<f64> {
    let (mut last, mut before) = (0.0, 0.0);
    for axis in axes {
        let departures = axis.departures(count)?;
        last += departures[0];
        before += departures[1..].iter().sum::<f64>() / (departures.len() - 1) as f64;
    }
    Some(last / (before / EXPECTED).max(1.0).powi(2))
}

/// The rates about one axis.
struct Axis<'a> {
    values: &'a [f64],
    step_s: f64,
}

impl<'a> Axis<'a> {
    fn series<'b>(&self, values: &'b [f64]) -> Series<'b> {
        Series { kind: Kind::Rates, values, step_s: self.step_s }
    }

    /// The most probable model of some of its rates.
    fn model(&self, values: &[f64]) -> Option<Noisy> {
        Noisy::fitted(&self.series(values))
    }

    /// The last `far` rates, the model of all but the last `count`, and the model of those.
    fn split(&self, count: usize, far: usize) -> Option<(&'a [f64], Noisy, Noisy)> {
        let whole = self.values.len();
        let (before, after) = self.values.split_at(whole - count);
        Some((&self.values[whole - far..], self.model(before)?, self.model(after)?))
    }

    /// How far the last `count` rates depart from a model.
    fn last(&self, count: usize, model: &Fitted) -> Option<f64> {
        departure(&self.series(&self.values[self.values.len() - count..]), model)
    }

    /// How far parts of `count` rates depart from the model of all but the last part, the last part first.
    fn departures(&self, count: usize) -> Option<Vec<f64>> {
        let usual = fitted(&self.series(&self.values[..self.values.len() - count]))?;
        self.values.rchunks_exact(count).map(|part| departure(&self.series(part), &usual)).collect()
    }
}

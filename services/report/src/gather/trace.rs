//! Series of any length in a bounded number of cells, for drawing.

use std::ops::Range;

/// As many cells as a drawing can show apart, or half as many.
const MOST: usize = 1200;
/// Values may be missing for so long, s, before a line is broken.
const HOLE_S: f64 = 0.6;

/// What is kept of the values of a cell.
pub trait Cell: Copy {
    /// Takes in what a later cell holds.
    fn join(&mut self, later: &Self);
}

impl<C: Cell> Cell for [C; 3] {
    fn join(&mut self, later: &Self) {
        self.iter_mut().zip(later).for_each(|(cell, later)| cell.join(later));
    }
}

/// Cells that follow each other in time, all of one width. It doubles whenever there would be too many.
#[derive(Clone, Debug)]
pub struct Trace<C> {
    width_ns: i64,
    cells: Vec<Option<C>>,
}

impl<C: Cell> Trace<C> {
    /// Of values that come so often.
    pub fn new(interval_ns: i64) -> Self {
        Self { width_ns: interval_ns.max(1), cells: Vec::new() }
    }

    /// Takes in a value so long after the beginning, ns; what is before the beginning counts as at it.
    pub fn take(&mut self, time_ns: i64, value: C) {
        let time_ns = time_ns.max(0);
        while time_ns / self.width_ns >= MOST as i64 {
            self.widen();
        }
        // less than MOST
        let place = (time_ns / self.width_ns) as usize;
        if self.cells.len() <= place {
            self.cells.resize(place + 1, None);
        }
        match &mut self.cells[place] {
            Some(cell) => cell.join(&value),
            empty => *empty = Some(value),
        }
    }

    fn widen(&mut self) {
        self.cells = joined(&self.cells, 2);
        self.width_ns *= 2;
    }

    /// Whether nothing has been taken in.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The cells that hold something, with the times of their middles, s; `None` between two that are far apart.
    pub fn cells(&self) -> Vec<Option<(f64, C)>> {
        let width_s = frames::unit::seconds(self.width_ns);
        let hole_s = HOLE_S.max(2.5 * width_s);
        let held =
            self.cells.iter().enumerate().filter_map(|(place, cell)| Some(((place as f64 + 0.5) * width_s, (*cell)?)));
        let mut cells: Vec<Option<(f64, C)>> = Vec::new();
        for cell in held {
            if cells.last().is_some_and(|last| last.is_some_and(|(t, _)| cell.0 - t > hole_s)) {
                cells.push(None);
            }
            cells.push(Some(cell));
        }
        cells
    }

    /// At most so many cells, each with its time from and to, s; those without values are left out.
    pub fn rows(&self, most: usize) -> Vec<(Range<f64>, C)> {
        let together = self.cells.len().div_ceil(most.max(1)).max(1);
        let width_s = together as f64 * frames::unit::seconds(self.width_ns);
        let rows = joined(&self.cells, together).into_iter().enumerate();
        rows.filter_map(|(row, cell)| Some((row as f64 * width_s..(row + 1) as f64 * width_s, cell?))).collect()
    }
}

fn joined<C: Cell>(cells: &[Option<C>], together: usize) -> Vec<Option<C>> {
    let join = |cells: &[Option<C>]| {
        cells.iter().flatten().copied().reduce(|mut sum, later| {
            sum.join(&later);
            sum
        })
    };
    cells.chunks(together).map(join).collect()
}

/// The least, the greatest and the mean of numbers; those that are not finite are passed over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// The least; infinite of nothing.
    pub least: f64,
    /// The greatest; minus infinite of nothing.
    pub most: f64,
    sum: f64,
    count: u32,
}

impl Envelope {
    /// Of one number.
    pub fn of(value: f64) -> Self {
        Self::between(value, value)
    }

    /// Of all that lies between two numbers.
    pub fn between(least: f64, most: f64) -> Self {
        if least.is_finite() && most.is_finite() {
            Self { least, most, sum: 0.5 * (least + most), count: 1 }
        } else {
            Self { least: f64::INFINITY, most: f64::NEG_INFINITY, sum: 0.0, count: 0 }
        }
    }

    /// The mean; `None` of nothing.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / f64::from(self.count))
    }
}

impl Cell for Envelope {
    fn join(&mut self, later: &Self) {
        self.least = self.least.min(later.least);
        self.most = self.most.max(later.most);
        self.sum += later.sum;
        self.count = self.count.saturating_add(later.count);
    }
}

/// Flags that were raised, and whether there was anything else.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// Raised at any time.
    pub any: u64,
}

impl Cell for Marks {
    fn join(&mut self, later: &Self) {
        self.any |= later.any;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn however_long_it_is_no_peak_is_lost_and_the_mean_stays() {
        let mut trace = Trace::new(10);
        for i in 0..100_000i64 {
            trace.take(10 * i, Envelope::of(if i == 54_321 { 700.0 } else { (i % 7) as f64 }));
        }
        let cells: Vec<_> = trace.cells().into_iter().flatten().collect();
        assert!(cells.len() <= MOST && cells.len() > MOST / 2, "{} cells", cells.len());
        assert!(cells.windows(2).all(|pair| pair[0].0 < pair[1].0));
        let most = cells.iter().map(|(_, cell)| cell.most).fold(0.0, f64::max);
        assert_eq!(most, 700.0);
        let rows = trace.rows(20);
        assert!(rows.len() <= 20 && rows.len() > 10);
        let [first, last] = [&rows[0], &rows[rows.len() - 1]];
        assert_eq!(first.0.start, 0.0);
        assert!((first.1.mean().unwrap_or(0.0) - 3.0).abs() < 0.01 && last.1.least == 0.0);
    }

    #[test]
    fn holes_stay_holes() {
        let mut trace = Trace::new(1_000_000_000);
        [0, 1, 2, 7, 8].into_iter().for_each(|t| trace.take(t * 1_000_000_000, Envelope::of(1.0)));
        let there: Vec<bool> = trace.cells().iter().map(Option::is_some).collect();
        assert_eq!(there, [true, true, true, false, true, true]);
        assert_eq!(trace.rows(3).len(), 2);
    }

    #[test]
    fn what_is_no_number_or_out_of_time_does_no_harm() {
        let mut trace = Trace::new(1);
        trace.take(i64::MIN, Envelope::of(f64::NAN));
        trace.take(i64::MAX, Envelope::of(2.0));
        let cells: Vec<_> = trace.cells().into_iter().flatten().collect();
        assert_eq!(cells.iter().map(|(_, cell)| cell.mean()).collect::<Vec<_>>(), [None, Some(2.0)]);
        assert!(Trace::<Envelope>::new(0).rows(5).is_empty());
    }
}

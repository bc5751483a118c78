//! When the sea hits the hull: 000 section 5, impulsive waves.

use crate::Impulses;
use crate::random::Source;
use crate::sampling::NEVER;
use frames::unit::nanoseconds;

/// The strength of the driving noise as time goes on.
pub(crate) struct Gusts {
    quiet: f64,
    loud: f64,
    probability: f64,
    cell_ns: i64,
    /// The loud cell that comes next or is under way.
    cell: i64,
    source: Source,
}

impl Gusts {
    /// `None` if the sea never hits.
    pub(crate) fn new(impulses: &Impulses, source: Source) -> Option<Self> {
        let Impulses { factor, probability, cell_s } = *impulses;
        let cell_ns = nanoseconds(cell_s);
        if !(probability > 0.0 && probability < 1.0 && cell_ns > 0) {
            return None;
        }
        let quiet = (1.0 - probability + probability * factor * factor).sqrt().recip();
        let mut gusts = Self { quiet, loud: factor * quiet, probability, cell_ns, cell: -1, source };
        gusts.draw();
        Some(gusts)
    }

    /// The next loud cell: the number of quiet ones between is geometric.
    fn draw(&mut self) {
        let gap = (1.0 - self.source.uniform()).ln() / (1.0 - self.probability).ln();
        self.cell = self.cell.saturating_add(1).saturating_add(gap as i64);
    }

    /// How many times as strong the noise is from an instant on, and until when. Instants must not go back.
    pub(crate) fn at(&mut self, time_ns: i64) -> (f64, i64) {
        while self.instant(self.cell.saturating_add(1)) <= time_ns {
            self.draw();
        }
        match self.instant(self.cell) {
            begin_ns if time_ns < begin_ns => (self.quiet, begin_ns),
            _ => (self.loud, self.instant(self.cell.saturating_add(1))),
        }
    }

    fn instant(&self, cell: i64) -> i64 {
        cell.checked_mul(self.cell_ns).unwrap_or(NEVER)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;

    /// Share of loud cells, mean power and whole cells, however finely the time is cut.
    #[test]
    fn loud_cells_are_as_frequent_and_strong_as_told() {
        let impulses = Impulses { factor: 50.0, probability: 5e-4, cell_s: 0.01 };
        for (seed, step_ns) in [(1, 10_000_000), (2, 7_000_000), (3, 5_000_000_000)] {
            let mut gusts = Gusts::new(&impulses, Source::new(seed, Purpose::Impulses, 0)).expect("possible impulses");
            let end_ns = 40_000_000_000_000;
            let (mut now_ns, mut loud_ns, mut power) = (0, 0, 0.0);
            while now_ns < end_ns {
                let (gain, until_ns) = gusts.at(now_ns);
                assert!(until_ns > now_ns && until_ns % 10_000_000 == 0);
                let step = until_ns.min(now_ns + step_ns).min(end_ns) - now_ns;
                loud_ns += if gain > 1.0 { step } else { 0 };
                power += gain * gain * step as f64;
                now_ns += step;
            }
            let cells = end_ns as f64 / 1e7;
            let spread = (5e-4 / cells).sqrt();
            assert!((loud_ns as f64 / end_ns as f64 - 5e-4).abs() < 4.0 * spread);
            assert!((power / end_ns as f64 - 1.0).abs() < 4.0 * spread * 2500.0 / 2.2495);
        }
    }

    #[test]
    fn impossible_gusts_never_come() {
        for (probability, cell_s) in [(0.0, 0.01), (1.0, 0.01), (f64::NAN, 0.01), (0.1, 0.0), (0.1, -1.0)] {
            let impulses = Impulses { factor: 2.0, probability, cell_s };
            assert!(Gusts::new(&impulses, Source::new(1, Purpose::Impulses, 0)).is_none());
        }
    }
}

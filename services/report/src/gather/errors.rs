use super::{Envelope, Trace};
use estimation::evaluate::against::{Difference, Figures as BlockFigures};
use frames::unit;
use messages::{Solution, Truth};
use pipeline::summary::{AreaSummary, Figures, deformation_error};

/// Length of a block, ns.
const BLOCK_NS: i64 = 600_000_000_000;

/// How far the solutions of an area were off, where the truth is recorded.
#[derive(Clone, Debug)]
pub struct Errors {
    figures: Figures,
    /// Error about each axis against time, arcmin.
    pub trace: Trace<[Envelope; 3]>,
    number: i64,
    differences: Vec<Difference>,
    /// Every ten minutes: when it begins, s, and the figures of the valid solutions in it.
    pub blocks: Vec<(f64, BlockFigures)>,
}

impl Errors {
    /// Nothing yet.
    pub fn new(name: &str, settle_s: f64, interval_ns: i64) -> Self {
        Self {
            figures: Figures::new(name, settle_s),
            trace: Trace::new(interval_ns),
            number: 0,
            differences: Vec::new(),
            blocks: Vec::new(),
        }
    }

    /// Takes a solution with its truth, if that is known.
    pub fn take(&mut self, since_ns: i64, solution: &Solution, truth: Option<&Truth>) {
        truth.iter().for_each(|truth| self.figures.truth(truth));
        self.figures.solution(solution);
        let Some(truth) = truth.filter(|_| solution.is_valid()) else { return };
        let number = since_ns.max(0) / BLOCK_NS;
        if number != self.number {
            self.close();
            self.number = number;
        }
        let error = deformation_error(solution, truth);
        self.trace.take(since_ns, error.array().map(|error| Envelope::of(error / unit::ARCMIN)));
        self.differences.push(Difference { error, range: Some(solution.range) });
    }

    /// Ends the block.
    pub fn close(&mut self) {
        let begin_s = unit::seconds(self.number.saturating_mul(BLOCK_NS));
        self.blocks.extend(BlockFigures::of(&self.differences).map(|figures| (begin_s, figures)));
        self.differences.clear();
    }

    /// The figures that `process` and `launch` write into `summary.json`.
    pub fn summary(&self) -> AreaSummary {
        self.figures.summary()
    }
}

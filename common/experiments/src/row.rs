use crate::statistics::{mean, rms, spread};
use crate::{Published, Verdict};

/// The statistical bound of a figure: what the best method could reach with the same data.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound {
    /// In the row's unit.
    Value(f64),
    /// Why there is none.
    None(String),
}

/// A figure of a paper, before it is measured. There is no claim without a bound or the reason why there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Unique over all experiments, such as `idam/gaussian/rvm/z`.
    pub id: String,
    /// The paper's table or figure. Rows of a table stand together.
    pub table: String,
    /// Method and case.
    pub row: String,
    /// `x`, `y`, `z`, or what else the figure is of.
    pub axis: String,
    /// Unit of measure of every number of the row; empty for a plain number.
    pub unit: String,
    /// The bound, or why there is none.
    pub bound: Bound,
    /// What the paper says.
    pub paper: Published,
    /// One sentence: why the verdict is what it is.
    pub why: String,
}

/// A figure of a paper beside ours.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What was claimed.
    pub claim: Claim,
    /// Our figure; NaN if no trial gave one.
    pub ours: f64,
    /// Standard deviation over the trials; NaN of a single one.
    pub spread: f64,
    /// Number of trials.
    pub trials: usize,
    /// Computed from the figures above.
    pub verdict: Verdict,
}

impl Claim {
    /// Beside the mean of a figure over the trials.
    pub fn mean(self, values: &[f64]) -> Row {
        self.figure(mean(values), values)
    }

    /// Beside the root mean square of a figure over the trials.
    pub fn rms(self, values: &[f64]) -> Row {
        self.figure(rms(values), values)
    }

    /// Beside another figure of the trials, whose spread is that of `values`.
    pub fn figure(self, ours: f64, values: &[f64]) -> Row {
        let (spread, trials) = (spread(values), values.len());
        let verdict = Verdict::of(ours, spread, trials, &self.paper);
        Row { claim: self, ours, spread, trials, verdict }
    }
}

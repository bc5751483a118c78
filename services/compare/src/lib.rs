//! `deckflex compare`: how far a solution lies from a reference unit's, or from the truth, once the fixed deviation is removed.

mod error;
mod pairs;
mod report;

pub use error::CompareError;
pub use report::Report;

use estimation::evaluate::against::{self, Difference, Figures};
use frames::Rot;
use pairs::Pair;
use pipeline::deformation_file::DeformationFile;
use std::path::PathBuf;

/// What the user asks for. Times count from the first instant that both files have.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The solution file.
    pub solution: PathBuf,
    /// A reference unit's solution file, or a file of the truth.
    pub reference: PathBuf,
    /// The static stretch from which the fixed deviation is taken, s; `None` for all that is compared.
    pub still: Option<[f64; 2]>,
    /// Leaves the fixed deviation in, as a reference allows that knows it, such as the truth.
    pub keep_fixed: bool,
    /// What comes before is not compared, s.
    pub from: f64,
    /// Where the numbers go.
    pub json: Option<PathBuf>,
}

/// Compares the files and writes `options.json`.
///
/// # Errors
/// A file cannot be used; the files have no time in common, or none in the static stretch; the output cannot be written.
pub fn run(options: &Options) -> Result<Report, CompareError> {
    let solution = DeformationFile::read(&options.solution)?;
    let reference = DeformationFile::read(&options.reference)?;
    let joined = pairs::join(&solution.rows, &reference.rows);
    let apart = || CompareError::Apart { solution: options.solution.clone(), reference: options.reference.clone() };
    let begin = joined.pairs.first().ok_or_else(apart)?.t;
    let end = joined.pairs.last().map_or(0.0, |pair| pair.t - begin);
    let compared: Vec<&Pair> = joined.pairs.iter().filter(|pair| pair.t - begin >= options.from).collect();
    let within = |[from, to]: [f64; 2]| joined.pairs.iter().filter(move |pair| (from..=to).contains(&(pair.t - begin)));
    let rotations = |pair: &Pair| (pair.solution.rotation, pair.reference);
    let still: Vec<_> = match options.still {
        _ if options.keep_fixed => Vec::new(),
        Some(stretch) => within(stretch).map(rotations).collect(),
        None => compared.iter().map(|pair| rotations(pair)).collect(),
    };
    let fixed = match (options.keep_fixed, against::fixed(&still)) {
        (true, _) => Rot::identity(),
        (false, Some(fixed)) => fixed,
        (false, None) => return Err(CompareError::Nothing { stretch: options.still, from: options.from, end }),
    };
    let difference = |pair: &&Pair| Difference {
        error: against::error(pair.solution.rotation, pair.reference, fixed),
        range: pair.solution.range,
    };
    let differences: Vec<Difference> = compared.iter().map(difference).collect();
    let nothing = CompareError::Nothing { stretch: None, from: options.from, end };
    let report = Report {
        options: options.clone(),
        figures: Figures::of(&differences).ok_or(nothing)?,
        span: [compared.first().map_or(begin, |pair| pair.t), begin + end],
        fixed,
        still: still.len(),
        solution_invalid: solution.invalid,
        solution_refused: solution.refused,
        reference_invalid: reference.invalid,
        reference_refused: reference.refused,
        unmatched: joined.unmatched,
        interpolated: joined.interpolated,
    };
    if let Some(path) = &options.json {
        std::fs::write(path, report.json()?).map_err(|source| CompareError::Output { path: path.clone(), source })?;
    }
    Ok(report)
}

//! What the comparison came to, as a table and as JSON.

use crate::Options;
use estimation::evaluate::against::Figures;
use frames::unit::{ARCSEC, DEGREE};
use frames::{Rot, Sub};
use serde_json::json;
use std::fmt;

/// What the comparison came to; it displays as a table.
#[derive(Clone, Debug)]
pub struct Report {
    /// What was asked for.
    pub options: Options,
    /// The figures of what was compared.
    pub figures: Figures,
    /// Times of the first and the last instant compared, s.
    pub span: [f64; 2],
    /// The fixed deviation that was removed.
    pub fixed: Rot<Sub, Sub>,
    /// Instants that it was taken from.
    pub still: usize,
    /// Rows of the solution without a valid deformation.
    pub solution_invalid: u64,
    /// Rows of the solution that cannot be read.
    pub solution_refused: u64,
    /// Rows of the reference without a valid deformation.
    pub reference_invalid: u64,
    /// Rows of the reference that cannot be read.
    pub reference_refused: u64,
    /// Valid solutions for which the reference has nothing.
    pub unmatched: u64,
    /// Instants whose reference was interpolated.
    pub interpolated: u64,
}

impl Report {
    fn fixed_deg(&self) -> [f64; 3] {
        self.fixed.log().array().map(|v| v / DEGREE)
    }

    /// The numbers, with a new line at their end.
    pub(crate) fn json(&self) -> serde_json::Result<String> {
        let figures = &self.figures;
        let arcsec = |v: [f64; 3]| v.map(|v| v / ARCSEC);
        let document = json!({
            "solution": self.options.solution.display().to_string(),
            "reference": self.options.reference.display().to_string(),
            "instants": figures.count,
            "span_s": self.span,
            "interpolated": self.interpolated,
            "unmatched": self.unmatched,
            "solution_invalid": self.solution_invalid,
            "solution_refused": self.solution_refused,
            "reference_invalid": self.reference_invalid,
            "reference_refused": self.reference_refused,
            "fixed_deviation_deg": (!self.options.keep_fixed).then(|| self.fixed_deg()),
            "fixed_deviation_instants": self.still,
            "mean_arcsec": arcsec(figures.mean),
            "rmse_arcsec": arcsec(figures.rmse),
            "max_arcsec": arcsec(figures.most),
            "range_rms_arcsec": figures.range.map(arcsec),
            "coverage_95": figures.coverage,
            "pooled_rmse_arcsec": figures.pooled_rmse() / ARCSEC,
            "pooled_coverage_95": figures.pooled_coverage(),
        });
        Ok(serde_json::to_string_pretty(&document)? + "\n")
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { options, figures, span, .. } = self;
        writeln!(f, "{} against {}", options.solution.display(), options.reference.display())?;
        writeln!(
            f,
            "{} instants from {:.3} to {:.3} s, {} of them interpolated; {} solutions without reference",
            figures.count, span[0], span[1], self.interpolated, self.unmatched
        )?;
        writeln!(
            f,
            "invalid rows: solution {}, reference {}; unreadable: {}, {}",
            self.solution_invalid, self.reference_invalid, self.solution_refused, self.reference_refused
        )?;
        let [x, y, z] = self.fixed_deg();
        match (options.keep_fixed, options.still) {
            (true, _) => writeln!(f, "the fixed deviation was left in")?,
            (false, Some([from, to])) => writeln!(
                f,
                "fixed deviation removed: {x:.4} {y:.4} {z:.4} deg, the mean of {} instants from {from} to {to} s",
                self.still
            )?,
            (false, None) => {
                writeln!(f, "fixed deviation removed: {x:.4} {y:.4} {z:.4} deg, the mean of all instants")?
            }
        }
        writeln!(f, "\n{:<26} {:>10} {:>10} {:>10} {:>10}", "arcsec, about", "x", "y", "z", "all")?;
        let row = |f: &mut fmt::Formatter<'_>, name: &str, values: [f64; 3], all: Option<f64>| {
            write!(f, "{name:<26}")?;
            values.iter().try_for_each(|v| write!(f, " {:>10.2}", v / ARCSEC))?;
            writeln!(f, " {:>10}", all.map_or(String::new(), |v| format!("{:.2}", v / ARCSEC)))
        };
        row(f, "root mean square error", figures.rmse, Some(figures.pooled_rmse()))?;
        row(f, "mean error", figures.mean, None)?;
        row(f, "largest error", figures.most, None)?;
        match (figures.range, figures.coverage, figures.pooled_coverage()) {
            (Some(range), Some(coverage), Some(pooled)) => {
                row(f, "95 % range, rms", range, None)?;
                write!(f, "{:<26}", "within the range, %")?;
                coverage.iter().try_for_each(|share| write!(f, " {:>10.1}", 100.0 * share))?;
                writeln!(f, " {:>10.1}", 100.0 * pooled)
            }
            _ => writeln!(f, "the solution tells no range"),
        }
    }
}

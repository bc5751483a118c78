//! Paper 002: a deformation without a model of it, and a sub unit whose data are late.
//!
//! The paper's tables of the flexure are missing from its text, so every experiment runs with a small flexure of 1 to 3 arcsec, as that of
//! paper 001, and with a large one of 15 to 50. A quick run takes fewer samples a second and half the length of experiments 1.1 to 1.3.

mod coarse;
mod deformation;
mod delay;
mod methods;
mod survival;

use crate::{Bound, Claim, Published, Stretch, Study};
use frames::unit::ARCSEC;

pub(crate) const TITLE: &str = "Paper 002: model-free deformation with time delay compensation";

const AXES: [&str; 3] = ["x", "y", "z"];

/// The studies of this paper.
pub(crate) fn studies() -> Vec<Study> {
    let mut studies = Vec::new();
    for size in [Size::Small, Size::Large] {
        studies.extend(["1.1", "1.2", "1.3"].map(|experiment| deformation::study(experiment, size)));
    }
    for size in [Size::Small, Size::Large] {
        studies.extend([10, 20, 30].map(|delay_ms| delay::study(delay_ms, size)));
    }
    studies.extend([Size::Small, Size::Large].map(survival::study));
    studies.extend(coarse::studies());
    studies
}

/// How far the hull bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Size {
    Small,
    Large,
}

impl Size {
    fn name(self) -> &'static str {
        match self {
            Self::Small => "small",
            Self::Large => "large",
        }
    }

    /// Over the small flexure.
    fn factor(self) -> f64 {
        match self {
            Self::Small => 1.0,
            Self::Large => 1.0 / 0.06,
        }
    }

    /// The preset of an experiment's scenario.
    fn preset(self, experiment: &str) -> String {
        format!("model_free_{}_{}", experiment.replace('.', "_"), self.name())
    }
}

/// What is kept of a method's track.
#[derive(Clone, Debug)]
struct Figures {
    /// arcsec.
    rmse: [f64; 3],
    /// arcsec.
    largest: f64,
    /// Root mean square of the method's own standard deviation, arcsec.
    sigma: [f64; 3],
}

impl Figures {
    fn of(stretch: Stretch) -> Self {
        let arcsec = |figures: [f64; 3]| figures.map(|figure| figure / ARCSEC);
        Self {
            rmse: arcsec(stretch.rmse()),
            largest: arcsec(stretch.max_abs()).into_iter().fold(f64::NAN, f64::max),
            sigma: arcsec(stretch.sigma()),
        }
    }
}

/// A claim about an axis, in a unit of measure.
fn claim(
    id: String,
    table: &str,
    row: String,
    [axis, unit]: [&str; 2],
    bound: Bound,
    paper: Published,
    why: &str,
) -> Claim {
    Claim { id, table: table.into(), row, axis: axis.into(), unit: unit.into(), bound, paper, why: why.into() }
}

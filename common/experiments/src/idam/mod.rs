//! Paper 000: the demonstration's scenario, its section 5, by the filter on SO(3) with identified parameters and with the true
//! ones, which is the bound.

use crate::{
    Bars, Bound, Claim, Data, Fault, Figure, Findings, Label, Line, Plot, Published, Series, Stretch, Stroke, Study,
    Track, Trial, Trials, presets, rms, run, spread,
};
use estimation::flexure::Flexure;
use frames::unit::ARCMIN;
use pipeline::configuration::{Configuration, IdentifierMethod};
use std::ops::RangeInclusive;

pub(crate) const TITLE: &str = "Paper 000: IDAM with parameters from a relevance vector machine";

const DURATION_S: f64 = 600.0;
/// Errors count from here to the end, as in the paper.
const SPAN: RangeInclusive<f64> = 120.0..=DURATION_S;
const AXES: [&str; 3] = ["x", "y", "z"];

/// The studies of this paper.
pub(crate) fn studies() -> Vec<Study> {
    vec![Study::new(Trials { full: 20, quick: 4 }, 2 * DURATION_S as u64, measure, conclude)]
}

/// The two methods on the data of one trial.
struct Measured {
    identified: Figures,
    told: Figures,
    /// Of the first trial.
    tracks: Option<[Track; 2]>,
}

struct Figures {
    rmse: [f64; 3],
    coverage: [f64; 3],
    nees: f64,
}

impl Figures {
    fn of(stretch: Stretch) -> Self {
        Self {
            rmse: stretch.rmse().map(|error| error / ARCMIN),
            coverage: stretch.coverage(|point| point.range),
            nees: stretch.nees(),
        }
    }
}

fn measure(trial: &Trial) -> Result<Measured, Fault> {
    let identified = presets::configuration("demo", trial.seed)?.with(|c| c.run.duration_s = Some(DURATION_S));
    let told = identified.with(tell);
    let data = Data::simulate(&identified)?;
    let [identified, told] = [identified, told].map(|method| run(&method, &data, 0.1));
    Ok(Measured {
        identified: Figures::of(identified.over(SPAN)),
        told: Figures::of(told.over(SPAN)),
        tracks: (trial.index == 0).then_some([identified, told]),
    })
}

/// Gives the filter the true flexure.
fn tell(configuration: &mut Configuration) {
    let area = &mut configuration.areas[0];
    let truth = area.simulation.flexure;
    area.identifier.method =
        IdentifierMethod::Fixed(truth.map(|axis| Flexure { mu: axis.mu, b: axis.b, sigma: axis.sigma }));
}

fn conclude(trials: &[Measured]) -> Findings {
    let all = |figure: &dyn Fn(&Measured) -> f64| -> Vec<f64> { trials.iter().map(figure).collect() };
    let mut rows = Vec::new();
    for (axis, name) in AXES.into_iter().enumerate() {
        let claim = Claim {
            id: format!("idam/rmse/so3-rvm/{name}"),
            table: "Section 5, RMSE from 120 s to 600 s".into(),
            row: "SO(3), RVM".into(),
            axis: name.into(),
            unit: "arcmin".into(),
            bound: Bound::Value(rms(&all(&|t| t.told.rmse[axis]))),
            paper: match name {
                "z" => Published::AtMost(4.26),
                _ => Published::Nothing("the paper gives z only".into()),
            },
            why: "The exact attitude matching loses nothing to small angles, and the model need not be known well."
                .into(),
        };
        rows.push(claim.rms(&all(&|t| t.identified.rmse[axis])));
    }
    let consistency = [
        ("coverage", "share of errors in the 95 % range, z", "z", &all(&|t| t.identified.coverage[2])),
        ("nees", "mean normalised squared error", "all", &all(&|t| t.identified.nees)),
    ];
    for (id, row, axis, values) in consistency {
        let claim = Claim {
            id: format!("idam/consistency/so3-rvm/{id}"),
            table: "Section 5, consistency".into(),
            row: format!("SO(3), RVM: {row}"),
            axis: axis.into(),
            unit: String::new(),
            bound: Bound::Value(if id == "nees" { 3.0 } else { 0.95 }),
            paper: Published::Nothing("the paper gives no covariance".into()),
            why: "A cautious filter covers more than it must.".into(),
        };
        rows.push(claim.mean(values));
    }
    Findings { rows, figures: figures(trials) }
}

fn figures(trials: &[Measured]) -> Vec<Figure> {
    let series = |axis: usize| {
        let of = |figures: fn(&Measured) -> &Figures| -> (f64, f64) {
            let values: Vec<f64> = trials.iter().map(|trial| figures(trial).rmse[axis]).collect();
            (rms(&values), spread(&values))
        };
        let told = of(|t| &t.told);
        Series { name: AXES[axis].into(), values: vec![of(|t| &t.identified), told], bounds: vec![told.0, f64::NAN] }
    };
    let mut figures = vec![Figure {
        title: "RMSE from 120 s to 600 s".into(),
        caption:
            "Root mean square over the trials, with the spread of one trial; the tick is the filter that is told the \
                  true flexure."
                .into(),
        plot: Plot::Bars(Bars {
            value: Label::new("RMSE", "arcmin"),
            groups: vec!["SO(3), RVM".into(), "SO(3), true parameters".into()],
            series: [0, 1, 2].map(series).into(),
        }),
    }];
    if let Some([identified, told]) = &trials[0].tracks {
        figures.extend([2, 0].map(|axis| estimates(identified, axis)));
        figures.push(errors(identified, told));
    }
    figures
}

fn estimates(track: &Track, axis: usize) -> Figure {
    let line = |name: &str, stroke, points| Line { name: name.into(), stroke, points };
    Figure {
        title: format!("Deformation about {}", AXES[axis]),
        caption: "The first trial: the estimate lies on the truth but for its first seconds.".into(),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new(format!("deformation about {}", AXES[axis]), "arcmin"),
            lines: vec![
                line("SO(3), RVM", Stroke::Solid, track.over(..).line(|point| point.estimate[axis] / ARCMIN)),
                line("truth", Stroke::Truth, track.over(..).line(|point| point.truth[axis] / ARCMIN)),
            ],
        },
    }
}

fn errors(identified: &Track, told: &Track) -> Figure {
    let [identified, told] = [identified, told].map(|track| track.over(SPAN));
    let line = |name: &str, stroke, points| Line { name: name.into(), stroke, points };
    Figure {
        title: "Error about z".into(),
        caption: "The first trial, with the range that the filter itself gives.".into(),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new("error about z", "arcmin"),
            lines: vec![
                line("95 % range", Stroke::Bound, identified.line(|point| point.range[2] / ARCMIN)),
                line("95 % range", Stroke::Bound, identified.line(|point| -point.range[2] / ARCMIN)),
                line("SO(3), RVM", Stroke::Solid, identified.line(|point| point.error[2] / ARCMIN)),
                line("SO(3), true parameters", Stroke::Solid, told.line(|point| point.error[2] / ARCMIN)),
            ],
        },
    }
}

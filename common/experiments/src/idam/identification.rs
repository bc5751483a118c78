//! Section 3: what the identifiers find of the flexure in 300 s, from the deformation itself, so that no filter blurs the comparison.

use super::AXES;
use crate::{
    Bound as Limit, Claim, Cloud, Ellipse, Fault, Figure, Findings, Label, Plot, Published, Study, Trial, Trials,
    pairs, presets,
};
use estimation::flexure::Flexure;
use estimation::identify::bound::{Band, Bound};
use estimation::identify::series::{Preparation, prepared};
use estimation::identify::{Kind, Method, Series, identify_axis};

const WINDOW_S: f64 = 300.0;
const STEP_S: f64 = 0.1;
/// What is identified, and its unit: the errors are of logarithms.
const PARAMETERS: [&str; 4] = ["mu", "b", "sigma", "Q"];
/// The error that counts for a method that finds nothing: it is off by a factor e^3.
const NOTHING: f64 = 3.0;

/// The study.
pub(super) fn study() -> Study {
    Study::new(Trials { full: 40, quick: 3 }, WINDOW_S as u64, measure, conclude)
}

/// What each method found, an axis each.
struct Measured {
    truth: [Flexure; 3],
    found: Vec<[Option<Flexure>; 3]>,
}

fn measure(trial: &Trial) -> Result<Measured, Fault> {
    let scenario = presets::configuration("idam", trial.seed)?.with(|c| c.run.duration_s = Some(WINDOW_S));
    let every = (STEP_S * scenario.rate_hz).round() as u64;
    let mut angles: [Vec<f64>; 3] = Default::default();
    pairs(&scenario, |_, truth| {
        if truth.header.sequence % every == 0 {
            angles.iter_mut().zip(truth.dynamic).for_each(|(series, angle)| series.push(angle));
        }
    })?;
    let rates = angles.map(|series| {
        let rates: Vec<f64> = series.windows(2).map(|pair| (pair[1] - pair[0]) / STEP_S).collect();
        prepared(&rates, STEP_S, Preparation::Line)
    });
    let find = |method: Method| {
        std::array::from_fn(|axis| {
            let series = Series { kind: Kind::Rates, values: &rates[axis], step_s: STEP_S };
            identify_axis(method, &series).map(|found| found.flexure)
        })
    };
    let truth = scenario.areas[0].simulation.flexure.map(|axis| Flexure { mu: axis.mu, b: axis.b, sigma: axis.sigma });
    Ok(Measured { truth, found: Method::ALL.into_iter().map(find).collect() })
}

/// Errors of the logarithms of mu, b, sigma and Q.
fn errors(found: &Flexure, truth: &Flexure) -> [f64; 4] {
    let error = |of: fn(&Flexure) -> f64| (of(found) / of(truth)).ln();
    [error(|f| f.mu), error(|f| f.b), error(|f| f.sigma), error(Flexure::density)]
}

/// The least standard deviations of the same.
fn bounds(truth: &Flexure) -> Option<[f64; 4]> {
    let series = Series { kind: Kind::Rates, values: &[0.0; (WINDOW_S / STEP_S) as usize], step_s: STEP_S };
    let bound = Bound::new(truth, WINDOW_S, Band::of(&series), 0.0)?;
    let density = bound.covariance[(2, 2)].sqrt();
    Some([bound.mu_sd() / truth.mu, bound.b_sd() / truth.b, bound.sigma_sd() / truth.sigma, density])
}

fn conclude(trials: &[Measured]) -> Findings {
    let mut findings = Findings::default();
    for (place, method) in Method::ALL.into_iter().enumerate() {
        for (axis, name) in AXES.into_iter().enumerate() {
            let off: Vec<[f64; 4]> = trials
                .iter()
                .map(|trial| trial.found[place][axis].map_or([NOTHING; 4], |found| errors(&found, &trial.truth[axis])))
                .collect();
            let least = bounds(&trials[0].truth[axis]);
            for (parameter, symbol) in PARAMETERS.into_iter().enumerate() {
                let values: Vec<f64> = off.iter().map(|error| error[parameter].abs()).collect();
                let claim = Claim {
                    id: format!("idam/identification/{}/{symbol}/{name}", method.name()),
                    table: "Section 3, RMS error of the logarithm of an identified parameter, 300 s".into(),
                    row: format!("{}: {symbol}", method.name()),
                    axis: name.into(),
                    unit: String::new(),
                    bound: least.map_or_else(
                        || Limit::None("the band says nothing of this flexure".into()),
                        |least| Limit::Value(least[parameter]),
                    ),
                    paper: Published::Nothing("the paper gives no identified parameter".into()),
                    why: "What fits an autocovariance is limited by the autocovariance's sampling error, not by the fit; the \
                          likelihood of the spectrum is not."
                        .into(),
                };
                findings.rows.push(claim.rms(&values));
            }
        }
    }
    findings.figures.extend((0..3).map(|axis| scatter(trials, axis)));
    findings
}

fn scatter(trials: &[Measured], axis: usize) -> Figure {
    let truth = trials[0].truth[axis];
    let cloud = |method: Method| {
        let place = Method::ALL.iter().position(|other| *other == method);
        let found = trials.iter().filter_map(|trial| trial.found[place?][axis]);
        Cloud {
            name: method.name().into(),
            truth: false,
            points: found.map(|f| (f.mu.ln(), f.b.ln())).collect(),
            sigma: Vec::new(),
        }
    };
    let mut clouds: Vec<Cloud> =
        [Method::Rvm, Method::SupportVector, Method::Whale, Method::Whittle].into_iter().map(cloud).collect();
    clouds.push(Cloud {
        name: "truth".into(),
        truth: true,
        points: vec![(truth.mu.ln(), truth.b.ln())],
        sigma: Vec::new(),
    });
    let series = Series { kind: Kind::Rates, values: &[0.0; (WINDOW_S / STEP_S) as usize], step_s: STEP_S };
    let bound = Bound::new(&truth, WINDOW_S, Band::of(&series), 0.0);
    let ellipse = |bound: Bound| Ellipse {
        name: "95 % at the bound".into(),
        centre: (truth.mu.ln(), truth.b.ln()),
        covariance: [bound.covariance[(0, 0)], bound.covariance[(0, 1)], bound.covariance[(1, 1)]],
        sigmas: 2.45,
    };
    Figure {
        title: format!("Identified flexure about {}", AXES[axis]),
        caption: "Logarithms of damping and natural frequency (1/s, rad/s) from 300 s, one point a trial.".into(),
        plot: Plot::Scatter {
            x: Label::new("ln mu", ""),
            y: Label::new("ln b", ""),
            clouds,
            ellipses: bound.map(ellipse).into_iter().collect(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_of_logarithms() {
        let truth = Flexure { mu: 0.2, b: 0.2, sigma: 1e-3 };
        let found = Flexure { mu: 0.4, b: 0.1, sigma: 1e-3 };
        let [mu, b, sigma, q] = errors(&found, &truth);
        assert!((mu - 2f64.ln()).abs() < 1e-12 && (b + 2f64.ln()).abs() < 1e-12 && sigma.abs() < 1e-12);
        assert!((q + 2f64.ln()).abs() < 1e-12);
        let least = bounds(&truth).expect("a band");
        assert!(least.iter().all(|sd| *sd > 0.01 && *sd < 1.0), "{least:?}");
    }
}

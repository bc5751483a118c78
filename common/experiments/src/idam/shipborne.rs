//! Section 6 in simulation: the paper's arrangement of testing units on a voyage with three turns. Its data are not published, so that its figures
//! stand beside ours without a comparison.

use super::methods::method;
use crate::{Bound, Claim, Data, Fault, Findings, Published, Study, Trial, Trials, presets, rms, run};
use frames::unit::ARCMIN;

/// The span of time that counts starts after the filter has settled, s.
const FROM_S: f64 = 120.0;
const QUICK_S: f64 = 300.0;
const FULL_S: u64 = 1500;
/// Roll is about y, pitch about x, heading about z.
const ANGLES: [(&str, usize); 3] = [("roll", 1), ("pitch", 0), ("heading", 2)];

/// A method with the paper's roll, pitch and heading, arcmin.
const METHODS: [(&str, Option<[f64; 3]>); 5] = [
    ("ekf-true", None),
    ("ekf-svr", Some([5.155, 5.098, 25.143])),
    ("ekf-woa", Some([0.828, 1.914, 10.735])),
    ("idam-literal", Some([0.797, 1.852, 9.589])),
    ("so3-rvm", None),
];

/// The study.
pub(super) fn study() -> Study {
    Study::new(Trials { full: 6, quick: 1 }, FULL_S * METHODS.len() as u64, measure, conclude)
}

/// RMSE of each method, arcmin.
fn measure(trial: &Trial) -> Result<Vec<[f64; 3]>, Fault> {
    let duration_s = if trial.quick { QUICK_S } else { FULL_S as f64 };
    let scenario = presets::configuration("idam_shipborne", trial.seed)?.with(|c| c.run.duration_s = Some(duration_s));
    let data = Data::simulate(&scenario)?;
    let rmse = |(id, _): &(&str, _)| {
        let track = run(&method(id).on(&scenario)?, &data, 0.1);
        Ok(track.over(FROM_S..).rmse().map(|error| error / ARCMIN))
    };
    METHODS.iter().map(rmse).collect()
}

fn conclude(trials: &[Vec<[f64; 3]>]) -> Findings {
    let mut rows = Vec::new();
    for (place, (id, paper)) in METHODS.iter().enumerate() {
        for (k, (name, axis)) in ANGLES.into_iter().enumerate() {
            let values = |place: usize| -> Vec<f64> { trials.iter().map(|trial| trial[place][axis]).collect() };
            let said = match paper {
                Some(paper) => format!("{} arcmin at sea, on data that are not published", paper[k]),
                None => "the paper has no such method".into(),
            };
            let claim = Claim {
                id: format!("idam/shipborne/{id}/{name}"),
                table: "Section 6 in simulation, figure 10: RMSE after 120 s".into(),
                row: method(id).name.into(),
                axis: name.into(),
                unit: "arcmin".into(),
                bound: if place == 0 {
                    Bound::None("this is the bound of others".into())
                } else {
                    Bound::Value(rms(&values(0)))
                },
                paper: Published::Nothing(said),
                why:
                    "The truth of the simulator stands for the two reference units, whose deviations the paper removes."
                        .into(),
            };
            rows.push(claim.rms(&values(place)));
        }
    }
    Findings { rows, figures: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_identity_is_that_of_a_method() {
        let rows = conclude(&[vec![[1.0, 2.0, 3.0]; METHODS.len()]]).rows;
        assert_eq!(rows.len(), METHODS.len() * ANGLES.len());
        assert!(rows.iter().all(|row| row.ours.is_finite()));
    }
}

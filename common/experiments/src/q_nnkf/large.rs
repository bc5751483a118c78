//! Beyond the paper: installation angles up to 179 degrees, the filters started by a registration at any angle.

use super::method::{AXES, Figures, Method, scenario};
use super::published::{TABLE_6, level};
use crate::{Bound, Claim, Data, Fault, Findings, Published, Study, Trial, Trials, mean};
use frames::unit::DEGREE;
use frames::{Main, Vec3};

/// About [`axis`], degrees.
const ANGLES: [f64; 10] = [5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 90.0, 120.0, 150.0, 179.0];
const METHODS: [Method; 2] = [Method::QKf, Method::So3];
const DURATION_S: f64 = 3600.0;
const SPAN: std::ops::RangeInclusive<f64> = 900.0..=DURATION_S;
/// Another realisation for each angle.
const APART: u64 = 104_729;

fn axis() -> Vec3<Main> {
    let axis = Vec3::new(0.5, 0.6, -0.62);
    axis / axis.norm()
}

pub(super) fn study() -> Study {
    let cost = (ANGLES.len() * METHODS.len()) as u64 * DURATION_S as u64;
    Study::new(Trials { full: 16, quick: 1 }, cost, measure, conclude)
}

/// By angle and method.
type Measured = Vec<[Figures; 2]>;

fn measure(trial: &Trial) -> Result<Measured, Fault> {
    let one = |(index, angle): (usize, f64)| {
        let seed = trial.seed.wrapping_add(APART * (1 + index as u64));
        let data = Data::simulate(&scenario(seed, axis() * (angle * DEGREE), DURATION_S)?)?;
        let [q, so3] = METHODS.map(|method| Ok::<_, Fault>(Figures::of(method.track(seed, &data, 1.0)?.over(SPAN))));
        Ok([q?, so3?])
    };
    ANGLES.into_iter().enumerate().map(one).collect()
}

fn conclude(trials: &[Measured]) -> Findings {
    let level = level(&TABLE_6);
    let mut rows = Vec::new();
    for (which, method) in METHODS.into_iter().enumerate() {
        for (index, angle) in ANGLES.into_iter().enumerate() {
            for (axis, axis_name) in AXES.into_iter().enumerate() {
                let all = |figure: fn(&Figures) -> [f64; 3], which: usize| -> Vec<f64> {
                    trials.iter().map(|trial| figure(&trial[index][which])[axis]).collect()
                };
                let claim = Claim {
                    id: format!("q-nnkf/large/{}/{angle}/{axis_name}", method.key()),
                    table: "Beyond table 6: any angle, beside the mean of table 6".into(),
                    row: format!("{}, {angle} deg", method.name()),
                    axis: axis_name.into(),
                    unit: "arcsec".into(),
                    bound: Bound::Value(mean(&all(|figures| figures.sigma, 1))),
                    paper: Published::Magnitude(level[axis], 10),
                    why: "Quaternion optimisation knows no small angle, and what it leaves over is small at every angle. \
                          The error is that of the rotation, seen in the main unit's axes."
                        .into(),
                };
                rows.push(claim.rms(&all(|figures| figures.rotation, which)));
            }
        }
    }
    Findings { rows, figures: Vec::new() }
}

//! The data of a trial as paper 003 sees them: the angle between two attitudes.

use crate::{Data, Fault, Track, presets, run};
use estimation::flexure::Flexure;
use estimation::identify::series::{Preparation, prepared};
use estimation::identify::{Kind, Method, Series, identify_axis};
use estimation::matching::attitude_dcm::difference;
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3};
use nalgebra::{Matrix3, Vector3};
use pipeline::configuration::{Configuration, IdentifierMethod};
use pipeline::lane;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// Length of a trial, s.
pub(super) const DURATION_S: f64 = 600.0;
/// The paper's cut-off frequency.
pub(super) const HIGH_PASS: Preparation = Preparation::HighPass(0.05);
/// A figure is taken every so many seconds.
const EVERY_S: f64 = 0.5;

/// One trial's data.
pub(super) struct Scene {
    configuration: Configuration,
    data: Data,
    /// Of the main unit since the start.
    attitude: Vec<Matrix3<f64>>,
}

impl Scene {
    pub(super) fn new(preset: &str, seed: u64) -> Result<Self, Fault> {
        let configuration = presets::configuration(preset, seed)?.with(|c| c.run.duration_s = Some(DURATION_S));
        let data = Data::simulate(&configuration)?;
        let start =
            data.pairs.first().map_or(Rot::identity(), |pair| Rot::<MainStart, Main>::from_wxyz(pair.attitude_m));
        let since = |q| -> Rot<Main, Main> { start.inverse() * Rot::<MainStart, Main>::from_wxyz(q) };
        let attitude = data.pairs.iter().map(|pair| since(pair.attitude_m).matrix()).collect();
        Ok(Self { configuration, data, attitude })
    }

    /// The flexure as simulated.
    pub(super) fn truth(&self) -> [Flexure; 3] {
        self.configuration.areas[0].simulation.flexure.map(|axis| Flexure { mu: axis.mu, b: axis.b, sigma: axis.sigma })
    }

    /// Standard deviation that the flexure really had in this trial, rad.
    pub(super) fn realised(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let values: Vec<f64> = self.data.truths.iter().map(|truth| truth.dynamic[axis]).collect();
            crate::spread(&values)
        })
    }

    /// White noise of so many dB below the flexure in the angle of each axis (003 eq 31), and its standard deviation in rad.
    pub(super) fn noisy(&self, snr_db: f64, seed: u64) -> (Self, f64) {
        let sigma = self.truth().map(|axis| axis.sigma * 10f64.powf(-snr_db / 20.0));
        let mut source = Pcg64Mcg::seed_from_u64(seed ^ snr_db.to_bits());
        let mut data = self.data.clone();
        for pair in data.pairs.iter_mut().skip(1) {
            let error = sigma.map(|sigma| sigma * Distribution::<f64>::sample(&StandardNormal, &mut source));
            let turned = Rot::<SubStart, Sub>::from_wxyz(pair.attitude_s) * Rot::<Sub, Sub>::exp(error.into());
            pair.attitude_s = turned.quaternion();
        }
        let scene = Self { configuration: self.configuration.clone(), data, attitude: self.attitude.clone() };
        (scene, crate::rms(&sigma))
    }

    /// `y` of the filter at each instant, rad.
    pub(super) fn angles(&self) -> Vec<Vector3<f64>> {
        let start =
            self.data.pairs.first().map_or(Rot::identity(), |pair| Rot::<SubStart, Sub>::from_wxyz(pair.attitude_s));
        let angle = |(pair, attitude): (&messages::ImuPair, &Matrix3<f64>)| {
            let sub: Rot<Sub, Sub> = start.inverse() * Rot::<SubStart, Sub>::from_wxyz(pair.attitude_s);
            difference(attitude, &sub.matrix())
        };
        self.data.pairs.iter().zip(&self.attitude).map(angle).collect()
    }

    /// The same without what a static part adds to it: the paper's second pass.
    pub(super) fn angles_without(&self, fixed: Vec3<Main>) -> Vec<Vector3<f64>> {
        let without =
            |(y, a): (Vector3<f64>, &Matrix3<f64>)| y - (Matrix3::identity() - a.transpose()) * fixed.column();
        self.angles().into_iter().zip(&self.attitude).map(without).collect()
    }

    /// The filter's configuration with a flexure model and an assumed noise of the measurement in rad.
    fn told(&self, flexure: [Flexure; 3], noise: f64) -> Configuration {
        self.configuration.with(|c| {
            c.areas[0].identifier.method = IdentifierMethod::Fixed(flexure.into());
            c.areas[0].estimator.attitude_noise = noise;
        })
    }

    /// The noise of the measurement in the preset, rad.
    pub(super) fn noise(&self) -> f64 {
        self.configuration.areas[0].estimator.attitude_noise
    }

    /// The static part by the filter at the end of the data.
    pub(super) fn static_part(&self, flexure: [Flexure; 3], noise: f64) -> Vec3<Main> {
        let mut estimator = lane::estimator(&self.told(flexure, noise), 0);
        let last = self.data.pairs.iter().map(|pair| estimator.step(pair)).last();
        last.map_or(Vec3::ZERO, |solution| Rot::<Main, Sub>::from_wxyz(solution.static_q).log())
    }

    /// The filter with a flexure model.
    pub(super) fn filtered(&self, flexure: [Flexure; 3], noise: f64) -> Track {
        run(&self.told(flexure, noise), &self.data, EVERY_S)
    }

    /// All axes of angles by a method; `None` if it fails on one.
    pub(super) fn identify(
        &self,
        angles: &[Vector3<f64>],
        method: Method,
        preparation: Preparation,
    ) -> Option<[Flexure; 3]> {
        let step_s = 1.0 / self.configuration.rate_hz;
        let axis = |axis: usize| {
            let values: Vec<f64> = angles.iter().map(|angle| angle[axis]).collect();
            let values = prepared(&values, step_s, preparation);
            identify_axis(method, &Series { kind: Kind::Angles, values: &values, step_s }).map(|found| found.flexure)
        };
        Some([axis(0)?, axis(1)?, axis(2)?])
    }
}

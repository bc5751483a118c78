//! Error model of an inertial unit: `(I + M) x + bias dt + walk sqrt(dt) n`, in the case axes, with a bias that wanders and
//! outliers on top.

use crate::random::{Purpose, Source};
use crate::{Outliers, Unit, Wander};
use frames::{Case, Frame, Rot, Vec3};

/// Three gyros or three accelerometers.
struct Triad {
    /// `I + M`, row by row.
    rows: [Vec3<Case>; 3],
    bias: Vec3<Case>,
    walk: f64,
}

impl Triad {
    fn new(source: &mut Source, bias: f64, scale: f64, misalignment: f64, walk: f64) -> Self {
        let bias = source.normals().map(|n| bias * n).into();
        let rows = [0, 1, 2].map(|axis| {
            let n = source.normals();
            let mut row = n.map(|n| misalignment * n);
            row[axis] = 1.0 + scale * n[axis];
            row.into()
        });
        Self { rows, bias, walk }
    }

    fn measure(&self, source: &mut Source, truth: Vec3<Case>, interval: f64) -> [f64; 3] {
        let noise: Vec3<Case> = source.normals().into();
        let distorted = Vec3::from(self.rows.map(|row| row.dot(truth)));
        (distorted + self.bias * interval + noise * (self.walk * interval.sqrt())).array()
    }
}

/// Biases of three gyros, each a first-order Gauss-Markov process.
struct Drift {
    wander: Wander,
    /// rad/s.
    now: Vec3<Case>,
    source: Source,
}

impl Drift {
    fn new(wander: Wander, mut source: Source) -> Option<Self> {
        let wanders = wander.sigma > 0.0 && wander.tau > 0.0;
        wanders.then(|| Self { wander, now: Vec3::from(source.normals()) * wander.sigma, source })
    }

    /// What the drift adds over an interval: the mean of both ends, for a sample is far shorter than `tau`.
    fn over(&mut self, interval: f64) -> Vec3<Case> {
        let kept = (-interval / self.wander.tau).exp();
        let noise = Vec3::from(self.source.normals()) * (self.wander.sigma * (1.0 - kept * kept).sqrt());
        let before = self.now;
        self.now = before * kept + noise;
        (before + self.now) * (interval / 2.0)
    }
}

/// Outliers of three gyros and three accelerometers.
struct Spikes {
    outliers: Outliers,
    source: Source,
}

impl Spikes {
    fn new(outliers: Outliers, source: Source) -> Option<Self> {
        (outliers.probability > 0.0).then_some(Self { outliers, source })
    }

    /// `deviation` is that of the white noise of the sample.
    fn strike(&mut self, sample: &mut [f64; 3], deviation: f64) {
        let Outliers { probability, size, one_sided } = self.outliers;
        for value in sample {
            if self.source.happens(probability) {
                let sign = if one_sided || self.source.happens(0.5) { 1.0 } else { -1.0 };
                *value += sign * size * deviation;
            }
        }
    }
}

/// A unit with the errors that this run gave it.
pub(crate) struct Imu<B: Frame> {
    case_from_body: Rot<Case, B>,
    gyros: Triad,
    accelerometers: Triad,
    source: Source,
    drift: Option<Drift>,
    spikes: Option<Spikes>,
}

impl<B: Frame> Imu<B> {
    /// `index` tells the units of one run apart.
    pub(crate) fn new(unit: &Unit<B>, seed: u64, index: u64) -> Self {
        let mut source = Source::new(seed, Purpose::Unit, index);
        let gyros = Triad::new(&mut source, unit.bias, unit.scale, unit.misalignment, unit.arw);
        let accelerometers =
            Triad::new(&mut source, unit.accel_bias, unit.accel_scale, unit.accel_misalignment, unit.vrw);
        Self {
            case_from_body: unit.mounting.inverse(),
            gyros,
            accelerometers,
            source,
            drift: Drift::new(unit.bias_wander, Source::new(seed, Purpose::BiasWander, index)),
            spikes: Spikes::new(unit.outliers, Source::new(seed, Purpose::Outlier, index)),
        }
    }

    /// Angle (rad) and velocity (m/s) increments in case axes, from the true ones over an interval (s).
    pub(crate) fn measure(&mut self, dtheta: Vec3<B>, dvel: Vec3<B>, interval: f64) -> ([f64; 3], [f64; 3]) {
        let (dtheta, dvel) = (self.case_from_body * dtheta, self.case_from_body * dvel);
        let mut angle = self.gyros.measure(&mut self.source, dtheta, interval);
        let mut velocity = self.accelerometers.measure(&mut self.source, dvel, interval);
        if let Some(drift) = &mut self.drift {
            angle = (Vec3::<Case>::from(angle) + drift.over(interval)).array();
        }
        if let Some(spikes) = &mut self.spikes {
            spikes.strike(&mut angle, self.gyros.walk * interval.sqrt());
            spikes.strike(&mut velocity, self.accelerometers.walk * interval.sqrt());
        }
        (angle, velocity)
    }
}

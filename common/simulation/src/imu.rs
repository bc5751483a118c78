//! Error model of an inertial unit: `(I + M) x + bias dt + walk sqrt(dt) n`, in the case axes.

use crate::Unit;
use crate::random::Source;
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

/// A unit with the errors that this run gave it.
pub(crate) struct Imu<B: Frame> {
    case_from_body: Rot<Case, B>,
    gyros: Triad,
    accelerometers: Triad,
    source: Source,
}

impl<B: Frame> Imu<B> {
    pub(crate) fn new(unit: &Unit<B>, mut source: Source) -> Self {
        let gyros = Triad::new(&mut source, unit.bias, unit.scale, unit.misalignment, unit.arw);
        let accelerometers =
            Triad::new(&mut source, unit.accel_bias, unit.accel_scale, unit.accel_misalignment, unit.vrw);
        Self { case_from_body: unit.mounting.inverse(), gyros, accelerometers, source }
    }

    /// Angle (rad) and velocity (m/s) increments in case axes, from the true ones over an interval (s).
    pub(crate) fn measure(&mut self, dtheta: Vec3<B>, dvel: Vec3<B>, interval: f64) -> ([f64; 3], [f64; 3]) {
        let (dtheta, dvel) = (self.case_from_body * dtheta, self.case_from_body * dvel);
        (
            self.gyros.measure(&mut self.source, dtheta, interval),
            self.accelerometers.measure(&mut self.source, dvel, interval),
        )
    }
}

//! What the simulator is told, from the configuration.

use super::{Accel, Area, Configuration, Gyro};
use frames::{Case, Frame, Rot};
use simulation::{InsErrors, Scenario, Ship, Unit, Wire};

impl Configuration {
    /// The simulated run. The true errors of a unit are those of its configured grade unless `[simulation]` gives others.
    pub fn scenario(&self, run_id: u64) -> Scenario {
        let s = &self.simulation;
        Scenario {
            rate_hz: self.rate_hz,
            seed: self.run.seed,
            duration_s: self.run.duration_s,
            run_id,
            ship: Ship {
                latitude: s.latitude,
                longitude: s.longitude,
                speed: s.speed,
                course: s.course,
                roll: s.roll,
                pitch: s.pitch,
                heading: s.heading,
                velocity_follows_heading: s.velocity_follows_heading,
                turns: s.turns,
                sea_change: s.sea_change,
            },
            main: Unit {
                bias_wander: s.bias_wander,
                ..unit(s.gyro.unwrap_or(self.main.gyro), s.accel.or(self.main.accel), self.main.mounting)
            },
            ins: InsErrors { attitude: [s.ins.level, s.ins.level, s.ins.heading], noise: s.ins.noise },
            areas: self.areas.iter().map(area).collect(),
        }
    }
}

fn unit<B: Frame>(gyro: Gyro, accel: Option<Accel>, mounting: Rot<B, Case>) -> Unit<B> {
    let ideal = Unit::<B>::ideal();
    let gyros =
        Unit { arw: gyro.arw, bias: gyro.bias, scale: gyro.scale, misalignment: gyro.misalignment, mounting, ..ideal };
    accel.map_or(gyros, |accel| Unit {
        vrw: accel.vrw,
        accel_bias: accel.bias,
        accel_scale: accel.scale,
        accel_misalignment: accel.misalignment,
        ..gyros
    })
}

fn area(area: &Area) -> simulation::Area {
    let s = &area.simulation;
    let gyro = s.gyro.unwrap_or(area.gyro);
    simulation::Area {
        lever_arm: area.lever_arm,
        dynamic_lever_arm: s.dynamic_lever_arm,
        installation: Rot::exp(s.installation),
        quasi_static: s.quasi_static,
        hull: s.hull,
        flexure: s.flexure,
        flexure_changes: s.flexure_changes.clone(),
        second_flexure: s.second_flexure,
        starts_at_rest: s.starts_at_rest,
        impulses: s.impulses,
        coupling: s.coupling,
        unit: Unit {
            bias_wander: s.bias_wander,
            outliers: s.outliers,
            ..unit(gyro, s.accel.or(area.accel), area.mounting)
        },
        wire: Wire {
            delay_s: s.wire.delay,
            skew: s.wire.skew,
            jitter_s: s.wire.jitter.unwrap_or(gyro.stamp_jitter),
            phase_s: s.wire.phase,
            rate_error: s.wire.rate_error,
            loss: s.wire.loss,
            duplicate: s.wire.duplicate,
            swap: s.wire.swap,
            transit_s: s.wire.transit,
        },
        events: s.events.clone(),
    }
}

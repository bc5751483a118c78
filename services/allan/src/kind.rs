//! Gyros and accelerometers: what their figures are called and measured in.

use frames::unit::{ARCSEC, DEG_PER_H, DEG_PER_SQRT_H, MICRO_G};

/// Which sensors a triad is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rates, rad/s.
    Gyro,
    /// Specific force, m/s^2.
    Accel,
}

/// A unit of measure: its name in tables, its name in keys, and its value in SI.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measure {
    pub name: &'static str,
    pub key: &'static str,
    pub si: f64,
}

/// A coefficient as it is told.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Named {
    pub name: &'static str,
    pub key: &'static str,
    pub measure: Measure,
}

const HOUR_S: f64 = 3600.0;
const SECOND: Measure = Measure { name: "s", key: "s", si: 1.0 };
const DEGREES_PER_HOUR: Measure = Measure { name: "deg/h", key: "deg_per_h", si: DEG_PER_H };
const MICRO_GRAVITY: Measure = Measure { name: "ug", key: "ug", si: MICRO_G };

impl Measure {
    /// A value in SI with three significant digits, in this unit, as tables and configurations take it.
    pub fn number(self, value: f64) -> String {
        let rounded = format!("{:.2e}", value / self.si).parse().unwrap_or(f64::NAN);
        format!("{rounded}")
    }
}

impl Kind {
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Gyro => "gyros",
            Self::Accel => "accelerometers",
        }
    }

    /// Of deviations.
    pub(crate) fn deviation(self) -> Measure {
        match self {
            Self::Gyro => DEGREES_PER_HOUR,
            Self::Accel => MICRO_GRAVITY,
        }
    }

    pub(crate) fn white(self) -> Named {
        let (name, key, measure) = match self {
            Self::Gyro => {
                ("angle random walk", "arw", Measure { name: "deg/sqrt(h)", key: "deg_per_sqrt_h", si: DEG_PER_SQRT_H })
            }
            Self::Accel => {
                ("velocity random walk", "vrw", Measure { name: "ug/sqrt(Hz)", key: "ug_per_sqrt_hz", si: MICRO_G })
            }
        };
        Named { name, key, measure }
    }

    pub(crate) fn instability(self) -> Named {
        Named { name: "bias instability", key: "bias_instability", measure: self.deviation() }
    }

    pub(crate) fn walk(self) -> Named {
        let (name, key, measure) = match self {
            Self::Gyro => (
                "rate random walk",
                "rate_random_walk",
                Measure { name: "deg/h/sqrt(h)", key: "deg_per_h_per_sqrt_h", si: DEG_PER_H / HOUR_S.sqrt() },
            ),
            Self::Accel => (
                "random walk",
                "random_walk",
                Measure { name: "ug/sqrt(h)", key: "ug_per_sqrt_h", si: MICRO_G / HOUR_S.sqrt() },
            ),
        };
        Named { name, key, measure }
    }

    pub(crate) fn quantisation(self) -> Named {
        let measure = match self {
            Self::Gyro => Measure { name: "arcsec", key: "arcsec", si: ARCSEC },
            Self::Accel => Measure { name: "um/s", key: "um_per_s", si: 1e-6 },
        };
        Named { name: "quantisation", key: "quantisation", measure }
    }

    pub(crate) fn correlation(self) -> Named {
        Named { name: "correlation time", key: "correlation_time", measure: SECOND }
    }
}

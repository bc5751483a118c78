//! Numbers with a unit of measure: read in the unit of the key, checked against the allowed range, kept in SI.

use frames::{Frame, Vec3, unit};
use serde::de::{Deserialize, Deserializer, Error, Visitor};
use std::fmt;

/// A number or a fixed array of numbers, each of which goes through `convert`.
pub(super) trait Numbers: Sized {
    /// Reads the shape; an error of `convert` becomes that of the value.
    fn read<'de, D: Deserializer<'de>>(
        deserializer: D,
        convert: &dyn Fn(f64) -> Result<f64, String>,
    ) -> Result<Self, D::Error>;
}

impl Numbers for f64 {
    fn read<'de, D: Deserializer<'de>>(
        deserializer: D,
        convert: &dyn Fn(f64) -> Result<f64, String>,
    ) -> Result<Self, D::Error> {
        convert(Number::deserialize(deserializer)?.0).map_err(D::Error::custom)
    }
}

impl<T: Numbers> Numbers for Option<T> {
    fn read<'de, D: Deserializer<'de>>(
        deserializer: D,
        convert: &dyn Fn(f64) -> Result<f64, String>,
    ) -> Result<Self, D::Error> {
        T::read(deserializer, convert).map(Some)
    }
}

impl Numbers for [f64; 3] {
    fn read<'de, D: Deserializer<'de>>(
        deserializer: D,
        convert: &dyn Fn(f64) -> Result<f64, String>,
    ) -> Result<Self, D::Error> {
        three(Vec::<Number>::deserialize(deserializer)?, |n| convert(n.0)).map_err(D::Error::custom)
    }
}

impl Numbers for [[f64; 3]; 3] {
    fn read<'de, D: Deserializer<'de>>(
        deserializer: D,
        convert: &dyn Fn(f64) -> Result<f64, String>,
    ) -> Result<Self, D::Error> {
        let rows = Vec::<Vec<Number>>::deserialize(deserializer)?;
        three(rows, |row| three(row, |n| convert(n.0))).map_err(D::Error::custom)
    }
}

impl<F: Frame> Numbers for Vec3<F> {
    fn read<'de, D: Deserializer<'de>>(
        deserializer: D,
        convert: &dyn Fn(f64) -> Result<f64, String>,
    ) -> Result<Self, D::Error> {
        <[f64; 3]>::read(deserializer, convert).map(Vec3::from)
    }
}

/// A derived array would accept more than three elements and drop the rest.
fn three<T, U>(items: Vec<T>, convert: impl Fn(T) -> Result<U, String>) -> Result<[U; 3], String> {
    let items = items.into_iter().map(convert).collect::<Result<Vec<U>, String>>()?;
    items.try_into().map_err(|items: Vec<U>| format!("expected 3 elements, found {}", items.len()))
}

/// A TOML float or integer.
struct Number(f64);

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl Visitor<'_> for NumberVisitor {
            type Value = Number;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number")
            }
            fn visit_f64<E: Error>(self, v: f64) -> Result<Number, E> {
                Ok(Number(v))
            }
            fn visit_i64<E: Error>(self, v: i64) -> Result<Number, E> {
                Ok(Number(v as f64))
            }
            fn visit_u64<E: Error>(self, v: u64) -> Result<Number, E> {
                Ok(Number(v as f64))
            }
        }
        deserializer.deserialize_any(NumberVisitor)
    }
}

/// Neither NaN nor an infinity lies within a range, so both are refused here.
fn scaled<'de, D: Deserializer<'de>, T: Numbers>(
    deserializer: D,
    unit: f64,
    minimum: f64,
    maximum: f64,
) -> Result<T, D::Error> {
    T::read(deserializer, &|v| {
        if (minimum..=maximum).contains(&v) {
            Ok(v * unit)
        } else {
            Err(format!("must be within {minimum} to {maximum}"))
        }
    })
}

macro_rules! quantities {
    ($($name:ident: $unit:expr, $minimum:expr, $maximum:expr;)*) => {$(
        pub(super) fn $name<'de, D: Deserializer<'de>, T: Numbers>(deserializer: D) -> Result<T, D::Error> {
            scaled(deserializer, $unit, $minimum, $maximum)
        }
    )*};
}

// name: unit of the key in SI, least and greatest value in the unit of the key
quantities! {
    rate_hz: 1.0, 10.0, 1000.0;
    silence_s: 1.0, 0.01, 3600.0;
    spike_threshold: 1.0, 0.0, 1e3;
    settle_s: 1.0, 0.0, 1e6;
    duration_s: 1.0, 0.1, 1e8;
    window_s: 1.0, 1.0, 86_400.0;
    period_s: 1.0, 0.1, 86_400.0;
    lead_s: 1.0, 0.0, 3600.0;
    registration_s: 1.0, 0.1, 86_400.0;
    filter_hz: 1.0, 0.1, 1000.0;
    pace: 1.0, 1e-3, 1e4;
    output_hz: 1.0, 0.1, 200.0;
    extrapolate_ms: 1e-3, 0.0, 50.0;
    silence_ms: 1e-3, 20.0, 60_000.0;
    limit_arcmin: unit::ARCMIN, 0.0, 10_800.0;
    invalid_s: 1.0, 0.1, 86_400.0;
    hold_s: 1.0, 0.0, 3600.0;

    arw_deg_per_sqrt_h: unit::DEG_PER_SQRT_H, 0.0, 1000.0;
    bias_deg_per_h: unit::DEG_PER_H, 0.0, 1e5;
    instability_deg_per_h: unit::DEG_PER_H, 0.0, 1e5;
    vrw_ug_per_sqrt_hz: unit::MICRO_G, 0.0, 1e6;
    bias_ug: unit::MICRO_G, 0.0, 1e6;
    scale_ppm: unit::PPM, 0.0, 1e5;
    misalignment_arcsec: unit::ARCSEC, 0.0, 36_000.0;
    stamp_jitter_us: 1e-6, 0.0, 1e5;
    range_deg_per_s: unit::DEGREE, 1.0, 1e5;
    range_g: unit::STANDARD_GRAVITY, 0.1, 1e4;
    attitude_noise_arcsec: unit::ARCSEC, 1e-3, 36_000.0;
    range_factor: 1.0, 0.0, 1e3;
    weight_walk_per_sqrt_s: 1.0, 0.0, 100.0;
    offset_walk_arcsec_per_sqrt_s: unit::ARCSEC, 0.0, 1e4;
    static_walk_arcsec_per_sqrt_h: unit::ARCSEC / 60.0, 0.0, 1e4;
    bias_doubt: 1.0, 1.0, 100.0;
    static_rate_noise_arcsec2_per_s3: unit::ARCSEC * unit::ARCSEC, 0.0, 1e6;
    weight_sigma: 1.0, 0.0, 10.0;

    lever_arm_m: 1.0, -1000.0, 1000.0;
    rotation_vector_deg: unit::DEGREE, -360.0, 360.0;
    zero_deg: unit::DEGREE, -5.0, 5.0;
    rotation_vector_arcmin: unit::ARCMIN, -10_800.0, 10_800.0;
    matrix: 1.0, -1.001, 1.001;
    sigma_deg: unit::DEGREE, 1e-4, 180.0;
    sigma_arcsec: unit::ARCSEC, 1e-3, 36_000.0;
    sigma_arcmin: unit::ARCMIN, 0.0, 600.0;
    mu_per_s: 1.0, 1e-4, 100.0;
    b_rad_per_s: 1.0, 1e-4, 100.0;
    tau_s: 1.0, 0.01, 1e4;

    speed_knots: unit::KNOT, 0.0, 100.0;
    latitude_deg: unit::DEGREE, -89.0, 89.0;
    longitude_deg: unit::DEGREE, -360.0, 360.0;
    course_deg: unit::DEGREE, -360.0, 360.0;
    phase_deg: unit::DEGREE, -360.0, 360.0;
    amplitude_deg: unit::DEGREE, 0.0, 60.0;
    sway_period_s: 1.0, 0.5, 3600.0;
    ins_arcsec: unit::ARCSEC, 0.0, 36_000.0;
    ratio: 1.0, 0.0, 0.9;
    gain: 1.0, -10.0, 10.0;
    delay_ms: 1e-3, -1000.0, 1000.0;
    milliseconds: 1e-3, 0.0, 1000.0;
    latency_ms: 1e-3, 0.0, 1000.0;
    clock_bound_ms: 1e-3, 0.01, 1000.0;
    jitter_us: 1e-6, 0.0, 1e5;
    frequency_hz: 1.0, 0.0, 20.0;
    band_limit_hz: 1.0, 0.05, 5.0;
    turn_deg_per_s: unit::DEGREE, -10.0, 10.0;
    turn_s: 1.0, 1.0, 86_400.0;
    sea_factor: 1.0, 0.0, 10.0;
    change_s: 1.0, 0.0, 1e8;
    gap_s: 1.0, 0.001, 1e6;
    flexure_arcsec: unit::ARCSEC, 0.0, 36_000.0;
    flexure_mrad: 1e-3, 0.0, 180.0;
    quasi_static_arcsec: unit::ARCSEC, -36_000.0, 36_000.0;
    quasi_static_s: 1.0, 60.0, 1e6;
    factor: 1.0, 0.0, 1e5;
    percent: 0.01, 0.0, 100.0;
    cell_ms: 1e-3, 0.1, 10_000.0;
    lag_s: 1.0, 0.0, 5.0;
    resonance_hz: std::f64::consts::TAU, 0.01, 5.0;
    damping_percent: 0.01, 0.1, 90.0;
    wander_s: 1.0, 1.0, 1e6;
    wander_h: 3600.0, 0.01, 1000.0;
    clock_ppm: unit::PPM, -10_000.0, 10_000.0;

    chunk_kib: 1024.0, 4.0, 1024.0;
    flush_s: 1.0, 0.05, 1.0;
    rotate_mb: 1e6, 1.0, 1e6;
    budget_mb: 1e6, 2.0, 1e9;
}

/// The number of sinusoids that make a sea.
pub(super) fn tones<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<usize>, D::Error> {
    match usize::deserialize(deserializer)? {
        n @ 1..=1000 => Ok(Some(n)),
        _ => Err(D::Error::custom("must be within 1 to 1000")),
    }
}

/// The number of a hull, beyond those that areas have by themselves.
pub(super) fn hull<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    match u32::deserialize(deserializer)? {
        n @ 1000..=9999 => Ok(Some(n)),
        _ => Err(D::Error::custom("must be within 1000 to 9999")),
    }
}

/// The number of flexure models in the identifier's dictionary.
pub(super) fn dictionary<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
    match usize::deserialize(deserializer)? {
        n @ 1..=100 => Ok(n),
        _ => Err(D::Error::custom("must be within 1 to 100")),
    }
}

//! The lines for the configuration.

use crate::{Kind, Triad};
use estimation::allan::least_bias;
use frames::unit::{DEG_PER_H, STANDARD_GRAVITY};

/// The earth's rate, rad/s.
const EARTH: f64 = 15.041_067 * DEG_PER_H;
/// By how much gravity differs from the standard on the seas, m/s^2.
const GRAVITY_RANGE: f64 = 0.03;

/// The figures that go into the configuration: root mean squares over the axes, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Angle or velocity random walk.
    pub white: Option<f64>,
    /// Bias instability; what it is less than where it is not shown.
    pub instability: f64,
    /// The least bias that mean and instability show.
    pub bias: f64,
}

/// Of a triad with at least one analysed axis.
pub fn figures(triad: &Triad) -> Figures {
    let coefficients = || triad.axes.iter().flatten().map(|analysis| analysis.coefficients);
    let white = coefficients().filter_map(|c| c.white.map(|white| white.value));
    let instability = coefficients().map(|c| c.instability.map_or(c.most_instability, |shown| shown.value));
    let instability = rms(instability).unwrap_or(0.0);
    let true_length = match triad.kind {
        Kind::Gyro => [0.0, EARTH],
        Kind::Accel => [STANDARD_GRAVITY - GRAVITY_RANGE, STANDARD_GRAVITY + GRAVITY_RANGE],
    };
    Figures { white: rms(white), instability, bias: least_bias(triad.mean, true_length).max(instability) }
}

/// The line of a triad; `None` where no white noise is shown, which such a line needs.
pub fn line(triad: &Triad) -> Option<String> {
    let Figures { white, instability, bias } = figures(triad);
    let white = triad.kind.white().measure.number(white?);
    let measure = triad.kind.deviation();
    let (bias, instability) = (measure.number(bias), measure.number(instability));
    Some(match triad.kind {
        Kind::Gyro => format!(
            "gyro = {{ arw_deg_per_sqrt_h = {white}, bias_deg_per_h = {bias}, instability_deg_per_h = {instability} }}"
        ),
        Kind::Accel => format!("accel = {{ vrw_ug_per_sqrt_hz = {white}, bias_ug = {bias} }}"),
    })
}

fn rms(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v * v, count + 1));
    (count > 0).then(|| (sum / f64::from(count)).sqrt())
}

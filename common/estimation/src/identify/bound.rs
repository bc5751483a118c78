//! The Cramer-Rao bound of the flexure model from a window: Fisher's information by Whittle's formula.
//!
//! `I_jk = T int d ln S / d theta_j  d ln S / d theta_k  df` over the band, `S` the density of the sampled series with its white noise;
//! the level of the noise is unknown too if there is any. It is the "bound" beside paper 003's Table IV.

use super::axis::sigma_variance;
use super::periodogram::{gain, slopes};
use super::series::{Kind, Series};
use crate::flexure::Flexure;
use nalgebra::{Matrix3, Matrix4, RowVector3, Vector4};
use std::f64::consts::TAU;

/// What part of a series is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Angles or rates.
    pub kind: Kind,
    /// Distance of the points, s.
    pub step_s: f64,
    /// Lowest and highest frequency, Hz.
    pub hz: (f64, f64),
}

/// The lowest frequency is so many times that of one oscillation in the window.
const LOWEST: f64 = 1.5;
/// Of rates and angles the highest frequency, Hz, and its largest share of the sampling frequency.
const HIGHEST: (f64, f64) = (2.5, 9.0);
const NYQUIST: f64 = 0.45;
/// The lowest frequency of angles is at least this, Hz: below it stand a gyro's drift and the static part.
const ANGLES_FROM: f64 = 0.02;

impl Band {
    /// What the methods use of a series.
    pub fn of(series: &Series) -> Self {
        let lowest = LOWEST / series.length_s();
        let (lowest, highest) = match series.kind {
            Kind::Rates => (lowest, HIGHEST.0),
            Kind::Angles => (lowest.max(ANGLES_FROM), HIGHEST.1),
        };
        Self { kind: series.kind, step_s: series.step_s, hz: (lowest, highest.min(NYQUIST / series.step_s)) }
    }
}

/// The least covariance that an unbiased method can have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The model that it was made for.
    pub flexure: Flexure,
    /// Covariance of `ln mu`, `ln b`, `ln Q`.
    pub covariance: Matrix3<f64>,
}

impl Bound {
    /// For `length_s` of data with white noise of the density `noise` (the series' square times s; 0: none, and the method knows).
    /// `None` if the band says nothing.
    pub fn new(flexure: &Flexure, length_s: f64, band: Band, noise: f64) -> Option<Self> {
        let (first, last) = ((band.hz.0 * length_s).ceil().max(1.0), (band.hz.1 * length_s).floor());
        let mut information = Matrix4::zeros();
        let mut line = first;
        while line <= last {
            let w = TAU * line / length_s;
            let [by_mu, by_b, flexible] = slopes(flexure, gain(band.kind, band.step_s, w), band.step_s, w);
            let gradient = Vector4::new(by_mu, by_b, flexible, noise) / (flexible + noise);
            information += gradient * gradient.transpose();
            line += 1.0;
        }
        let covariance = if noise > 0.0 {
            information.try_inverse()?.fixed_view::<3, 3>(0, 0).into_owned()
        } else {
            information.fixed_view::<3, 3>(0, 0).into_owned().try_inverse()?
        };
        covariance.iter().all(|value| value.is_finite()).then_some(Self { flexure: *flexure, covariance })
    }

    /// Standard deviation of the damping, 1/s.
    pub fn mu_sd(&self) -> f64 {
        self.flexure.mu * self.covariance[(0, 0)].sqrt()
    }

    /// Standard deviation of the natural frequency, rad/s.
    pub fn b_sd(&self) -> f64 {
        self.flexure.b * self.covariance[(1, 1)].sqrt()
    }

    /// Standard deviation of the size, rad.
    pub fn sigma_sd(&self) -> f64 {
        self.flexure.sigma * sigma_variance(&self.covariance).sqrt()
    }

    /// Standard deviation of the frequency `beta / 2 pi`, `beta^2 = b^2 - mu^2`, Hz; `None` where the model does not oscillate.
    pub fn frequency_sd_hz(&self) -> Option<f64> {
        let Flexure { mu, b, .. } = self.flexure;
        let beta = (b > mu).then(|| (b * b - mu * mu).sqrt())?;
        let row = RowVector3::new(-mu * mu / beta, b * b / beta, 0.0);
        Some((row * self.covariance * row.transpose())[0].sqrt() / TAU)
    }
}

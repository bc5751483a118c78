//! What each rate of a flexure says that those before it did not: Kalman's filter of a mode with white noise on its rates.

use super::series::Series;
use super::whittle;
use crate::flexure::Flexure;
use nalgebra::{Matrix3, RowVector3, Vector3};

/// A mode, and the white noise of its rates.
#[derive(Clone, Copy, Debug)]
pub struct Noisy {
    /// The mode.
    pub mode: Flexure,
    /// Variance of each rate's noise, rad^2/s^2.
    pub noise: f64,
}

impl Noisy {
    /// The most probable one of a series of rates; `None` if nothing can be fitted.
    pub fn fitted(series: &Series) -> Option<Self> {
        let found = whittle::fitted(series)?;
        Some(Self { mode: found.mode()?, noise: found.noise() / series.step_s })
    }
}

/// The filter of angle, rate and the angle a step before, of which the mean rate over each step is seen (rad/s).
#[derive(Clone, Copy, Debug)]
pub struct Kalman {
    /// Over a step.
    pub transition: Matrix3<f64>,
    /// Covariance that the driving noise adds in a step.
    pub drive: Matrix3<f64>,
    /// Variance of a rate's noise.
    pub noise: f64,
    /// Covariance before the first step.
    pub start: Matrix3<f64>,
    seen: RowVector3<f64>,
}

impl Kalman {
    /// The filter of a mode whose rates are `step_s` apart.
    pub fn new(model: &Noisy, step_s: f64) -> Self {
        let (mut transition, mut drive, mut start) = (Matrix3::zeros(), Matrix3::zeros(), Matrix3::zeros());
        model.mode.place(step_s, 0, 1, &mut transition, &mut drive);
        transition[(2, 0)] = 1.0;
        model.mode.place_stationary(0, 1, &mut start);
        Self { transition, drive, noise: model.noise, start, seen: RowVector3::new(1.0, 0.0, -1.0) / step_s }
    }

    /// The same with so many times the driving noise.
    pub fn driven(self, times: f64) -> Self {
        Self { drive: self.drive * times, start: self.start * times, ..self }
    }

    /// The rate that a state shows.
    pub fn rate(&self, state: &Vector3<f64>) -> f64 {
        (self.seen * state)[0]
    }

    /// The variance of a rate that a covariance makes, without the rate's own noise.
    pub fn share(&self, p: &Matrix3<f64>) -> f64 {
        (self.seen * p * self.seen.transpose())[0]
    }

    /// The covariance carried on by a step.
    pub fn carried(&self, p: &Matrix3<f64>) -> Matrix3<f64> {
        self.transition * p * self.transition.transpose() + self.drive
    }

    /// The variance of the next rate before it is seen.
    pub fn variance(&self, p: &Matrix3<f64>) -> f64 {
        self.share(p) + self.noise
    }

    /// By how much a rate that is off by one corrects the state.
    pub fn gain(&self, p: &Matrix3<f64>) -> Vector3<f64> {
        p * self.seen.transpose() / self.variance(p)
    }

    /// The covariance after a rate has been seen.
    pub fn updated(&self, p: &Matrix3<f64>) -> Matrix3<f64> {
        let gain = self.gain(p);
        p - gain * gain.transpose() * self.variance(p)
    }
}

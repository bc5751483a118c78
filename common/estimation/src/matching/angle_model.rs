//! A matching model by the states of [`super::angles`]: its file holds only what is measured and how.

use super::angles::{Angles, Covariance, Rows, STATES, State};
use super::{Matching, Model, Motion, Observation, Prediction, Start, View};
use crate::flexure::Flexure;
use frames::{Main, Rot, Sub};
use nalgebra::Vector3;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// What is particular about a matching by angles.
pub trait AngleModel: Clone + Send + Serialize + DeserializeOwned + 'static {
    /// What the total stands on.
    fn base(_start: &Start) -> Rot<Main, Sub> {
        Rot::identity()
    }
    /// The model of these states.
    fn new(angles: Angles) -> Self;
    /// The states.
    fn angles(&self) -> &Angles;
    /// The states, to be moved.
    fn angles_mut(&mut self) -> &mut Angles;
    /// What the states leave of the measurement, rad.
    fn residual(&self) -> Vector3<f64>;
    /// How the measurement depends on the states.
    fn matrix(&self) -> Rows;
    /// Moves the states on.
    fn carry(&mut self) -> Prediction<STATES> {
        self.angles_mut().propagate()
    }
    /// The total at the last pair taken in.
    fn total_view(&self) -> View<STATES> {
        self.angles().view()
    }
}

impl<M: AngleModel> Matching<STATES, 3> for M {
    fn propagate(&mut self) -> Prediction<STATES> {
        self.carry()
    }

    fn observe(&self) -> Observation<STATES, 3> {
        Observation { residual: self.residual(), matrix: self.matrix(), noise: Angles::measurement_noise() }
    }

    fn inject(&mut self, error: &State) {
        self.angles_mut().x += error;
    }
}

impl<M: AngleModel> Model<STATES, 3> for M {
    type Options = ();

    fn begin(_: &(), start: &Start) -> (Self, Covariance) {
        let (angles, p) = Angles::begin(start, Self::base(start));
        (Self::new(angles), p)
    }

    fn advance(&mut self, motion: &Motion) {
        self.angles_mut().advance(motion);
    }

    fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.angles_mut().set_flexure(flexure);
    }

    fn view(&self) -> View<STATES> {
        self.total_view()
    }
}

//! Attitude and velocity matching: the model of [`super::so3`] with accelerometers and an unknown delay.
//!
//! Source: paper 001 (attitudes), 000 (velocities, lever arm), 002 (delay), all in product form. `A_m D = N A_s` gives the attitude part as in
//! `so3`. Through the same constant the sub unit's accelerometers show the relative velocity `u`, `du = N A_s f_s dt - A_m f_m dt`, in which
//! the attitude's error turns gravity, and which the lever arm must explain: `A_m^T u = w x r + g (w x (theta x r) + theta' x r)`.
//! The sub unit's stamps are late by a delay of which the attitudes' re-timing takes out the known part, and two states the rest.
//!
//! | state | size | error | moves by |
//! |---|---|---|---|
//! | those of `so3` | 33 | | |
//! | relative velocity `u`, m/s | 3 | additive, in the main unit's starting axes | tilt, biases, velocity random walk |
//! | relative accelerometer bias, m/s^2 | 3 | additive, in s | constant |
//! | angle from gyros to accelerometers of the sub unit, rad | 3 | additive, in s | constant |
//! | gain `g` of the flexure on the lever arm, about 0 to 1 | 3 | additive | constant |
//! | lever arm `r`, m | 3 | additive, in m | constant |
//! | rest of the delay, s | 1 | additive | the skew |
//! | skew | 1 | additive | constant |
//!
//! Static part and flexure are those of the moment that the sub unit felt; what is published is carried on from there to the stamp, see
//! [`super::quaternion`]. Without accelerometers the velocity's states stay without variance and nothing is compared.

pub mod place;
mod velocity;

pub use velocity::{Lever, Velocity};

use super::increment::{Increment, Velocities};
use super::quaternion::DelayOptions;
use super::retiming::{Retimed, Together};
use super::so3::{self, Grade, So3};
use super::{Matching, Observation, Prediction, View, rows_of};
use crate::align::Lag;
use crate::flexure::Hull;
use frames::{Main, Rot, Sub, Vec3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};
use velocity::Scene;

/// Size of the error state.
pub const STATES: usize = 50;
/// Size of the measurement: attitude, then velocity.
pub const ROWS: usize = 6;
/// The first of them that compares velocities.
pub const VELOCITY_ROW: usize = 3;

/// Covariance of the error state.
pub type Covariance = SMatrix<f64, STATES, STATES>;
/// Error state.
pub type ErrorState = SVector<f64, STATES>;
type Rows = SMatrix<f64, 3, STATES>;

/// What the model is told beside the units' figures.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Options {
    /// Accelerometers and lever arm; `None` to go by the gyros alone.
    pub lever: Option<Lever>,
    /// What is known of the delay.
    pub delay: DelayOptions,
}

/// The nominal state of one area.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Deck {
    options: Options,
    grade: Grade,
    so3: So3,
    velocity: Option<Velocity>,
    attitudes: Retimed,
    /// Both units at the last moment that both have felt.
    together: Option<Together>,
    /// What has come in since that moment.
    waiting: Option<Increment>,
    delay: f64,
    skew: f64,
}

fn widened(rows: &SMatrix<f64, 3, { so3::STATES }>) -> Rows {
    let mut wide = Rows::zeros();
    wide.fixed_view_mut::<3, { so3::STATES }>(0, 0).copy_from(rows);
    wide
}

fn embedded(small: &so3::Covariance, diagonal: f64) -> Covariance {
    let mut large = Covariance::from_diagonal_element(diagonal);
    large.fixed_view_mut::<{ so3::STATES }, { so3::STATES }>(0, 0).copy_from(small);
    large
}

impl Deck {
    /// A state at rest beside the gyros' part, with what is known of the delay, and the covariance `p` of the gyros' part made into that of all.
    pub fn new(options: Options, grade: Grade, so3: So3, lag: Option<Lag>, p: &so3::Covariance) -> (Self, Covariance) {
        let mut p = embedded(p, 0.0);
        let velocity = options.lever.map(Velocity::new);
        if let Some(velocity) = &velocity {
            velocity.doubt(&grade, &mut p);
        }
        let mut attitudes = Retimed::new(options.delay.retimed);
        let mut delay = 0.0;
        let mut sigma = options.delay.sigma;
        if let Some(lag) = lag.filter(|_| sigma > 0.0) {
            (delay, sigma) = (lag.delay, lag.sigma);
            attitudes.absorb(&mut delay);
        }
        p[(place::DELAY, place::DELAY)] = sigma * sigma;
        p[(place::SKEW, place::SKEW)] = options.delay.skew_sigma.powi(2);
        (Self { options, grade, so3, velocity, attitudes, together: None, waiting: None, delay, skew: 0.0 }, p)
    }

    /// The gyros' part.
    pub fn so3(&self) -> &So3 {
        &self.so3
    }

    /// Replaces the flexure model from now on.
    pub fn set_flexure(&mut self, hull: Hull) {
        self.so3.set_flexure(hull);
    }

    /// Lets time pass for the model of static part and flexure.
    pub fn coast(&mut self, time_s: f64) {
        self.so3.coast(time_s);
    }

    /// The time since the last propagation, s.
    pub fn pending_s(&self) -> f64 {
        self.so3.pending_s()
    }

    /// Forgets the velocity; it starts anew from what the lever arm gives.
    pub fn forget_velocity(&mut self) {
        if let Some(velocity) = &mut self.velocity {
            velocity.restart();
        }
    }

    /// Forgets the attitudes: those to come have other starting axes.
    pub fn restart(&mut self) {
        self.attitudes.restart();
        (self.together, self.waiting) = (None, None);
        self.forget_velocity();
    }

    /// Starts an epoch: the constant is defined by the deformation as it is believed to be now. Gives the transition of the error state.
    pub fn start_epoch(&mut self) -> Option<Covariance> {
        let now = self.together?;
        let turn = Rot::<Main, Main>::exp(now.w_m * self.delay);
        let mut transition = embedded(&self.so3.start_epoch(now.a_m, now.a_s, turn), 1.0);
        let by_delay = now.a_m.matrix() * now.w_m.column();
        transition.fixed_view_mut::<3, 1>(place::CONSTANT, place::DELAY).copy_from(&by_delay);
        self.forget_velocity();
        Some(transition)
    }

    /// Takes in what both units felt up to `time_s` since any fixed instant; `false` while there is no moment that both have felt.
    pub fn advance(&mut self, time_s: f64, step: &Increment) -> bool {
        self.attitudes.take(time_s, step);
        let step = self.waiting.take().map_or(*step, |waiting| waiting.then(step));
        let Some(now) = self.attitudes.together() else {
            self.waiting = Some(step);
            return false;
        };
        let Some(before) = self.together.replace(now) else { return true };
        let velocities = step
            .velocities
            .is_some()
            .then(|| Velocities { m: now.gained.m - before.gained.m, s: now.gained.s - before.gained.s });
        let moved = Increment {
            a_m: now.a_m,
            a_s: now.a_s,
            dtheta_m: (before.a_m.inverse() * now.a_m).log(),
            velocities,
            ..step
        };
        if let Some(velocity) = &mut self.velocity {
            velocity.advance(&moved, self.so3.constant(), self.so3.by_gyro());
        }
        self.so3.advance(&moved);
        true
    }

    /// Both units at the last moment that both have felt.
    pub fn together(&self) -> Option<&Together> {
        self.together.as_ref()
    }

    /// By how much the sub unit's data are older than their stamps, s.
    pub fn lateness(&self) -> f64 {
        self.attitudes.shift() + self.delay + self.skew * self.so3.pending_s()
    }

    /// By how much of the lateness the attitudes are not re-timed, as a turn of the ship.
    fn turn(&self) -> Rot<Main, Main> {
        let rate = self.together.map_or(Vec3::ZERO, |now| now.w_m);
        Rot::exp(rate * (self.delay + self.skew * self.so3.pending_s()))
    }

    /// The deformation by the units' attitudes, of the moment that the sub unit felt.
    pub fn deformation(&self) -> Rot<Main, Sub> {
        self.turn() * self.so3.deformation()
    }

    fn scene(&self, now: &Together) -> Scene {
        let (theta, theta_rate) = self.so3.flexed();
        Scene {
            a_m: now.a_m,
            w_m: now.w_m.column(),
            theta,
            theta_rate,
            delay: self.delay,
            liveliest: self.so3.liveliest(),
        }
    }

    /// Variance of each velocity that the observation leaves out, m^2/s^2, at the covariance `p`.
    pub fn left_out(&self, p: &Covariance) -> Vector3<f64> {
        let now = self.together.filter(|_| self.velocity.as_ref().is_some_and(Velocity::is_begun));
        match (&self.velocity, now) {
            (Some(velocity), Some(now)) => velocity.left_out(&self.scene(&now), p),
            _ => Vector3::zeros(),
        }
    }

    /// How the error of the deformation by the attitudes depends on the error state.
    pub fn deformation_rows(&self) -> Rows {
        let mut rows = widened(&self.so3.deformation_rows());
        if let Some(now) = self.together {
            rows.set_column(place::DELAY, &-now.w_m.column());
            rows.set_column(place::SKEW, &(-now.w_m.column() * self.so3.pending_s()));
        }
        rows
    }

    /// What stands at the stamp of the last pair; with `by_model` without the attitudes, which are missing or old.
    pub fn view(&self, by_model: bool) -> View<STATES> {
        let static_rows: Rows = -rows_of(place::STATIC);
        let rate_rows: Rows = -(rows_of(place::FLEXURE_RATE) + rows_of(place::SECOND_RATE));
        let (seen, mut rows, mut noise) = if by_model {
            (self.so3.predicted(), -widened(&So3::prediction_rows()), Matrix3::zeros())
        } else {
            (self.deformation(), self.deformation_rows(), self.so3.deformation_noise())
        };
        let late_s = self.lateness().max(0.0);
        let mut turn = Vec3::ZERO;
        if late_s > 0.0 {
            let ahead = self.so3.ahead(late_s);
            turn = ahead.turn;
            rows += widened(&ahead.rows);
            noise += ahead.noise;
            let rate = self.so3.flexed().1;
            rows.set_column(place::DELAY, &(rows.column(place::DELAY) - rate));
        }
        let told = |value: f64, sigma: f64, place: usize| (sigma > 0.0).then_some((value, place));
        View {
            deformation: Rot::<Main, Main>::exp(turn) * seen,
            rows,
            noise,
            static_part: self.so3.static_part(),
            static_rows,
            rate: self.so3.rate(),
            rate_rows,
            drift: self.so3.drift(),
            delay: told(self.lateness(), self.options.delay.sigma, place::DELAY),
            skew: told(self.skew, self.options.delay.skew_sigma, place::SKEW),
        }
    }
}

impl Matching<STATES, ROWS> for Deck {
    fn propagate(&mut self) -> Prediction<STATES> {
        let h = self.so3.pending_s();
        let Prediction { transition, noise } = self.so3.propagate();
        let (mut transition, mut noise) = (embedded(&transition, 1.0), embedded(&noise, 0.0));
        self.delay += self.skew * h;
        transition[(place::DELAY, place::SKEW)] = h;
        if let Some(now) = self.together {
            let scene = self.scene(&now);
            if let Some(velocity) = &mut self.velocity {
                velocity.propagate(&scene, &mut transition, &mut noise);
            }
        }
        Prediction { transition, noise }
    }

    fn observe(&self) -> Observation<STATES, ROWS> {
        let mut seen = Observation { residual: SVector::zeros(), matrix: SMatrix::zeros(), noise: SMatrix::identity() };
        let Some(now) = self.together else { return seen };
        let attitude = self.so3.observe();
        let residual = (self.deformation() * self.so3.predicted().inverse()).log().column();
        let mut matrix = widened(&attitude.matrix);
        matrix.set_column(place::DELAY, &-now.w_m.column());
        seen.residual.fixed_rows_mut::<3>(0).copy_from(&residual);
        seen.matrix.fixed_rows_mut::<3>(0).copy_from(&matrix);
        seen.noise.fixed_view_mut::<3, 3>(0, 0).copy_from(&attitude.noise);
        if let Some(velocity) = self.velocity.as_ref().filter(|velocity| velocity.is_begun()) {
            let scene = self.scene(&now);
            seen.residual.fixed_rows_mut::<3>(VELOCITY_ROW).copy_from(&velocity.residual(&scene));
            seen.matrix.fixed_rows_mut::<3>(VELOCITY_ROW).copy_from(&velocity.matrix(&scene));
            seen.noise.fixed_view_mut::<3, 3>(VELOCITY_ROW, VELOCITY_ROW).fill_diagonal(velocity.variance(&self.grade));
        }
        seen
    }

    fn inject(&mut self, error: &ErrorState) {
        self.so3.inject(&error.fixed_rows::<{ so3::STATES }>(0).into());
        if let Some(velocity) = &mut self.velocity {
            velocity.inject(error);
        }
        self.delay += error[place::DELAY];
        self.skew += error[place::SKEW];
        let before = self.attitudes.shift();
        self.attitudes.absorb(&mut self.delay);
        if self.attitudes.shift() != before {
            self.retime();
        }
    }
}

impl Deck {
    /// Puts attitudes and velocity at the moment that a new shift says.
    fn retime(&mut self) {
        let before = std::mem::replace(&mut self.together, self.attitudes.together());
        let (Some(before), Some(now)) = (before, self.together) else {
            self.restart();
            return;
        };
        self.so3.retime(now.a_m, now.a_s);
        if let Some(velocity) = &mut self.velocity {
            velocity.retime(before.gained, now.gained, self.so3.constant());
        }
    }
}

#[cfg(test)]
mod tests;

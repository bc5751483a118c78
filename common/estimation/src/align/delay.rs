//! Coarse registration of installation, delay and relative gyro bias together.
//!
//! Source: the time base of paper 002's reworking. The rates of both units over short windows obey `w_m(t) = C_s^m w_s(t + tau) + c`, with
//! `w_s` by its late stamps. The correlation of the rates' lengths, which no installation angle changes, gives `tau` to a fraction of a window;
//! Gauss and Newton's method takes out the rest with rotation and bias. Every lagged stretch has its own mean taken out: a ship's motion
//! is so narrow-banded that the ends would shift the top of the correlation otherwise.
//!
//! The pairs are held, so that the filter can run over them once the delay is known.

use super::motion::nearest_rotation;
use super::{Lag, Register, Registration};
use frames::{Main, Rot, Sub, Vec3, unit};
use messages::{Flags, ImuPair};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// Length of a window, s.
const WINDOW_S: f64 = 0.02;
/// Delays up to this are searched, s.
const SEARCH_S: f64 = 0.4;
/// The flexure's rate, which is what disturbs the rates, keeps its sign for about so long, s.
const CORRELATION_S: f64 = 1.0;
/// Least length of data before a solution is tried, s.
const LEAST_S: f64 = 2.0;
/// The filter sees the held pairs again, which must not count twice: the variances are made so many times as large.
const SEEN_AGAIN: f64 = 100.0;
const ITERATIONS: usize = 5;
/// Rotation, bias, delay.
const UNKNOWNS: usize = 7;

/// Rates of both units over a window.
#[derive(Clone, Copy, Debug)]
struct Rates {
    main: Vector3<f64>,
    sub: Vector3<f64>,
}

/// Holds pairs and finds installation and delay.
#[derive(Clone, Debug, Default)]
pub struct DelayRegistrar {
    held: Vec<ImuPair>,
    windows: Vec<Rates>,
    /// Angles of the window that is being filled, and its length.
    filling: (Vector3<f64>, Vector3<f64>, f64),
    /// Mean length of the windows so far, s.
    step_s: f64,
}

/// What the fit found.
struct Fit {
    rotation: Matrix3<f64>,
    bias: Vector3<f64>,
    delay: f64,
    covariance: SMatrix<f64, UNKNOWNS, UNKNOWNS>,
    residual: Vector3<f64>,
    ratio: f64,
}

impl DelayRegistrar {
    /// A registrar that has seen nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    fn restart(&mut self) {
        *self = Self::default();
    }

    fn length_s(&self) -> f64 {
        self.step_s * self.windows.len() as f64
    }

    /// The delay by the correlation of the rates' lengths, s.
    pub fn correlate(&self) -> Option<f64> {
        let n = self.windows.len();
        let most = (SEARCH_S / self.step_s).round() as usize;
        if self.length_s() < LEAST_S || n < 3 * most {
            return None;
        }
        let main: Vec<f64> = self.windows.iter().map(|rates| rates.main.norm()).collect();
        let sub: Vec<f64> = self.windows.iter().map(|rates| rates.sub.norm()).collect();
        let at = |lag: isize| {
            let (a, b) = if lag >= 0 { (0, lag as usize) } else { (lag.unsigned_abs(), 0) };
            let count = n - lag.unsigned_abs();
            correlation(&main[a..a + count], &sub[b..b + count])
        };
        let most = most as isize;
        let best = (-most..=most).map(|lag| (lag, at(lag))).max_by(|x, y| x.1.total_cmp(&y.1))?.0;
        let (before, top, after) = (at(best - 1), at(best), at(best + 1));
        let bend = before - 2.0 * top + after;
        let rest = if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-1.0, 1.0) } else { 0.0 };
        Some((best as f64 + rest) * self.step_s)
    }

    /// The sub unit's rate at a place between the windows, with its derivative by that place; four points.
    fn sub_at(&self, place: f64) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let left = place.floor();
        let u = place - left;
        let first = left as isize - 1;
        if first < 0 || first as usize + 3 >= self.windows.len() {
            return None;
        }
        let y = |i: usize| self.windows[first as usize + i].sub;
        let (u2, u3) = (u * u, u * u * u);
        let value = y(0) * (-u3 + 3.0 * u2 - 2.0 * u) / 6.0
            + y(1) * (u3 - 2.0 * u2 - u + 2.0) / 2.0
            + y(2) * (-u3 + u2 + 2.0 * u) / 2.0
            + y(3) * (u3 - u) / 6.0;
        let slope = y(0) * (-3.0 * u2 + 6.0 * u - 2.0) / 6.0
            + y(1) * (3.0 * u2 - 4.0 * u - 1.0) / 2.0
            + y(2) * (-3.0 * u2 + 2.0 * u + 2.0) / 2.0
            + y(3) * (3.0 * u2 - 1.0) / 6.0;
        Some((value, slope))
    }

    /// The main unit's rate beside the sub unit's at a delay, with the derivative of the latter by time.
    fn pairs(&self, delay: f64) -> impl Iterator<Item = (Vector3<f64>, Vector3<f64>, Vector3<f64>)> {
        let shift = delay / self.step_s;
        self.windows.iter().enumerate().filter_map(move |(k, rates)| {
            let (sub, slope) = self.sub_at(k as f64 + shift)?;
            Some((rates.main, sub, slope / self.step_s))
        })
    }

    fn fit(&self) -> Option<Fit> {
        let mut delay = self.correlate()?;
        let (mut rotation, ratio) = self.davenport(delay)?;
        let mut bias = Vector3::zeros();
        for _ in 0..ITERATIONS {
            let (normal, right, ..) = self.normal_equations(&rotation, bias, delay);
            let step = normal.cholesky()?.solve(&right);
            let turn = Rot::<Main, Main>::exp(Vec3::from_column(step.fixed_rows::<3>(0).into()));
            rotation = turn.matrix() * rotation;
            bias += step.fixed_rows::<3>(3);
            delay += step[6];
            if !delay.is_finite() || delay.abs() > 2.0 * SEARCH_S {
                return None;
            }
        }
        let (normal, _, square, count) = self.normal_equations(&rotation, bias, delay);
        let freedom = (count - UNKNOWNS as f64 / 3.0).max(1.0);
        let residual = square / freedom;
        let correlated = (CORRELATION_S / self.step_s).max(1.0);
        let variance = residual.mean() * correlated * SEEN_AGAIN;
        let covariance = normal.cholesky()?.inverse() * variance.max(f64::MIN_POSITIVE);
        Some(Fit { rotation, bias, delay, covariance, residual, ratio })
    }

    /// The rotation at a delay, and the ratio of the second to the first singular value.
    fn davenport(&self, delay: f64) -> Option<(Matrix3<f64>, f64)> {
        let (mut ab, mut a, mut b, mut n) = (Matrix3::zeros(), Vector3::zeros(), Vector3::zeros(), 0.0);
        for (main, sub, _) in self.pairs(delay) {
            ab += main * sub.transpose();
            a += main;
            b += sub;
            n += 1.0;
        }
        let (rotation, singular) = nearest_rotation(&(ab - a * b.transpose() / n))?;
        Some((rotation, singular[1] / singular[0].max(f64::MIN_POSITIVE)))
    }

    /// Normal matrix and right side of the step, sum of squares per axis, number of windows.
    fn normal_equations(
        &self,
        rotation: &Matrix3<f64>,
        bias: Vector3<f64>,
        delay: f64,
    ) -> (SMatrix<f64, UNKNOWNS, UNKNOWNS>, SVector<f64, UNKNOWNS>, Vector3<f64>, f64) {
        let mut normal = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
        let (mut right, mut square, mut count) = (SVector::<f64, UNKNOWNS>::zeros(), Vector3::zeros(), 0.0);
        for (main, sub, slope) in self.pairs(delay) {
            let turned = rotation * sub;
            let residual = main - turned - bias;
            let mut by = SMatrix::<f64, 3, UNKNOWNS>::zeros();
            by.fixed_view_mut::<3, 3>(0, 0).copy_from(&-turned.cross_matrix());
            by.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
            by.set_column(6, &(rotation * slope));
            normal += by.transpose() * by;
            right += by.transpose() * residual;
            square += residual.component_mul(&residual);
            count += 1.0;
        }
        (normal, right, square, count)
    }
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let (mean_a, mean_b) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        let (x, y) = (x - mean_a, y - mean_b);
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    ab / (aa * bb).sqrt().max(f64::MIN_POSITIVE)
}

impl Register for DelayRegistrar {
    fn add(&mut self, pair: &ImuPair) {
        // windows must lie side by side
        if pair.flags.intersects(Flags::GAP | Flags::NEW_EPOCH) {
            self.restart();
            if pair.flags.contains(Flags::GAP) {
                return;
            }
        }
        self.held.push(*pair);
        if self.held.len() == 1 {
            return;
        }
        let (main, sub, length_s) = &mut self.filling;
        *main += Vec3::<Main>::from(pair.dtheta_m).column();
        *sub += Vec3::<Sub>::from(pair.dtheta_s).column();
        let interval_s = unit::seconds(pair.interval_ns);
        *length_s += interval_s;
        if *length_s >= WINDOW_S - 0.5 * interval_s {
            let (main, sub, length_s) = std::mem::take(&mut self.filling);
            self.windows.push(Rates { main: main / length_s, sub: sub / length_s });
            self.step_s += (length_s - self.step_s) / self.windows.len() as f64;
        }
    }

    fn solve(&self) -> Option<Registration> {
        let fit = self.fit()?;
        let bias_variance = fit.covariance.fixed_view::<3, 3>(3, 3).diagonal();
        let covariance: Matrix3<f64> = fit.covariance.fixed_view::<3, 3>(0, 0).into();
        let sound = covariance.iter().chain(fit.rotation.iter()).all(|x| x.is_finite());
        (sound && covariance.diagonal().min() > 0.0).then(|| Registration {
            rotation: Rot::from_matrix(&fit.rotation),
            covariance,
            bias: Vec3::from_column(fit.bias),
            bias_sigma: bias_variance.map(f64::sqrt),
            residual_rate: fit.residual.map(f64::sqrt),
            ratio: fit.ratio,
        })
    }

    fn lag(&self) -> Option<Lag> {
        self.fit().map(|fit| Lag { delay: fit.delay, sigma: fit.covariance[(6, 6)].sqrt() })
    }

    fn held(&self) -> &[ImuPair] {
        &self.held
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::conformance::{STEP_S, Voyage};
    use frames::unit::{ARCSEC, DEGREE};

    fn registrar(voyage: &Voyage, seconds: f64) -> DelayRegistrar {
        let mut registrar = DelayRegistrar::new();
        for k in 1..=(seconds / STEP_S) as usize {
            let motion = voyage.motion(k);
            registrar.add(&ImuPair {
                interval_ns: unit::nanoseconds(STEP_S),
                dtheta_m: motion.dtheta_m.array(),
                dtheta_s: motion.dtheta_s.array(),
                ..ImuPair::default()
            });
        }
        registrar
    }

    #[test]
    fn a_rigid_ship_shows_delay_and_installation_at_any_angle() {
        for delay_s in [0.0, 0.0123, -0.0577, 0.1874, 0.35] {
            for installation in [Vec3::ZERO, Vec3::new(0.2, -0.4, 2.5)] {
                let installation = Rot::exp(installation);
                let registrar = registrar(&Voyage { installation, flexure: 0.0, delay_s, lever_arm: Vec3::ZERO }, 20.0);
                assert!((registrar.correlate().expect("seen") - delay_s).abs() < 2e-3, "{delay_s}");
                let (lag, found) = (registrar.lag().expect("seen"), registrar.solve().expect("seen"));
                assert!((lag.delay - delay_s).abs() < 1e-6, "{delay_s} {}", lag.delay);
                assert!((found.rotation * installation.inverse()).angle() < 0.5 * ARCSEC, "{delay_s}");
            }
        }
    }

    #[test]
    fn it_knows_what_a_flexing_hull_leaves_open() {
        let installation = Rot::exp(Vec3::new(0.5, -1.0, 2.0) * DEGREE);
        for seconds in [10.0, 30.0, 60.0] {
            let flexing = Voyage { installation, flexure: 20.0 * ARCSEC, delay_s: 0.05, lever_arm: Vec3::ZERO };
            let lag = registrar(&flexing, seconds).lag().expect("seen");
            assert!(lag.sigma < 0.1 && (lag.delay - 0.05).abs() < lag.sigma, "{seconds} {lag:?}");
        }
    }

    #[test]
    fn nothing_to_see_gives_nothing() {
        assert!(DelayRegistrar::new().lag().is_none());
        let mut still = DelayRegistrar::new();
        (0..4000).for_each(|_| still.add(&ImuPair { interval_ns: 10_000_000, ..ImuPair::default() }));
        assert!(still.solve().is_none() && still.lag().is_none());
    }
}

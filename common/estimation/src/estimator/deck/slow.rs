//! What the slow motion alone shows: turns of the ship, and of the Earth under her.
//!
//! A flexure in step with the waves looks like a static angle to any filter that uses the waves (004). The mean over minutes does not know the waves:
//! `mean(Log(A_m^T N A_s S^T)) = s - mean(A_m)^T eta`, with `s` and `eta` the errors of static part and constant, and the flexure's mean is small. On a straight
//! course that tells the difference of the two only; when the course changes, each of them about the axes that turn. So this filter, the model of
//! [`crate::matching::so3`] without a flexure, gets one weighted mean every two minutes, knows little most of the time, and is not deceived.
//!
//! Hann's weights leave a few thousandths of a wave of 0.05 Hz.

use super::DeckSettings;
use super::surprise::Surprise;
use crate::filter::sequential;
use crate::flexure::{Flexure, Hull};
use crate::matching::Matching;
use crate::matching::increment::Increment;
use crate::matching::retiming::Together;
use crate::matching::so3::{self, Covariance, Rows, So3, place};
use frames::{Main, Rot, Vec3, unit};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Length of a mean, s.
const BLOCK_S: f64 = 120.0;
/// The attitudes are looked at so often, s.
const EVERY_S: f64 = 0.1;
/// What is known of static part and constant before any turn, rad: half a degree, more than any coupling hides. With ten degrees it wandered so far about
/// the axes that nothing shows that its linear equations no longer held about the others.
const UNKNOWN: f64 = 0.5 * unit::DEGREE;
/// Variance of a mean with Hann's weights over that with equal ones.
const HANN: f64 = 1.5;
/// By how much calmer the static part is taken to be than the fast filter takes it. That one has the waves at every moment and loses nothing by reckoning with
/// sudden bends; over the half hour from one turn to the next its figure would be seven minutes of arc, and a turn would be forgotten as soon as seen.
const CALMER: f64 = 1e-3;
/// By how much less calm it is taken to be after the means have refuted that, at most as the fast filter takes it.
const LIVELIER: f64 = 32.0;
/// What refutes it: the mean square of about so many innovations in terms of their variance. 1 is expected, and 0.2 its deviation; a static part that moves by
/// 800 arcsec in two hours comes to hundreds, and taken for still it was 80 arcsec wrong.
const REFUTING: f64 = 2.0;
const REMEMBERED: f64 = 8.0;
/// So many means are there before the filter is believed. Two of them give where the static part stands and how fast it goes; only those that follow can refute
/// that it goes on so. Believed after two, the filter turned paper 002's ship, whose static part bends its way by 5 arcsec in two minutes, by 2 deviations.
const TRIED: u32 = 4;

/// The slow filter.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Slow {
    so3: So3,
    p: Covariance,
    /// The fast filter's flexure model.
    hull: Hull,
    block: Block,
    /// The last moment of the epoch; `None` before its first.
    last: Option<Last>,
    calmer: f64,
    surprise: Surprise,
    /// Means so far.
    means: u32,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Last {
    time_ns: i64,
    now: Together,
    disturbance: f64,
}

/// Weighted sums since the last propagation.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Block {
    weight: f64,
    residual: Vector3<f64>,
    rows: Rows,
}

impl Block {
    fn new() -> Self {
        Self { weight: 0.0, residual: Vector3::zeros(), rows: Rows::zeros() }
    }
}

fn still(hull: &Hull) -> Hull {
    Hull::from(hull.modes.map(|mode| Flexure { sigma: 0.0, ..mode }))
}

impl Slow {
    /// A filter that starts from where a fast one stands, but knows nothing of what that believes.
    pub fn new(settings: &DeckSettings, fast: &So3, hull: Hull) -> Self {
        Self::calmer_by(CALMER, settings, fast, hull)
    }

    /// This filter, or, where the means have refuted what it takes the static part to do, one that starts anew and takes it to move more.
    pub fn revised(self, settings: &DeckSettings, fast: &So3) -> Self {
        if self.surprise.is_small() {
            return self;
        }
        let anew = Self::calmer_by((self.calmer * LIVELIER).min(1.0), settings, fast, self.hull);
        // there is no livelier one
        let surprise = if self.calmer < 1.0 { anew.surprise } else { self.surprise };
        Self { surprise, ..anew }
    }

    /// By how much the fast filter's covariance is too small for how the static part moves, which its own innovations do not show; 1 where nothing says so.
    pub fn excess(&self) -> f64 {
        if self.calmer < 1.0 { 1.0 } else { self.surprise.excess() }
    }

    fn calmer_by(calmer: f64, settings: &DeckSettings, fast: &So3, hull: Hull) -> Self {
        let grade = so3::Grade { static_noise: settings.area.grade.static_noise * calmer, ..settings.area.grade };
        let mut p = Covariance::zeros();
        for axis in 0..3 {
            p[(place::STATIC + axis, place::STATIC + axis)] = UNKNOWN * UNKNOWN;
            p[(place::STATIC_RATE + axis, place::STATIC_RATE + axis)] = grade.static_rate_variance();
            p[(place::BIAS + axis, place::BIAS + axis)] = grade.bias_variance();
            p[(place::WANDER + axis, place::WANDER + axis)] = grade.wander_variance();
        }
        let scale = grade.scale_covariance(fast.static_part());
        p.fixed_view_mut::<6, 6>(place::SCALE, place::SCALE).copy_from(&scale);
        let so3 = So3::new(grade, still(&hull), fast.static_part(), fast.drift());
        let surprise = Surprise::new(REMEMBERED, REFUTING);
        Self { so3, p, hull, block: Block::new(), last: None, calmer, surprise, means: 0 }
    }

    /// Replaces the flexure model from now on.
    pub fn set_flexure(&mut self, hull: Hull) {
        self.hull = hull;
    }

    /// Variance of a mean by the flexure's slow part, about each axis, rad^2.
    fn flexure_variance(&self) -> Vector3<f64> {
        let Hull { modes, second } = &self.hull;
        let density = |axis: usize| modes[axis].spectrum(0.0) + second[axis].map_or(0.0, |mode| mode.spectrum(0.0));
        Vector3::from_fn(|axis, _| HANN * density(axis) / BLOCK_S)
    }

    /// The attitudes to come have other starting axes.
    pub fn leave_epoch(&mut self) {
        (self.last, self.block) = (None, Block::new());
    }

    /// Takes in the units' attitudes of a moment, with the angle errors that came in since the one before, rad. Whether a mean was complete; `None` when the
    /// numbers have become useless.
    pub fn step(&mut self, time_ns: i64, now: &Together, disturbance: f64) -> Option<bool> {
        let Some(last) = &mut self.last else {
            self.start_epoch(now);
            self.last = Some(Last { time_ns, now: *now, disturbance: 0.0 });
            return Some(false);
        };
        last.disturbance = last.disturbance.hypot(disturbance);
        let time_s = unit::seconds(time_ns - last.time_ns);
        if time_s < EVERY_S - 0.5e-3 {
            return Some(false);
        }
        let step = Increment {
            time_ns,
            time_s,
            a_m: now.a_m,
            a_s: now.a_s,
            dtheta_m: (last.now.a_m.inverse() * now.a_m).log(),
            disturbance: last.disturbance,
            rate_changes: Matrix3::zeros(),
            velocities: None,
            spiked_s: 0.0,
        };
        self.last = Some(Last { time_ns, now: *now, disturbance: 0.0 });
        self.so3.coast(time_s);
        self.so3.advance(&step);
        self.add(time_s);
        if self.so3.pending_s() >= BLOCK_S { self.end_block().map(|()| true) } else { Some(false) }
    }

    /// The constant of a new epoch is defined by static part and flexure, of which the flexure is not known.
    fn start_epoch(&mut self, now: &Together) {
        for axis in 0..3 {
            let second = self.hull.second[axis].map_or(0.0, |mode| mode.sigma);
            let variance = self.hull.modes[axis].sigma.powi(2) + second * second;
            self.p[(place::FLEXURE + axis, place::FLEXURE + axis)] = variance;
        }
        let transition = self.so3.start_epoch(now.a_m, now.a_s, Rot::identity());
        self.p = sequential::carried(&transition, &self.p);
        for axis in place::FLEXURE..place::FLEXURE + 3 {
            self.p.fill_row(axis, 0.0);
            self.p.fill_column(axis, 0.0);
        }
        self.block = Block::new();
    }

    fn add(&mut self, time_s: f64) {
        let since_s = self.so3.pending_s();
        let weight = (PI * since_s / BLOCK_S).sin().powi(2) * time_s;
        let ahead = Rot::<Main, Main>::exp(self.so3.rate() * since_s);
        let predicted = ahead * self.so3.predicted();
        let mut rows = So3::prediction_rows() + self.so3.deformation_rows();
        for axis in 0..3 {
            rows[(axis, place::STATIC_RATE + axis)] += since_s;
        }
        let block = &mut self.block;
        block.weight += weight;
        block.residual += (self.so3.deformation() * predicted.inverse()).log().column() * weight;
        block.rows += rows * weight;
    }

    fn end_block(&mut self) -> Option<()> {
        let block = std::mem::replace(&mut self.block, Block::new());
        let walk = self.so3.deformation_noise();
        let prediction = self.so3.propagate();
        if block.weight > 0.0 {
            let noise = Matrix3::from_diagonal(&self.flexure_variance()) + walk;
            let (residual, rows) = (block.residual / block.weight, block.rows / block.weight);
            let correction = sequential::update(&mut self.p, &residual, &rows, &noise)?;
            self.surprise.take(correction.surprise);
            self.means = self.means.saturating_add(1);
            self.so3.inject(&(prediction.transition * correction.error));
        }
        self.p = sequential::carried(&prediction.transition, &self.p) + prediction.noise;
        self.p.diagonal().iter().all(|v| v.is_finite() && *v >= 0.0).then_some(())
    }

    /// By how much the deformation by the constant of a fast filter is turned by what this one shows, and the covariance after that. `likely` is the
    /// covariance before (rad^2, in m) by which the two are weighed, `known` the one that is answered for, `now` the units' attitudes. `None` before
    /// anything shows, and before it has been tried.
    pub fn correct(
        &self,
        fast: &So3,
        now: &Together,
        likely: &Matrix3<f64>,
        known: &Matrix3<f64>,
    ) -> Option<(Rot<Main, Main>, Matrix3<f64>)> {
        self.last.filter(|_| self.means >= TRIED)?;
        let rows = self.so3.deformation_rows();
        let seen = rows * self.p * rows.transpose() + self.so3.deformation_noise();
        let gain = likely * (likely + seen).try_inverse()?;
        let left = Matrix3::identity() - gain;
        let off = (now.a_m.inverse() * self.so3.constant() * fast.constant().inverse() * now.a_m).log().column();
        let covariance = left * known * left.transpose() + gain * seen * gain.transpose();
        Some((Rot::exp(Vec3::from_column(gain * off)), covariance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::Settings;
    use crate::matching::deck::Options;
    use crate::matching::increment::Velocities;
    use frames::unit::{ARCSEC, DEGREE, nanoseconds};
    use frames::{MainStart, Sub, SubStart};

    const HULL: Flexure = Flexure { mu: 0.1, b: 0.42, sigma: 12.0 * ARCSEC };
    /// What the flexure is of the swing: so much that a filter which trusts the waves is a minute of arc off.
    const COUPLED: f64 = 3e-4;

    fn settings() -> DeckSettings {
        let gyro = so3::Gyro { arw: 3e-7, bias: 1.5e-8, instability: 1.5e-9, ..so3::Gyro::default() };
        let area = Settings {
            area: 0,
            grade: so3::Grade { main: gyro, sub: gyro, static_noise: 1e-4 * ARCSEC * ARCSEC },
            interval_s: 0.1,
            filter_hz: 10.0,
            registration_s: 30.0,
            installation: None,
            hull: None,
        };
        DeckSettings { area, options: Options::default(), replay: true }
    }

    /// Attitude of a ship in waves that turns by 150 degrees after twenty minutes, and the swing by the waves.
    fn ship(t: f64) -> (Rot<MainStart, Main>, Vec3<Main>) {
        let swing = Vec3::new(0.06 * (0.45 * t).sin(), 0.04 * (1.1 * t + 1.0).sin(), 0.014 * (0.4 * t + 2.0).sin());
        let course = DEGREE * (t - 1200.0).clamp(0.0, 150.0);
        (Rot::<MainStart, Main>::exp(Vec3::new(0.0, 0.0, course)) * Rot::<Main, Main>::exp(swing), swing)
    }

    /// By how much the static part is wrong at the start, arcsec.
    const WRONG: [f64; 3] = [60.0, -40.0, 50.0];
    /// What the fast filter believes to know, arcsec.
    const HIDDEN: f64 = 100.0;

    struct Seen {
        /// Error of a deformation as wrong as at the start, and its covariance, arcsec, arcsec^2, once the filter has been tried.
        said: Option<(Vector3<f64>, Matrix3<f64>)>,
        /// How often the static part was seen to move more than thought.
        refuted: usize,
        excess: f64,
    }

    /// How the static part moves: by so much, arcsec, to and fro in so long, s.
    #[derive(Clone, Copy)]
    struct Moving(f64, f64);

    const STILL: Moving = Moving(0.0, 1.0);

    /// What is seen after a time of a deck that bends with the swing and moves.
    fn seen(until_s: f64, Moving(size, period_s): Moving) -> Seen {
        let fixed = Rot::<Main, Sub>::exp(Vec3::new(0.3, -0.2, 0.5));
        let moved = |t: f64| Vec3::new(1.0, 0.7, -0.5) * (size * ARCSEC * (t * 2.0 * PI / period_s).sin());
        let bent = |t: f64, swing: Vec3<Main>| {
            Rot::<Main, Main>::exp(moved(t) + swing.cross(Vec3::new(1.0, -2.0, 0.5)) * COUPLED) * fixed
        };
        let wrong = Rot::<Main, Main>::exp(Vec3::from(WRONG) * ARCSEC) * fixed;
        let hull = Hull::from([HULL; 3]);
        let mut fast = So3::new(settings().area.grade, hull, wrong, Vec3::ZERO);
        let mut slow = Slow::new(&settings(), &fast, hull);
        let (start, first) = ship(0.0);
        let attitudes = |t: f64| {
            let (a, swing) = ship(t);
            let a_m = start.relabel::<Main, MainStart>().inverse().relabel::<MainStart, MainStart>() * a;
            (a_m, bent(0.0, first).inverse().relabel::<SubStart, MainStart>() * a_m * bent(t, swing))
        };
        let (a_m, a_s) = attitudes(0.0);
        fast.start_epoch(a_m, a_s, Rot::identity());
        let mut refuted = 0;
        for k in 0..=(until_s / 0.1) as i64 {
            let (a_m, a_s) = attitudes(k as f64 * 0.1);
            let now = Together { a_m, a_s, w_m: Vec3::ZERO, gained: Velocities::ZERO };
            if slow.step(nanoseconds(k as f64 * 0.1), &now, 0.0).expect("numbers") {
                refuted += usize::from(!slow.surprise.is_small());
                slow = slow.revised(&settings(), &fast);
            }
        }
        let known = Matrix3::identity() * (HIDDEN * ARCSEC).powi(2);
        let (_, swing) = ship(until_s);
        let (a_m, a_s) = attitudes(until_s);
        let now = Together { a_m, a_s, w_m: Vec3::ZERO, gained: Velocities::ZERO };
        let deformation = a_m.inverse() * fast.constant() * a_s;
        let said = slow.correct(&fast, &now, &known, &known).map(|(turn, covariance)| {
            let error = (turn * deformation * bent(until_s, swing).inverse()).log().column() / ARCSEC;
            (error, covariance / (ARCSEC * ARCSEC))
        });
        Seen { said, refuted, excess: slow.excess() }
    }

    #[test]
    fn nothing_is_said_before_means_have_tried_the_filter() {
        assert!(seen(BLOCK_S * f64::from(TRIED) - 1.0, STILL).said.is_none());
        assert!(seen(BLOCK_S * f64::from(TRIED) + 1.0, STILL).said.is_some());
    }

    #[test]
    fn a_straight_course_tells_nothing_and_is_not_believed() {
        let Seen { said, refuted, .. } = seen(1190.0, STILL);
        let (error, covariance) = said.expect("tried");
        assert_eq!(refuted, 0);
        let wrong = Vector3::from(WRONG);
        assert!(covariance.diagonal().iter().all(|variance| variance.sqrt() > 0.9 * HIDDEN), "{covariance}");
        assert!((error - wrong).amax() < 5.0, "{error}");
    }

    #[test]
    fn a_turn_shows_what_the_waves_hide_about_the_axes_that_turn() {
        let Seen { said, refuted, excess } = seen(2400.0, STILL);
        let (error, covariance) = said.expect("tried");
        assert_eq!((refuted, excess), (0, 1.0));
        for axis in 0..2 {
            let sigma = covariance[(axis, axis)].sqrt();
            assert!(sigma < 25.0 && error[axis].abs() < 3.0 * sigma, "{axis}: {error} {covariance}");
        }
        assert!(covariance[(2, 2)].sqrt() > 0.9 * HIDDEN, "{covariance}");
    }

    #[test]
    fn a_deck_that_moves_is_not_taken_for_still() {
        let moving = Moving(800.0, 7200.0);
        // before it is refuted, just after, in the turn, and long after
        let told = [800.0, 1190.0, 1400.0, 3600.0].map(|until_s| seen(until_s, moving));
        assert_eq!(told.each_ref().map(|seen| seen.said.is_some()), [true, false, true, true]);
        assert_eq!(told[0].refuted, 0);
        assert!(told[1].refuted > 0 && told[3].refuted <= 4, "{} {}", told[1].refuted, told[3].refuted);
        for Seen { said, excess, .. } in told {
            assert_eq!(excess, 1.0);
            let Some((error, covariance)) = said else { continue };
            for axis in 0..3 {
                assert!(error[axis].abs() < 2.5 * covariance[(axis, axis)].sqrt(), "{axis}: {error} {covariance}");
            }
        }
    }

    #[test]
    fn a_deck_that_moves_faster_than_any_model_is_told() {
        let excess = seen(2400.0, Moving(800.0, 900.0)).excess;
        assert!(excess > REFUTING, "{excess}");
    }
}

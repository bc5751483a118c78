//! The true deformation of one area: `C_s^m(t) = Exp(theta(t)) C_Phi`, and the lever arm that bends with it.

use crate::gauss_markov::Step;
use crate::random::Source;
use crate::{Area, GaussMarkov};
use frames::unit::seconds;
use frames::{Main, Rot, Sub, Vec3};

/// A hull that remembers how it is bent now.
pub(crate) struct Hull {
    lever_arm: Vec3<Main>,
    gain: f64,
    installation: Rot<Main, Sub>,
    models: [GaussMarkov; 3],
    /// `[angle, rate]` about each axis, rad and rad/s.
    state: [[f64; 2]; 3],
    time_ns: i64,
    /// The last two lengths of step (ns): a fixed offset between two units of one rate makes two that alternate.
    steps: [(i64, [Step; 3]); 2],
    source: Source,
}

impl Hull {
    /// A hull in its stationary state at the given time.
    pub(crate) fn new(area: &Area, mut source: Source, time_ns: i64) -> Self {
        let state = area.flexure.map(|m| [m.sigma * source.normal(), m.b * m.sigma * source.normal()]);
        let still = (0, area.flexure.map(|m| Step::over(&m, 0.0)));
        Self {
            lever_arm: area.lever_arm,
            gain: area.dynamic_lever_arm,
            installation: area.installation,
            models: area.flexure,
            state,
            time_ns,
            steps: [still, still],
            source,
        }
    }

    /// Bends on to a later instant; an earlier one is left alone.
    pub(crate) fn advance(&mut self, time_ns: i64) {
        if time_ns <= self.time_ns {
            return;
        }
        let interval_ns = time_ns - self.time_ns;
        if self.steps[0].0 != interval_ns {
            self.steps.swap(0, 1);
        }
        if self.steps[0].0 != interval_ns {
            self.steps[0] = (interval_ns, self.models.map(|m| Step::over(&m, seconds(interval_ns))));
        }
        for (state, step) in self.state.iter_mut().zip(&self.steps[0].1) {
            *state = step.apply(*state, [self.source.normal(), self.source.normal()]);
        }
        self.time_ns = time_ns;
    }

    /// The flexure theta, rad.
    pub(crate) fn theta(&self) -> Vec3<Main> {
        self.state.map(|[angle, _]| angle).into()
    }

    /// The static part `C_Phi`.
    pub(crate) fn installation(&self) -> Rot<Main, Sub> {
        self.installation
    }

    /// The whole deformation `C_s^m`.
    pub(crate) fn main_from_sub(&self) -> Rot<Main, Sub> {
        Rot::<Main, Main>::exp(self.theta()) * self.installation
    }

    /// Velocity of the sub unit relative to the main unit in inertial space, m/s: `w x r + r'`, 000 eq 6, 7.
    pub(crate) fn lever_velocity(&self, w_im_m: Vec3<Main>) -> Vec3<Main> {
        let rate: Vec3<Main> = self.state.map(|[_, rate]| rate).into();
        let r = self.lever_arm + (self.theta() * self.gain).cross(self.lever_arm);
        w_im_m.cross(r) + (rate * self.gain).cross(self.lever_arm)
    }
}

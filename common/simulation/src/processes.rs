//! Several independent second-order Gauss-Markov processes that are stepped together.

use crate::GaussMarkov;
use crate::gauss_markov::Step;
use crate::random::Source;
use frames::unit::seconds;

/// N processes and where they are now.
pub(crate) struct Processes<const N: usize> {
    models: [GaussMarkov; N],
    /// `[angle, rate]` of each, rad and rad/s.
    state: [[f64; 2]; N],
    /// The last two lengths of step (ns): a fixed offset between two units of one rate makes two that alternate.
    steps: [(i64, [Step; N]); 2],
}

impl<const N: usize> Processes<N> {
    /// Processes in their stationary state.
    pub(crate) fn stationary(models: [GaussMarkov; N], source: &mut Source) -> Self {
        let state = models.map(|m| [m.sigma * source.normal(), m.b * m.sigma * source.normal()]);
        let still = (0, models.map(|m| Step::over(&m, 0.0)));
        Self { models, state, steps: [still, still] }
    }

    /// Puts angles and rates to zero.
    pub(crate) fn rest(&mut self) {
        self.state = [[0.0; 2]; N];
    }

    /// Other models from here on; angles and rates stay.
    pub(crate) fn change(&mut self, models: [GaussMarkov; N]) {
        self.models = models;
        self.steps.iter_mut().for_each(|step| step.0 = 0);
    }

    /// A step over a positive time with `gain` times the noise of the models.
    pub(crate) fn advance(&mut self, interval_ns: i64, gain: f64, source: &mut Source) {
        if self.steps[0].0 != interval_ns {
            self.steps.swap(0, 1);
        }
        if self.steps[0].0 != interval_ns {
            self.steps[0] = (interval_ns, self.models.map(|m| Step::over(&m, seconds(interval_ns))));
        }
        for (state, step) in self.state.iter_mut().zip(&self.steps[0].1) {
            *state = step.apply(*state, [source.normal() * gain, source.normal() * gain]);
        }
    }

    /// Angle (rad) and rate (rad/s) of each.
    pub(crate) fn state(&self) -> &[[f64; 2]; N] {
        &self.state
    }
}

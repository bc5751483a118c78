//! Exact discretisation of the second-order Gauss-Markov process, 000 eq 3.

use crate::GaussMarkov;

/// What one axis does over one time step: `[angle, rate] <- F [angle, rate] + L n`, n standard normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    f: [[f64; 2]; 2],
    /// Lower triangular: `[L00, L10, L11]`, rad, rad/s, rad/s.
    l: [f64; 3],
}

/// Nodes and weights of Gauss's rule on 0 to 1.
pub(crate) const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl Step {
    /// The step over the time `t >= 0`, s.
    ///
    /// A short step is summed as a power series, which needs no case for the damping and loses no digit of the noise to
    /// cancellation, as the closed form does; a long one is made of short ones by doubling.
    pub(crate) fn over(model: &GaussMarkov, t: f64) -> Self {
        let doublings = (model.mu.max(model.b) * t / 0.05).log2().ceil().clamp(0.0, 64.0) as i32;
        let short = t / 2f64.powi(doublings);
        let (mut f, mut q) = short_step(model, short);
        for _ in 0..doublings {
            let carried = product(product(f, q), transposed(f));
            q = [0, 1].map(|i| [0, 1].map(|j| carried[i][j] + q[i][j]));
            f = product(f, f);
        }
        let l00 = q[0][0].max(0.0).sqrt();
        let l10 = if l00 > 0.0 { q[1][0] / l00 } else { 0.0 };
        Self { f, l: [l00, l10, (q[1][1] - l10 * l10).max(0.0).sqrt()] }
    }

    /// The state `[angle, rate]` (rad, rad/s) after the step.
    pub(crate) fn apply(&self, [angle, rate]: [f64; 2], n: [f64; 2]) -> [f64; 2] {
        [
            self.f[0][0] * angle + self.f[0][1] * rate + self.l[0] * n[0],
            self.f[1][0] * angle + self.f[1][1] * rate + self.l[1] * n[0] + self.l[2] * n[1],
        ]
    }
}

/// Transition and noise covariance for `t` well below the time constants.
fn short_step(model: &GaussMarkov, t: f64) -> ([[f64; 2]; 2], [[f64; 2]; 2]) {
    let b2 = model.b * model.b;
    let density = 4.0 * model.mu * b2 * model.sigma * model.sigma;
    let series = response(model);
    let (x, v) = evaluate(&series, t);
    let f = [[v + 2.0 * model.mu * x, x], [-b2 * x, v]];
    let mut q = [[0.0; 2]; 2];
    for (node, weight) in GAUSS {
        let (x, v) = evaluate(&series, node * t);
        let share = density * weight * t;
        q[0][0] += share * x * x;
        q[0][1] += share * x * v;
        q[1][1] += share * v * v;
    }
    q[1][0] = q[0][1];
    (f, q)
}

/// Power series of the angle after a unit impulse: `x(0) = 0`, `x'(0) = 1`.
fn response(model: &GaussMarkov) -> [f64; 10] {
    let mut a = [0.0; 10];
    a[1] = 1.0;
    for n in 0..8 {
        let order = n as f64;
        a[n + 2] =
            -(2.0 * model.mu * (order + 1.0) * a[n + 1] + model.b * model.b * a[n]) / ((order + 1.0) * (order + 2.0));
    }
    a
}

/// The series and its derivative at `t`.
fn evaluate(series: &[f64; 10], t: f64) -> (f64, f64) {
    series.iter().rev().fold((0.0, 0.0), |(x, v), a| (x * t + a, v * t + x))
}

fn product(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

fn transposed(a: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [[a[0][0], a[1][0]], [a[0][1], a[1][1]]]
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODELS: [GaussMarkov; 4] = [
        GaussMarkov { mu: 0.2146, b: 0.2146, sigma: 1.7e-3 },
        GaussMarkov { mu: 0.1, b: 0.6, sigma: 1e-3 },
        GaussMarkov { mu: 0.8, b: 0.3, sigma: 2e-3 },
        GaussMarkov { mu: 0.15, b: 6.0, sigma: 1e-5 },
    ];
    const TIMES: [f64; 8] = [1e-6, 1e-3, 0.005, 0.01, 0.1, 1.0, 10.0, 60.0];

    /// `R(tau) / sigma^2`, 000 eq 17 with the factor the right way up.
    fn correlation(m: &GaussMarkov, tau: f64) -> f64 {
        let k = m.b * m.b - m.mu * m.mu;
        let l = k.abs().sqrt();
        let (c, s) = match () {
            () if l * tau < 1e-9 => (1.0, tau),
            () if k > 0.0 => ((l * tau).cos(), (l * tau).sin() / l),
            () => ((l * tau).cosh(), (l * tau).sinh() / l),
        };
        (-m.mu * tau).exp() * (c + m.mu * s)
    }

    #[test]
    fn the_stationary_covariance_stays_and_the_autocovariance_is_that_of_the_model() {
        for m in MODELS {
            for t in TIMES {
                let step = Step::over(&m, t);
                let (variance, [l00, l10, l11]) = (m.sigma * m.sigma, step.l);
                let p = [[variance, 0.0], [0.0, m.b * m.b * variance]];
                let carried = product(product(step.f, p), transposed(step.f));
                let q = [[l00 * l00, l00 * l10], [l00 * l10, l10 * l10 + l11 * l11]];
                for (i, j) in [(0, 0), (0, 1), (1, 1)] {
                    let scale = (p[i][i] * p[j][j]).sqrt();
                    assert!((carried[i][j] + q[i][j] - p[i][j]).abs() < 1e-12 * scale, "{m:?} {t} {i}{j}");
                }
                assert!((step.f[0][0] - correlation(&m, t)).abs() < 1e-12, "{m:?} {t}");
            }
        }
    }

    #[test]
    fn the_noise_of_a_very_short_step_is_that_of_an_integrated_random_walk() {
        for m in MODELS {
            let t = 1e-7;
            let density = 4.0 * m.mu * m.b * m.b * m.sigma * m.sigma;
            let [l00, l10, l11] = Step::over(&m, t).l;
            assert!((l00 * l00 / (density * t.powi(3) / 3.0) - 1.0).abs() < 1e-5);
            assert!((l00 * l10 / (density * t * t / 2.0) - 1.0).abs() < 1e-5);
            assert!(((l10 * l10 + l11 * l11) / (density * t) - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn steps_of_impossible_models_end() {
        for mu in [0.0, f64::INFINITY, f64::NAN] {
            for b in [0.0, f64::INFINITY, f64::NAN] {
                Step::over(&GaussMarkov { mu, b, sigma: 1.0 }, 0.01);
            }
        }
        let still = Step::over(&GaussMarkov { mu: 0.0, b: 0.0, sigma: 1.0 }, 0.01);
        assert_eq!(still.apply([2.0, 0.0], [1.0, 1.0]), [2.0, 0.0]);
    }
}

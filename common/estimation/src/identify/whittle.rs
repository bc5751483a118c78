//! Whittle's maximum likelihood: the model fitted to the periodogram, whose values scatter by as much as they are large.
//!
//! Source: P. Whittle (1953) for the model of 003 eq 7-8 and 000 eq 17-20; rival of all methods of both papers and near the bound.
//!
//! | parameter | prior |
//! |---|---|
//! | `ln mu` | N(ln 0.15, 1), if wanted |
//! | `ln b` | N(ln 0.6, 1), if wanted |
//! | `ln Q` | none |
//! | `ln n`, the white noise | none; without this parameter the damping takes the noise's place (15 % at 30 dB, many times at 10 dB) |
//!
//! `-ln L = sum w (ln S + I / S)`, a generalised linear model of the gamma family; Fisher scoring with Levenberg's damping. A hull may have two modes about
//! an axis: then `S` is the sum of two densities and the noise, with three parameters more.

use super::axis::Identified;
use super::bound::Band;
use super::periodogram::{Periodogram, Taper, density, gain, slopes};
use super::refinement::{DAMPING, FREQUENCY, MEDIANS, PRIOR_SD};
use super::series::{Kind, Series};
use crate::flexure::Flexure;
use nalgebra::{SMatrix, SVector};

/// What is fitted and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Lowest and highest frequency, Hz; of high-passed data it must begin above the cut.
    pub band_hz: (f64, f64),
    /// How the ends are faded.
    pub taper: Taper,
    /// Whether the priors count.
    pub priors: bool,
    /// Whether there is white noise; without it the method is known to fail.
    pub floor: bool,
}

impl Settings {
    /// What suits a series: of rates Hann's taper, against the sway; of angles one that loses little.
    pub fn of(series: &Series) -> Self {
        let taper = if series.kind == Kind::Rates { Taper::Hann } else { Taper::Tukey(0.05) };
        Self { band_hz: Band::of(series).hz, taper, priors: true, floor: true }
    }
}

/// Most steps from a start, the largest step of a logarithm, and the change that ends it.
const STEPS: usize = 40;
const LONGEST: f64 = 0.5;
const CONVERGED: f64 = 1e-5;
/// The dampings and frequencies to start from, beside the periodogram's peak: 1/s, rad/s.
const STARTS: [(f64, f64); 3] = [(0.15, 0.3), (0.3, 1.0), (0.1, 0.1)];
/// Damping with which the peak is started, 1/s, and over how many frequencies it is smoothed.
const PEAK_DAMPING: f64 = 0.12;
const PEAK_WIDTH: usize = 15;
/// Range of the noise's logarithm about the level of the highest frequencies.
const FLOOR_RANGE: f64 = 25.0;
/// Parameters of a mode, then of a hull of one mode and of two, with the noise.
const MODE: usize = 3;
const ONE: usize = MODE + 1;
const TWO: usize = 2 * MODE + 1;
/// What a second mode is started with: its share of the power, and damping over natural frequency.
const SECOND_SHARE: f64 = 0.5;
const SECOND_DAMPING: f64 = 0.3;
/// The natural frequencies that it is started at, rad/s.
const SECOND_STARTS: [f64; 5] = [0.1, 0.3, 0.8, 2.0, 4.0];
/// Twice the logarithm of a ratio of posterior densities that leaves no doubt of a second mode: of hundreds of windows, each has some chance to mislead.
const SECOND_DECISIVE: f64 = 30.0;

/// The model does not describe the series where the power over octaves is off by so much: the sum of the squares of some ten normal variables. Only there
/// is a second mode looked for, which takes longer than all the rest; where there is one the sum goes into hundreds.
const WORTH_A_LOOK: f64 = 20.0;

/// Which start leads to the best model is tried with lines merged over this share of their frequency: a sixth of them for ten minutes of rates.
const COARSE: f64 = 0.03;

/// The logarithms of damping, natural frequency and density of each mode, and of the noise.
type Logs<const N: usize> = SVector<f64, N>;

/// Identifies an axis; `None` if the band is empty or nothing converges.
pub fn identify(series: &Series, settings: &Settings) -> Option<Identified> {
    let fit = Fit::new(series, settings)?;
    let (logs, _) = fit.best()?;
    let [found] = fit.identified(&logs, series)?[..] else { return None };
    Some(found)
}

/// What an axis's window says if a hull may have two modes.
#[derive(Clone, Debug)]
pub struct Modes {
    /// The slower one first: two if the data demand a second, otherwise one.
    pub found: Vec<Identified>,
    /// Whether the power over octaves is what one mode says. Where it is not, part of the series may follow the waves, even if it looks like a second mode.
    pub described: bool,
}

/// Identifies the modes of an axis. `None` if the band is empty or nothing converges.
pub fn identify_modes(series: &Series) -> Option<Modes> {
    let fit = Fit::new(series, &Settings::of(series))?;
    let (one, cost) = fit.best()?;
    let described = fit.misfit(&one) < WORTH_A_LOOK;
    let two = if described { None } else { fit.two(&one, cost, series) };
    Some(Modes { found: two.or_else(|| fit.identified(&one, series))?, described })
}

/// A model that was fitted to a series.
#[derive(Clone, Copy, Debug)]
pub struct Fitted(Logs<ONE>);

impl Fitted {
    /// The mode.
    pub fn mode(&self) -> Option<Flexure> {
        modes(&self.0).next().filter(Flexure::is_sound)
    }

    /// Density of the white noise, the series' square times s.
    pub fn noise(&self) -> f64 {
        self.0[MODE].exp()
    }
}

/// The most probable model of a series; `None` if the band is empty or nothing converges.
pub fn fitted(series: &Series) -> Option<Fitted> {
    Fit::new(series, &Settings::of(series))?.best().map(|(logs, _)| Fitted(logs))
}

/// By how much better a model of its own fits a series than another series' model: twice the difference of the logarithms of the posterior densities,
/// about chi-squared with four degrees of freedom if it is the same flexure and the other series much longer. `None` if nothing can be fitted.
pub fn departure(series: &Series, other: &Fitted) -> Option<f64> {
    let fit = Fit::new(series, &Settings::of(series))?;
    let (_, least) = fit.best()?;
    Some(2.0 * (fit.cost(&other.0) - least))
}

/// By how much better the series is fitted by any model than by one at critical damping of natural frequency `slow` (rad/s): twice the difference of the
/// logarithms of the likelihoods, about chi-squared with two degrees of freedom if the flexure is that slow. What lies below a window's lowest frequency
/// makes no difference; a model that is believed in spite of it would bound the flexure by what has not been seen. `None` if nothing can be fitted.
pub fn against_slow(series: &Series, slow: f64) -> Option<f64> {
    let settings = Settings { priors: false, ..Settings::of(series) };
    let fit = Fit::new(series, &settings)?;
    let (_, least) = fit.best()?;
    let start = fit.start(slow, slow);
    let (_, held) = Fit { held: true, ..fit }.climb(start)?;
    Some(2.0 * (held - least))
}

struct Fit {
    data: Periodogram,
    /// What the series shows of an angle's density, frequency by frequency.
    gains: Vec<f64>,
    kind: Kind,
    step_s: f64,
    settings: Settings,
    /// Whether damping and frequency stay where they are.
    held: bool,
}

/// The modes of a hull.
fn modes<const N: usize>(logs: &Logs<N>) -> impl Iterator<Item = Flexure> + '_ {
    (0..N - 1).step_by(MODE).map(|k| {
        let (mu, b) = (logs[k].exp(), logs[k + 1].exp());
        Flexure { mu, b, sigma: (logs[k + 2].exp() / (4.0 * mu * b * b)).sqrt() }
    })
}

impl Fit {
    fn new(series: &Series, settings: &Settings) -> Option<Self> {
        let data = Periodogram::new(series, settings.taper, settings.band_hz)?;
        Some(Self::of(data, series.kind, series.step_s, settings))
    }

    fn of(data: Periodogram, kind: Kind, step_s: f64, settings: &Settings) -> Self {
        let gains = data.frequencies.iter().map(|w| gain(kind, step_s, *w)).collect();
        Self { data, gains, kind, step_s, settings: *settings, held: false }
    }

    /// Frequency (rad/s), gain, power and count of lines.
    fn lines(&self) -> impl Iterator<Item = (f64, f64, f64, f64)> + '_ {
        let Periodogram { frequencies, power, counts, .. } = &self.data;
        let lines = frequencies.iter().zip(&self.gains).zip(power).zip(counts);
        lines.map(|(((w, gain), power), count)| (*w, *gain, *power, *count))
    }

    /// The best logarithms from some starts, and their cost. Which start leads there, fewer lines tell as well.
    fn best_of<const N: usize>(&self, starts: impl Iterator<Item = Logs<N>>) -> Option<(Logs<N>, f64)> {
        let coarse = Self::of(self.data.merged(COARSE), self.kind, self.step_s, &self.settings);
        let found = starts.filter_map(|start| coarse.climb(start));
        let (logs, _) = found.min_by(|one, other| one.1.total_cmp(&other.1))?;
        self.climb(logs)
    }

    /// The best logarithms of one mode, and their cost.
    fn best(&self) -> Option<(Logs<ONE>, f64)> {
        self.best_of(STARTS.into_iter().chain(self.peak()).map(|(mu, b)| self.start(mu, b)))
    }

    /// Mean power of the tenth of the highest frequencies.
    fn floor(&self) -> f64 {
        let count = self.data.power.len();
        let highest = &self.data.power[count.saturating_sub((count / 10).max(4))..];
        (highest.iter().sum::<f64>() / highest.len() as f64).max(f64::MIN_POSITIVE)
    }

    /// The peak of the smooth periodogram.
    fn peak(&self) -> Option<(f64, f64)> {
        let sums = self.data.power.windows(PEAK_WIDTH).map(|window| window.iter().sum::<f64>());
        let (place, _) = sums.enumerate().max_by(|one, other| one.1.total_cmp(&other.1))?;
        Some((PEAK_DAMPING, self.data.frequencies[place + PEAK_WIDTH / 2]))
    }

    /// Damping and frequency as told, the density such that the total power is right.
    fn start(&self, mu: f64, b: f64) -> Logs<ONE> {
        let unit = Flexure { mu, b, sigma: 1.0 };
        let ratio = self.data.power.iter().sum::<f64>() / self.power(&unit);
        Logs::from([mu.ln(), b.ln(), (unit.density() * ratio).ln(), (0.5 * self.floor()).ln()])
    }

    /// The power of a mode over all lines.
    fn power(&self, mode: &Flexure) -> f64 {
        self.lines().map(|(w, gain, _, count)| count * density(mode, gain, self.step_s, w)).sum()
    }

    /// The best logarithms with a second mode beside the one found, and their cost.
    fn second(&self, one: &Logs<ONE>) -> Option<(Logs<TWO>, f64)> {
        let total = self.data.power.iter().sum::<f64>();
        let start = |b: f64| {
            let unit = Flexure { mu: SECOND_DAMPING * b, b, sigma: 1.0 };
            let density = unit.density() * SECOND_SHARE * total / self.power(&unit);
            Logs::from([one[0], one[1], one[2], unit.mu.ln(), unit.b.ln(), density.ln(), one[3]])
        };
        self.best_of(SECOND_STARTS.into_iter().map(start))
    }

    /// How far the power in each octave is off a model, in terms of its scatter: the sum of the squares.
    fn misfit<const N: usize>(&self, logs: &Logs<N>) -> f64 {
        let noise = self.noise(logs);
        let modes: Vec<Flexure> = modes(logs).collect();
        let (mut sum, mut excess, mut count, mut end) = (0.0, 0.0, 0.0, 0.0);
        for (w, gain, power, _) in self.lines() {
            if w > end {
                sum += if count > 0.0 { self.data.weight * excess * excess / count } else { 0.0 };
                (excess, count, end) = (0.0, 0.0, 2.0 * w);
            }
            let level = modes.iter().map(|mode| density(mode, gain, self.step_s, w)).sum::<f64>() + noise;
            excess += power / level - 1.0;
            count += 1.0;
        }
        sum + if count > 0.0 { self.data.weight * excess * excess / count } else { 0.0 }
    }

    /// Both modes, if a second beside the `one` found at its `cost` is demanded.
    fn two(&self, one: &Logs<ONE>, cost: f64, series: &Series) -> Option<Vec<Identified>> {
        let (two, least) = self.second(one)?;
        if 2.0 * (cost - least) < SECOND_DECISIVE {
            return None;
        }
        let mut found = self.identified(&two, series)?;
        found.sort_by(|one, other| one.flexure.b.total_cmp(&other.flexure.b));
        Some(found)
    }

    /// The modes with what is known of them.
    fn identified<const N: usize>(&self, logs: &Logs<N>, series: &Series) -> Option<Vec<Identified>> {
        let mut information = self.scores(logs).1;
        if !self.settings.floor {
            information[(N - 1, N - 1)] = 1.0;
        }
        let covariance = information.try_inverse()?;
        let mode = |(k, flexure): (usize, Flexure)| {
            let of_mode = covariance.fixed_view::<MODE, MODE>(k * MODE, k * MODE).into_owned();
            Identified::new(flexure, &of_mode, series.length_s()).filter(|found| found.flexure.is_sound())
        };
        modes(logs).enumerate().map(mode).collect()
    }

    /// How far damping and frequency of each mode are from their priors' medians, in terms of the priors' variance.
    fn away<const N: usize>(&self, logs: &Logs<N>) -> Logs<N> {
        let share = if self.settings.priors { 1.0 / (PRIOR_SD * PRIOR_SD) } else { 0.0 };
        let mut away = Logs::zeros();
        for k in (0..N - 1).step_by(MODE) {
            away[k] = share * (logs[k] - MEDIANS.0.ln());
            away[k + 1] = share * (logs[k + 1] - MEDIANS.1.ln());
        }
        away
    }

    fn noise<const N: usize>(&self, logs: &Logs<N>) -> f64 {
        if self.settings.floor { logs[N - 1].exp() } else { 0.0 }
    }

    /// Minus the logarithm of the posterior density.
    fn cost<const N: usize>(&self, logs: &Logs<N>) -> f64 {
        let noise = self.noise(logs);
        let modes: Vec<Flexure> = modes(logs).collect();
        let misfit: f64 = self
            .lines()
            .map(|(w, gain, power, count)| {
                let level = modes.iter().map(|mode| density(mode, gain, self.step_s, w)).sum::<f64>() + noise;
                count * (level.ln() + power / level)
            })
            .sum();
        let away = self.away(logs);
        let squares = away.norm_squared() * PRIOR_SD * PRIOR_SD;
        self.data.weight * misfit + 0.5 * squares
    }

    /// Direction downhill and information.
    fn scores<const N: usize>(&self, logs: &Logs<N>) -> (Logs<N>, SMatrix<f64, N, N>) {
        let noise = self.noise(logs);
        let modes: Vec<Flexure> = modes(logs).collect();
        let (mut downhill, mut information) = (Logs::<N>::zeros(), SMatrix::<f64, N, N>::zeros());
        for (w, gain, power, count) in self.lines() {
            let mut slope = Logs::<N>::zeros();
            let mut level = noise;
            slope[N - 1] = noise;
            for (mode, k) in modes.iter().zip((0..).step_by(MODE)) {
                let slopes = slopes(mode, gain, self.step_s, w);
                level += slopes[MODE - 1];
                slope.fixed_rows_mut::<MODE>(k).copy_from_slice(&slopes);
            }
            slope *= 1.0 / level;
            downhill += slope * (count * (power / level - 1.0));
            information.syger(count, &slope, &slope, 1.0);
        }
        information.fill_upper_triangle_with_lower_triangle();
        let mut information = information * self.data.weight;
        if self.settings.priors {
            for k in (0..N - 1).step_by(MODE) {
                information[(k, k)] += 1.0 / (PRIOR_SD * PRIOR_SD);
                information[(k + 1, k + 1)] += 1.0 / (PRIOR_SD * PRIOR_SD);
            }
        }
        let mut downhill = downhill * self.data.weight - self.away(logs);
        if self.held {
            information.fixed_rows_mut::<2>(0).fill(0.0);
            information.fixed_columns_mut::<2>(0).fill(0.0);
            downhill.fixed_rows_mut::<2>(0).fill(0.0);
        }
        (downhill, information)
    }

    /// The logarithms at the end, and their cost.
    fn climb<const N: usize>(&self, mut logs: Logs<N>) -> Option<(Logs<N>, f64)> {
        let floor = self.floor().ln();
        let bounded = |mut logs: Logs<N>| {
            for k in (0..N - 1).step_by(MODE) {
                logs[k] = logs[k].clamp(DAMPING.0.ln(), DAMPING.1.ln());
                logs[k + 1] = logs[k + 1].clamp(FREQUENCY.0.ln(), FREQUENCY.1.ln());
            }
            logs[N - 1] = logs[N - 1].clamp(floor - FLOOR_RANGE, floor + 1.0);
            logs
        };
        let mut cost = self.cost(&logs);
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let (downhill, information) = self.scores(&logs);
            let mut moved = 0.0;
            while damping < 1e8 {
                // The last term keeps a noise that cannot be seen where it is.
                let damped = information
                    + SMatrix::<f64, N, N>::from_diagonal(&information.diagonal()) * damping
                    + SMatrix::<f64, N, N>::identity() * 1e-9;
                let step = damped.cholesky()?.solve(&downhill).map(|s| s.clamp(-LONGEST, LONGEST));
                let next = bounded(logs + step);
                let next_cost = self.cost(&next);
                if next_cost <= cost {
                    moved = (next - logs).amax();
                    (logs, cost, damping) = (next, next_cost, (damping / 10.0_f64).max(1e-9));
                    break;
                }
                damping *= 10.0;
            }
            if moved < CONVERGED {
                break;
            }
        }
        cost.is_finite().then_some((logs, cost))
    }
}

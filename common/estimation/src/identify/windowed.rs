use super::Settings;
use super::axis::Identified;
use super::chain::{Anchor, Chain};
use super::change::changed;
use super::safety::{SHORT_S, is_not_slow, safe};
use super::series::{Kind, Series};
use super::window::Window;
use crate::Identifier;
use crate::flexure::Flexure;
use frames::unit;
use messages::{FlexureParams, Header, ImuPair, Solution, Stamps};

/// Windows up to this length are guarded against a worse constant, s.
const GUARDED_S: f64 = 120.0;
/// By how much the variance may grow before a re-built window is thought to be worse.
const TOLERATED: f64 = 1.05;

/// The slow identifier: a window of data, rebuilt with the latest constant, each axis identified by the method of the settings,
/// and the result made safe if they say so.
#[derive(Clone, Debug)]
pub struct Windowed {
    settings: Settings,
    window: Window,
    kept: Option<Anchor>,
}

impl Windowed {
    /// An identifier that has seen nothing.
    pub fn new(settings: Settings) -> Self {
        Self { settings, window: Window::new(&settings), kept: None }
    }

    /// The window rebuilt with the latest constant, or with the one kept before if the latest makes early data rougher.
    fn chain(&mut self, latest: &Anchor) -> Option<Chain> {
        let guarded = self.window.length_s() <= GUARDED_S;
        let points = self.window.points();
        let chain = Chain::rebuild(points, latest)?;
        if !guarded {
            return Some(chain);
        }
        let earlier = self.kept.as_ref().and_then(|kept| Chain::rebuild(points, kept));
        match earlier {
            Some(earlier) if chain.variance > TOLERATED * earlier.variance => Some(earlier),
            _ => Some(chain),
        }
    }

    fn identify(&self, chain: &Chain) -> Option<[Identified; 3]> {
        let Settings { method, dictionary, .. } = self.settings;
        let series = |values| Series { kind: Kind::Rates, values, step_s: chain.step_s };
        let solver = method.solver(&series(&chain.rates[0]), dictionary);
        let [x, y, z] = &chain.rates;
        Some([solver.solve(&series(x))?, solver.solve(&series(y))?, solver.solve(&series(z))?])
    }

    /// What a filter gets.
    fn models(&self, axes: &[Identified; 3], chain: &Chain) -> [Flexure; 3] {
        let length_s = self.window.length_s();
        let model = |(axis, values): (&Identified, &Vec<f64>)| {
            if !self.settings.safety {
                return axis.flexure;
            }
            let series = Series { kind: Kind::Rates, values, step_s: chain.step_s };
            let believed = self.settings.provisional && length_s <= SHORT_S && is_not_slow(&series);
            safe(axis, if believed { f64::INFINITY } else { length_s })
        };
        [0, 1, 2].map(|i| model((&axes[i], &chain.rates[i])))
    }
}

impl Identifier for Windowed {
    fn step(&mut self, pair: &ImuPair, solution: &Solution) -> Option<FlexureParams> {
        let restarted = self.window.restarted();
        let due = self.window.take(pair, solution);
        if self.window.restarted() != restarted {
            self.kept = None;
        }
        if !due {
            return None;
        }
        let anchor = Anchor::of(pair, solution)?;
        let mut chain = self.chain(&anchor)?;
        if self.settings.provisional
            && let Some(length_s) = changed(&chain.rates, chain.step_s)
        {
            self.window.keep(length_s);
            self.kept = None;
            chain = self.chain(&anchor)?;
        }
        self.kept = Some(chain.end);
        let axes = self.identify(&chain)?;
        let models = self.models(&axes, &chain);
        if !models.iter().all(Flexure::is_sound) {
            return None;
        }
        let points = self.window.points();
        Some(FlexureParams {
            header: Header { stamps: Stamps::default(), ..pair.header },
            id: pair.header.sequence,
            window_begin_ns: points.first()?.time_ns,
            effective_from_ns: pair.header.time_ns + unit::nanoseconds(self.settings.lead_s),
            mu: models.map(|model| model.mu),
            b: models.map(|model| model.b),
            sigma: models.map(|model| model.sigma),
            ln_mu_sd: axes.map(|axis| axis.ln_mu_sd),
            ln_b_sd: axes.map(|axis| axis.ln_b_sd),
            ln_sigma_sd: axes.map(|axis| axis.ln_sigma_sd),
            points: points.len() as u32,
            area: self.settings.area,
        })
    }

    fn restarted_windows(&self) -> u64 {
        self.window.restarted()
    }
}

use super::Settings;
use super::axis::Identified;
use super::blows::without_blows;
use super::chain::{Anchor, Chain};
use super::change::changed;
use super::method::Method;
use super::safety::{Belief, SHORT_S, is_not_slow, safe};
use super::series::{Kind, Series};
use super::whittle;
use super::window::Window;
use crate::Identifier;
use crate::flexure::{Flexure, Hull};
use frames::unit;
use messages::{FlexureParams, Header, ImuPair, Solution, Stamps};

/// Windows up to this length are guarded against a worse constant, s.
const GUARDED_S: f64 = 120.0;
/// By how much the variance may grow before a re-built window is thought to be worse.
const TOLERATED: f64 = 1.05;

/// What was found about one axis.
#[derive(Clone, Copy)]
struct Axis {
    mode: Identified,
    second: Option<Identified>,
    /// Whether it has been tested that one mode is all there is to the window.
    described: bool,
}

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

    /// The rates about an axis without the blows of the sea, if there are any and the filter reckons with them itself.
    fn calmed(&self, series: &Series) -> Option<Vec<f64>> {
        if self.settings.provisional { without_blows(series) } else { None }
    }

    /// The modes about each axis of m.
    fn identify(&self, chain: &Chain) -> Option<[Axis; 3]> {
        let Settings { method, dictionary, .. } = self.settings;
        let [x, y, z] = chain.rates.each_ref().map(|values| Series { kind: Kind::Rates, values, step_s: chain.step_s });
        let solver = method.solver(&x, dictionary);
        let looked_for = self.settings.second_mode && self.window.length_s() > SHORT_S;
        let modes = |series: &Series| {
            let found = if looked_for && series.is_usable() { whittle::identify_modes(series) } else { None };
            let described = found.as_ref().is_some_and(|modes| modes.described);
            match found.as_ref().map(|modes| modes.found.as_slice()) {
                Some(&[mode, second]) => Some(Axis { mode, second: Some(second), described }),
                // what the method itself would find
                Some(&[mode]) if method == Method::Whittle => Some(Axis { mode, second: None, described }),
                _ => solver.solve(series).map(|mode| Axis { mode, second: None, described }),
            }
        };
        let axis = |series: &Series| match self.calmed(series) {
            Some(calm) => modes(&Series { values: &calm, ..*series }),
            None => modes(series),
        };
        Some([axis(&x)?, axis(&y)?, axis(&z)?])
    }

    /// What a filter gets.
    fn hull(&self, axes: &[Axis; 3], chain: &Chain) -> Hull {
        let length_s = self.window.length_s();
        let model = |i: usize, found: &Identified| {
            if !self.settings.safety {
                return found.flexure;
            }
            let series = Series { kind: Kind::Rates, values: &chain.rates[i], step_s: chain.step_s };
            let belief = if self.settings.provisional && length_s <= SHORT_S && is_not_slow(&series) {
                Belief::Decided
            } else if self.settings.provisional && axes[i].described {
                Belief::Described
            } else {
                Belief::Guarded
            };
            safe(found, length_s, belief)
        };
        Hull {
            modes: [0, 1, 2].map(|i| model(i, &axes[i].mode)),
            second: [0, 1, 2].map(|i| axes[i].second.map(|second| model(i, &second))),
        }
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
        let hull = self.hull(&axes, &chain);
        if !hull.all().all(Flexure::is_sound) {
            return None;
        }
        let of_second = |number: fn(&Flexure) -> f64| hull.second.map(|mode| mode.as_ref().map_or(0.0, number));
        let points = self.window.points();
        Some(FlexureParams {
            header: Header { stamps: Stamps::default(), ..pair.header },
            id: pair.header.sequence,
            window_begin_ns: points.first()?.time_ns,
            effective_from_ns: pair.header.time_ns + unit::nanoseconds(self.settings.lead_s),
            mu: hull.modes.map(|mode| mode.mu),
            b: hull.modes.map(|mode| mode.b),
            sigma: hull.modes.map(|mode| mode.sigma),
            ln_mu_sd: axes.map(|axis| axis.mode.ln_mu_sd),
            ln_b_sd: axes.map(|axis| axis.mode.ln_b_sd),
            ln_sigma_sd: axes.map(|axis| axis.mode.ln_sigma_sd),
            second_mu: of_second(|mode| mode.mu),
            second_b: of_second(|mode| mode.b),
            second_sigma: of_second(|mode| mode.sigma),
            points: points.len() as u32,
            area: self.settings.area,
        })
    }

    fn restarted_windows(&self) -> u64 {
        self.window.restarted()
    }
}

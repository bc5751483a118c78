//! What the page knows: filled from messages, drawn by `draw`, without ports and clocks.

use frames::unit;
use messages::{FlexureParams, Health, Solution, Stage};
use pipeline::zero::LastMinute;
use runtime::Sequence;
use std::collections::VecDeque;

/// How much of the past the strip charts show, s.
pub const SHOWN_S: f64 = 60.0;
/// A point of the strip charts every so often, s.
const STEP_S: f64 = 0.1;
/// Latencies are those of so many solutions.
const LATENCIES: usize = 1000;
/// A stage that has not spoken for so long is silent, ns; it speaks once a second.
pub const SILENCE_NS: i64 = 3_000_000_000;

/// What stands between the page and a launch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Link {
    /// Nothing to look at; the sentence says what is waited for.
    Waiting(String),
    /// Attached.
    Live,
}

/// One stage of the table.
#[derive(Clone, Debug)]
pub struct StageState {
    /// Which.
    pub stage: Stage,
    /// Index of its area; `None` for the source.
    pub area: Option<usize>,
    /// Its last words, and when they came, ns of the monotonic clock.
    pub last: Option<(Health, i64)>,
}

/// A point of the strip charts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Past {
    /// Time of validity, s.
    pub t: f64,
    /// Rotation vector of the deformation, arcmin.
    pub phi: [f64; 3],
    /// Half width of its 95 % range, arcmin.
    pub range: [f64; 3],
}

/// Latencies of the newest solutions, us.
#[derive(Clone, Debug, Default)]
pub struct Delays(VecDeque<f64>);

impl Delays {
    fn take(&mut self, from_ns: i64, to_ns: i64) {
        if self.0.len() == LATENCIES {
            self.0.pop_front();
        }
        self.0.push_back((to_ns - from_ns) as f64 / 1e3);
    }

    /// The value that a share of them does not exceed; `None` of none.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let mut sorted: Vec<f64> = self.0.iter().copied().collect();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted.get((share * sorted.len().saturating_sub(1) as f64).round() as usize).copied()
    }
}

/// An area.
#[derive(Clone, Debug, Default)]
pub struct AreaState {
    /// Its name.
    pub name: String,
    /// The newest solution.
    pub last: Option<Solution>,
    /// The newest flexure model.
    pub parameters: Option<FlexureParams>,
    /// Solutions taken in.
    pub received: u64,
    /// Whether its stream has come to its end mark.
    pub ended: bool,
    /// Counts what never arrived here.
    pub sequence: Sequence,
    /// What a zero would be made of.
    pub minute: LastMinute,
    /// The past of the strip charts.
    pub past: VecDeque<Past>,
    /// By the source, by synchronise, by estimate, and from the sample's due time to the solution.
    pub delays: [Delays; 4],
}

/// The page.
#[derive(Clone, Debug)]
pub struct Page {
    /// Name of the configuration.
    pub title: String,
    /// Samples a second.
    pub rate_hz: f64,
    /// Whether there is anything to see.
    pub link: Link,
    /// In the order of the configuration.
    pub areas: Vec<AreaState>,
    /// The source, and three stages an area.
    pub stages: Vec<StageState>,
    /// Index of the area on show.
    pub shown: usize,
    /// What the last key did.
    pub note: String,
}

impl Page {
    /// A page that waits for a launch.
    pub fn waiting(reason: String) -> Self {
        let link = Link::Waiting(reason);
        Self { title: String::new(), rate_hz: 0.0, link, areas: vec![], stages: vec![], shown: 0, note: String::new() }
    }

    /// An empty page of a launch.
    pub fn attached(title: String, rate_hz: f64, areas: &[&str], source: Stage) -> Self {
        let state = |name: &&str| AreaState { name: (*name).to_owned(), ..AreaState::default() };
        let of_area = |area| {
            [Stage::Synchronise, Stage::Estimate, Stage::Identify].map(|stage| StageState {
                stage,
                area: Some(area),
                last: None,
            })
        };
        let first = StageState { stage: source, area: None, last: None };
        Self {
            title,
            rate_hz,
            link: Link::Live,
            areas: areas.iter().map(state).collect(),
            stages: std::iter::once(first).chain((0..areas.len()).flat_map(of_area)).collect(),
            shown: 0,
            note: String::new(),
        }
    }

    /// Takes a solution of an area in.
    pub fn solution(&mut self, area: usize, solution: &Solution) {
        if let Some(area) = self.areas.get_mut(area) {
            area.solution(solution);
        }
    }

    /// Takes a flexure model of an area in.
    pub fn parameters(&mut self, area: usize, parameters: &FlexureParams) {
        if let Some(area) = self.areas.get_mut(area) {
            area.parameters = Some(*parameters);
        }
    }

    /// Takes a stage's health in, in the order of `stages`; it came at `now_ns` of the monotonic clock.
    pub fn health(&mut self, stage: usize, health: &Health, now_ns: i64) {
        if let Some(stage) = self.stages.get_mut(stage) {
            stage.last = Some((*health, now_ns));
        }
    }

    /// Shows the next area.
    pub fn next_area(&mut self) {
        self.shown = (self.shown + 1) % self.areas.len().max(1);
    }

    /// The area on show.
    pub fn area(&self) -> Option<&AreaState> {
        self.areas.get(self.shown)
    }
}

impl AreaState {
    fn solution(&mut self, solution: &Solution) {
        if solution.header.is_end() {
            self.ended = true;
            return;
        }
        let t = unit::seconds(solution.header.time_ns);
        if self.last.is_some_and(|last| last.header.run_id != solution.header.run_id) {
            self.past.clear();
        }
        self.ended = false;
        self.sequence.see(&solution.header);
        self.minute.see(solution);
        self.received += 1;
        self.last = Some(*solution);
        let stamps = solution.header.stamps;
        let [source, synchronise, estimate, whole] = &mut self.delays;
        source.take(stamps.due_ns, stamps.source_ns);
        synchronise.take(stamps.complete_ns, stamps.pair_ns);
        estimate.take(stamps.pair_ns, stamps.solution_ns);
        whole.take(stamps.due_ns, stamps.solution_ns);
        let due = self.past.back().is_none_or(|last| t - last.t >= STEP_S - 1e-6);
        if solution.is_valid() && due {
            let arcmin = |v: [f64; 3]| v.map(|v| v / unit::ARCMIN);
            self.past.push_back(Past { t, phi: arcmin(solution.phi), range: arcmin(solution.range) });
        }
        while self.past.front().is_some_and(|first| t - first.t > SHOWN_S) {
            self.past.pop_front();
        }
    }
}

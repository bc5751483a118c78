//! What the launcher hears of its set: solutions, parameters, truth and health; latencies and files come of it.

use crate::lines::Lines;
use crate::outputs::{OutputRecord, OutputRow};
use crate::recorded::Recorded;
use crate::report::{AreaRow, Percentiles, Report, StageRow};
use crate::set::{RECORD, Role};
use crate::{LaunchError, Options};
use messages::{
    Flags, FlexureParams, Health, ImuPair, ImuSample, MainAttitude, OutputState, Scheduling, Solution, Stage, State,
    StatePart, StateWish, Truth, topic,
};
use pipeline::configuration::Configuration;
use pipeline::solution_file::SolutionFile;
use pipeline::summary::{Figures, Summary};
use runtime::{Anchor, Latency, Node, Sequence, Subscriber, TransportError, Wake};
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

/// The launcher's readers in one domain.
pub struct Ports {
    areas: Vec<AreaPorts>,
    health: Vec<(Role, Subscriber<Health>)>,
    outputs: Vec<Subscriber<OutputState>>,
    _anchors: Anchors,
}

/// The stage that serves all areas at the other end.
const OUTPUT: Role = Role { stage: Stage::Output, area: None };

/// Holds the topics that the launcher does not read: a stage killed while it makes a topic then leaves nothing half made.
struct Anchors {
    _samples: Vec<Anchor<ImuSample>>,
    _attitude: Anchor<MainAttitude>,
    _pairs: Vec<Anchor<ImuPair>>,
    _states: Vec<(Anchor<StatePart>, Anchor<StateWish>)>,
}

impl Anchors {
    fn open(node: &Node, configuration: &Configuration) -> Result<Self, TransportError> {
        let mut samples = vec![Anchor::open(node, &topic::main_imu())?];
        let (mut pairs, mut states) = (Vec::new(), Vec::new());
        for area in &configuration.areas {
            samples.push(Anchor::open(node, &topic::area_imu(&area.name))?);
            pairs.push(Anchor::open(node, &topic::pair(&area.name))?);
            let (parts, wish) = (topic::state(&area.name), topic::state_wish(&area.name));
            states.push((Anchor::open(node, &parts)?, Anchor::open(node, &wish)?));
        }
        let attitude = Anchor::open(node, &topic::main_attitude())?;
        Ok(Self { _samples: samples, _attitude: attitude, _pairs: pairs, _states: states })
    }
}

struct AreaPorts {
    solutions: Subscriber<Solution>,
    parameters: Subscriber<FlexureParams>,
    truth: Subscriber<Truth>,
}

impl Ports {
    /// What the launcher waits for.
    pub fn wakes(&self) -> Vec<&dyn Wake> {
        self.areas.iter().map(|area| &area.solutions as &dyn Wake).collect()
    }
}

/// Everything that is known of the run, kept over restarts and new domains.
pub struct Collector {
    areas: Vec<AreaRecord>,
    health: HashMap<Role, Counted>,
    outputs: Vec<OutputRecord>,
    source: Role,
    source_latency: Recorded,
    lines: Lines,
    out: Option<PathBuf>,
    cut_short: bool,
}

struct AreaRecord {
    name: String,
    figures: Figures,
    file: Option<(PathBuf, SolutionFile<BufWriter<File>>)>,
    sequence: Sequence,
    received: u64,
    ended: bool,
    parameters: u64,
    late: u64,
    first_parameters_s: Option<f64>,
    begin_ns: Option<i64>,
    last: Option<Solution>,
    synchronise: Recorded,
    wait: Recorded,
    estimate: Recorded,
    identify: Recorded,
    end_to_end: Recorded,
}

/// A stage's counters, summed over the processes that carried it out.
#[derive(Clone, Copy, Default)]
struct Counted {
    past: Totals,
    now: Health,
    seen: bool,
}

#[derive(Clone, Copy, Default)]
struct Totals {
    taken: u64,
    given: u64,
    lost: u64,
    overflow: u64,
}

impl Collector {
    /// Creates the output files that the user asked for.
    pub fn new(configuration: &Configuration, options: &Options) -> Result<Self, LaunchError> {
        for folder in options.out.iter().chain(&options.hlog) {
            std::fs::create_dir_all(folder).map_err(LaunchError::output(folder))?;
        }
        let stage = configuration.main.source.stage();
        let hlog = options.hlog.as_deref();
        let areas = configuration
            .areas
            .iter()
            .map(|area| AreaRecord::new(area, configuration, options))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            areas,
            health: HashMap::new(),
            outputs: OutputRecord::all(configuration),
            source: Role { stage, area: None },
            source_latency: Recorded::new(hlog, stage.name())?,
            lines: Lines::new(configuration),
            out: options.out.clone(),
            cut_short: false,
        })
    }

    /// Opens the readers in a domain; of what the stages of an earlier domain said only the sums are kept.
    pub fn connect(&mut self, node: &Node, configuration: &Configuration) -> Result<Ports, LaunchError> {
        for counted in self.health.values_mut() {
            counted.retire();
        }
        let _anchors = Anchors::open(node, configuration)?;
        let mut ports = Ports { areas: Vec::new(), health: Vec::new(), outputs: Vec::new(), _anchors };
        for (index, area) in configuration.areas.iter().enumerate() {
            let name = area.name.as_str();
            ports.areas.push(AreaPorts {
                solutions: Subscriber::open(node, &topic::solution(name))?,
                parameters: Subscriber::open(node, &topic::parameters(name))?,
                truth: Subscriber::open(node, &topic::truth(name))?,
            });
            for stage in [Stage::Synchronise, Stage::Estimate, Stage::Identify] {
                let health = Subscriber::open(node, &topic::health(stage, Some(name)))?;
                ports.health.push((Role { stage, area: Some(index) }, health));
            }
        }
        self.lines.connect(node)?;
        for number in 0..self.outputs.len() {
            ports.outputs.push(Subscriber::open(node, &topic::output(number))?);
        }
        let output = (!self.outputs.is_empty()).then_some(OUTPUT);
        let record = configuration.record.is_some().then_some(RECORD);
        for role in output.into_iter().chain(record).chain([self.source]) {
            ports.health.push((role, Subscriber::open(node, &topic::health(role.stage, None))?));
        }
        Ok(ports)
    }

    /// Takes in everything that has come.
    pub fn drain(&mut self, ports: &Ports) -> Result<(), LaunchError> {
        self.lines.drain()?;
        for (role, port) in &ports.health {
            while let Some(health) = port.take()? {
                self.health.entry(*role).or_default().update(health);
            }
        }
        for (record, port) in self.outputs.iter_mut().zip(&ports.outputs) {
            while let Some(state) = port.take()? {
                record.update(state);
            }
        }
        for (index, (record, ports)) in self.areas.iter_mut().zip(&ports.areas).enumerate() {
            while let Some(solution) = ports.solutions.take()? {
                // a truth was published before the solution of its sample
                while let Some(truth) = ports.truth.take()? {
                    record.figures.truth(&truth);
                }
                if index == 0 && !solution.header.is_end() {
                    let stamps = solution.header.stamps;
                    self.source_latency.record(stamps.due_ns, stamps.source_ns)?;
                }
                record.solution(&solution)?;
            }
            while let Some(parameters) = ports.parameters.take()? {
                record.parameters(&parameters)?;
            }
        }
        Ok(())
    }

    /// Whether the stage is connected.
    pub fn is_ready(&self, role: Role) -> bool {
        self.health.get(&role).is_some_and(|counted| counted.seen)
    }

    /// Whether every fast stage that has spoken runs in the real-time class.
    pub fn all_fifo(&self) -> bool {
        let slow = [Stage::Identify, Stage::Record];
        let mut fast = self.health.iter().filter(|(role, counted)| !slow.contains(&role.stage) && counted.seen);
        fast.all(|(_, counted)| counted.now.scheduling == Scheduling::Fifo as u32)
    }

    /// Whether the stream of every area has come to its end mark.
    pub fn streams_ended(&self) -> bool {
        self.areas.iter().all(|area| area.ended)
    }

    /// Whether every stage has said its last word.
    pub fn all_ended(&self) -> bool {
        self.health.values().all(|counted| counted.now.state == State::Ended as u32)
    }

    /// Notes that the streams had to be given up before their end.
    pub fn cut_short(&mut self) {
        self.cut_short = true;
    }

    /// The last solution of each area.
    pub fn latest(&self) -> impl Iterator<Item = (&str, Option<&Solution>)> {
        self.areas.iter().map(|area| (area.name.as_str(), area.last.as_ref()))
    }

    /// The units on wires from which nothing comes, in words.
    pub fn quiet(&self, now_ns: i64) -> impl Iterator<Item = String> {
        self.lines.quiet(now_ns)
    }

    /// The last word of each stage.
    pub fn healths(&self) -> impl Iterator<Item = (&Role, &Health)> {
        self.health.iter().filter(|(_, counted)| counted.seen).map(|(role, counted)| (role, &counted.now))
    }

    /// The name of an area.
    pub fn area_name(&self, area: usize) -> &str {
        &self.areas[area].name
    }

    /// What became of the telegrams of each destination so far.
    pub fn outputs(&self) -> impl Iterator<Item = OutputRow> {
        self.outputs.iter().map(OutputRecord::row)
    }

    /// Median end-to-end latency of the first area so far, microseconds.
    pub fn median_us(&self) -> f64 {
        self.areas[0].end_to_end.whole.summary().p50_us
    }

    /// Closes the files and gives the report.
    pub fn finish(mut self, configuration: &Configuration, restarts: &[(Role, u64)]) -> Result<Report, LaunchError> {
        let mut stages = vec![self.row(self.source, restarts, "", &self.source_latency.whole, 0.0)];
        for (index, area) in self.areas.iter().enumerate() {
            let role = |stage| Role { stage, area: Some(index) };
            let wait_us = area.wait.whole.summary().p50_us;
            let name = area.name.as_str();
            stages.push(self.row(role(Stage::Synchronise), restarts, name, &area.synchronise.whole, wait_us));
            stages.push(self.row(role(Stage::Estimate), restarts, name, &area.estimate.whole, 0.0));
            stages.push(self.row(role(Stage::Identify), restarts, name, &area.identify.whole, 0.0));
        }
        if !self.outputs.is_empty() {
            stages.push(self.row(OUTPUT, restarts, "", &Latency::new(), 0.0));
        }
        if configuration.record.is_some() {
            stages.push(self.row(RECORD, restarts, "", &Latency::new(), 0.0));
        }
        let scheduling = if self.all_fifo() { Scheduling::Fifo } else { Scheduling::Normal };
        let end_to_end: Vec<AreaRow> = self.areas.iter().map(AreaRecord::row).collect();
        let missed = |role: &Role| self.health.get(role).map_or(0, |counted| counted.now.missing);
        let missing =
            (0..self.areas.len()).map(|area| missed(&Role { stage: Stage::Synchronise, area: Some(area) })).sum();
        self.source_latency.finish()?;
        for area in &mut self.areas {
            area.finish()?;
        }
        if let Some(folder) = &self.out {
            let path = folder.join("summary.json");
            let summary = Summary { areas: self.areas.iter().map(|area| area.figures.summary()).collect() };
            summary.write(&path).map_err(LaunchError::output(&path))?;
        }
        Ok(Report {
            pairs: end_to_end.iter().map(|area| area.pairs).min().unwrap_or(0),
            parameters: end_to_end.iter().map(|area| area.parameters).sum(),
            late_parameters: end_to_end.iter().map(|area| area.late_parameters).sum(),
            scheduling: scheduling.name(),
            rate_hz: configuration.rate_hz,
            missing_samples: missing,
            refused_samples: self.health.values().map(|counted| counted.now.refused).sum(),
            cut_short: self.cut_short,
            stages,
            end_to_end,
            lines: self.lines.rows(),
            outputs: self.outputs.iter().map(OutputRecord::row).collect(),
        })
    }

    fn row(&self, role: Role, restarts: &[(Role, u64)], area: &str, latency: &Latency, wait_us: f64) -> StageRow {
        let counted = self.health.get(&role).copied().unwrap_or_default();
        StageRow {
            name: role.stage.name(),
            area: area.to_owned(),
            taken: counted.past.taken + counted.now.taken,
            given: counted.past.given + counted.now.given,
            lost: counted.past.lost + counted.now.lost,
            restarts: restarts.iter().find(|(known, _)| *known == role).map_or(0, |(_, n)| *n),
            overflow: counted.past.overflow + counted.now.overflow,
            latency: Percentiles::of(latency, wait_us),
        }
    }
}

impl Counted {
    fn update(&mut self, health: Health) {
        if self.now.pid != health.pid {
            self.retire();
        }
        (self.now, self.seen) = (health, true);
    }

    fn retire(&mut self) {
        self.past.taken += self.now.taken;
        self.past.given += self.now.given;
        self.past.lost += self.now.lost;
        self.past.overflow += self.now.overflow;
        *self = Self { past: self.past, ..Self::default() };
    }
}

impl AreaRecord {
    fn new(
        area: &pipeline::configuration::Area,
        configuration: &Configuration,
        options: &Options,
    ) -> Result<Self, LaunchError> {
        let name = area.name.as_str();
        let file = match &options.out {
            None => None,
            Some(folder) => {
                let path = pipeline::solution_file::path(folder, name);
                let file = SolutionFile::create(folder, name).map_err(LaunchError::output(&path))?;
                Some((path, file))
            }
        };
        let recorded = |what: &str| Recorded::new(options.hlog.as_deref(), &format!("{what}_{name}"));
        Ok(Self {
            name: name.to_owned(),
            figures: Figures::new(name, configuration.settle_s),
            file,
            sequence: Sequence::default(),
            received: 0,
            ended: false,
            parameters: 0,
            late: 0,
            first_parameters_s: None,
            begin_ns: None,
            last: None,
            synchronise: recorded("synchronise")?,
            wait: recorded("wait")?,
            estimate: recorded("estimate")?,
            identify: recorded("identify")?,
            end_to_end: recorded("end_to_end")?,
        })
    }

    fn solution(&mut self, solution: &Solution) -> Result<(), LaunchError> {
        if solution.header.is_end() {
            self.ended = true;
            return Ok(());
        }
        self.sequence.see(&solution.header);
        self.received += 1;
        self.begin_ns.get_or_insert(solution.header.time_ns);
        self.late += u64::from(solution.flags.contains(Flags::LATE));
        self.figures.solution(solution);
        let stamps = solution.header.stamps;
        self.wait.record(stamps.source_ns, stamps.complete_ns)?;
        self.synchronise.record(stamps.complete_ns, stamps.pair_ns)?;
        self.estimate.record(stamps.pair_ns, stamps.solution_ns)?;
        self.end_to_end.record(stamps.due_ns, stamps.solution_ns)?;
        if let Some((path, file)) = &mut self.file {
            file.write(solution).map_err(LaunchError::output(path.as_path()))?;
        }
        self.last = Some(*solution);
        Ok(())
    }

    fn parameters(&mut self, parameters: &FlexureParams) -> Result<(), LaunchError> {
        self.parameters += 1;
        let time_ns = parameters.header.time_ns;
        let begin_ns = *self.begin_ns.get_or_insert(time_ns);
        self.first_parameters_s.get_or_insert(frames::unit::seconds(time_ns - begin_ns));
        let stamps = parameters.header.stamps;
        self.identify.record(stamps.solution_ns, stamps.parameters_ns)?;
        Ok(())
    }

    fn row(&self) -> AreaRow {
        AreaRow {
            area: self.name.clone(),
            pairs: self.received,
            lost: self.sequence.lost(),
            parameters: self.parameters,
            late_parameters: self.late,
            first_parameters_s: self.first_parameters_s,
            zero_deg: self.figures.summary().zero_deg,
            latency: Percentiles::of(&self.end_to_end.whole, self.wait.whole.summary().p50_us),
        }
    }

    fn finish(&mut self) -> Result<(), LaunchError> {
        for recorded in
            [&mut self.synchronise, &mut self.wait, &mut self.estimate, &mut self.identify, &mut self.end_to_end]
        {
            recorded.finish()?;
        }
        if let Some((path, file)) = self.file.take() {
            let mut out = file.finish().map_err(LaunchError::output(&path))?;
            out.flush().map_err(LaunchError::output(&path))?;
        }
        Ok(())
    }
}

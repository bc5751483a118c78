//! `deckflex launch`: starts the process set of a configuration, watches it, restarts what dies, and reports.

mod collector;
mod error;
mod line_row;
mod lines;
mod outputs;
mod prometheus;
mod recorded;
mod report;
mod set;
mod status;

pub use error::LaunchError;
pub use line_row::LineRow;
pub use outputs::OutputRow;
pub use report::{AreaRow, Percentiles, Report, StageRow};

use collector::Collector;
use pipeline::configuration::{Configuration, LogLevel, SchedulingChoice};
use prometheus::Textfile;
use runtime::scheduling::Request;
use runtime::{Context, Domain, Node, Stop, Waiter, monotonic_ns};
use set::{Outcome, Set};
use status::Status;
use std::path::PathBuf;
use std::time::Duration;

/// What the user asked for on the command line.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The program whose subcommands are the stages.
    pub program: PathBuf,
    /// The configuration file.
    pub configuration: PathBuf,
    /// `--duration` in seconds, as it has to be handed on to the stages.
    pub duration_s: Option<f64>,
    /// Folder for the solution files and the summary.
    pub out: Option<PathBuf>,
    /// `--record`: folder for the recording, if it is not that of the configuration.
    pub record: Option<PathBuf>,
    /// Folder for the latency logs.
    pub hlog: Option<PathBuf>,
    /// Text file of the stages' health, for the node exporter of Prometheus.
    pub prometheus: Option<PathBuf>,
    /// `--log`, as it has to be handed on to the stages.
    pub log: Option<LogLevel>,
}

/// The set is looked after at least so often.
const WATCH: Duration = Duration::from_millis(50);
/// From the moment all stages are ready to the first sample, ns: the source has to start meanwhile.
const RUN_UP_NS: i64 = 500_000_000;
/// After so long the stages for which the source waits are named, ns.
const SLOW_START_NS: i64 = 5_000_000_000;
/// How long the stages may take to work off their queues once the source has ended or been told to, ns.
const WORK_OFF_NS: i64 = 15_000_000_000;
/// How long a stage may take for its last health message after the streams have ended, ns.
const LAST_WORDS_NS: i64 = 2_000_000_000;
/// How often a poisoned transport is replaced before the launch gives up.
const DOMAINS: u32 = 8;

/// Runs the set to its end: the run's duration, the end of the recordings, or a signal.
///
/// # Errors
/// The set cannot be started or kept up, or an output file cannot be written.
pub fn run(configuration: &Configuration, options: &Options) -> Result<Report, LaunchError> {
    let stop = Stop::install()?;
    if let Err(error) = Domain::sweep() {
        tracing::warn!(%error, "what an earlier launch has left is removed by a later one");
    }
    let run_id = monotonic_ns() as u64;
    let (file, areas) = (configuration.path.display(), configuration.areas.len());
    tracing::info!(configuration = %file, areas, run_id, "a run begins");
    let mut collector = Collector::new(configuration, options)?;
    let mut textfile = Textfile::create(options.prometheus.clone())?;
    let mut epoch_ns = None;
    let mut restarts = Vec::new();
    for _ in 0..DOMAINS {
        let domain = Domain::create()?;
        let context = Context {
            domain: domain.root().to_path_buf(),
            run_id,
            epoch_ns: 0,
            resume: false,
            scheduling: request(configuration.run.scheduling),
        };
        let mut set = Set::new(configuration, options, context, std::mem::take(&mut restarts));
        let ended = attend(configuration, &stop, &domain, &mut set, &mut collector, &mut textfile, &mut epoch_ns);
        set.kill();
        restarts = set.restarts();
        domain.remove()?;
        let left = domain.leftovers();
        if !left.is_empty() {
            return Err(LaunchError::Leftovers(left));
        }
        match ended {
            Ok(()) => {
                textfile.end()?;
                let report = collector.finish(configuration, &restarts)?;
                ended_words(&report);
                return Ok(report);
            }
            Err(error) if error.is_poisoned() => {
                tracing::warn!(reason = %error, "the set moves to a new domain");
            }
            Err(error) => return Err(error),
        }
    }
    Err(LaunchError::Poisoned(DOMAINS))
}

fn ended_words(report: &Report) {
    let pairs = report.pairs;
    let lost: u64 = report.end_to_end.iter().map(|row| row.lost).sum();
    let restarts: u64 = report.stages.iter().map(|row| row.restarts).sum();
    match report.cut_short {
        false => tracing::info!(pairs, lost, restarts, "the run has ended in order"),
        true => tracing::warn!(pairs, lost, restarts, "the streams did not end in time: the run was cut short"),
    }
}

/// What the configuration's choice asks of the operating system.
pub fn request(choice: SchedulingChoice) -> Request {
    match choice {
        SchedulingChoice::Auto => Request::Auto,
        SchedulingChoice::Normal => Request::Normal,
        SchedulingChoice::Fifo => Request::Fifo,
    }
}

/// Starts the set in a domain and stays with it until every area's stream has ended.
fn attend(
    configuration: &Configuration,
    stop: &Stop,
    domain: &Domain,
    set: &mut Set,
    collector: &mut Collector,
    textfile: &mut Textfile,
    epoch_ns: &mut Option<i64>,
) -> Result<(), LaunchError> {
    let node = Node::open(domain, "launch")?;
    let ports = collector.connect(&node, configuration)?;
    let mut waiter = Waiter::new();
    let mut status = Status::new(configuration);
    set.start_workers()?;
    let (mut until_ns, mut last_ns, mut complain_ns) = (None, None, monotonic_ns() + SLOW_START_NS);
    loop {
        waiter.wait(&ports.wakes(), WATCH)?;
        collector.drain(&ports)?;
        let now_ns = monotonic_ns();
        match set.watch(now_ns)? {
            Outcome::Running => {}
            Outcome::SourceEnded => {
                until_ns.get_or_insert(now_ns + WORK_OFF_NS);
            }
        }
        if !set.has_source() {
            let late: Vec<&str> =
                set.workers().filter(|(role, _)| !collector.is_ready(*role)).map(|(_, name)| name).collect();
            if late.is_empty() {
                if configuration.run.scheduling == SchedulingChoice::Fifo && !collector.all_fifo() {
                    return Err(LaunchError::NoRealTime);
                }
                let resume = epoch_ns.is_some();
                tracing::info!(real_time = collector.all_fifo(), resume, "all stages are ready: the source starts");
                set.start_source(*epoch_ns.get_or_insert(now_ns + RUN_UP_NS), resume)?;
            } else if now_ns > complain_ns {
                tracing::warn!(waits_for = late.join(", "), "the source cannot start yet");
                complain_ns = i64::MAX;
            }
        }
        if stop.requested() && until_ns.is_none() {
            tracing::info!("asked to stop: the streams end");
            until_ns = Some(now_ns + WORK_OFF_NS);
            if !set.has_source() {
                return Ok(());
            }
            set.stop_source();
        }
        if collector.streams_ended() {
            // an identifier in the middle of a long solution need not finish it
            let last_ns = *last_ns.get_or_insert(now_ns + LAST_WORDS_NS);
            if collector.all_ended() || now_ns > last_ns {
                return Ok(());
            }
        }
        if until_ns.is_some_and(|until_ns| now_ns > until_ns) {
            collector.cut_short();
            return Ok(());
        }
        status.show(now_ns, collector, set);
        textfile.show(now_ns, collector, set);
    }
}

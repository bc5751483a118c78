//! deckflex: deck deformation of a ship from two or more inertial units, in real time, with an error range.

use clap::{Args, Parser, Subcommand};
use pipeline::configuration::Configuration;
use runtime::{Context, POISONED_EXIT_CODE, TransportError};
use std::error::Error;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// Deck deformation of a ship from two or more inertial units, in real time, with an error range.
#[derive(Parser)]
#[command(version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Start the process set of a configuration and print the latency of every stage at the end
    Launch {
        configuration: PathBuf,
        /// Length of the run, such as 60s or 10min; without it until the source ends or Ctrl-C
        #[arg(long, value_parser = humantime::parse_duration)]
        duration: Option<Duration>,
        /// Write the report as JSON
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Write the latencies as HdrHistogram interval logs
        #[arg(long, value_name = "DIR")]
        hlog: Option<PathBuf>,
        /// Write the solutions, the same files as `process`
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Write the health of all stages for Prometheus's node exporter, every five seconds
        #[arg(long, value_name = "FILE")]
        prometheus: Option<PathBuf>,
        /// Record everything there, whatever folder the table `record` names
        #[arg(long, value_name = "DIR")]
        record: Option<PathBuf>,
    },
    /// Run the same steps in one thread without transport, as fast as it goes
    Process {
        /// Or a recorded run, to go through it again as it was
        configuration: PathBuf,
        /// Length of the data, such as 60s or 10min
        #[arg(long, value_parser = humantime::parse_duration)]
        duration: Option<Duration>,
        /// Where the solutions and the summary go
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Check a configuration and the head of each recording
    Check { configuration: PathBuf },
    /// Repeat the papers' experiments and print our figures beside theirs and beside the statistical bound
    Reproduce {
        /// Name of a paper's experiment, deck for the project's own estimator, or all; an unknown name is answered with the known ones
        #[arg(default_value = "all")]
        experiment: reproduce::Selection,
        /// Trials of every study, instead of its own number
        #[arg(long, value_name = "N")]
        trials: Option<NonZeroUsize>,
        #[arg(long, value_name = "S", default_value_t = 1)]
        seed: u64,
        /// Few trials: a look, not a result
        #[arg(long)]
        quick: bool,
        /// Write the rows as JSON
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
        /// Write a page with tables and figures
        #[arg(long, value_name = "DIR")]
        report: Option<PathBuf>,
        /// Threads at work, by default one a core; the results are the same
        #[arg(long, value_name = "N")]
        threads: Option<NonZeroUsize>,
    },
    /// Tell how well the data of a simulated configuration would show the deformation, were the flexure's model known, against time
    Bound {
        configuration: PathBuf,
        /// Length of the data, such as 10min or 2h; without it run.duration_s of the configuration, or 30min
        #[arg(long, value_parser = humantime::parse_duration)]
        duration: Option<Duration>,
        /// Draw the standard deviations against time
        #[arg(long, value_name = "FILE")]
        svg: Option<PathBuf>,
        /// Write the numbers as JSON
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
    },
    /// Stage: simulated units (started by launch); with --wire a program of its own that speaks the units' protocols on their ports
    Simulate(SimulateArgs),
    /// Stage: units on wires (started by launch)
    Acquire(StageArgs),
    /// Complete a recording that was cut, and say what it holds
    Recover {
        recording: PathBuf,
        /// The new file; without it beside the recording, with the ending .recovered.mcap
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Write a recorded run as CSV files
    Export {
        recording: PathBuf,
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Tell the noise of a unit at rest by its Allan deviation, and the lines for the configuration
    Allan {
        /// A recording (CSV), or a configuration (.toml) whose units are recordings
        file: PathBuf,
        /// Unit of the configuration: main or the name of an area
        #[arg(long)]
        unit: Option<String>,
        /// Draw the deviations against the averaging time
        #[arg(long, value_name = "FILE")]
        svg: Option<PathBuf>,
        /// Write the numbers as JSON
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
    },
    /// Tell how far a solution lies from a reference unit's or from the truth, without their fixed deviation
    Compare {
        /// A solution file
        solution: PathBuf,
        /// A reference unit's solution file, or any file with t_s and q_w, q_x, q_y, q_z or phi_x_arcsec, phi_y_arcsec, phi_z_arcsec
        reference: PathBuf,
        /// The static stretch that gives the fixed deviation, such as 10s..1min after the first common instant; without it all of it
        #[arg(long = "static", value_name = "FROM..TO", value_parser = stretch)]
        still: Option<[f64; 2]>,
        /// Leave the fixed deviation in
        #[arg(long, conflicts_with = "still")]
        keep_fixed: bool,
        /// Compare only from so long after the first common instant
        #[arg(long, value_name = "TIME", default_value = "0s", value_parser = humantime::parse_duration)]
        from: Duration,
        /// Write the numbers as JSON
        #[arg(long, value_name = "FILE")]
        json: Option<PathBuf>,
    },
    /// Look at what of this computer stands in the way of a live run, and say how to mend it; changes nothing
    Doctor {
        /// What this configuration needs is looked at too
        configuration: Option<PathBuf>,
    },
    /// Look at a running launch, from another terminal
    Monitor {
        /// The configuration whose launch is meant; without it the one that runs
        configuration: Option<PathBuf>,
        /// Where events go that are marked with the key e
        #[arg(long, value_name = "FILE", default_value = "events.csv")]
        events: PathBuf,
        /// Where it is told which zeros were taken with the key z
        #[arg(long, value_name = "FILE", default_value = "zeros.csv")]
        zeros: PathBuf,
    },
    /// Show a running launch to viewers that speak the Foxglove WebSocket
    #[cfg(feature = "foxglove")]
    Live {
        /// The configuration whose launch is meant; without it the one that runs
        configuration: Option<PathBuf>,
        /// Where viewers connect; port 0 takes a free one
        #[arg(long, value_name = "ADDR:PORT", default_value = "127.0.0.1:8765")]
        listen: std::net::SocketAddr,
    },
    /// Stage: recorded units (started by launch)
    Replay(StageArgs),
    /// Stage: one area's samples onto the main unit's instants (started by launch)
    Synchronise(AreaArgs),
    /// Stage: one area's deformation (started by launch)
    Estimate(AreaArgs),
    /// Stage: one area's flexure parameters (started by launch)
    Identify(AreaArgs),
    /// Stage: telegrams on the ship's wires (started by launch where the configuration has outputs)
    Output(StageArgs),
    /// Stage: the recorder (started by launch)
    Record(RecordArgs),
}

#[derive(Args)]
struct RecordArgs {
    #[command(flatten)]
    stage: StageArgs,
    /// Where to record, whatever folder the table `record` names
    #[arg(long, value_name = "DIR")]
    folder: Option<PathBuf>,
}

#[derive(Args)]
struct StageArgs {
    configuration: PathBuf,
    /// Root of the transport domain, made by launch
    #[arg(long, value_name = "DIR")]
    domain: PathBuf,
    #[arg(long, default_value_t = 1)]
    run_id: u64,
    /// When the first sample is due, on the monotonic clock
    #[arg(long, value_name = "NS", default_value_t = 0)]
    epoch_ns: i64,
    /// Take the place of a stage that died
    #[arg(long)]
    resume: bool,
    #[arg(long, value_parser = humantime::parse_duration)]
    duration: Option<Duration>,
}

#[derive(Args)]
struct SimulateArgs {
    configuration: PathBuf,
    /// Speak the protocols of the configured devices on their serial ports and sockets
    #[arg(long)]
    wire: bool,
    #[command(flatten)]
    wires: WireArgs,
    #[arg(long, value_name = "DIR", required_unless_present = "wire")]
    domain: Option<PathBuf>,
    #[arg(long, default_value_t = 1)]
    run_id: u64,
    #[arg(long, value_name = "NS", default_value_t = 0)]
    epoch_ns: i64,
    #[arg(long)]
    resume: bool,
    #[arg(long, value_parser = humantime::parse_duration)]
    duration: Option<Duration>,
}

/// How the emulated wires behave.
#[derive(Args)]
struct WireArgs {
    /// Mean of the delays beyond the least one
    #[arg(long, requires = "wire", default_value = "100us", value_parser = humantime::parse_duration)]
    jitter: Duration,
    /// The least delay from a sample's end to its sending
    #[arg(long, requires = "wire", default_value = "1ms", value_parser = humantime::parse_duration)]
    latency: Duration,
    /// By how much the main unit's clock is fast and the others' are slow
    #[arg(long, requires = "wire", value_name = "PPM", default_value_t = 50.0, allow_negative_numbers = true)]
    skew_ppm: f64,
    /// The INS tells UTC, ahead of the host's by so much
    #[arg(long, requires = "wire", value_name = "TIME", value_parser = humantime::parse_duration)]
    utc_ahead: Option<Duration>,
    /// Format of KVH units
    #[arg(long, requires = "wire", default_value = "b")]
    kvh_format: KvhFormat,
    /// Write the true deformation and the true times of all samples
    #[arg(long, requires = "wire", value_name = "DIR")]
    truth: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum KvhFormat {
    A,
    B,
    C,
}

#[derive(Args)]
struct AreaArgs {
    #[command(flatten)]
    stage: StageArgs,
    /// Name of the area
    #[arg(long)]
    area: String,
}

/// The configuration, the recording or the command line cannot be used.
const UNUSABLE: u8 = 2;

type Outcome = Result<ExitCode, Box<dyn Error>>;

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Launch { configuration, duration, json, hlog, out, prometheus, record } => {
            launch(configuration, duration, json, hlog, out, prometheus, record)
        }
        Command::Process { configuration, duration, out } => process(configuration, duration, &out),
        Command::Check { configuration } => check(configuration),
        Command::Bound { configuration, duration, svg, json } => {
            let duration_s = duration.map(|duration| duration.as_secs_f64());
            bound(&bound::Options { configuration, duration_s, svg, json })
        }
        Command::Reproduce { experiment: selection, trials, seed, quick, json, report, threads } => {
            let plan = reproduce::Plan { trials, seed, quick };
            reproduce(&reproduce::Options { selection, plan, json, report, threads })
        }
        Command::Simulate(args) => simulate(args),
        Command::Acquire(args) => stage(&args, acquire::run),
        Command::Recover { recording, out } => recover(&recording, out.as_deref()),
        Command::Export { recording, out } => export(&recording, &out),
        Command::Allan { file, unit, svg, json } => allan(&allan::Options { file, unit, svg, json }),
        Command::Compare { solution, reference, still, keep_fixed, from, json } => {
            let from = from.as_secs_f64();
            compare(&compare::Options { solution, reference, still, keep_fixed, from, json })
        }
        Command::Doctor { configuration } => doctor(configuration.as_deref()),
        Command::Monitor { configuration, events, zeros } => {
            monitor(&monitor::Options { configuration, events, zeros })
        }
        #[cfg(feature = "foxglove")]
        Command::Live { configuration, listen } => live(&live::Options { configuration, listen }),
        Command::Replay(args) => stage(&args, replay::run),
        Command::Synchronise(args) => of_area(&args, synchronise::run),
        Command::Estimate(args) => of_area(&args, estimate::run),
        Command::Identify(args) => of_area(&args, identify::run),
        Command::Output(args) => stage(&args, output::run),
        Command::Record(args) => record(&args),
    };
    outcome.unwrap_or_else(|error| failed(error.as_ref()))
}

/// Prints the error; the exit code tells the launcher and scripts what to do about it.
fn failed(error: &(dyn Error + 'static)) -> ExitCode {
    eprintln!("deckflex: {error}");
    let poisoned = error.downcast_ref::<TransportError>().is_some_and(TransportError::is_poisoned)
        || matches!(error.downcast_ref(), Some(replay::ReplayError::Transport(error)) if error.is_poisoned())
        || matches!(error.downcast_ref(), Some(acquire::AcquireError::Transport(error)) if error.is_poisoned())
        || matches!(error.downcast_ref(), Some(output::OutputError::Transport(error)) if error.is_poisoned())
        || matches!(error.downcast_ref(), Some(record::RecordError::Transport(error)) if error.is_poisoned());
    let unusable = error.is::<pipeline::configuration::ConfigurationError>()
        || error.is::<check::CheckError>()
        || matches!(error.downcast_ref(), Some(bound::BoundError::Configuration(_)))
        || matches!(error.downcast_ref(), Some(process::ProcessError::Recording(_)))
        || matches!(error.downcast_ref(), Some(replay::ReplayError::Recording(_)))
        || error.downcast_ref().is_some_and(acquire::AcquireError::is_lasting)
        || error.is::<simulate::EmulatorError>()
        || matches!(error.downcast_ref(), Some(output::OutputError::Destination { .. }))
        || matches!(error.downcast_ref(), Some(launch::LaunchError::Refused(_)))
        || matches!(error.downcast_ref(), Some(record::RecordError::Configuration(_) | record::RecordError::Nowhere))
        || error.is::<recover::RecoverError>()
        || error.is::<export::ExportError>()
        || error.is::<NoFolder>()
        || matches!(error.downcast_ref(), Some(error) if allan::AllanError::is_unusable(error))
        || matches!(error.downcast_ref(), Some(error) if compare::CompareError::is_unusable(error))
        || matches!(error.downcast_ref(), Some(monitor::MonitorError::Configuration(_)))
        || error.is::<NoSuchArea>()
        || error.is::<Endless>();
    match (poisoned, unusable) {
        (true, _) => ExitCode::from(POISONED_EXIT_CODE),
        (_, true) => ExitCode::from(UNUSABLE),
        _ => ExitCode::FAILURE,
    }
}

fn read(path: &std::path::Path, duration: Option<Duration>) -> Result<Configuration, Box<dyn Error>> {
    let mut configuration = Configuration::read(path)?;
    if let Some(duration) = duration {
        configuration.run.duration_s = Some(duration.as_secs_f64());
    }
    Ok(configuration)
}

fn launch(
    path: PathBuf,
    duration: Option<Duration>,
    json: Option<PathBuf>,
    hlog: Option<PathBuf>,
    out: Option<PathBuf>,
    prometheus: Option<PathBuf>,
    record: Option<PathBuf>,
) -> Outcome {
    let mut configuration = read(&path, duration)?;
    record.iter().for_each(|folder| configuration.record_in(folder));
    // before any process starts
    check_recordings(&path)?;
    if let Some(record) = &configuration.record {
        std::fs::create_dir_all(&record.folder).map_err(|reason| NoFolder(record.folder.clone(), reason))?;
    }
    let duration_s = duration.map(|d| d.as_secs_f64());
    let program = std::env::current_exe()?;
    let options = launch::Options { program, configuration: path, duration_s, out, record, hlog, prometheus };
    let report = launch::run(&configuration, &options)?;
    print!("{report}");
    if let Some(json) = json {
        std::fs::write(json, serde_json::to_string_pretty(&report)? + "\n")?;
    }
    Ok(if report.cut_short { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn process(path: PathBuf, duration: Option<Duration>, out: &std::path::Path) -> Outcome {
    let configuration = read(&path, duration)?;
    if let (None, pipeline::configuration::Source::Simulator) =
        (configuration.run.duration_s, &configuration.main.source)
    {
        return Err(Endless.into());
    }
    check_recordings(&path)?;
    println!("{}", process::run(&configuration, out)?);
    Ok(ExitCode::SUCCESS)
}

/// Refuses recordings that cannot be used, and says what looks wrong about the others.
fn check_recordings(path: &std::path::Path) -> Result<(), check::CheckError> {
    let found = check::run(path)?;
    found.suspicions().iter().for_each(|suspicion| eprintln!("deckflex: {suspicion}"));
    Ok(())
}

fn check(path: PathBuf) -> Outcome {
    let report = check::run(&path)?;
    println!("{report}");
    check::listen(&report.configuration).for_each(|listened| println!("{listened}"));
    Ok(ExitCode::SUCCESS)
}

fn bound(options: &bound::Options) -> Outcome {
    print!("{}", bound::run(options)?);
    Ok(ExitCode::SUCCESS)
}

fn reproduce(options: &reproduce::Options) -> Outcome {
    print!("{}", reproduce::run(options)?);
    Ok(ExitCode::SUCCESS)
}

fn recover(recording: &std::path::Path, out: Option<&std::path::Path>) -> Outcome {
    println!("{}", recover::run(recording, out)?);
    Ok(ExitCode::SUCCESS)
}

fn export(recording: &std::path::Path, out: &std::path::Path) -> Outcome {
    print!("{}", export::run(recording, out)?);
    Ok(ExitCode::SUCCESS)
}

fn record(args: &RecordArgs) -> Outcome {
    stage(&args.stage, |configuration, context| {
        let mut configuration = configuration.clone();
        args.folder.iter().for_each(|folder| configuration.record_in(folder));
        record::run(&configuration, context, |line| {
            // a log on the disk that is full must not end the recorder
            let _ = writeln!(std::io::stderr(), "deckflex record: {line}");
        })
    })
}

fn allan(options: &allan::Options) -> Outcome {
    print!("{}", allan::run(options)?);
    Ok(ExitCode::SUCCESS)
}

fn compare(options: &compare::Options) -> Outcome {
    print!("{}", compare::run(options)?);
    Ok(ExitCode::SUCCESS)
}

/// Success also with warnings: a live run works then.
fn doctor(configuration: Option<&std::path::Path>) -> Outcome {
    let report = doctor::run(&doctor::Host::this(), configuration)?;
    print!("{report}");
    Ok(if report.worst() == doctor::Grade::Bad { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn monitor(options: &monitor::Options) -> Outcome {
    monitor::run(options)?;
    Ok(ExitCode::SUCCESS)
}

#[cfg(feature = "foxglove")]
fn live(options: &live::Options) -> Outcome {
    let report = live::run(options, |line| {
        let _ = writeln!(std::io::stderr(), "deckflex live: {line}");
    })?;
    println!("{report}");
    Ok(ExitCode::SUCCESS)
}

/// Two times with two dots between them, s.
fn stretch(text: &str) -> Result<[f64; 2], String> {
    let (from, to) = text.split_once("..").ok_or("must be two times such as 10s..1min")?;
    let seconds = |text: &str| humantime::parse_duration(text).map(|d| d.as_secs_f64()).map_err(|e| e.to_string());
    let [from, to] = [seconds(from)?, seconds(to)?];
    if from < to { Ok([from, to]) } else { Err("must begin before it ends".to_owned()) }
}

fn stage<E: Into<Box<dyn Error>>>(
    args: &StageArgs,
    run: impl Fn(&Configuration, &Context) -> Result<(), E>,
) -> Outcome {
    let configuration = read(&args.configuration, args.duration)?;
    run(&configuration, &context(&configuration, args)).map_err(Into::into)?;
    Ok(ExitCode::SUCCESS)
}

fn simulate(args: SimulateArgs) -> Outcome {
    let SimulateArgs { configuration, wire, wires, domain, run_id, epoch_ns, resume, duration } = args;
    let Some(domain) = domain.filter(|_| !wire) else { return emulate(&configuration, duration, wires) };
    stage(&StageArgs { configuration, domain, run_id, epoch_ns, resume, duration }, simulate::run)
}

fn emulate(path: &std::path::Path, duration: Option<Duration>, wires: WireArgs) -> Outcome {
    let options = simulate::Options {
        jitter_s: wires.jitter.as_secs_f64(),
        latency_s: wires.latency.as_secs_f64(),
        skew: wires.skew_ppm * 1e-6,
        utc_ahead_s: wires.utc_ahead.map(|ahead| ahead.as_secs_f64()),
        kvh_format: match wires.kvh_format {
            KvhFormat::A => simulate::KvhFormat::A,
            KvhFormat::B => simulate::KvhFormat::B,
            KvhFormat::C => simulate::KvhFormat::C,
        },
        truth: wires.truth,
    };
    let emulator = simulate::Emulator::open(&read(path, duration)?, options)?;
    println!("{emulator}");
    emulator.run()?;
    Ok(ExitCode::SUCCESS)
}

fn of_area(args: &AreaArgs, run: fn(&Configuration, usize, &Context) -> Result<(), TransportError>) -> Outcome {
    stage::<Box<dyn Error>>(&args.stage, |configuration, context| {
        let area = configuration.areas.iter().position(|area| area.name == args.area);
        let area = area.ok_or_else(|| NoSuchArea(args.area.clone()))?;
        Ok(run(configuration, area, context)?)
    })
}

fn context(configuration: &Configuration, args: &StageArgs) -> Context {
    Context {
        domain: args.domain.clone(),
        run_id: args.run_id,
        epoch_ns: args.epoch_ns,
        resume: args.resume,
        scheduling: launch::request(configuration.run.scheduling),
    }
}

#[derive(Debug)]
struct NoSuchArea(String);

impl std::fmt::Display for NoSuchArea {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the configuration has no area \"{}\"", self.0)
    }
}

impl Error for NoSuchArea {}

#[derive(Debug)]
struct NoFolder(PathBuf, std::io::Error);

impl std::fmt::Display for NoFolder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "cannot record in {}: {}", self.0.display(), self.1)
    }
}

impl Error for NoFolder {}

#[derive(Debug)]
struct Endless;

impl std::fmt::Display for Endless {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a simulated run has no end of its own: give --duration or run.duration_s")
    }
}

impl Error for Endless {}

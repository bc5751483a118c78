//! The command line.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use pipeline::configuration::LogLevel;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

/// Deck deformation of a ship from two or more inertial units, in real time, with an error range.
#[derive(Parser)]
#[command(version)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Start the process set of a configuration and print the latency of every stage at the end
    Launch(LaunchArgs),
    /// Run the same steps in one thread without transport, as fast as it goes
    Process {
        /// Or a recorded run, to go through it again as it was: its first file, or its folder
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
    /// Write a page with pictures and tables about a recorded run
    Report {
        recording: PathBuf,
        /// The page; without it beside the recording, with the ending .html
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
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
pub struct LaunchArgs {
    pub configuration: PathBuf,
    /// Length of the run, such as 60s or 10min; without it until the source ends or Ctrl-C
    #[arg(long, value_parser = humantime::parse_duration)]
    pub duration: Option<Duration>,
    /// Write the report as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the latencies as HdrHistogram interval logs
    #[arg(long, value_name = "DIR")]
    pub hlog: Option<PathBuf>,
    /// Write the solutions, the same files as `process`
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write the health of all stages for Prometheus's node exporter, every five seconds
    #[arg(long, value_name = "FILE")]
    pub prometheus: Option<PathBuf>,
    /// Record everything there, whatever folder the table `record` names
    #[arg(long, value_name = "DIR")]
    pub record: Option<PathBuf>,
    /// The least that is logged, whatever the table `log` says
    #[arg(long, value_name = "LEVEL", value_parser = log_level())]
    pub log: Option<LogLevel>,
}

#[derive(Args)]
pub struct RecordArgs {
    #[command(flatten)]
    pub stage: StageArgs,
    /// Where to record, whatever folder the table `record` names
    #[arg(long, value_name = "DIR")]
    pub folder: Option<PathBuf>,
}

#[derive(Args)]
pub struct StageArgs {
    pub configuration: PathBuf,
    /// Root of the transport domain, made by launch
    #[arg(long, value_name = "DIR")]
    pub domain: PathBuf,
    #[command(flatten)]
    pub run: RunArgs,
}

/// What launch tells every stage.
#[derive(Args)]
pub struct RunArgs {
    #[arg(long, default_value_t = 1)]
    pub run_id: u64,
    /// When the first sample is due, on the monotonic clock
    #[arg(long, value_name = "NS", default_value_t = 0)]
    pub epoch_ns: i64,
    /// Take the place of a stage that died
    #[arg(long)]
    pub resume: bool,
    #[arg(long, value_parser = humantime::parse_duration)]
    pub duration: Option<Duration>,
    /// The least that is logged, whatever the table `log` says
    #[arg(long, value_name = "LEVEL", value_parser = log_level())]
    pub log: Option<LogLevel>,
}

#[derive(Args)]
pub struct SimulateArgs {
    pub configuration: PathBuf,
    /// Speak the protocols of the configured devices on their serial ports and sockets
    #[arg(long)]
    pub wire: bool,
    #[command(flatten)]
    pub wires: WireArgs,
    #[arg(long, value_name = "DIR", required_unless_present = "wire")]
    pub domain: Option<PathBuf>,
    #[command(flatten)]
    pub run: RunArgs,
}

/// How the emulated wires behave.
#[derive(Args)]
pub struct WireArgs {
    /// Mean of the delays beyond the least one
    #[arg(long, requires = "wire", default_value = "100us", value_parser = humantime::parse_duration)]
    pub jitter: Duration,
    /// The least delay from a sample's end to its sending
    #[arg(long, requires = "wire", default_value = "1ms", value_parser = humantime::parse_duration)]
    pub latency: Duration,
    /// By how much the main unit's clock is fast and the others' are slow
    #[arg(long, requires = "wire", value_name = "PPM", default_value_t = 50.0, allow_negative_numbers = true)]
    pub skew_ppm: f64,
    /// The INS tells UTC, ahead of the host's by so much
    #[arg(long, requires = "wire", value_name = "TIME", value_parser = humantime::parse_duration)]
    pub utc_ahead: Option<Duration>,
    /// Format of KVH units
    #[arg(long, requires = "wire", default_value = "b")]
    pub kvh_format: KvhFormat,
    /// Write the true deformation and the true times of all samples
    #[arg(long, requires = "wire", value_name = "DIR")]
    pub truth: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
pub enum KvhFormat {
    A,
    B,
    C,
}

#[derive(Args)]
pub struct AreaArgs {
    #[command(flatten)]
    pub stage: StageArgs,
    /// Name of the area
    #[arg(long)]
    pub area: String,
}

fn log_level() -> impl TypedValueParser<Value = LogLevel> {
    let level = |name: String| LogLevel::ALL.into_iter().find(|level| level.name() == name).ok_or("no such level");
    PossibleValuesParser::new(LogLevel::ALL.map(LogLevel::name)).try_map(level)
}

/// Two times with two dots between them, s.
fn stretch(text: &str) -> Result<[f64; 2], String> {
    let (from, to) = text.split_once("..").ok_or("must be two times such as 10s..1min")?;
    let seconds = |text: &str| humantime::parse_duration(text).map(|d| d.as_secs_f64()).map_err(|e| e.to_string());
    let [from, to] = [seconds(from)?, seconds(to)?];
    if from < to { Ok([from, to]) } else { Err("must begin before it ends".to_owned()) }
}

//! deckflex: deck deformation of a ship from two or more inertial units, in real time, with an error range.

mod arguments;
mod exit;
mod log;

use arguments::{
    AreaArgs, Cli, Command, KvhFormat, LaunchArgs, RecordArgs, RunArgs, SimulateArgs, StageArgs, WireArgs,
};
use clap::Parser;
use exit::Refusal;
use pipeline::configuration::Configuration;
use pipeline::recorded_run::first_file;
use runtime::{Context, TransportError};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

type Outcome = Result<ExitCode, Box<dyn Error>>;

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Launch(args) => launch(args),
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
        Command::Acquire(args) => stage("acquire", &args, acquire::run),
        Command::Recover { recording, out } => recover(&recording, out.as_deref()),
        Command::Report { recording, out } => report(&recording, out.as_deref()),
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
        Command::Replay(args) => stage("replay", &args, replay::run),
        Command::Synchronise(args) => of_area("synchronise", &args, synchronise::run),
        Command::Estimate(args) => of_area("estimate", &args, estimate::run),
        Command::Identify(args) => of_area("identify", &args, identify::run),
        Command::Output(args) => stage("output", &args, output::run),
        Command::Record(args) => record(&args),
    };
    outcome.unwrap_or_else(|error| exit::failed(error.as_ref()))
}

fn read(path: &Path, duration: Option<Duration>) -> Result<Configuration, Box<dyn Error>> {
    let mut configuration = Configuration::read(path)?;
    if let Some(duration) = duration {
        configuration.run.duration_s = Some(duration.as_secs_f64());
    }
    Ok(configuration)
}

fn launch(args: LaunchArgs) -> Outcome {
    let LaunchArgs { configuration: path, duration, json, hlog, out, prometheus, record, log } = args;
    let mut configuration = read(&path, duration)?;
    record.iter().for_each(|folder| configuration.record_in(folder));
    // before any process starts
    check_recordings(&path)?;
    if let Some(record) = &configuration.record {
        std::fs::create_dir_all(&record.folder).map_err(|reason| Refusal::NoFolder(record.folder.clone(), reason))?;
    }
    let duration_s = duration.map(|d| d.as_secs_f64());
    let program = std::env::current_exe()?;
    let logged = log::start(configuration.log, log, "launch", None);
    let options = launch::Options { program, configuration: path, duration_s, out, record, hlog, prometheus, log };
    let report = launch::run(&configuration, &options);
    // what has been logged stands above the report, or the error
    drop(logged);
    let report = report?;
    print!("{report}");
    if let Some(json) = json {
        std::fs::write(json, serde_json::to_string_pretty(&report)? + "\n")?;
    }
    Ok(if report.cut_short { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn process(path: PathBuf, duration: Option<Duration>, out: &Path) -> Outcome {
    let path = first_file(&path)?;
    let configuration = read(&path, duration)?;
    if let (None, pipeline::configuration::Source::Simulator) =
        (configuration.run.duration_s, &configuration.main.source)
    {
        return Err(Refusal::Endless.into());
    }
    check_recordings(&path)?;
    println!("{}", process::run(&configuration, out)?);
    Ok(ExitCode::SUCCESS)
}

/// Refuses recordings that cannot be used, and says what looks wrong about the others.
fn check_recordings(path: &Path) -> Result<(), check::CheckError> {
    let found = check::run(path)?;
    found.suspicions().iter().for_each(|suspicion| eprintln!("deckflex: {suspicion}"));
    Ok(())
}

fn check(path: PathBuf) -> Outcome {
    let report = check::run(&first_file(&path)?)?;
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

fn recover(recording: &Path, out: Option<&Path>) -> Outcome {
    println!("{}", recover::run(recording, out)?);
    Ok(ExitCode::SUCCESS)
}

fn export(recording: &Path, out: &Path) -> Outcome {
    print!("{}", export::run(&first_file(recording)?, out)?);
    Ok(ExitCode::SUCCESS)
}

fn report(recording: &Path, out: Option<&Path>) -> Outcome {
    print!("{}", report::run(&first_file(recording)?, out)?);
    Ok(ExitCode::SUCCESS)
}

fn record(args: &RecordArgs) -> Outcome {
    stage("record", &args.stage, |configuration, context| {
        let mut configuration = configuration.clone();
        args.folder.iter().for_each(|folder| configuration.record_in(folder));
        record::run(&configuration, context)
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
fn doctor(configuration: Option<&Path>) -> Outcome {
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
    use std::io::Write;
    let report = live::run(options, |line| {
        let _ = writeln!(std::io::stderr(), "deckflex live: {line}");
    })?;
    println!("{report}");
    Ok(ExitCode::SUCCESS)
}

fn stage<E: Into<Box<dyn Error>>>(
    name: &str,
    args: &StageArgs,
    run: impl Fn(&Configuration, &Context) -> Result<(), E>,
) -> Outcome {
    of_whom(name, None, args, run)
}

fn of_whom<E: Into<Box<dyn Error>>>(
    name: &str,
    area: Option<&str>,
    args: &StageArgs,
    run: impl Fn(&Configuration, &Context) -> Result<(), E>,
) -> Outcome {
    let configuration = read(&args.configuration, args.run.duration)?;
    let _log = log::start(configuration.log, args.run.log, name, area);
    run(&configuration, &context(&configuration, args)).map_err(Into::into)?;
    Ok(ExitCode::SUCCESS)
}

fn simulate(args: SimulateArgs) -> Outcome {
    let SimulateArgs { configuration, wire, wires, domain, run } = args;
    let Some(domain) = domain.filter(|_| !wire) else { return emulate(&configuration, run.duration, wires) };
    stage("simulate", &StageArgs { configuration, domain, run }, simulate::run)
}

fn emulate(path: &Path, duration: Option<Duration>, wires: WireArgs) -> Outcome {
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

fn of_area(
    name: &str,
    args: &AreaArgs,
    run: fn(&Configuration, usize, &Context) -> Result<(), TransportError>,
) -> Outcome {
    of_whom::<Box<dyn Error>>(name, Some(&args.area), &args.stage, |configuration, context| {
        let area = configuration.areas.iter().position(|area| area.name == args.area);
        let area = area.ok_or_else(|| Refusal::NoSuchArea(args.area.clone()))?;
        Ok(run(configuration, area, context)?)
    })
}

fn context(configuration: &Configuration, args: &StageArgs) -> Context {
    let RunArgs { run_id, epoch_ns, resume, .. } = args.run;
    let scheduling = launch::request(configuration.run.scheduling);
    Context { domain: args.domain.clone(), run_id, epoch_ns, resume, scheduling }
}

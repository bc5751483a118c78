//! Latency of the real process set beside a bare chain of Unix datagram sockets, idle and with every core loaded.
//!
//! `DECKFLEX_BENCH_S` is the length of each run, s. The chain has as many hops, sends messages of the same sizes by the same
//! deadlines in the same scheduling class, and does no work. Both end where the estimator stamps its output.
#![allow(clippy::print_stdout)]

use messages::{ImuPair, ImuSample, Solution, Stamps};
use runtime::scheduling::{self, Request};
use runtime::{Domain, Latency, Pacer, die_with_parent, monotonic_ns};
use std::error::Error;
use std::fs::{self, File};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::net::UnixDatagram;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// What this program is when it has been started by itself.
const ROLE: &str = "DECKFLEX_BENCH_ROLE";
const CLASS: &str = "DECKFLEX_BENCH_CLASS";
const LENGTH: &str = "DECKFLEX_BENCH_S";
const DEFAULT_S: f64 = 20.0;
const RATE_HZ: f64 = 100.0;
const PRIORITY: i32 = 40;
/// Time for the members of the chain to start, ns.
const RUN_UP_NS: i64 = 500_000_000;
/// A silence so long means that a member of the chain is gone.
const SILENCE: Duration = Duration::from_secs(10);
/// Far more than starting and ending takes.
const HUNG: Duration = Duration::from_secs(60);
/// What a child is granted to end by itself.
const GRACE: Duration = Duration::from_secs(5);

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Stage, then p50, p90, p99, p99.9 and max, us.
type Row = (String, [f64; 5]);

fn main() -> Outcome<()> {
    match std::env::var(ROLE).ok().as_deref() {
        None => compare(),
        Some("busy") => busy(),
        Some("source") => member(source),
        Some("synchronise") => member(synchronise),
        Some("estimate") => member(estimate),
        Some("sink") => member(sink),
        Some(role) => Err(format!("{ROLE}={role} is not known").into()),
    }
}

fn length_s() -> Outcome<f64> {
    match std::env::var(LENGTH) {
        Ok(text) => text.parse().ok().filter(|s| *s > 0.0).ok_or_else(|| format!("{LENGTH}={text}").into()),
        Err(_) => Ok(DEFAULT_S),
    }
}

fn compare() -> Outcome<()> {
    let length_s = length_s()?;
    let folder = tempfile::tempdir()?;
    println!("{length_s} s a run at {RATE_HZ} Hz, microseconds");
    println!(
        "{:<8} {:<8} {:<10} {:<12} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "load", "class", "chain", "stage", "p50", "p90", "p99", "p99.9", "max"
    );
    let mut fifo = true;
    for load in ["idle", "loaded"] {
        let _load = if load == "loaded" { spinners()? } else { Vec::new() };
        for class in ["normal", "auto"] {
            if class == "auto" && !fifo {
                continue;
            }
            let (set, obtained) = process_set(folder.path(), class, length_s)?;
            if class == "auto" && obtained != "fifo" {
                println!("{load:<8} fifo     not permitted here");
                fifo = false;
                continue;
            }
            let bare = datagrams(class, length_s)?;
            print(load, &obtained, "deckflex", &set);
            print(load, &obtained, "datagrams", &bare);
            let median = |rows: &[Row]| rows.iter().find(|(stage, _)| stage == "end to end").map(|(_, tail)| tail[0]);
            if let (Some(set), Some(bare)) = (median(&set), median(&bare)) {
                println!("{load:<8} {obtained:<8} ratio of the medians end to end: {:.2}", set / bare);
            }
        }
    }
    Ok(())
}

fn print(load: &str, class: &str, chain: &str, rows: &[Row]) {
    for (stage, tail) in rows {
        let tail = tail.map(|us| format!("{us:>9.1}")).join(" ");
        println!("{load:<8} {class:<8} {chain:<10} {stage:<12} {tail}");
    }
}

/// A child that ends with its owner, whatever has happened; first it may clean up after itself.
struct Owned(Child);

impl Owned {
    fn ends_well(&mut self, within: Duration) -> Outcome<()> {
        let start = Instant::now();
        loop {
            match self.0.try_wait()? {
                Some(status) if status.success() => return Ok(()),
                Some(status) => return Err(status.to_string().into()),
                None if start.elapsed() > within => return Err("it does not end".into()),
                None => thread::sleep(Duration::from_millis(20)),
            }
        }
    }
}

impl Drop for Owned {
    fn drop(&mut self) {
        if !matches!(self.0.try_wait(), Ok(None)) {
            return;
        }
        // SAFETY: the call has no preconditions; the process is a child that has not been waited for.
        unsafe { libc::kill(self.0.id() as i32, libc::SIGTERM) };
        if self.ends_well(GRACE).is_err() {
            // both fail only where it has ended
            let _ = self.0.kill();
            let _ = self.0.wait();
        }
    }
}

/// The demonstration as processes; its rows and the class that all fast stages obtained.
fn process_set(folder: &Path, class: &str, length_s: f64) -> Outcome<(Vec<Row>, String)> {
    let demo = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/demo.toml");
    // so3 has its first solution within seconds, the default only after the registration
    let so3 = "[area.estimator]\nmatching = \"so3\"\n\n[area.identifier]";
    let text = fs::read_to_string(demo)?.replacen("[run]", &format!("[run]\nscheduling = \"{class}\""), 1).replacen(
        "[area.identifier]",
        so3,
        1,
    );
    let [configuration, json, errors] = ["bench.toml", "report.json", "errors.txt"].map(|name| folder.join(name));
    fs::write(&configuration, text)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_deckflex"));
    command.arg("launch").arg(&configuration).arg("--json").arg(&json);
    command.args(["--duration", &format!("{}ms", (length_s * 1e3).round())]);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(File::create(&errors)?);
    let ended = Owned(command.spawn()?).ends_well(Duration::from_secs_f64(length_s) + HUNG);
    if let Err(error) = ended {
        // its stages have been told to end; what a killed launcher leaves behind would stay until the next launch
        thread::sleep(GRACE / 5);
        Domain::sweep()?;
        return Err(format!("launch: {error}: {}", fs::read_to_string(&errors)?).into());
    }
    let report: serde_json::Value = serde_json::from_str(&fs::read_to_string(&json)?)?;
    let tail = |row: &serde_json::Value| {
        ["p50_us", "p90_us", "p99_us", "p999_us", "max_us"].map(|key| row[key].as_f64().unwrap_or(f64::NAN))
    };
    let list = |key: &str| report[key].as_array().cloned().unwrap_or_default();
    let named = |row: &serde_json::Value| (row["name"].as_str().unwrap_or_default().to_owned(), tail(row));
    let mut rows: Vec<Row> = list("stages").iter().map(named).collect();
    // in a short run the identifier gives nothing
    rows.retain(|(_, tail)| tail[4] > 0.0);
    rows.extend(list("end_to_end").iter().map(|row| ("end to end".to_owned(), tail(row))));
    Ok((rows, report["scheduling"].as_str().unwrap_or_default().to_owned()))
}

/// This program in another role.
fn myself(role: &str) -> Outcome<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    command.env(ROLE, role).stdin(Stdio::null());
    Ok(command)
}

/// One busy process for each core.
fn spinners() -> Outcome<Vec<Owned>> {
    (0..thread::available_parallelism()?.get()).map(|_| Ok(Owned(myself("busy")?.spawn()?))).collect()
}

fn busy() -> Outcome<()> {
    die_with_parent()?;
    loop {
        std::hint::spin_loop();
    }
}

/// The bare chain: four processes and three pairs of sockets.
fn datagrams(class: &str, length_s: f64) -> Outcome<Vec<Row>> {
    let mut members = Vec::new();
    let mut input = Stdio::null();
    for role in ["source", "synchronise", "estimate"] {
        let (near, far) = UnixDatagram::pair()?;
        let mut command = myself(role)?;
        command.env(CLASS, class).env(LENGTH, length_s.to_string());
        command.stdin(input).stdout(OwnedFd::from(near));
        members.push((role, Owned(command.spawn()?)));
        input = OwnedFd::from(far).into();
    }
    let mut command = myself("sink")?;
    command.env(CLASS, "normal").stdin(input).stdout(Stdio::piped());
    let mut sink = Owned(command.spawn()?);
    // ends with the sink, which ends by itself when nothing comes any more
    let text = sink.0.stdout.take().map(std::io::read_to_string).transpose()?.unwrap_or_default();
    members.push(("sink", sink));
    for (role, member) in &mut members {
        member.ends_well(GRACE).map_err(|error| format!("{role} of the bare chain: {error}"))?;
    }
    Ok(serde_json::from_str(&text)?)
}

/// Standard input or output as a socket.
fn socket(descriptor: BorrowedFd) -> Outcome<UnixDatagram> {
    let socket = UnixDatagram::from(descriptor.try_clone_to_owned()?);
    socket.set_read_timeout(Some(SILENCE))?;
    Ok(socket)
}

fn member(body: fn() -> Outcome<()>) -> Outcome<()> {
    die_with_parent()?;
    let request = if std::env::var(CLASS).as_deref() == Ok("auto") { Request::Auto } else { Request::Normal };
    scheduling::apply(request, PRIORITY);
    body()
}

fn source() -> Outcome<()> {
    let output = socket(std::io::stdout().as_fd())?;
    let pacer = Pacer::new(monotonic_ns() + RUN_UP_NS, RATE_HZ);
    for k in 0..(length_s()? * RATE_HZ) as u64 {
        pacer.wait(k);
        let mut sample = ImuSample::default();
        sample.header.stamps = Stamps { due_ns: pacer.due_ns(k), source_ns: monotonic_ns(), ..Stamps::default() };
        send(&output, &sample)?;
    }
    let mut end = ImuSample::default();
    end.header.end = 1;
    send(&output, &end)
}

fn synchronise() -> Outcome<()> {
    relay(|sample: ImuSample| {
        let mut pair = ImuPair { header: sample.header, ..ImuPair::default() };
        pair.header.stamps.pair_ns = monotonic_ns();
        pair
    })
}

fn estimate() -> Outcome<()> {
    relay(|pair: ImuPair| {
        let mut solution = Solution { header: pair.header, ..Solution::default() };
        solution.header.stamps.solution_ns = monotonic_ns();
        solution
    })
}

fn relay<In: messages::Message, Out: messages::Message>(make: fn(In) -> Out) -> Outcome<()> {
    let (input, output) = (socket(std::io::stdin().as_fd())?, socket(std::io::stdout().as_fd())?);
    loop {
        let message = make(receive(&input)?);
        send(&output, &message)?;
        if message.header().is_end() {
            return Ok(());
        }
    }
}

fn sink() -> Outcome<()> {
    let input = socket(std::io::stdin().as_fd())?;
    let mut latencies: [Latency; 5] = std::array::from_fn(|_| Latency::new());
    loop {
        let solution: Solution = receive(&input)?;
        if solution.header.is_end() {
            break;
        }
        let Stamps { due_ns, source_ns, pair_ns, solution_ns, .. } = solution.header.stamps;
        let times = [source_ns - due_ns, pair_ns - source_ns, solution_ns - pair_ns, monotonic_ns() - solution_ns];
        latencies.iter_mut().zip(times).for_each(|(latency, ns)| latency.record(ns));
        latencies[4].record(solution_ns - due_ns);
    }
    let stages = ["source", "synchronise", "estimate", "sink", "end to end"].into_iter();
    let figures = latencies.iter().map(Latency::summary).map(|s| [s.p50_us, s.p90_us, s.p99_us, s.p999_us, s.max_us]);
    println!("{}", serde_json::to_string(&stages.zip(figures).collect::<Vec<_>>())?);
    Ok(())
}

fn send<M: messages::Message>(socket: &UnixDatagram, message: &M) -> Outcome<()> {
    // SAFETY: the bytes of a message that lives through the call; the kernel only copies them.
    let bytes = unsafe { std::slice::from_raw_parts((message as *const M).cast::<u8>(), size_of::<M>()) };
    socket.send(bytes)?;
    Ok(())
}

fn receive<M: messages::Message>(socket: &UnixDatagram) -> Outcome<M> {
    let mut message = M::default();
    // SAFETY: the bytes of a message that is not used meanwhile; it is plain numbers, all of whose bit patterns are valid.
    let bytes = unsafe { std::slice::from_raw_parts_mut((&raw mut message).cast::<u8>(), size_of::<M>()) };
    match socket.recv(bytes)? {
        n if n == size_of::<M>() => Ok(message),
        n => Err(format!("a message of {n} bytes").into()),
    }
}

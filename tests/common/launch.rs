//! A launch as a process, with its stages seen from outside.

use super::Place;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// After so long something hangs: far more than a loaded host needs, and never a measure of speed.
const HUNG: Duration = Duration::from_secs(120);

static ALONE: Mutex<()> = Mutex::new(());

/// Held by each test while it runs processes.
pub fn one_at_a_time() -> MutexGuard<'static, ()> {
    // what a failed test leaves does not concern the next one
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A running launch; dropped, it is killed.
pub struct Launch {
    child: Child,
    out: PathBuf,
    json: PathBuf,
    errors: PathBuf,
    over: Arc<AtomicBool>,
    domains: Option<JoinHandle<BTreeSet<PathBuf>>>,
}

/// A launch that has ended.
pub struct Ended {
    pub status: ExitStatus,
    pub out: PathBuf,
    pub errors: String,
    /// `None` where it was killed.
    pub report: Option<Value>,
    /// Roots of all the domains that it ever had.
    pub domains: BTreeSet<PathBuf>,
}

/// A process seen in `/proc`.
pub struct Process {
    pub pid: u32,
    pub arguments: Vec<String>,
}

impl Launch {
    /// `deckflex launch`, its output in the folder `name` of the place.
    pub fn start(place: &Place, name: &str, configuration: &Path, duration: Option<&str>) -> Self {
        Self::start_with(place, name, configuration, duration, &[])
    }

    /// With further arguments.
    pub fn start_with(place: &Place, name: &str, configuration: &Path, duration: Option<&str>, more: &[&str]) -> Self {
        let out = place.path(name);
        fs::create_dir(&out).unwrap();
        let (json, errors) = (out.join("report.json"), out.join("errors.txt"));
        let mut command = place.deckflex();
        command.arg("launch").arg(configuration).arg("--json").arg(&json).arg("--out").arg(&out);
        command.args(duration.iter().flat_map(|duration| ["--duration", duration])).args(more);
        // a file, since a pipe would stay open as long as one of the stages lives
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(File::create(&errors).unwrap());
        let child = command.spawn().unwrap();
        let over = Arc::new(AtomicBool::new(false));
        let domains = watch_domains(child.id(), place.path("run"), Arc::clone(&over));
        Self { child, out, json, errors, over, domains: Some(domains) }
    }

    pub fn pid(&self) -> u32 {
        self.child.id()
    }

    pub fn out(&self) -> &Path {
        &self.out
    }

    /// The stages that run now.
    pub fn stages(&self) -> Vec<Process> {
        processes().into_iter().filter(|process| parent_of(process.pid) == Some(self.pid())).collect()
    }

    /// The process of a stage, as soon as there is one other than `before`.
    pub fn stage(&mut self, name: &str, before: Option<u32>) -> u32 {
        self.eventually(name, |launch| {
            let mut stages = launch.stages().into_iter();
            let is_it = |s: &Process| s.arguments.get(1).is_some_and(|stage| stage == name) && Some(s.pid) != before;
            stages.find(is_it).map(|stage| stage.pid)
        })
    }

    /// The heading and the last whole row that have reached an area's file by now.
    pub fn written(&self, area: &str) -> Option<String> {
        let text = fs::read_to_string(pipeline::solution_file::path(&self.out, area)).ok()?;
        let (whole, _) = text.rsplit_once('\n')?;
        let (heading, rows) = whole.split_once('\n')?;
        Some(format!("{heading}\n{}\n", rows.lines().last()?))
    }

    /// Waits until something can be seen; fails when the launch ends before.
    pub fn eventually<T>(&mut self, what: &str, mut seen: impl FnMut(&Self) -> Option<T>) -> T {
        let start = Instant::now();
        loop {
            if let Some(seen) = seen(self) {
                return seen;
            }
            if let Some(status) = self.child.try_wait().unwrap() {
                panic!("the launch ended ({status}) before there was {what}: {}", self.errors());
            }
            assert!(start.elapsed() < HUNG, "no {what}: {}", self.errors());
            thread::sleep(Duration::from_millis(1));
        }
    }

    pub fn signal(&self, signal: i32) {
        send(self.pid(), signal);
    }

    /// Waits for the launch to end by itself, or by a signal that has been sent to it.
    pub fn end(mut self) -> Ended {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(start.elapsed() < HUNG, "the launch does not end: {}", self.errors());
            thread::sleep(Duration::from_millis(2));
        };
        self.over.store(true, Ordering::Relaxed);
        let domains = self.domains.take().unwrap().join().unwrap();
        let report = fs::read_to_string(&self.json).ok().map(|text| serde_json::from_str(&text).unwrap());
        Ended { status, out: self.out.clone(), errors: self.errors(), report, domains }
    }

    /// What stands on the error output by now.
    pub fn errors(&self) -> String {
        fs::read_to_string(&self.errors).unwrap()
    }
}

impl Drop for Launch {
    fn drop(&mut self) {
        // both fail only where it has ended
        let _ = self.child.kill();
        let _ = self.child.wait();
        self.over.store(true, Ordering::Relaxed);
    }
}

impl Ended {
    /// The report of a launch that ended well and left nothing behind.
    pub fn well(&self) -> &Value {
        assert!(self.status.success(), "{}: {}", self.status, self.errors);
        assert!(!self.domains.is_empty(), "the test has not seen a domain");
        self.assert_nothing_left();
        let report = self.report.as_ref().unwrap();
        assert_eq!(report["cut_short"], false, "{}", self.errors);
        report
    }

    /// Of all its domains neither the root nor a file in shared memory may be left.
    pub fn assert_nothing_left(&self) {
        for root in &self.domains {
            assert!(!root.exists(), "{} is left: {}", root.display(), self.errors);
            assert_eq!(in_shared_memory(root), Vec::<PathBuf>::new(), "{}", self.errors);
        }
    }

    /// What stands on the error output and is no line of the log: errors, panics.
    pub fn not_logged(&self) -> String {
        let levels = ["DEBUG ", "INFO  ", "WARN  "];
        let is_logged =
            |line: &&str| line.split_once("Z ").is_some_and(|(_, rest)| levels.iter().any(|l| rest.starts_with(l)));
        self.errors.lines().filter(|line| !is_logged(line)).collect()
    }

    /// The lines of the log of a process (`estimate/radar`) at a level that hold all of the words.
    pub fn logged(&self, level: &str, process: &str, words: &[&str]) -> Vec<&str> {
        let begin = format!("Z {level:<5} {process}: ");
        let holds = |line: &&str| line.contains(&begin) && words.iter().all(|word| line.contains(word));
        self.errors.lines().filter(holds).collect()
    }

    pub fn solutions(&self, area: &str) -> String {
        fs::read_to_string(pipeline::solution_file::path(&self.out, area)).unwrap()
    }
}

/// The number under a key of a report's row of a stage.
pub fn of_stage(report: &Value, stage: &str, key: &str) -> u64 {
    let rows = report["stages"].as_array().unwrap();
    rows.iter().filter(|row| row["name"] == stage).map(|row| row[key].as_u64().unwrap()).sum()
}

/// Files of a domain in shared memory.
pub fn in_shared_memory(root: &Path) -> Vec<PathBuf> {
    let prefix = format!("{}_", root.file_name().unwrap().to_str().unwrap());
    let files = fs::read_dir("/dev/shm").unwrap().flatten().map(|entry| entry.path());
    files.filter(|path| path.file_name().unwrap().to_string_lossy().starts_with(&prefix)).collect()
}

/// All processes whose command line can be read; one that has ended has none.
pub fn processes() -> Vec<Process> {
    let read = |entry: fs::DirEntry| {
        let pid = entry.file_name().to_str()?.parse().ok()?;
        let line = fs::read_to_string(entry.path().join("cmdline")).ok().filter(|line| !line.is_empty())?;
        Some(Process { pid, arguments: line.trim_end_matches('\0').split('\0').map(str::to_owned).collect() })
    };
    fs::read_dir("/proc").unwrap().flatten().filter_map(read).collect()
}

fn parent_of(pid: u32) -> Option<u32> {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    status.lines().find_map(|line| line.strip_prefix("PPid:"))?.trim().parse().ok()
}

/// Sends a signal to a process of the test.
pub fn send(pid: u32, signal: i32) {
    // SAFETY: the call has no preconditions; the process is a child, or a child's child that its parent has not waited for.
    assert_eq!(unsafe { libc::kill(pid as i32, signal) }, 0, "signal {signal} to {pid}");
}

/// Collects the roots of the domains that a process owns, for as long as it runs.
fn watch_domains(owner: u32, run: PathBuf, over: Arc<AtomicBool>) -> JoinHandle<BTreeSet<PathBuf>> {
    thread::spawn(move || {
        let mut seen = BTreeSet::new();
        while !over.load(Ordering::Relaxed) {
            for base in fs::read_dir(&run).into_iter().flatten().flatten() {
                let roots = fs::read_dir(base.path()).into_iter().flatten().flatten().map(|entry| entry.path());
                seen.extend(roots.filter(|root| owner_of(root) == Some(owner)));
            }
            thread::sleep(Duration::from_millis(5));
        }
        seen
    })
}

fn owner_of(root: &Path) -> Option<u32> {
    fs::read_to_string(root.join("owner")).ok()?.split_whitespace().next()?.parse().ok()
}

//! Real processes, some of them killed. This executable starts itself again as the other process, which runs the test `child`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use messages::topic::{self, Topic};
use messages::{Header, ImuSample};
use runtime::{Anchor, Domain, Node, Publisher, Sequence, Stop, Subscriber, Waiter, die_with_parent};
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

const ROLE: &str = "DECKFLEX_TEST_ROLE";
const DOMAIN: &str = "DECKFLEX_TEST_DOMAIN";
const LONG: Duration = Duration::from_secs(20);
const MARK: &str = "child says ";

fn sample(run_id: u64, k: u64) -> ImuSample {
    let header = Header { run_id, sequence: k, ..Header::default() };
    ImuSample { header, dvel: [0.25 * k as f64; 3], ..ImuSample::default() }
}

fn imu() -> Topic<ImuSample> {
    topic::area_imu("aft")
}

struct Process {
    child: Child,
    out: BufReader<ChildStdout>,
}

impl Process {
    fn start(role: &str, domain: &Path) -> Self {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["child", "--exact", "--nocapture"])
            .env(ROLE, role)
            .env(DOMAIN, domain)
            .env_remove("IOX2_LOG_LEVEL")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let out = BufReader::new(child.stdout.take().unwrap());
        Self { child, out }
    }

    /// The next thing that the child says.
    fn hear(&mut self) -> String {
        let mut line = String::new();
        while self.out.read_line(&mut line).unwrap() > 0 {
            if let Some((_, said)) = line.trim_end().split_once(MARK) {
                return said.to_owned();
            }
            line.clear();
        }
        panic!("the child ended without a word: {}", self.errors());
    }

    fn errors(&mut self) -> String {
        let mut text = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut text).unwrap();
        text
    }

    fn signal(&self, signal: i32) {
        // SAFETY: the child is ours and not waited for yet.
        assert_eq!(unsafe { libc::kill(self.child.id() as i32, signal) }, 0);
    }

    fn kill(mut self) {
        self.signal(libc::SIGKILL);
        self.child.wait().unwrap();
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn say(what: &str) {
    println!("\n{MARK}{what}");
}

/// Not a test, but what the other processes do.
#[test]
fn child() {
    let Ok(role) = std::env::var(ROLE) else { return };
    let root = PathBuf::from(std::env::var_os(DOMAIN).unwrap());
    die_with_parent().unwrap();
    match role.as_str() {
        "owner" => {
            let domain = Domain::create().unwrap();
            let node = Node::open(&domain, "owner").unwrap();
            let _writer = Publisher::open(&node, &imu()).unwrap();
            say(domain.root().to_str().unwrap());
            std::thread::sleep(LONG);
        }
        "writer" => write(&root, 500, Duration::ZERO),
        "endless writer" => write(&root, u64::MAX, Duration::from_millis(1)),
        "reader" => {
            let domain = Domain::open(&root).unwrap();
            let node = Node::open(&domain, "reader").unwrap();
            let reader = Subscriber::open(&node, &imu()).unwrap();
            let mut waiter = Waiter::new();
            let mut first = true;
            loop {
                waiter.wait(&[&reader], LONG).unwrap();
                while reader.take().unwrap().is_some() {
                    if std::mem::take(&mut first) {
                        say("reading");
                    }
                }
            }
        }
        "stillborn reader" => {
            let domain = Domain::open(&root).unwrap();
            let node = Node::open(&domain, "stillborn reader").unwrap();
            say("ready");
            // the first file of over a kilobyte is the connection to the writer, and setting its size ends the process
            let limit = libc::rlimit { rlim_cur: 1024, rlim_max: 1024 };
            // SAFETY: the limit lives through the call.
            assert_eq!(unsafe { libc::setrlimit(libc::RLIMIT_FSIZE, &limit) }, 0);
            let _reader = Subscriber::open(&node, &imu()).unwrap();
            panic!("it lives");
        }
        "parent" => {
            let mut orphan = Process::start("orphan", &root);
            say(&orphan.hear());
            std::thread::sleep(LONG);
        }
        "orphan" => {
            let stop = Stop::install().unwrap();
            let domain = Domain::open(&root).unwrap();
            let node = Node::open(&domain, "orphan").unwrap();
            let writer = Publisher::open(&node, &imu()).unwrap();
            say("ready");
            let deadline = Instant::now() + LONG;
            while !stop.requested() && Instant::now() < deadline {
                Waiter::new().wait(&[], Duration::from_millis(50)).unwrap();
            }
            writer.publish(&sample(u64::from(stop.requested()), 1)).unwrap();
        }
        other => panic!("no such role: {other}"),
    }
}

/// Waits for a reader, sends `count` samples and the mark of the end, and stays until it is stopped.
fn write(root: &Path, count: u64, pause: Duration) {
    let stop = Stop::install().unwrap();
    let domain = Domain::open(root).unwrap();
    let node = Node::open(&domain, "writer").unwrap();
    let writer = Publisher::open(&node, &imu()).unwrap();
    say("ready");
    let run_id = u64::from(std::process::id());
    let mut k = 0;
    while k < count && !stop.requested() {
        if writer.publish(&sample(run_id, k)).unwrap() > 0 || k > 0 {
            k += 1;
        }
        Waiter::new().wait(&[], pause).unwrap();
    }
    let mut end = sample(run_id, k);
    end.header.end = 1;
    writer.publish(&end).unwrap();
    // A reader that has not been scheduled since the writer came would get nothing of one that is gone already.
    let deadline = Instant::now() + LONG;
    while !stop.requested() && Instant::now() < deadline {
        Waiter::new().wait(&[], Duration::from_millis(20)).unwrap();
    }
}

/// Takes until the end of the stream or until `enough` samples have come.
fn read(reader: &Subscriber<ImuSample>, enough: usize) -> Vec<ImuSample> {
    let mut waiter = Waiter::new();
    let mut taken = Vec::new();
    let deadline = Instant::now() + LONG;
    while taken.len() < enough {
        assert!(Instant::now() < deadline, "only {} samples came", taken.len());
        waiter.wait(&[reader], Duration::from_secs(1)).unwrap();
        while let Some(message) = reader.take().unwrap() {
            taken.push(message);
            if message.header.is_end() {
                return taken;
            }
        }
    }
    taken
}

#[test]
fn a_stream_crosses_processes_whole() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "reader").unwrap();
    let reader = Subscriber::open(&node, &imu()).unwrap();
    let mut writer = Process::start("writer", domain.root());
    writer.hear();
    let taken = read(&reader, usize::MAX);
    let run_id = u64::from(writer.child.id());
    let sent: Vec<ImuSample> = (0..500).map(|k| sample(run_id, k)).collect();
    assert!(taken.len() == 501 && taken[..500] == sent, "{} came", taken.len());
    writer.signal(libc::SIGTERM);
    let errors = writer.errors();
    assert!(writer.child.wait().unwrap().success(), "{errors}");
    assert_eq!(errors, "", "the transport has nothing to say when all is well");
}

#[test]
fn a_killed_writer_is_replaced_and_the_reader_goes_on() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "reader").unwrap();
    let reader = Subscriber::open(&node, &imu()).unwrap();
    let mut sequence = Sequence::default();
    for generation in 0..4 {
        let mut writer = Process::start("endless writer", domain.root());
        writer.hear();
        let run_id = u64::from(writer.child.id());
        let taken = read(&reader, 50);
        for message in &taken {
            sequence.see(&message.header);
        }
        assert_eq!(taken[0], sample(run_id, 0), "generation {generation}");
        std::thread::sleep(Duration::from_millis(30));
        writer.kill();
        // What it had sent is still there, in order and without a gap.
        let mut rest = 0;
        while let Some(message) = reader.take().unwrap() {
            sequence.see(&message.header);
            assert_eq!(message.header.run_id, run_id);
            rest += 1;
        }
        assert!(rest > 0);
        assert_eq!(sequence.lost(), 0, "generation {generation}");
    }
}

#[test]
fn killed_readers_neither_stop_the_writer_nor_keep_their_places() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "writer").unwrap();
    let writer = Publisher::open(&node, &imu()).unwrap();
    let mut k = 0;
    let mut send = || {
        writer.publish(&sample(1, k)).unwrap();
        k += 1;
    };
    // More than a topic has places.
    for _ in 0..10 {
        let mut process = Process::start("reader", domain.root());
        std::thread::scope(|scope| {
            let heard = scope.spawn(|| process.hear());
            while !heard.is_finished() {
                send();
                std::thread::sleep(Duration::from_millis(1));
            }
            assert_eq!(heard.join().unwrap(), "reading");
        });
        process.kill();
        let start = Instant::now();
        (0..3000).for_each(|_| send());
        assert!(start.elapsed() < LONG, "the dead reader blocks the writer");
    }
}

/// Its connection to the writer exists and has no size, for which the transport would wait for ever.
#[test]
fn a_reader_killed_in_the_middle_of_connecting_holds_nobody_up() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "writer").unwrap();
    let writer = Publisher::open(&node, &imu()).unwrap();
    let mut stillborn = Process::start("stillborn reader", domain.root());
    stillborn.hear();
    let errors = stillborn.errors();
    assert_eq!(stillborn.child.wait().unwrap().signal(), Some(libc::SIGXFSZ), "{errors}");
    let (done, next) = std::sync::mpsc::channel();
    let root = domain.root().to_owned();
    std::thread::spawn(move || {
        let domain = Domain::open(&root).unwrap();
        let node = Node::open(&domain, "next reader").unwrap();
        let reader = Subscriber::open(&node, &imu()).unwrap();
        done.send("open").unwrap();
        read(&reader, 5);
        done.send("reading").unwrap();
    });
    assert_eq!(next.recv_timeout(LONG), Ok("open"), "the next reader hangs");
    let deadline = Instant::now() + LONG;
    let mut k = 0;
    while next.try_recv() != Ok("reading") && Instant::now() < deadline {
        writer.publish(&sample(1, k)).unwrap();
        k += 1;
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(Instant::now() < deadline, "the next reader gets nothing");
}

#[test]
fn a_sweep_removes_what_a_dead_owner_left_and_nothing_else() {
    let mine = Domain::create().unwrap();
    let node = Node::open(&mine, "node").unwrap();
    let writer = Publisher::open(&node, &imu()).unwrap();
    let mut living = Process::start("owner", Path::new(""));
    let living_root = PathBuf::from(living.hear());
    let mut dying = Process::start("owner", Path::new(""));
    let root = PathBuf::from(dying.hear());
    let domain = Domain::open(&root).unwrap();
    assert!(domain.leftovers().len() > 1, "root and shared memory");
    dying.kill();
    assert!(domain.leftovers().len() > 1, "a killed owner cannot clean up");
    assert!(Domain::open(&root).is_err(), "nobody may join the domain of a dead owner");

    Domain::sweep().unwrap();
    assert_eq!(domain.leftovers(), Vec::<PathBuf>::new());
    assert!(Domain::open(&living_root).unwrap().leftovers().len() > 1);
    assert!(Domain::open(mine.root()).is_ok());
    let reader = Subscriber::open(&node, &imu()).unwrap();
    writer.publish(&sample(1, 1)).unwrap();
    assert_eq!(reader.take().unwrap(), Some(sample(1, 1)));
    living.kill();
    Domain::sweep().unwrap();
    assert!(!living_root.exists());
}

#[test]
fn sigterm_ends_a_stage_in_good_order() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "reader").unwrap();
    let reader = Subscriber::open(&node, &imu()).unwrap();
    let mut writer = Process::start("endless writer", domain.root());
    writer.hear();
    read(&reader, 5);
    writer.signal(libc::SIGTERM);
    assert!(read(&reader, usize::MAX).last().unwrap().header.is_end());
    assert!(writer.child.wait().unwrap().success());
}

#[test]
fn a_stage_does_not_outlive_its_parent() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "reader").unwrap();
    let reader = Subscriber::open(&node, &imu()).unwrap();
    let mut parent = Process::start("parent", domain.root());
    assert_eq!(parent.hear(), "ready");
    assert_eq!(reader.take().unwrap(), None);
    parent.kill();
    let last = read(&reader, 1);
    assert_eq!(last[0].header.run_id, 1, "it stopped because it was asked to");
}

/// Without the anchor a kill in the middle of creating a topic poisons the domain sooner or later.
#[test]
fn anchored_topics_survive_kills_at_any_moment_of_the_start() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "launcher").unwrap();
    let _anchor = Anchor::open(&node, &imu()).unwrap();
    for k in 0..60 {
        let process = Process::start("endless writer", domain.root());
        std::thread::sleep(Duration::from_micros(k * 7919 % 40_000));
        process.kill();
        let visitor = Node::open(&domain, "visitor").unwrap();
        Subscriber::open(&visitor, &imu()).unwrap();
        Publisher::open(&visitor, &imu()).unwrap();
    }
}

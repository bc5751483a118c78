//! Files by size, the budget, a disk that refuses, and a recorder that takes over from another.
#![allow(clippy::unwrap_used)]

use super::*;
use crossbeam::channel::bounded;
use messages::ImuSample;
use recording::Reader;
use std::fmt::{self, Write};
use std::sync::Mutex;
use tempfile::TempDir;
use tracing::field::{Field, Visit};
use tracing::span::{self, Attributes, Id};
use tracing::{Event, Metadata, Subscriber};

const RUN: u64 = 0x1a2b;
const TOPICS: [&str; 1] = ["main/imu"];

/// What was said, by all tests of this process.
static SAID: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Keeps the words and fields of every event.
struct Listener;

struct Line(String);

impl Visit for Line {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        write!(self.0, "{}={value:?} ", field.name()).unwrap();
    }
}

impl Subscriber for Listener {
    fn enabled(&self, _: &Metadata<'_>) -> bool {
        true
    }

    fn event(&self, event: &Event<'_>) {
        let mut line = Line(String::new());
        event.record(&mut line);
        SAID.lock().unwrap().push(line.0);
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &span::Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

fn listen() {
    // by whichever test comes first
    let _ = tracing::subscriber::set_global_default(Listener);
}

fn said(words: &[&str]) -> bool {
    SAID.lock().unwrap().iter().any(|line| words.iter().all(|word| line.contains(word)))
}

fn settings(folder: &Path, rotate: f64) -> RecordSettings {
    RecordSettings { chunk: 2000.0, flush_s: 0.05, rotate, ..RecordSettings::new(folder) }
}

fn disk(settings: RecordSettings) -> (Disk, Arc<Tally>) {
    let tally = Arc::new(Tally::default());
    let about = About { run_id: RUN, from_the_start: true, configuration: "x".into(), ..About::default() };
    let launched = SystemTime::UNIX_EPOCH + Duration::from_secs(1_800_000_000);
    let topics = TOPICS.map(str::to_owned).to_vec();
    listen();
    (Disk::open(Plan { settings, about, launched, topics }, Arc::clone(&tally)), tally)
}

fn sample(number: u64) -> Item {
    let mut sample = ImuSample::default();
    sample.header.sequence = number;
    Item::Message { topic: 0, time_ns: number, record: sample.into() }
}

/// Has the disk thread's work done on samples of these numbers, each its own cycle.
fn work(disk: &mut Disk, numbers: std::ops::Range<u64>) {
    let (to_disk, items) = bounded(10_000);
    for number in numbers {
        to_disk.send(sample(number)).unwrap();
        to_disk.send(Item::Mark).unwrap();
    }
    drop(to_disk);
    disk.work(&items);
}

/// The run's files in order: about, sample numbers, ending.
fn files(folder: &Path) -> Vec<(About, Vec<u64>, Option<Ending>)> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let read = |path: PathBuf| {
        assert!(path.to_str().unwrap().contains("20270115T080000Z-1a2b_"), "{}", path.display());
        let bytes = fs::read(&path).unwrap();
        let (mut about, mut numbers, mut ending) = (None, Vec::new(), None);
        for event in Reader::new(bytes.as_slice()) {
            match event {
                recording::Event::Metadata(m) => {
                    about = about.or(About::from_metadata(&m.name, &m.metadata));
                    ending = ending.or(Ending::from_metadata(&m.name, &m.metadata));
                }
                recording::Event::Message(message) => {
                    numbers.push(message.record().unwrap().unwrap().header().sequence)
                }
            }
        }
        (about.unwrap(), numbers, ending)
    };
    paths.into_iter().map(read).collect()
}

#[test]
fn files_are_begun_by_size_and_each_opens_by_itself() {
    let folder = TempDir::new().unwrap();
    let (mut disk, tally) = disk(settings(folder.path(), 50_000.0));
    work(&mut disk, 0..1000);
    disk.finish(true);
    let files = files(folder.path());
    assert!(files.len() > 2, "{} files", files.len());
    let all: Vec<u64> = files.iter().flat_map(|(_, numbers, _)| numbers.clone()).collect();
    assert!(all.iter().copied().eq(0..1000));
    for (part, (about, _, ending)) in files.iter().enumerate() {
        assert_eq!((about.part, about.from_the_start, about.run_id), (part as u64, part == 0, RUN));
        let end_of_run = part + 1 == files.len();
        assert_eq!(*ending, Some(Ending { end_of_run, dropped: 0, lost: 0 }));
    }
    let mut health = messages::Health::default();
    tally.tell(&mut health);
    assert_eq!((health.given, health.overflow), (1000, 0));
}

#[test]
fn the_oldest_files_go_to_keep_the_budget() {
    let folder = TempDir::new().unwrap();
    let (mut disk, _) = disk(RecordSettings { budget: Some(150_000.0), ..settings(folder.path(), 50_000.0) });
    for begin in (0..4000).step_by(100) {
        work(&mut disk, begin..begin + 100);
        let total: u64 = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().metadata().unwrap().len()).sum();
        // a file is closed when it has passed its size, by a chunk and its index at most
        assert!(total < 150_000 + 3 * 10_000, "{total} bytes");
    }
    disk.finish(true);
    let files = files(folder.path());
    assert!(files.len() >= 2 && files[0].0.part > 3, "{} files from {} on", files.len(), files[0].0.part);
    let all: Vec<u64> = files.iter().flat_map(|(_, numbers, _)| numbers.clone()).collect();
    assert!(all.iter().copied().eq(all[0]..4000), "the newest are all there");
    assert!(said(&["removed", "_000.mcap", "budget_mb"]));
}

/// The folder cannot be made, since a file stands in its place.
#[test]
fn a_disk_that_refuses_is_tried_again_and_what_was_dropped_is_counted() {
    let place = TempDir::new().unwrap();
    let folder = place.path().join("records");
    fs::write(&folder, "").unwrap();
    let (mut disk, tally) = disk(settings(&folder, 50_000.0));
    work(&mut disk, 0..100);
    assert_eq!(tally.dropped(), 100);
    assert!(said(&["cannot write", "records", "dropped"]));
    assert_eq!(tally.files(), 0);
    fs::remove_file(&folder).unwrap();
    std::thread::sleep(RETRY);
    work(&mut disk, 100..150);
    disk.finish(true);
    let files = files(&folder);
    assert_eq!(files.len(), 1);
    let (about, numbers, ending) = &files[0];
    // the message that came with the mark that opened the file was refused too
    assert!(numbers.iter().copied().eq(101..150), "{numbers:?}");
    assert!(!about.from_the_start, "samples are missing before it");
    assert_eq!(*ending, Some(Ending { end_of_run: true, dropped: 101, lost: 0 }));
    assert!(said(&["goes on", "records", "dropped=101"]));
    assert_eq!(tally.files(), 1);
}

#[test]
fn a_recorder_that_takes_over_goes_on_behind_the_files_of_the_one_before() {
    let folder = TempDir::new().unwrap();
    let (mut first, _) = disk(settings(folder.path(), 50_000.0));
    work(&mut first, 0..30);
    // it dies: nothing is completed
    std::mem::forget(first);
    let (mut second, _) = disk(settings(folder.path(), 50_000.0));
    work(&mut second, 40..60);
    second.finish(true);
    let files = files(folder.path());
    assert_eq!(files.len(), 2);
    assert!(files[0].1.len() >= 10 && files[0].2.is_none(), "whole chunks and no end");
    assert!(files[1].1.iter().copied().eq(40..60) && files[1].0.part == 1 && !files[1].0.from_the_start);
}

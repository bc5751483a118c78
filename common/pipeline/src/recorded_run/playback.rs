//! The samples of a recorded run, one main sample at a time, as the source handed them out.

use super::Files;
use crate::configuration::Configuration;
use crate::recording::RecordingError;
use crate::source::Batch;
use frames::unit::nanoseconds;
use messages::{ClockDomain, Header, ImuSample, MainAttitude, Stamps, Truth, topic};
use recording::Record;
use std::collections::{HashMap, VecDeque};
use std::path::Path;

/// What belongs to a main sample may stand so many main samples behind it: the recorder takes one topic after the other, of each as
/// many messages as have come, which are at most those that a topic holds.
const LOOK_AHEAD: usize = 4096;

/// Plays a recorded run's samples back.
pub struct Playback {
    files: Files,
    wanted: HashMap<String, Stream>,
    mains: VecDeque<ImuSample>,
    attitudes: VecDeque<MainAttitude>,
    areas: Vec<AreaStreams>,
    run_id: u64,
    duration_ns: i64,
    begin_ns: Option<i64>,
    stopped: bool,
}

#[derive(Clone, Copy)]
enum Stream {
    Main,
    Attitude,
    Sub(usize),
    Truth(usize),
}

#[derive(Default)]
struct AreaStreams {
    samples: VecDeque<ImuSample>,
    truths: VecDeque<Truth>,
}

impl Playback {
    /// Opens the run; areas are found by their names.
    ///
    /// # Errors
    /// The file cannot be read or is no recorded run.
    pub fn open(path: &Path, configuration: &Configuration, run_id: u64) -> Result<Self, RecordingError> {
        let mut wanted = HashMap::new();
        wanted.insert(topic::main_imu().name, Stream::Main);
        wanted.insert(topic::main_attitude().name, Stream::Attitude);
        for (index, area) in configuration.areas.iter().enumerate() {
            wanted.insert(topic::area_imu(&area.name).name, Stream::Sub(index));
            wanted.insert(topic::truth(&area.name).name, Stream::Truth(index));
        }
        Ok(Self {
            files: Files::open(path)?,
            wanted,
            mains: VecDeque::new(),
            attitudes: VecDeque::new(),
            areas: configuration.areas.iter().map(|_| AreaStreams::default()).collect(),
            run_id,
            duration_ns: configuration.run.duration_s.map_or(i64::MAX, nanoseconds),
            begin_ns: None,
            stopped: false,
        })
    }

    /// Whether the recorded streams have been played to their ends.
    pub fn whole(&self) -> bool {
        !self.stopped && self.files.ending().is_some_and(|ending| ending.end_of_run)
    }

    /// How many messages could not be read.
    pub fn unreadable(&self) -> u64 {
        self.files.unreadable()
    }

    /// Fills in the next batch; `false` at the end of the recording or of the run's duration.
    pub fn next(&mut self, batch: &mut Batch) -> bool {
        batch.sub.clear();
        batch.truth.clear();
        self.read_on();
        let Some(main) = self.mains.pop_front() else { return false };
        let begin_ns = *self.begin_ns.get_or_insert(main.header.time_ns);
        if main.header.time_ns.saturating_sub(begin_ns) > self.duration_ns {
            self.stopped = true;
            return false;
        }
        let last = self.mains.is_empty();
        let number = main.header.sequence;
        batch.attitude = None;
        while let Some(attitude) = self.attitudes.pop_front_if(|a| a.header.sequence <= number) {
            let header = played(&attitude.header, self.run_id);
            batch.attitude = Some(MainAttitude { header, ..attitude }).filter(|a| a.header.sequence == number);
        }
        for (index, area) in self.areas.iter_mut().enumerate() {
            while let Some(sample) = area.samples.pop_front_if(|sample| last || handed_out(sample, &main)) {
                let header = played(&sample.header, self.run_id);
                batch.sub.push(ImuSample { header, unit: 1 + index as u32, ..sample });
            }
            while let Some(truth) = area.truths.pop_front_if(|truth| truth.header.sequence <= number) {
                let header = played(&truth.header, self.run_id);
                batch.truth.push(Truth { header, area: index as u32, ..truth });
            }
        }
        batch.main = ImuSample { header: played(&main.header, self.run_id), ..main };
        true
    }

    fn read_on(&mut self) {
        while self.mains.len() <= LOOK_AHEAD {
            let Some((topic, record)) = self.files.next() else { return };
            match (self.wanted.get(&topic), record) {
                (Some(Stream::Main), Record::Sample(sample)) => self.mains.push_back(sample),
                (Some(Stream::Attitude), Record::Attitude(attitude)) => self.attitudes.push_back(attitude),
                (Some(Stream::Sub(area)), Record::Sample(sample)) => self.areas[*area].samples.push_back(sample),
                (Some(Stream::Truth(area)), Record::Truth(truth)) => self.areas[*area].truths.push_back(truth),
                _ => {}
            }
        }
    }
}

/// Whether the source handed a sub unit's sample out before a main sample, which is what the stages go by.
fn handed_out(sub: &ImuSample, main: &ImuSample) -> bool {
    let (sub, main) = (&sub.header, &main.header);
    match (sub.stamps.source_ns, main.stamps.source_ns) {
        (0, _) | (_, 0) => sub.time_ns <= main.time_ns,
        (sub_ns, main_ns) => sub_ns <= main_ns,
    }
}

/// The header of a message that is played back: when the stages of the recorded run handled it is of no meaning any more.
fn played(header: &Header, run_id: u64) -> Header {
    Header { run_id, clock_domain: ClockDomain::Recorded as u32, stamps: Stamps::default(), ..*header }
}

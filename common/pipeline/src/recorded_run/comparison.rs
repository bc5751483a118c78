//! Whether a replay gives what was recorded, to the bit.

use super::Files;
use crate::configuration::Configuration;
use crate::recording::RecordingError;
use messages::{Header, Solution, Stamps, topic};
use recording::Record;
use std::collections::{HashMap, VecDeque};
use std::path::Path;

/// Compares solutions with those of a recorded run, while both come in the order of their samples.
pub struct Comparison {
    files: Files,
    areas: HashMap<String, usize>,
    waiting: Vec<VecDeque<Solution>>,
    found: Vec<Likeness>,
    /// Of each area, the sample from behind which on solutions are compared.
    after: Vec<Option<u64>>,
}

/// What the comparison of an area's solutions gave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Likeness {
    /// Solutions that are the same to the bit.
    pub same: u64,
    /// Solutions that differ.
    pub different: u64,
    /// Solutions of the replay that are not recorded.
    pub unrecorded: u64,
    /// Recorded solutions that the replay does not give, because their samples are missing.
    pub unrepeated: u64,
    /// Recorded solutions from before the state that the replay starts from.
    pub before: u64,
    /// The first sample whose solutions differ: its number and time, ns.
    pub first: Option<(u64, i64)>,
}

impl Comparison {
    /// Opens the run.
    ///
    /// # Errors
    /// The file cannot be read or is no recorded run.
    pub fn open(path: &Path, configuration: &Configuration) -> Result<Self, RecordingError> {
        let names = configuration.areas.iter().enumerate();
        Ok(Self {
            files: Files::open(path)?,
            areas: names.map(|(index, area)| (topic::solution(&area.name).name, index)).collect(),
            waiting: configuration.areas.iter().map(|_| VecDeque::new()).collect(),
            found: vec![Likeness::default(); configuration.areas.len()],
            after: vec![None; configuration.areas.len()],
        })
    }

    /// Compares the solutions of an area from behind a sample on, by its number.
    pub fn after(&mut self, area: usize, number: u64) {
        self.after[area] = Some(number);
    }

    /// Takes the next solution of the replay.
    pub fn solution(&mut self, own: &Solution) {
        let area = own.area as usize;
        let number = own.header.sequence;
        while self.waiting[area].back().is_none_or(|last| last.header.sequence < number) && self.read_on() {}
        let found = &mut self.found[area];
        while self.waiting[area].pop_front_if(|recorded| recorded.header.sequence < number).is_some() {
            found.unrepeated += 1;
        }
        match self.waiting[area].pop_front_if(|recorded| recorded.header.sequence == number) {
            None => found.unrecorded += 1,
            Some(recorded) if result(&recorded) == result(own) => found.same += 1,
            Some(_) => {
                found.different += 1;
                found.first.get_or_insert((number, own.header.time_ns));
            }
        }
    }

    /// What was found, by area.
    pub fn finish(mut self) -> Vec<Likeness> {
        while self.read_on() {}
        for (found, waiting) in self.found.iter_mut().zip(&self.waiting) {
            found.unrepeated += waiting.len() as u64;
        }
        self.found
    }

    /// Reads one message; `false` at the end.
    fn read_on(&mut self) -> bool {
        let Some((topic, record)) = self.files.next() else { return false };
        if let (Some(area), Record::Solution(solution)) = (self.areas.get(&topic), record) {
            if self.after[*area].is_some_and(|number| solution.header.sequence <= number) {
                self.found[*area].before += 1;
            } else {
                self.waiting[*area].push_back(solution);
            }
        }
        true
    }
}

/// The bits of what was worked out, without what each run has of its own: its number, its clock and when its stages were at work.
fn result(solution: &Solution) -> Vec<u8> {
    let header = Header { run_id: 0, clock_domain: 0, stamps: Stamps::default(), ..solution.header };
    Record::Solution(Solution { header, area: 0, ..*solution }).encode()
}

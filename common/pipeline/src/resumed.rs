//! A recorded run that is gone through again from its middle: the estimators go on from recorded states, with the recorded pairs.

use crate::configuration::Configuration;
use crate::lane;
use crate::offline::{Outcome, Sink};
use crate::recorded_run::{Course, Files};
use crate::recording::RecordingError;
use estimation::{Estimator, StateError};
use frames::unit::nanoseconds;
use messages::{FlexureParams, ImuPair, topic};
use recording::Record;
use std::collections::{HashMap, VecDeque};
use std::path::Path;

/// A truth may stand so many pairs behind the pair of its sample: the recorder takes one topic after the other, of each as many messages as have come.
const LOOK_AHEAD: usize = 2048;

/// How an area's estimator begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Begin {
    /// As if it had seen everything up to a sample.
    State {
        /// The sample's number.
        number: u64,
        /// Its time, ns.
        time_ns: i64,
    },
    /// With nothing, since there is no state of it.
    Anew,
    /// With nothing, since the state is of no use.
    Refused(StateError),
}

/// The estimators of a run at its middle.
pub struct Resumed {
    areas: Vec<Lane>,
}

struct Lane {
    estimator: Box<dyn Estimator>,
    begin: Begin,
    /// Parameter sets with the samples at which they took effect.
    sets: VecDeque<(u64, FlexureParams)>,
    pairs: VecDeque<ImuPair>,
}

impl Resumed {
    /// Estimators with the states of a recording; `None` where it has none.
    pub fn new(configuration: &Configuration, course: &Course) -> Option<Self> {
        let lane = |area: usize| {
            let mut estimator = lane::estimator(configuration, area);
            let begin = match course.start(area) {
                None => Begin::Anew,
                Some(start) => match estimator.thaw(&start.state) {
                    Ok(()) => Begin::State { number: start.number, time_ns: start.time_ns },
                    Err(error) => Begin::Refused(error),
                },
            };
            let sets = course.adoptions(area).unwrap_or_default();
            Lane { estimator, begin, sets, pairs: VecDeque::new() }
        };
        course.has_starts().then(|| Self { areas: (0..configuration.areas.len()).map(lane).collect() })
    }

    /// How each area's estimator begins.
    pub fn begins(&self) -> Vec<Begin> {
        self.areas.iter().map(|lane| lane.begin.clone()).collect()
    }

    /// Goes through the recorded pairs. What became of the samples is not known, since they are not looked at.
    ///
    /// # Errors
    /// The recorded run cannot be opened.
    pub fn run(
        mut self,
        configuration: &Configuration,
        run: &Path,
        sink: &mut dyn Sink,
    ) -> Result<Outcome, RecordingError> {
        let places = configuration.areas.iter().enumerate();
        let topics = places.flat_map(|(index, area)| {
            [topic::pair(&area.name).name, topic::truth(&area.name).name].map(|name| (name, index))
        });
        let topics: HashMap<String, usize> = topics.collect();
        let mut files = Files::open(run)?;
        let mut until_ns = i64::MAX;
        for (topic, record) in files.by_ref() {
            match (topics.get(&topic), record) {
                (Some(index), Record::Pair(pair)) => {
                    if until_ns == i64::MAX
                        && let Some(duration_s) = configuration.run.duration_s
                    {
                        until_ns = pair.header.time_ns.saturating_add(nanoseconds(duration_s));
                    }
                    let lane = &mut self.areas[*index];
                    if pair.header.time_ns <= until_ns {
                        lane.pairs.push_back(pair);
                    }
                    if lane.pairs.len() > LOOK_AHEAD {
                        lane.work_off(sink);
                    }
                }
                (Some(index), Record::Truth(mut truth)) => {
                    truth.area = *index as u32;
                    sink.truth(&truth);
                }
                _ => {}
            }
        }
        for lane in &mut self.areas {
            while !lane.pairs.is_empty() {
                lane.work_off(sink);
            }
        }
        Ok(Outcome { areas: Vec::new(), unreadable_rows: files.unreadable() })
    }
}

impl Lane {
    /// Handles the oldest pair.
    fn work_off(&mut self, sink: &mut dyn Sink) {
        let Some(pair) = self.pairs.pop_front() else { return };
        let number = pair.header.sequence;
        if matches!(self.begin, Begin::State { number: seen, .. } if number <= seen) {
            return;
        }
        while let Some((_, set)) = self.sets.pop_front_if(|(at, _)| *at <= number) {
            self.estimator.offer(set);
        }
        sink.solution(&self.estimator.step(&pair));
    }
}

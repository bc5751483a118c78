//! What the page needs of a recorded run, taken in while the run is read once.

mod alarms;
mod area;
mod blocks;
mod errors;
mod join;
mod latencies;
mod means;
mod ship;
mod stages;
mod trace;

pub use alarms::Spell;
pub use area::{AreaRun, VALID};
pub use blocks::Block;
pub use errors::Errors;
pub use latencies::Latencies;
pub use ship::ShipRun;
pub use stages::StageRun;
pub use trace::{Envelope, Marks, Trace};

use messages::topic;
use pipeline::configuration::Configuration;
use pipeline::recorded_run::{Files, adoption_topic};
use pipeline::recording::RecordingError;
use recording::{About, Ending, Record};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// A recorded run, read through.
pub struct Run {
    /// What the first file says about itself.
    pub about: About,
    /// What the last file says at its end; `None` where a cut hides it.
    pub ending: Option<Ending>,
    /// The files that are cut, and why.
    pub cuts: Vec<(PathBuf, String)>,
    /// Messages that cannot be read.
    pub unreadable: u64,
    /// Messages by topic.
    pub counts: BTreeMap<String, u64>,
    /// When the first and the last message were recorded, ns since 1970.
    pub recorded_ns: Option<(u64, u64)>,
    /// From the first to the last data time, ns.
    pub length_ns: i64,
    /// By area, in the configuration's order.
    pub areas: Vec<AreaRun>,
    /// The ship.
    pub ship: ShipRun,
    /// By the topics of their health.
    pub stages: BTreeMap<String, StageRun>,
}

/// Where the messages of a topic go.
#[derive(Clone, Copy)]
enum Place {
    Attitude,
    Pair(usize),
    Solution(usize),
    Parameters(usize),
    Adoption(usize),
    Truth(usize),
    Health,
    /// Only its time counts.
    Other,
}

fn places(configuration: &Configuration) -> HashMap<String, Place> {
    let mut places = HashMap::from([(topic::main_attitude().name, Place::Attitude)]);
    for (index, area) in configuration.areas.iter().enumerate() {
        let name = area.name.as_str();
        places.insert(topic::pair(name).name, Place::Pair(index));
        places.insert(topic::solution(name).name, Place::Solution(index));
        places.insert(topic::parameters(name).name, Place::Parameters(index));
        places.insert(adoption_topic(name), Place::Adoption(index));
        places.insert(topic::truth(name).name, Place::Truth(index));
    }
    places
}

impl Run {
    /// Reads a run whole, through all its files.
    ///
    /// # Errors
    /// The file cannot be read or is no recorded run.
    pub fn read(path: &Path, configuration: &Configuration) -> Result<Self, RecordingError> {
        let mut files = Files::open(path)?;
        let places = places(configuration);
        let interval_ns = configuration.interval_ns();
        let mut run = Self {
            about: files.about().clone(),
            ending: None,
            cuts: Vec::new(),
            unreadable: 0,
            counts: BTreeMap::new(),
            recorded_ns: None,
            length_ns: 0,
            areas: configuration.areas.iter().map(|area| AreaRun::new(area, configuration)).collect(),
            ship: ShipRun::new(interval_ns),
            stages: BTreeMap::new(),
        };
        let mut begin_ns = None;
        while let Some((topic, record)) = files.next() {
            let now_ns = files.recorded_ns();
            run.recorded_ns = Some((run.recorded_ns.map_or(now_ns, |(first_ns, _)| first_ns), now_ns));
            let place = match record {
                Record::Health(_) => Place::Health,
                _ => places.get(&topic).copied().unwrap_or(Place::Other),
            };
            run.take(place, &topic, &record, &mut begin_ns);
            match run.counts.get_mut(&topic) {
                Some(count) => *count += 1,
                None => _ = run.counts.insert(topic, 1),
            }
        }
        run.areas.iter_mut().for_each(AreaRun::finish);
        run.ending = files.ending();
        run.cuts = files.cuts().to_vec();
        run.unreadable = files.unreadable();
        Ok(run)
    }

    fn take(&mut self, place: Place, topic: &str, record: &Record, begin_ns: &mut Option<i64>) {
        if let Record::Health(health) = record {
            self.stages.entry(topic.to_owned()).or_default().take(health);
            return;
        }
        let time_ns = record.header().time_ns;
        let begin_ns = *begin_ns.get_or_insert(time_ns);
        let since_ns = time_ns.saturating_sub(begin_ns);
        self.length_ns = self.length_ns.max(since_ns);
        match (place, record) {
            (Place::Attitude, Record::Attitude(attitude)) => self.ship.attitude(since_ns, attitude),
            (Place::Pair(0), Record::Pair(pair)) => self.ship.pair(since_ns, pair),
            (Place::Solution(area), Record::Solution(solution)) => self.areas[area].solution(begin_ns, solution),
            (Place::Truth(area), Record::Truth(truth)) => self.areas[area].truth(begin_ns, truth),
            (Place::Parameters(area), Record::Parameters(set)) => self.areas[area].parameters(begin_ns, set),
            (Place::Adoption(area), Record::Adoption(adoption)) => self.areas[area].adoption(adoption),
            _ => {}
        }
    }

    /// Whether the files hold the run's end.
    pub fn is_whole(&self) -> bool {
        self.ending.is_some_and(|ending| ending.end_of_run) && self.cuts.is_empty()
    }
}

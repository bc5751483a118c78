//! How a recorded run went: which parameter set took effect at which sample, and who was started again.

use super::start::Starts;
use super::{Files, Start, adoption_topic};
use crate::configuration::{Area, Configuration};
use crate::recording::RecordingError;
use messages::{FlexureParams, topic};
use recording::{About, Record};
use std::collections::{BTreeMap, HashMap, VecDeque};
use std::fmt;
use std::path::{Path, PathBuf};

/// Refuses a run without the samples of a unit.
fn units(path: &Path, configuration: &Configuration, counts: &BTreeMap<String, u64>) -> Result<(), RecordingError> {
    let areas = configuration.areas.iter().map(|area| topic::area_imu(&area.name).name);
    for topic in std::iter::once(topic::main_imu().name).chain(areas) {
        if !counts.contains_key(&topic) {
            let known: Vec<&str> = counts.keys().map(String::as_str).filter(|topic| topic.ends_with("/imu")).collect();
            let known = if known.is_empty() { "none of any unit".to_owned() } else { known.join(", ") };
            return Err(RecordingError::NoUnit { path: path.to_path_buf(), topic, known });
        }
    }
    Ok(())
}

/// What is known of a recorded run once it has been read.
#[derive(Clone, Debug)]
pub struct Course {
    /// What the first file says about itself.
    pub about: About,
    /// Messages by topic.
    pub counts: BTreeMap<String, u64>,
    /// Whether the streams ended; otherwise the recording goes to a cut, or to the last file that is there.
    pub to_the_end: bool,
    /// Messages that the recorder had to drop or did not get; `None` where a cut hides it.
    pub missing: Option<u64>,
    /// Messages that cannot be read.
    pub unreadable: u64,
    /// The files that are cut, and why.
    pub cuts: Vec<(PathBuf, String)>,
    /// Stages that were started again, with how often; as their topics of health are named.
    pub restarts: Vec<(String, u64)>,
    /// Of each area, the sample numbers at which a parameter set took effect; `None` if they are not all recorded.
    adoptions: Vec<Option<VecDeque<(u64, FlexureParams)>>>,
    /// Whether the run's first sample is recorded.
    from_the_start: bool,
    /// Of each area, the first state of its estimator that is of use; none in a recording from the run's start.
    starts: Vec<Option<Start>>,
}

impl Course {
    /// Reads a whole run for the areas of a configuration.
    ///
    /// # Errors
    /// The file cannot be read or is no recorded run.
    pub fn read(path: &Path, configuration: &Configuration) -> Result<Self, RecordingError> {
        let mut files = Files::open(path)?;
        let mut counts: BTreeMap<String, u64> = BTreeMap::new();
        let mut sets: HashMap<(String, u64), FlexureParams> = HashMap::new();
        let mut adopted: HashMap<String, BTreeMap<u64, u64>> = HashMap::new();
        let mut processes: BTreeMap<String, Vec<u32>> = BTreeMap::new();
        let main_imu = topic::main_imu().name;
        let mut begin = None;
        let mut starts: HashMap<String, Starts> = HashMap::new();
        for (topic, record) in files.by_ref() {
            *counts.entry(topic.clone()).or_default() += 1;
            match record {
                Record::Pair(pair) => {
                    starts.entry(topic).or_default().pair(pair.header.sequence);
                }
                Record::State(part) => {
                    // the states are kept by the topic of the pairs that they are of
                    let pairs = topic.strip_suffix("state").map(|area| format!("{area}pair")).unwrap_or(topic);
                    starts.entry(pairs).or_default().part(&part);
                }
                Record::Sample(sample) if topic == main_imu => {
                    begin.get_or_insert(sample.ordinal);
                }
                Record::Parameters(set) => {
                    sets.insert((topic, set.id), set);
                }
                Record::Adoption(adoption) => {
                    adopted.entry(topic).or_default().insert(adoption.header.sequence, adoption.params_id);
                }
                Record::Health(health) => {
                    let seen = processes.entry(topic).or_default();
                    if !seen.contains(&health.pid) {
                        seen.push(health.pid);
                    }
                }
                _ => {}
            }
        }
        units(path, configuration, &counts)?;
        // a recorder that somebody starts by hand does not know how much it has missed
        let from_the_start = files.about().from_the_start && begin.is_none_or(|ordinal| ordinal == 0);
        if from_the_start {
            starts.clear();
        }
        let found = |area: &Area| starts.remove(&topic::pair(&area.name).name).and_then(Starts::finish);
        let starts: Vec<Option<Start>> = configuration.areas.iter().map(found).collect();
        let of_area = |(area, start): (&Area, &Option<Start>)| {
            let parameters = topic::parameters(&area.name).name;
            let adopted = adopted.remove(&adoption_topic(&area.name));
            if adopted.is_none() && !counts.contains_key(&parameters) {
                return None;
            }
            let adopted = adopted.unwrap_or_default().into_iter();
            let adopted = adopted.map(|(number, id)| Some((number, *sets.get(&(parameters.clone(), id))?)));
            // a set that came before the recording is in the state
            if start.is_some() { Some(adopted.flatten().collect()) } else { adopted.collect() }
        };
        let adoptions = configuration.areas.iter().zip(&starts).map(of_area).collect();
        let restarts = processes.into_iter().map(|(topic, seen)| (topic, seen.len() as u64 - 1));
        let ending = files.ending();
        Ok(Self {
            about: files.about().clone(),
            counts: counts.clone(),
            to_the_end: ending.is_some_and(|ending| ending.end_of_run),
            missing: ending.map(|ending| ending.dropped + ending.lost),
            unreadable: files.unreadable(),
            cuts: files.cuts().to_vec(),
            restarts: restarts.filter(|(_, n)| *n > 0).collect(),
            adoptions,
            from_the_start,
            starts,
        })
    }

    /// The parameter sets of an area with the sample numbers at which they took effect, in order; `None` if they are not recorded, or
    /// not all of them.
    pub fn adoptions(&self, area: usize) -> Option<VecDeque<(u64, FlexureParams)>> {
        self.adoptions[area].clone()
    }

    /// The state from which an area's estimator goes on; `None` if there is none, or the recording begins with the run.
    pub fn start(&self, area: usize) -> Option<&Start> {
        self.starts[area].as_ref()
    }

    /// Whether there is any.
    pub fn has_starts(&self) -> bool {
        self.starts.iter().any(Option::is_some)
    }

    /// What a reader should know before believing that a replay is the run, a sentence each; nothing if all is well.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if self.has_starts() {
            remarks.push("begins in the middle of the run: a replay starts from the states in it".to_owned());
        } else if !self.from_the_start {
            let without =
                "begins in the middle of the run, without a state: a replay starts anew and gives other solutions";
            remarks.push(without.to_owned());
        }
        for (path, reason) in &self.cuts {
            remarks.push(format!("is cut at the end of {} ({reason})", path.display()));
        }
        match self.missing {
            Some(0) => {}
            Some(n) => {
                remarks.push(format!("lacks {n} messages: the recorder could not keep up, or the disk was full"))
            }
            None => remarks.push("does not go to the run's end".to_owned()),
        }
        if self.unreadable > 0 {
            remarks.push(format!("has {} messages that cannot be read", self.unreadable));
        }
        for (topic, n) in &self.restarts {
            remarks.push(format!("has {n} new starts of {}", topic.trim_start_matches("health/")));
        }
        remarks
    }
}

impl fmt::Display for Course {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let About { version, run_id, part, path, .. } = &self.about;
        writeln!(f, "run {run_id:x}, recorded by deckflex {version} with {path}")?;
        for (topic, count) in &self.counts {
            writeln!(f, "  {count:>9} {topic}")?;
        }
        self.remarks().iter().try_for_each(|remark| writeln!(f, "  {remark}"))?;
        if *part > 0 {
            writeln!(f, "  the run's file number {part}")?;
        }
        Ok(())
    }
}

//! Where samples come from: the simulator or recordings, one main sample at a time.

use crate::configuration::{Configuration, Source as Kind};
use crate::recorded_run::Playback;
use crate::recording::{Recording, RecordingError, Row};
use frames::unit::nanoseconds;
use messages::{ImuSample, MainAttitude, Truth};
use simulation::Simulator;
use std::path::Path;

/// How far beyond the main unit's last sample the sub units' are still wanted, ns.
const TAIL_NS: i64 = 1_000_000_000;

/// What is handed out at one main sampling instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Batch {
    /// The main unit's sample.
    pub main: ImuSample,
    /// The main INS's attitude at the same instant, if there is one.
    pub attitude: Option<MainAttitude>,
    /// The sub units' samples that have come by now; `unit` is 1 + the index of the area.
    pub sub: Vec<ImuSample>,
    /// The truth of each area, from a simulator.
    pub truth: Vec<Truth>,
}

/// A source of samples.
pub enum Source {
    /// Simulated units.
    Simulated(Box<Simulator>),
    /// Recorded units.
    Recorded(Box<Recorded>),
}

/// Recorded units.
pub enum Recorded {
    /// A recording each.
    Rows(Box<Merged>),
    /// A recorded run.
    Run(Box<Playback>),
}

/// Recordings of the main unit and of each area, merged by time.
pub struct Merged {
    main: Option<Recording>,
    areas: Vec<Area>,
    next: Option<Row>,
    duration_ns: i64,
    begin_ns: Option<i64>,
}

/// The recording of one area.
struct Area {
    recording: Recording,
    next: Option<Row>,
}

impl Source {
    /// The source that the configuration names.
    ///
    /// # Errors
    /// A recording cannot be opened or its columns are not known, or the units are on wires.
    pub fn open(configuration: &Configuration, run_id: u64) -> Result<Self, RecordingError> {
        match &configuration.main.source {
            Kind::Simulator => Ok(Self::Simulated(Box::new(Simulator::new(&configuration.scenario(run_id))))),
            source @ Kind::Line(_) => Err(RecordingError::Live(source.kind())),
            Kind::Csv(_) | Kind::Mcap(_) => {
                Recorded::open(configuration, run_id).map(|recorded| Self::Recorded(Box::new(recorded)))
            }
        }
    }

    /// Whether all streams have come to their ends, and are not cut off.
    pub fn whole(&self) -> bool {
        match self {
            Self::Recorded(recorded) => recorded.whole(),
            Self::Simulated(_) => true,
        }
    }

    /// How many rows of recordings could not be read.
    pub fn unreadable_rows(&self) -> u64 {
        match self {
            Self::Simulated(_) => 0,
            Self::Recorded(recorded) => recorded.refused(),
        }
    }

    /// Fills in the next batch; `false` at the end of the run.
    pub fn next(&mut self, batch: &mut Batch) -> bool {
        match self {
            Self::Simulated(simulator) => simulator.step().is_some_and(|epoch| {
                batch.sub.clear();
                batch.truth.clear();
                batch.main = epoch.main;
                batch.attitude = Some(epoch.attitude);
                batch.sub.extend_from_slice(&epoch.sub);
                batch.truth.extend_from_slice(&epoch.truth);
                true
            }),
            Self::Recorded(recorded) => recorded.next(batch),
        }
    }
}

impl Recorded {
    /// Opens the recordings that the configuration names; sources of another kind give nothing.
    ///
    /// # Errors
    /// A recording cannot be opened or its columns are not known.
    pub fn open(configuration: &Configuration, run_id: u64) -> Result<Self, RecordingError> {
        Ok(match &configuration.main.source {
            Kind::Mcap(path) => Self::Run(Box::new(Playback::open(path, configuration, run_id)?)),
            _ => Self::Rows(Box::new(Merged::open(configuration, run_id)?)),
        })
    }

    /// How many rows or messages could not be read.
    pub fn refused(&self) -> u64 {
        match self {
            Self::Rows(merged) => merged.refused(),
            Self::Run(playback) => playback.unreadable(),
        }
    }

    /// Fills in the next batch; `false` at the end of the main unit's samples or of the run's duration.
    pub fn next(&mut self, batch: &mut Batch) -> bool {
        match self {
            Self::Rows(merged) => merged.next(batch),
            Self::Run(playback) => playback.next(batch),
        }
    }

    fn whole(&self) -> bool {
        match self {
            Self::Rows(_) => true,
            Self::Run(playback) => playback.whole(),
        }
    }
}

impl Merged {
    fn open(configuration: &Configuration, run_id: u64) -> Result<Self, RecordingError> {
        let interval_ns = configuration.interval_ns();
        let open = |path: &Path, unit: usize| Recording::open(path, unit as u32, run_id, interval_ns);
        let mut areas = Vec::new();
        for (index, area) in configuration.areas.iter().enumerate() {
            if let Kind::Csv(path) = &area.source {
                let mut recording = open(path, 1 + index)?;
                let next = recording.next();
                areas.push(Area { recording, next });
            }
        }
        let mut main = match &configuration.main.source {
            Kind::Csv(path) => Some(open(path, 0)?),
            Kind::Mcap(_) | Kind::Simulator | Kind::Line(_) => None,
        };
        let next = main.as_mut().and_then(Iterator::next);
        let duration_ns = configuration.run.duration_s.map_or(i64::MAX, nanoseconds);
        Ok(Self { main, areas, next, duration_ns, begin_ns: None })
    }

    fn refused(&self) -> u64 {
        let areas = self.areas.iter().map(|area| &area.recording);
        self.main.iter().chain(areas).map(|recording| recording.counts().refused).sum()
    }

    fn next(&mut self, batch: &mut Batch) -> bool {
        batch.sub.clear();
        let Some(row) = self.next.take() else { return false };
        let time_ns = row.sample.header.time_ns;
        let begin_ns = *self.begin_ns.get_or_insert(time_ns);
        if time_ns.saturating_sub(begin_ns) > self.duration_ns {
            return false;
        }
        self.next = self.main.as_mut().and_then(Iterator::next);
        (batch.main, batch.attitude) = (row.sample, row.attitude);
        let until_ns = if self.next.is_some() { time_ns } else { time_ns.saturating_add(TAIL_NS) };
        for area in &mut self.areas {
            while let Some(row) = area.next.take_if(|row| row.sample.header.time_ns <= until_ns) {
                batch.sub.push(row.sample);
                area.next = area.recording.next();
            }
        }
        true
    }
}

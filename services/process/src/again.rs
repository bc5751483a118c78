//! A recorded run that is gone through again, and compared with itself.

use frames::unit;
use messages::{FlexureParams, Solution, Truth};
use pipeline::configuration::Configuration;
use pipeline::offline::{self, Outcome, Sink};
use pipeline::recorded_run::{Comparison, Course, Likeness};
use pipeline::recording::RecordingError;
use pipeline::resumed::{Begin, Resumed};
use std::fmt;
use std::path::Path;

/// Whether a recorded run gave what was recorded.
#[derive(Clone, Debug)]
pub struct Again {
    /// Names of the areas, with what their comparison gave.
    pub areas: Vec<(String, Likeness)>,
    /// How their estimators began, where the recording begins in the middle of the run and holds states.
    pub begins: Vec<Begin>,
    /// What may have made a difference, a sentence each.
    pub remarks: Vec<String>,
}

/// Goes through the run of the configuration again.
pub fn run(
    configuration: &Configuration,
    run: &Path,
    sink: &mut dyn Sink,
) -> Result<(Outcome, Option<Again>), RecordingError> {
    let course = Course::read(run, configuration)?;
    let mut compared = Compared { comparison: Comparison::open(run, configuration)?, sink };
    let resumed = Resumed::new(configuration, &course);
    let begins = resumed.as_ref().map(Resumed::begins).unwrap_or_default();
    for (area, begin) in begins.iter().enumerate() {
        if let Begin::State { number, .. } = begin {
            compared.comparison.after(area, *number);
        }
    }
    let outcome = match resumed {
        Some(resumed) => resumed.run(configuration, run, &mut compared)?,
        None => offline::again(configuration, &course, &mut compared)?,
    };
    let names = configuration.areas.iter().map(|area| area.name.clone());
    let areas = names.zip(compared.comparison.finish()).collect();
    Ok((outcome, Some(Again { areas, begins, remarks: course.remarks() })))
}

struct Compared<'a> {
    comparison: Comparison,
    sink: &'a mut dyn Sink,
}

impl Sink for Compared<'_> {
    fn truth(&mut self, truth: &Truth) {
        self.sink.truth(truth);
    }

    fn solution(&mut self, solution: &Solution) {
        self.comparison.solution(solution);
        self.sink.solution(solution);
    }

    fn parameters(&mut self, parameters: &FlexureParams) {
        self.sink.parameters(parameters);
    }
}

impl fmt::Display for Again {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, (name, found)) in self.areas.iter().enumerate() {
            match self.begins.get(place) {
                Some(Begin::State { number, time_ns }) => {
                    let time_s = unit::seconds(*time_ns);
                    writeln!(
                        f,
                        "area {name}: from behind {time_s} s on (sample {number}), where its state is recorded"
                    )?;
                }
                Some(Begin::Refused(error)) => {
                    writeln!(f, "area {name}: starts anew, since its recorded state is refused: {error}")?;
                }
                Some(Begin::Anew) => writeln!(f, "area {name}: starts anew, since no state of it is recorded")?,
                None => {}
            }
            let Likeness { same, different, unrecorded, unrepeated, before, first } = found;
            write!(f, "area {name}: {same} solutions are the recorded ones to the bit")?;
            if let Some((number, time_ns)) = first {
                let time_s = unit::seconds(*time_ns);
                write!(f, ", {different} differ, the first at {time_s} s (sample {number})")?;
            }
            if *unrecorded > 0 {
                write!(f, ", {unrecorded} are not recorded")?;
            }
            if *unrepeated > 0 {
                write!(f, ", {unrepeated} recorded ones lack their samples")?;
            }
            if *before > 0 {
                write!(f, ", {before} recorded ones are from before")?;
            }
            writeln!(f)?;
        }
        self.remarks.iter().try_for_each(|remark| writeln!(f, "the recording {remark}"))
    }
}

//! A recorded run that is gone through again, and compared with itself.

use frames::unit;
use messages::{FlexureParams, Solution, Truth};
use pipeline::configuration::Configuration;
use pipeline::offline::{self, Outcome, Sink};
use pipeline::recorded_run::{Comparison, Course, Likeness};
use pipeline::recording::RecordingError;
use std::fmt;
use std::path::Path;

/// Whether a recorded run gave what was recorded.
#[derive(Clone, Debug)]
pub struct Again {
    /// Names of the areas, with what their comparison gave.
    pub areas: Vec<(String, Likeness)>,
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
    let outcome = offline::again(configuration, &course, &mut compared)?;
    let names = configuration.areas.iter().map(|area| area.name.clone());
    let areas = names.zip(compared.comparison.finish()).collect();
    Ok((outcome, Some(Again { areas, remarks: course.remarks() })))
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
        for (name, found) in &self.areas {
            let Likeness { same, different, unrecorded, unrepeated, first } = found;
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
            writeln!(f)?;
        }
        self.remarks.iter().try_for_each(|remark| writeln!(f, "the recording {remark}"))
    }
}

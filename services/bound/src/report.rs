//! What the runs came to, as a reader wants it.

use crate::SEEDS;
use crate::curve::{Point, SWINGS_S};
use frames::unit::ARCSEC;
use std::fmt;

/// The times of the table, s.
const TIMES_S: [f64; 13] = [30.0, 60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0, 3600.0, 7200.0, 18e3, 36e3, 86.4e3, 864e3];
/// The standard deviations whose times are told, arcsec.
pub const LIMITS_ARCSEC: [f64; 4] = [60.0, 10.0, 5.0, 1.0];
/// An axis whose standard deviation stays above this part of its first value is not shown by the motion.
const SHOWN: f64 = 0.5;

/// What the runs came to; it displays as tables.
#[derive(Clone, Debug)]
pub struct Report {
    /// Length of the data, s.
    pub duration_s: f64,
    /// In the order of the configuration.
    pub areas: Vec<Area>,
}

/// What the data of one area would allow.
#[derive(Clone, Debug)]
pub struct Area {
    /// Its name.
    pub name: String,
    /// Whether accelerometers were compared too.
    pub has_accelerometers: bool,
    /// Each second at which all runs have a valid solution.
    pub curve: Vec<Point>,
    /// Whether a run found no installation by motion.
    pub is_unobservable: bool,
    /// The total's standard deviation before any data, rad, where the filter starts from the survey.
    pub surveyed: Option<[f64; 3]>,
    /// What the truth has and the model of the bound has not.
    pub left_out: Vec<&'static str>,
}

/// One time of the table, with nothing where a run has no valid solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Time since the first sample, s.
    pub t_s: f64,
    /// What is known then.
    pub point: Option<Point>,
}

impl Area {
    /// The table, up to the end of the data.
    pub fn rows(&self, duration_s: f64) -> Vec<Row> {
        let times = TIMES_S.into_iter().filter(|t_s| *t_s < duration_s).chain([duration_s]);
        let at = |t_s: f64| self.curve.iter().find(|point| point.t_s == t_s).copied();
        times.map(|t_s| Row { t_s, point: at(t_s) }).collect()
    }

    /// From when on the total's standard deviation about each axis stays below a limit (rad), s; `None` where it does not.
    pub fn below(&self, limit: f64) -> [Option<f64>; 3] {
        std::array::from_fn(|axis| {
            let below = self.curve.iter().rev().take_while(|point| point.total[axis] < limit);
            below.last().map(|point| point.t_s)
        })
    }

    /// The axes whose standard deviation is still above half of the survey's, or of its first value where the motion shows the installation.
    pub fn hardly_shown(&self) -> Vec<char> {
        let Some((first, last)) = self.curve.first().zip(self.curve.last()) else { return vec!['x', 'y', 'z'] };
        let axes = ['x', 'y', 'z'].into_iter().enumerate();
        let before = self.surveyed.unwrap_or(first.total);
        axes.filter(|(axis, _)| last.total[*axis] > SHOWN * before[*axis]).map(|(_, name)| name).collect()
    }

    /// What the data consist of.
    pub fn sensors(&self) -> &'static str {
        if self.has_accelerometers { "gyros and accelerometers" } else { "gyros alone" }
    }

    fn table(&self, f: &mut fmt::Formatter<'_>, duration_s: f64) -> fmt::Result {
        writeln!(f, "  {:>9}  {:>28}  {:>28}", "", "total: x, y, z", "static part: x, y, z")?;
        for row in self.rows(duration_s) {
            write!(f, "  {:>9}", time(row.t_s))?;
            for part in [row.point.map(|point| point.total), row.point.map(|point| point.fixed)] {
                write!(f, "  ")?;
                for axis in 0..3 {
                    let text = part.map_or("-".to_owned(), |sigma| number(sigma[axis] / ARCSEC));
                    write!(f, "{}{text:>8}", if axis > 0 { "  " } else { "" })?;
                }
            }
            writeln!(f)?;
        }
        Ok(())
    }

    fn times(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "  {:>14}  {:>28}", "total below", "from when on: x, y, z")?;
        for limit in LIMITS_ARCSEC {
            let [x, y, z] = self.below(limit * ARCSEC).map(|t_s| t_s.map_or("not yet".to_owned(), time));
            writeln!(f, "  {:>14}  {x:>8}  {y:>8}  {z:>8}", format!("{limit} arcsec"))?;
        }
        Ok(())
    }

    fn remarks(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_unobservable {
            writeln!(f, "  the motion does not show the installation: what is told rests on [area.installation]")?;
        }
        match (self.curve.first(), self.hardly_shown().as_slice()) {
            (None, _) => {
                writeln!(f, "  no time has a valid solution in every run: longer data or more motion is needed")?
            }
            (_, []) => {}
            (Some(first), axes) => {
                let axes: Vec<String> = axes.iter().map(char::to_string).collect();
                let before =
                    self.surveyed.map_or(format!("the value at {}", time(first.t_s)), |_| "the survey's".to_owned());
                writeln!(f, "  hardly shown by the motion (sigma still above half of {before}): {}", axes.join(", "))?;
            }
        }
        self.left_out.iter().try_for_each(|part| writeln!(f, "  the bound leaves out {part}"))
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "The standard deviation that the data would allow, were the flexure's model known: arcsec, about the main unit's axes."
        )?;
        let seeds = SEEDS.map(|seed| seed.to_string()).join(", ");
        writeln!(
            f,
            "Root mean square over {} simulated runs (seeds {seeds}) of {}, and each time over the {SWINGS_S} s before it.",
            SEEDS.len(),
            time(self.duration_s)
        )?;
        for area in &self.areas {
            writeln!(f, "\narea {}, {}", area.name, area.sensors())?;
            area.table(f, self.duration_s)?;
            area.times(f)?;
            area.remarks(f)?;
        }
        Ok(())
    }
}

/// Three significant digits or so.
fn number(value: f64) -> String {
    match value {
        v if v < 10.0 => format!("{v:.2}"),
        v if v < 100.0 => format!("{v:.1}"),
        v => format!("{v:.0}"),
    }
}

/// In seconds below a minute, in minutes up to two hours, in hours beyond; without needless decimals.
pub fn time(t_s: f64) -> String {
    let told = |value: f64, unit: &str| {
        let text = format!("{value:.1}");
        format!("{} {unit}", text.trim_end_matches('0').trim_end_matches('.'))
    };
    match t_s {
        t if t < 60.0 => told(t, "s"),
        t if t <= 7200.0 => told(t / 60.0, "min"),
        t => told(t / 3600.0, "h"),
    }
}

//! What was found, as tables.

use crate::kind::Named;
use crate::{Kind, paste};
use estimation::allan::{Analysis, Coefficients, Estimate, Point};
use pipeline::recording::Counts;
use std::fmt;
use std::path::PathBuf;

/// What a static recording shows; it displays as tables.
#[derive(Clone, Debug)]
pub struct Report {
    /// The recording.
    pub path: PathBuf,
    /// Values of each channel, bridged ones among them.
    pub samples: usize,
    /// Mean time between them, s.
    pub interval: f64,
    /// Parts without a hole.
    pub stretches: usize,
    /// Samples made up in short holes.
    pub bridged: u64,
    /// What became of the rows.
    pub counts: Counts,
    /// What looks wrong about the recording, a sentence each.
    pub suspicions: Vec<String>,
    /// Gyros, and accelerometers if there are any.
    pub triads: Vec<Triad>,
}

/// Three sensors of a kind.
#[derive(Clone, Debug)]
pub struct Triad {
    /// Which.
    pub kind: Kind,
    /// x, y, z of the case; `None` for a channel that does not vary.
    pub axes: [Option<Analysis>; 3],
    /// Mean readings, rad/s or m/s^2.
    pub mean: [f64; 3],
}

type Coefficient = fn(&Coefficients) -> Option<Estimate>;

impl Triad {
    /// The coefficients with their names, in the order of the table.
    pub(crate) fn coefficients(&self) -> [(Named, Coefficient); 5] {
        let kind = self.kind;
        [
            (kind.white(), |c| c.white),
            (kind.instability(), |c| c.instability),
            (kind.correlation(), |c| c.correlation),
            (kind.walk(), |c| c.walk),
            (kind.quantisation(), |c| c.quantisation),
        ]
    }

    /// Deviations with the ends of their bars.
    fn curve(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let measure = self.kind.deviation();
        writeln!(f, "\nAllan deviation of the {}, {} (68 % bar)", self.kind.title(), measure.name)?;
        writeln!(f, "{:>10} {:^30} {:^30} {:^30}", "tau s", "x", "y", "z")?;
        let longest = self.axes.iter().flatten().map(|analysis| analysis.points.len()).max().unwrap_or(0);
        for k in 0..longest {
            let points: Vec<Option<&Point>> =
                self.axes.iter().map(|axis| axis.as_ref().and_then(|analysis| analysis.points.get(k))).collect();
            let tau = points.iter().flatten().next().map_or(f64::NAN, |point| point.tau);
            write!(f, "{:>10}", format!("{tau:.3}"))?;
            for point in points {
                let text = point.map_or("-".to_owned(), |point| {
                    let [value, low, high] = [point.deviation, point.lower, point.upper].map(|v| measure.number(v));
                    format!("{value} ({low} to {high})")
                });
                write!(f, " {text:^30}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }

    fn table(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\n{:<38} {:^22} {:^22} {:^22}", self.kind.title(), "x", "y", "z")?;
        for (named, of) in self.coefficients() {
            let cells: Vec<Option<Estimate>> =
                self.axes.iter().map(|axis| axis.as_ref().and_then(|analysis| of(&analysis.coefficients))).collect();
            // noise and bias are what the command is for; the others only where they are shown
            let always = named.key == self.kind.white().key || named.key == self.kind.instability().key;
            if !always && cells.iter().all(Option::is_none) {
                continue;
            }
            write!(f, "  {:<36}", format!("{}, {}", named.name, named.measure.name))?;
            for (cell, axis) in cells.iter().zip(&self.axes) {
                let text = match (cell, axis) {
                    (Some(Estimate { value, sigma }), _) => {
                        format!("{} +- {}", named.measure.number(*value), named.measure.number(*sigma))
                    }
                    (None, Some(analysis)) if named.key == self.kind.instability().key => {
                        format!("not shown, < {}", named.measure.number(analysis.coefficients.most_instability))
                    }
                    _ => "not shown".to_owned(),
                };
                write!(f, " {text:^22}")?;
            }
            writeln!(f)?;
        }
        let measure = self.kind.deviation();
        let [x, y, z] = self.mean.map(|v| measure.number(v));
        writeln!(f, "  {:<36} {x:^22} {y:^22} {z:^22}", format!("mean reading, {}", measure.name))
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { samples, interval, stretches, bridged, counts, .. } = self;
        let hours = *samples as f64 * interval / 3600.0;
        writeln!(f, "{}: {samples} samples, {hours:.2} h at {:.4} Hz", self.path.display(), 1.0 / interval)?;
        writeln!(
            f,
            "stretches without a hole {stretches}, bridged {bridged}, refused {}, not finite {}, repeated {}, back {}",
            counts.refused, counts.not_finite, counts.repeated, counts.back
        )?;
        self.suspicions.iter().try_for_each(|suspicion| writeln!(f, "suspicious: {suspicion}"))?;
        self.triads.iter().try_for_each(|triad| triad.curve(f))?;
        self.triads.iter().try_for_each(|triad| triad.table(f))?;
        writeln!(f, "\nFor the configuration (root mean square of the axes):")?;
        for triad in &self.triads {
            match paste::line(triad) {
                Some(line) => writeln!(f, "{line}")?,
                None => writeln!(f, "# {}: no white noise is shown", triad.kind.title())?,
            }
        }
        writeln!(
            f,
            "# bias: the least that mean reading and instability show; a data sheet's turn-on bias goes there if it is more"
        )?;
        let hidden = |triad: &Triad| triad.axes.iter().flatten().any(|a| a.coefficients.instability.is_none());
        if self.triads.iter().any(hidden) {
            writeln!(f, "# where a bias instability is not shown its bound is taken; a longer recording may show it")?;
        }
        Ok(())
    }
}

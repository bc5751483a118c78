//! The dictionary of the relevance vector machine: what the autocovariance of a flexure rate can be made of.
//!
//! Paper 000 eq 21-24: for lags of one step and more it is a damped sinusoid. To these, on a grid of damping and frequency,
//! come undamped cosines, which take up what the ship's sway leaks into the data.

use nalgebra::DMatrix;

/// Range of the damping, 1/s, and its number of values at size 1.
const DAMPING: (f64, f64, usize) = (0.03, 2.0, 10);
/// Range of the frequency, rad/s, and its number of values at size 1, zero not counted.
const FREQUENCY: (f64, f64, usize) = (0.05, 4.0, 16);
/// Range of the frequency of the undamped atoms, rad/s, and its number of values at size 1.
const LINES: (f64, f64, usize) = (0.2, 2.0, 37);

/// One column before it is brought to unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Atom {
    /// `exp(-damping t) cos(frequency t)`.
    Cosine {
        /// Damping, 1/s.
        damping: f64,
        /// Frequency, rad/s.
        frequency: f64,
    },
    /// `exp(-damping t) sin(frequency t)`, at frequency 0 `t exp(-damping t)`.
    Sine {
        /// Damping, 1/s.
        damping: f64,
        /// Frequency, rad/s.
        frequency: f64,
    },
    /// `cos(frequency t)`.
    Line {
        /// Frequency, rad/s.
        frequency: f64,
    },
}

impl Atom {
    /// Its value at the lag `t`, s.
    pub fn value(&self, t: f64) -> f64 {
        match *self {
            Atom::Cosine { damping, frequency } => (-damping * t).exp() * (frequency * t).cos(),
            Atom::Sine { damping, frequency: 0.0 } => t * (-damping * t).exp(),
            Atom::Sine { damping, frequency } => (-damping * t).exp() * (frequency * t).sin(),
            Atom::Line { frequency } => (frequency * t).cos(),
        }
    }
}

/// Atoms and their columns at given lags.
#[derive(Clone, Debug, PartialEq)]
pub struct Dictionary {
    /// One atom a column.
    pub atoms: Vec<Atom>,
    /// Lags by atoms, each column of unit length.
    pub design: DMatrix<f64>,
}

impl Dictionary {
    /// A grid of about `size` times the standard number of atoms at the lags `times` (s), with the undamped ones or without.
    pub fn new(times: &[f64], size: usize, lines: bool) -> Self {
        let side = (size.max(1) as f64).sqrt();
        let more = |count: usize, factor: f64| (count as f64 * factor).round() as usize;
        let mut frequencies = vec![0.0];
        frequencies.extend(logarithmic(FREQUENCY.0, FREQUENCY.1, more(FREQUENCY.2, side)));
        let mut atoms = Vec::new();
        for damping in logarithmic(DAMPING.0, DAMPING.1, more(DAMPING.2, side)) {
            for &frequency in &frequencies {
                atoms.push(Atom::Cosine { damping, frequency });
                atoms.push(Atom::Sine { damping, frequency });
            }
        }
        if lines {
            let count = more(LINES.2 - 1, size.max(1) as f64);
            let step = (LINES.1 - LINES.0) / count as f64;
            atoms.extend((0..=count).map(|k| Atom::Line { frequency: LINES.0 + k as f64 * step }));
        }
        let mut design = DMatrix::from_fn(times.len(), atoms.len(), |row, column| atoms[column].value(times[row]));
        for mut column in design.column_iter_mut() {
            let norm = column.norm();
            if norm > 0.0 {
                column /= norm;
            }
        }
        Self { atoms, design }
    }

    /// The frequencies of the undamped atoms, rad/s.
    pub fn lines(&self) -> Vec<f64> {
        let line = |atom: &Atom| if let Atom::Line { frequency } = *atom { Some(frequency) } else { None };
        self.atoms.iter().filter_map(line).collect()
    }
}

/// `count` values from `low` to `high`, evenly spaced in the logarithm.
pub(super) fn logarithmic(low: f64, high: f64, count: usize) -> impl Iterator<Item = f64> {
    let ratio = (high / low).ln() / (count.max(2) - 1) as f64;
    (0..count).map(move |k| low * (ratio * k as f64).exp())
}

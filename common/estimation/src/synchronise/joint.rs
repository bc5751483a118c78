//! Spikes that hide in what the deck does: found by what all channels of a unit say together.
//!
//! A flexure that is driven at every instant makes the accelerometers at the end of a lever arm as rough as spikes of fifty deviations of their noise, and
//! the gyros say at the same instant how much of that is flexure. How second differences of all channels go together over a few samples is learnt from the
//! stretch itself. From that follows how far each value is off what all the others say; the fewest spikes that explain a window are taken out (W. Baarda's
//! data snooping, 1968). What few spikes do not explain is left as it is: a slam is felt by all channels together, but otherwise than usual.

use super::spike::{AHEAD, CENTRE, Found, ROWS};
use nalgebra::{DMatrix, Matrix3, SMatrix, SVector, Vector3};

const CHANNELS: usize = 6;
/// Second differences of all channels between the first row and the last.
const SIZE: usize = CHANNELS * (ROWS - 2);
/// The values that are not judged yet.
const PLACES: usize = CHANNELS * (AHEAD + 1);
/// So many spikes explain a window at most.
const MOST: usize = 3;
/// Of these, so many of one channel: those of all rows ahead would explain any step.
const IN_CHANNEL: usize = AHEAD;
/// The squares that are left sum to so many times what is usual at most.
const LARGEST: f64 = 3.0;
/// Windows from which a covariance is learnt.
const LEAST: u32 = 8 * SIZE as u32;
/// What was learnt describes a block if fewer than one window in so many cannot be explained. Swell sampled slowly goes otherwise with every wave.
const REFUSED: u32 = 10;
/// What was learnt is forgotten if fewer than one window in so many can be learnt from.
const LITTLE: u32 = 8;
/// All channels together are asked if they show spikes of one of them that are so many times smaller than it shows itself.
const WORTH: f64 = 3.0;
/// Added to the diagonal of the correlations, for channels that follow from the others but for rounding.
const RIDGE: f64 = 1e-13;

type Differences = SVector<f64, SIZE>;
type Square = SMatrix<f64, SIZE, SIZE>;

/// A value that may be a spike.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    row: usize,
    channel: usize,
}

impl Place {
    /// All values that are not judged yet.
    fn all() -> impl Iterator<Item = Self> {
        (CENTRE..=CENTRE + AHEAD).flat_map(|row| (0..CHANNELS).map(move |channel| Self { row, channel }))
    }

    /// What a spike of one does to the differences.
    fn reach(self) -> Differences {
        let mut out = Differences::zeros();
        let weights = [(self.row, 1.0), (self.row - 1, -2.0), (self.row - 2, 1.0)];
        weights
            .into_iter()
            .filter(|(row, _)| *row < ROWS - 2)
            .for_each(|(row, weight)| out[row * CHANNELS + self.channel] = weight);
        out
    }
}

fn differences(rows: &[[f64; CHANNELS]; ROWS]) -> Differences {
    Differences::from_fn(|i, _| {
        let (row, channel) = (i / CHANNELS, i % CHANNELS);
        rows[row][channel] - 2.0 * rows[row + 1][channel] + rows[row + 2][channel]
    })
}

/// What a spike at a place does.
#[derive(Debug)]
struct Spike {
    place: Place,
    /// The differences that one of size one makes.
    reach: Differences,
    /// By what the differences are weighted to see its size.
    weights: Differences,
    /// Standard deviation with which its size is seen.
    sigma: f64,
}

/// What is known of the differences.
#[derive(Debug)]
struct Learnt {
    information: Square,
    spikes: Vec<Spike>,
    /// What a spike at one place says of one at another.
    normal: DMatrix<f64>,
}

impl Learnt {
    /// `None` where the covariance has no inverse. Channels that do not move have no spikes.
    fn of(covariance: &Square) -> Option<Self> {
        let scale = covariance.diagonal().map(|variance| if variance > 0.0 { variance.sqrt().recip() } else { 0.0 });
        let mut correlation = Square::from_fn(|i, j| covariance[(i, j)] * scale[i] * scale[j]);
        for i in 0..SIZE {
            correlation[(i, i)] = 1.0 + RIDGE;
        }
        let inverse = correlation.cholesky()?.inverse();
        let information = Square::from_fn(|i, j| inverse[(i, j)] * scale[i] * scale[j]);
        let seen = |place: Place| {
            let reach = place.reach();
            let weights = information * reach;
            let seen = weights.dot(&reach);
            (seen > 0.0).then(|| Spike { place, reach, weights, sigma: seen.sqrt().recip() })
        };
        let spikes: Vec<Spike> = Place::all().filter_map(seen).collect();
        let normal = DMatrix::from_fn(spikes.len(), spikes.len(), |i, j| spikes[i].weights.dot(&spikes[j].reach));
        Some(Self { information, spikes, normal })
    }

    /// Whether it sees smaller spikes of the row that is judged than a channel by itself.
    fn is_worth(&self, alone: &[Option<f64>; CHANNELS]) -> bool {
        let mut centre = self.spikes.iter().filter(|spike| spike.place.row == CENTRE);
        centre.any(|spike| alone[spike.place.channel].is_some_and(|alone| alone > WORTH * spike.sigma))
    }

    /// Whether differences are no more unusual than they ever are.
    fn describes(&self, seen: &Differences) -> bool {
        seen.dot(&(self.information * seen)) < LARGEST * SIZE as f64
    }

    /// The sizes of spikes at some places that explain differences best, and by how much their square sum becomes less.
    fn sizes(&self, taken: &[usize], weighted: &[f64; PLACES]) -> Option<(Vector3<f64>, f64)> {
        let (mut normal, mut right) = (Matrix3::identity(), Vector3::zeros());
        for (i, &one) in taken.iter().enumerate() {
            right[i] = weighted[one];
            for (j, &other) in taken.iter().enumerate() {
                normal[(i, j)] = self.normal[(one, other)];
            }
        }
        let sizes = normal.lu().solve(&right)?;
        Some((sizes, sizes.dot(&right)))
    }

    /// Adds places to `taken` up to `count`, and keeps those that explain most.
    fn search(&self, weighted: &[f64; PLACES], count: usize, taken: &mut Vec<usize>, best: &mut Best) {
        if taken.len() == count {
            if let Some((sizes, gain)) = self.sizes(taken, weighted).filter(|(_, gain)| *gain > best.gain) {
                *best = Best { gain, taken: taken.clone(), sizes };
            }
            return;
        }
        for next in taken.last().map_or(0, |last| last + 1)..self.spikes.len() {
            let channel = self.spikes[next].place.channel;
            if taken.iter().filter(|&&other| self.spikes[other].place.channel == channel).count() < IN_CHANNEL {
                taken.push(next);
                self.search(weighted, count, taken, best);
                taken.pop();
            }
        }
    }

    /// The fewest spikes that explain differences, none at all included, so that no other is beyond `threshold` standard deviations; `None` where few do
    /// not.
    fn explained(&self, seen: &Differences, threshold: f64) -> Option<Vec<(Place, Found)>> {
        let mut weighted = [0.0; PLACES];
        weighted.iter_mut().zip(&self.spikes).for_each(|(out, spike)| *out = spike.weights.dot(seen));
        let is_quiet = |left: &Differences, taken: &[usize]| {
            let off = |spike: &Spike| (spike.weights.dot(left) * spike.sigma).abs();
            self.spikes.iter().enumerate().all(|(i, spike)| taken.contains(&i) || off(spike) < threshold)
        };
        if is_quiet(seen, &[]) {
            return self.describes(seen).then(Vec::new);
        }
        (1..=MOST).find_map(|count| {
            let mut best = Best::default();
            self.search(&weighted, count, &mut Vec::with_capacity(count), &mut best);
            let spikes = || best.taken.iter().map(|&i| &self.spikes[i]).zip(&best.sizes);
            let left = spikes().fold(*seen, |left, (spike, &size)| left - spike.reach * size);
            let found = |(spike, &excess): (&Spike, &f64)| (spike.place, Found { excess, sigma: spike.sigma });
            (is_quiet(&left, &best.taken) && self.describes(&left)).then(|| spikes().map(found).collect())
        })
    }
}

/// The spikes that explain most, of so many.
#[derive(Default)]
struct Best {
    gain: f64,
    taken: Vec<usize>,
    sizes: Vector3<f64>,
}

/// The test of all channels of a unit together.
#[derive(Debug)]
pub(super) struct Joint {
    /// The last rows that have been judged, and how many of them follow each other.
    judged: [[f64; CHANNELS]; ROWS],
    filled: usize,
    /// Of the windows of this block that are learnt from; with the number of rows, of those windows, and of the rows about which nothing could be said.
    sum: Box<Square>,
    rows: u32,
    taken: u32,
    refused: u32,
    learnt: Option<Box<Learnt>>,
    /// Whether what was learnt has described another block, and sees more than the channels alone.
    trusted: bool,
}

impl Joint {
    /// Nothing has been learnt.
    pub fn new() -> Self {
        Self {
            judged: [[0.0; CHANNELS]; ROWS],
            filled: 0,
            sum: Box::new(Square::zeros()),
            rows: 0,
            taken: 0,
            refused: 0,
            learnt: None,
            trusted: false,
        }
    }

    /// The spikes of the row that is judged, beyond `threshold` standard deviations; `None` where this cannot tell.
    pub fn spikes(&mut self, rows: &[[f64; CHANNELS]; ROWS], threshold: f64) -> Option<[Option<Found>; CHANNELS]> {
        let learnt = self.learnt.as_ref()?;
        let mut found = [const { None }; CHANNELS];
        if let Some(spikes) = learnt.explained(&differences(rows), threshold) {
            for (place, spike) in spikes.into_iter().filter(|(place, _)| place.row == CENTRE) {
                found[place.channel] = Some(spike);
            }
        } else {
            self.refused += 1;
        }
        self.trusted.then_some(found)
    }

    /// Takes a row that has been judged. What was altered, or is unusual, is not learnt from: it would bear out what altered it.
    pub fn take(&mut self, row: &[f64; CHANNELS], is_altered: bool) {
        self.judged.copy_within(1.., 0);
        self.judged[ROWS - 1] = *row;
        self.filled = if is_altered { 0 } else { ROWS.min(self.filled + 1) };
        self.rows += 1;
        let seen = differences(&self.judged);
        if self.filled == ROWS && self.learnt.as_ref().is_none_or(|learnt| learnt.describes(&seen)) {
            self.sum.ger(1.0, &seen, &seen, 1.0);
            self.taken += 1;
        }
    }

    /// The next row does not follow the last.
    pub fn interrupt(&mut self) {
        self.filled = 0;
    }

    /// What was seen since the last time is learnt; all is forgotten if that was little. `alone` are the standard deviations with which each channel sees a
    /// spike by itself.
    pub fn end_block(&mut self, alone: &[Option<f64>; CHANNELS]) {
        if self.taken * LITTLE < self.rows {
            self.learnt = None;
            self.forget_block();
        }
        if self.taken < LEAST {
            return;
        }
        let is_tried = self.learnt.is_some() && self.refused * REFUSED < self.rows;
        // the inverse of a covariance from so few windows is too large by this on average (Wishart)
        let covariance = *self.sum / (f64::from(self.taken) - SIZE as f64 - 1.0);
        let learnt = Learnt::of(&covariance).map(Box::new);
        self.trusted = is_tried && learnt.as_ref().is_some_and(|learnt| learnt.is_worth(alone));
        self.learnt = learnt;
        self.forget_block();
    }

    fn forget_block(&mut self) {
        self.sum.fill(0.0);
        (self.rows, self.taken, self.refused) = (0, 0, 0);
    }
}

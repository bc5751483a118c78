//! Spikes that hide in what the deck does: found by what all channels of a unit say together.
//!
//! A flexure that is driven at every instant makes the accelerometers at the end of a lever arm as rough as spikes of fifty deviations of their noise, and
//! the gyros say at the same instant how much of that is flexure. How second differences of all channels go together over a few samples is learnt from the
//! stretch itself. From that follows how far each value is off what all the others say; the fewest spikes that explain a window are taken out (W. Baarda's
//! data snooping, 1968). What few spikes do not explain is left as it is: a slam is felt by all channels together, but otherwise than usual.

use super::spike::{AHEAD, CENTRE, Found, ROWS};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

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

/// What a spike of one does to the differences. The places are those of the row that is judged, then those of the rows ahead.
fn reach(place: usize) -> Differences {
    let (row, channel) = (CENTRE + place / CHANNELS, place % CHANNELS);
    let mut out = Differences::zeros();
    let weights = [(row, 1.0), (row - 1, -2.0), (row - 2, 1.0)];
    weights
        .into_iter()
        .filter(|(row, _)| *row < ROWS - 2)
        .for_each(|(row, weight)| out[row * CHANNELS + channel] = weight);
    out
}

fn differences(rows: &[[f64; CHANNELS]; ROWS]) -> Differences {
    Differences::from_fn(|i, _| {
        let (row, channel) = (i / CHANNELS, i % CHANNELS);
        rows[row][channel] - 2.0 * rows[row + 1][channel] + rows[row + 2][channel]
    })
}

/// What a spike at a place does.
#[derive(Clone, Copy, Debug)]
struct Spike {
    /// The differences that one of size one makes.
    reach: Differences,
    /// By what the differences are weighted to see its size.
    weights: Differences,
    /// Standard deviation with which its size is seen.
    sigma: f64,
}

/// Some of the places, in their order, with the sizes of spikes there that explain differences best.
#[derive(Clone, Copy, Debug, Default)]
struct Taken {
    places: [usize; MOST],
    count: usize,
    sizes: Vector3<f64>,
    /// By how much the square sum of the differences is less without them.
    gain: f64,
}

impl Taken {
    fn places(&self) -> &[usize] {
        &self.places[..self.count]
    }

    fn with(mut self, place: usize) -> Self {
        self.places[self.count] = place;
        self.count += 1;
        self
    }

    /// Whether so many of them are of a channel that no more may be.
    fn is_full(&self, channel: usize) -> bool {
        self.places().iter().filter(|&&place| place % CHANNELS == channel).count() == IN_CHANNEL
    }
}

/// What is known of the differences.
#[derive(Debug)]
struct Learnt {
    information: Square,
    /// Channels that do not move have none.
    spikes: [Option<Spike>; PLACES],
    /// What a spike at one place says of one at another.
    normal: SMatrix<f64, PLACES, PLACES>,
}

impl Learnt {
    /// `None` where the covariance has no inverse.
    fn of(covariance: &Square) -> Option<Self> {
        let scale = covariance.diagonal().map(|variance| if variance > 0.0 { variance.sqrt().recip() } else { 0.0 });
        let mut correlation = Square::from_fn(|i, j| covariance[(i, j)] * scale[i] * scale[j]);
        for i in 0..SIZE {
            correlation[(i, i)] = 1.0 + RIDGE;
        }
        let inverse = correlation.cholesky()?.inverse();
        let information = Square::from_fn(|i, j| inverse[(i, j)] * scale[i] * scale[j]);
        let spikes = std::array::from_fn(|place| {
            let reach = reach(place);
            let weights = information * reach;
            let seen = weights.dot(&reach);
            (seen > 0.0).then(|| Spike { reach, weights, sigma: seen.sqrt().recip() })
        });
        let both = |i: usize, j: usize| Some(spikes[i].as_ref()?.weights.dot(&spikes[j].as_ref()?.reach));
        let normal = SMatrix::from_fn(|i, j| both(i, j).unwrap_or(0.0));
        Some(Self { information, spikes, normal })
    }

    fn spikes(&self) -> impl Iterator<Item = (usize, &Spike)> {
        self.spikes.iter().enumerate().filter_map(|(place, spike)| Some((place, spike.as_ref()?)))
    }

    /// Whether it sees smaller spikes of the row that is judged than a channel by itself.
    fn is_worth(&self, alone: &[Option<f64>; CHANNELS]) -> bool {
        let mut judged = self.spikes().filter(|(place, _)| *place < CHANNELS);
        judged.any(|(place, spike)| alone[place].is_some_and(|alone| alone > WORTH * spike.sigma))
    }

    /// Whether differences are no more unusual than they ever are.
    fn describes(&self, seen: &Differences) -> bool {
        seen.dot(&(self.information * seen)) < LARGEST * SIZE as f64
    }

    /// The places with the sizes there; `None` where they cannot be told apart.
    fn sized(&self, taken: Taken, weighted: &[f64; PLACES]) -> Option<Taken> {
        let (mut normal, mut right) = (Matrix3::identity(), Vector3::zeros());
        for (i, &one) in taken.places().iter().enumerate() {
            right[i] = weighted[one];
            for (j, &other) in taken.places().iter().enumerate() {
                normal[(i, j)] = self.normal[(one, other)];
            }
        }
        let sizes = normal.lu().solve(&right)?;
        Some(Taken { sizes, gain: sizes.dot(&right), ..taken })
    }

    /// Adds places up to `count`, and keeps those that explain most.
    fn search(&self, weighted: &[f64; PLACES], count: usize, taken: Taken, best: &mut Taken) {
        if taken.count == count {
            if let Some(taken) = self.sized(taken, weighted).filter(|taken| taken.gain > best.gain) {
                *best = taken;
            }
            return;
        }
        let first = taken.places().last().map_or(0, |last| last + 1);
        for (next, _) in self.spikes().filter(|(place, _)| *place >= first && !taken.is_full(place % CHANNELS)) {
            self.search(weighted, count, taken.with(next), best);
        }
    }

    /// Whether what places leave of differences is no spike beyond `threshold` standard deviations at any other, and whether it is usual.
    fn judged(&self, taken: &Taken, seen: &Differences, threshold: f64) -> (bool, bool) {
        let spikes =
            taken.places().iter().zip(&taken.sizes).filter_map(|(&place, size)| Some((self.spikes[place]?, size)));
        let left = spikes.fold(*seen, |left, (spike, &size)| left - spike.reach * size);
        let is_quiet = |(place, spike): (usize, &Spike)| {
            taken.places().contains(&place) || (spike.weights.dot(&left) * spike.sigma).abs() < threshold
        };
        (self.spikes().all(is_quiet), self.describes(&left))
    }

    /// The fewest spikes that explain differences, none at all included, so that no other is beyond `threshold` standard deviations; `None` where few do
    /// not.
    fn explained(&self, seen: &Differences, threshold: f64) -> Option<Taken> {
        if let (true, is_usual) = self.judged(&Taken::default(), seen, threshold) {
            return is_usual.then(Taken::default);
        }
        let mut weighted = [0.0; PLACES];
        self.spikes().for_each(|(place, spike)| weighted[place] = spike.weights.dot(seen));
        (1..=MOST).find_map(|count| {
            let mut best = Taken::default();
            self.search(&weighted, count, Taken::default(), &mut best);
            (self.judged(&best, seen, threshold) == (true, true)).then_some(best)
        })
    }
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
    learnt: Box<Option<Learnt>>,
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
            learnt: Box::new(None),
            trusted: false,
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        (*self.learnt, self.trusted) = (None, false);
        self.interrupt();
        self.begin_block();
    }

    /// The spikes of the row that is judged, beyond `threshold` standard deviations; `None` where this cannot tell.
    pub fn spikes(&mut self, rows: &[[f64; CHANNELS]; ROWS], threshold: f64) -> Option<[Option<Found>; CHANNELS]> {
        let learnt = self.learnt.as_ref().as_ref()?;
        let mut found = [const { None }; CHANNELS];
        if let Some(taken) = learnt.explained(&differences(rows), threshold) {
            for (&place, &excess) in taken.places().iter().zip(&taken.sizes).filter(|(place, _)| **place < CHANNELS) {
                found[place] = learnt.spikes[place].map(|spike| Found { excess, sigma: spike.sigma });
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
        if self.filled == ROWS && self.learnt.as_ref().as_ref().is_none_or(|learnt| learnt.describes(&seen)) {
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
            *self.learnt = None;
            self.begin_block();
        }
        if self.taken < LEAST {
            return;
        }
        let is_tried = self.learnt.is_some() && self.refused * REFUSED < self.rows;
        // the inverse of a covariance from so few windows is too large by this on average (Wishart)
        let covariance = *self.sum / (f64::from(self.taken) - SIZE as f64 - 1.0);
        *self.learnt = Learnt::of(&covariance);
        self.trusted = is_tried && self.learnt.as_ref().as_ref().is_some_and(|learnt| learnt.is_worth(alone));
        self.begin_block();
    }

    fn begin_block(&mut self) {
        self.sum.fill(0.0);
        (self.rows, self.taken, self.refused) = (0, 0, 0);
    }
}

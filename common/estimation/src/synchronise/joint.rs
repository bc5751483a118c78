//! Spikes that hide in what the deck does: found by what all channels of a unit say together.
//!
//! A flexure that is driven at every instant makes the accelerometers at the end of a lever arm as rough as spikes of fifty deviations of their noise, and
//! the gyros say at the same instant how much of that is flexure. How second differences of all channels go together over a few samples is learnt from the
//! stretch itself. From that follows how far each value is off what all the others say; the fewest spikes that explain a window are taken out (W. Baarda's
//! data snooping, 1968). What few spikes do not explain is left as it is: a slam is felt by all channels together, but otherwise than usual. A value that
//! was replaced is never evidence: what is said holds whatever it should have been, or one wrong replacement would bring about the next.

use super::spike::{AHEAD, CENTRE, Found, ROWS};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

pub(super) const CHANNELS: usize = 6;
/// Second differences of all channels between the first row and the last.
const SIZE: usize = CHANNELS * (ROWS - 2);
/// The values of a window.
const VALUES: usize = CHANNELS * ROWS;
/// Those that are judged already.
const PAST: usize = CHANNELS * CENTRE;
/// The others: of the row that is judged, then of those ahead.
const PLACES: usize = CHANNELS * (AHEAD + 1);
/// So many spikes explain a window at most.
const MOST: usize = 3;
/// Of these, so many of one channel: those of all rows ahead would explain any step.
const IN_CHANNEL: usize = AHEAD;
/// So many values of the past may be doubtful.
const DOUBTFUL: usize = 6;
/// What is left of a value's information beside doubtful ones is none below so much of it.
const TOLD_APART: f64 = 1e-6;
/// The squares that are left sum to so many times what is usual at most.
const LARGEST: f64 = 3.0;
/// What was learnt describes a block if the squares that are left sum to so many times what is usual on average: .89 to 1.14 were seen of what held, and up to
/// 1.9 of what did not.
const AVERAGE: f64 = 1.2;
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
/// The values that are known to be wrong: they were replaced, or could not be any more.
pub(super) type Doubts = [[bool; CHANNELS]; ROWS];

/// What one added to a value does to the differences.
fn reach(value: usize) -> Differences {
    let (row, channel) = (value / CHANNELS, value % CHANNELS);
    let mut out = Differences::zeros();
    for (back, weight) in [1.0, -2.0, 1.0].into_iter().enumerate() {
        if let Some(first) = row.checked_sub(back).filter(|first| *first < ROWS - 2) {
            out[first * CHANNELS + channel] = weight;
        }
    }
    out
}

fn differences(rows: &[[f64; CHANNELS]; ROWS]) -> Differences {
    Differences::from_fn(|i, _| {
        let (row, channel) = (i / CHANNELS, i % CHANNELS);
        rows[row][channel] - 2.0 * rows[row + 1][channel] + rows[row + 2][channel]
    })
}

/// What is known of the differences.
#[derive(Debug)]
struct Learnt {
    information: Square,
    /// How many differences vary.
    size: usize,
    /// By what the differences are weighted to see what is added to each value, and what is seen of it by what is added to another.
    weights: SMatrix<f64, SIZE, VALUES>,
    normal: SMatrix<f64, VALUES, VALUES>,
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
        let reaches = SMatrix::<f64, SIZE, VALUES>::from_columns(&std::array::from_fn::<_, VALUES, _>(reach));
        let weights = information * reaches;
        let size = scale.iter().filter(|scale| **scale > 0.0).count();
        Some(Self { information, size, weights, normal: reaches.transpose() * weights })
    }

    /// Standard deviation with which a spike of a channel of the row that is judged is seen; `None` of a channel that does not move.
    fn sigma(&self, channel: usize) -> Option<f64> {
        let seen = self.normal[(PAST + channel, PAST + channel)];
        (seen > 0.0).then(|| seen.sqrt().recip())
    }

    /// Whether it sees smaller spikes of the row that is judged than a channel by itself.
    fn is_worth(&self, alone: &[Option<f64>; CHANNELS]) -> bool {
        let mut both = (0..CHANNELS).filter_map(|channel| alone[channel].zip(self.sigma(channel)));
        both.any(|(alone, sigma)| alone > WORTH * sigma)
    }

    fn square(&self, seen: &Differences) -> f64 {
        seen.dot(&(self.information * seen))
    }

    /// Whether differences are no more unusual than they ever are.
    fn describes(&self, seen: &Differences) -> bool {
        self.square(seen) < LARGEST * self.size as f64
    }

    /// What differences say of spikes, whatever the doubtful values of the past should have been; `None` where these are too many.
    fn evidence(&self, seen: &Differences, doubts: &Doubts) -> Option<Evidence> {
        let mut evidence = Evidence {
            weighted: self.weights.fixed_columns::<PLACES>(PAST).tr_mul(seen),
            normal: self.normal.fixed_view::<PLACES, PLACES>(PAST, PAST).into_owned(),
            square: self.square(seen),
            size: self.size,
        };
        let (mut doubtful, mut count) = ([0; DOUBTFUL], 0);
        let is_doubtful =
            |value: &usize| doubts[value / CHANNELS][value % CHANNELS] && self.normal[(*value, *value)] > 0.0;
        for value in (0..PAST).filter(is_doubtful) {
            *doubtful.get_mut(count)? = value;
            count += 1;
        }
        if count == 0 {
            return Some(evidence);
        }
        let doubtful = &doubtful[..count];
        evidence.size -= count;
        let (mut normal, mut weighted) =
            (SMatrix::<f64, DOUBTFUL, DOUBTFUL>::identity(), SVector::<f64, DOUBTFUL>::zeros());
        let mut across = SMatrix::<f64, DOUBTFUL, PLACES>::zeros();
        for (i, &value) in doubtful.iter().enumerate() {
            weighted[i] = self.weights.column(value).dot(seen);
            across.set_row(i, &self.normal.fixed_view::<1, PLACES>(value, PAST));
            for (j, &other) in doubtful.iter().enumerate() {
                normal[(i, j)] = self.normal[(value, other)];
            }
        }
        let inverse = normal.try_inverse()?;
        evidence.square -= weighted.dot(&(inverse * weighted));
        evidence.weighted -= across.tr_mul(&(inverse * weighted));
        let known = evidence.normal.diagonal();
        evidence.normal -= across.tr_mul(&(inverse * across));
        for place in 0..PLACES {
            if evidence.normal[(place, place)] < TOLD_APART * known[place] {
                evidence.normal.column_mut(place).fill(0.0);
                evidence.normal.row_mut(place).fill(0.0);
            }
        }
        Some(evidence)
    }
}

/// Some of the places, in their order, with the sizes of spikes there that explain a window best.
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

/// What a window says of spikes at the places, by least squares.
#[derive(Clone, Debug)]
struct Evidence {
    weighted: SVector<f64, PLACES>,
    normal: SMatrix<f64, PLACES, PLACES>,
    /// The square sum of the differences, and of how many.
    square: f64,
    size: usize,
}

impl Evidence {
    /// Those at which a spike is seen.
    fn places(&self) -> impl Iterator<Item = usize> {
        (0..PLACES).filter(|&place| self.normal[(place, place)] > 0.0)
    }

    fn sigma(&self, place: usize) -> f64 {
        self.normal[(place, place)].sqrt().recip()
    }

    /// The places with the sizes there; `None` where they cannot be told apart.
    fn sized(&self, taken: Taken) -> Option<Taken> {
        let (mut normal, mut right) = (Matrix3::identity(), Vector3::zeros());
        for (i, &one) in taken.places().iter().enumerate() {
            right[i] = self.weighted[one];
            for (j, &other) in taken.places().iter().enumerate() {
                normal[(i, j)] = self.normal[(one, other)];
            }
        }
        let sizes = normal.lu().solve(&right)?;
        Some(Taken { sizes, gain: sizes.dot(&right), ..taken })
    }

    /// Adds places up to `count`, and keeps those that explain most.
    fn search(&self, count: usize, taken: Taken, best: &mut Taken) {
        if taken.count == count {
            if let Some(taken) = self.sized(taken).filter(|taken| taken.gain > best.gain) {
                *best = taken;
            }
            return;
        }
        let first = taken.places().last().map_or(0, |last| last + 1);
        for next in self.places().filter(|&place| place >= first && !taken.is_full(place % CHANNELS)) {
            self.search(count, taken.with(next), best);
        }
    }

    /// By how much what places leave is more than is usual.
    fn unusual(&self, taken: &Taken) -> f64 {
        (self.square - taken.gain) / self.size as f64
    }

    /// Whether what places leave is no spike beyond `threshold` standard deviations at any other.
    fn is_quiet(&self, taken: &Taken, threshold: f64) -> bool {
        let left = |place: usize| {
            let told = taken.places().iter().zip(&taken.sizes).map(|(&other, size)| self.normal[(place, other)] * size);
            self.weighted[place] - told.sum::<f64>()
        };
        let mut others = self.places().filter(|place| !taken.places().contains(place));
        others.all(|place| (left(place) * self.sigma(place)).abs() < threshold)
    }

    /// The fewest spikes that explain the window, none at all included, so that no other is beyond `threshold` standard deviations; `None` where few do
    /// not.
    fn explained(&self, threshold: f64) -> Option<Taken> {
        let is_usual = |taken: &Taken| self.unusual(taken) < LARGEST;
        if self.is_quiet(&Taken::default(), threshold) {
            return Some(Taken::default()).filter(is_usual);
        }
        (1..=MOST).find_map(|count| {
            let mut best = Taken::default();
            self.search(count, Taken::default(), &mut best);
            Some(best).filter(|best| self.is_quiet(best, threshold) && is_usual(best))
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
    /// By how much the others were more than is usual, and how many they were.
    unusual: f64,
    explained: u32,
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
            unusual: 0.0,
            explained: 0,
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
    pub fn spikes(
        &mut self,
        rows: &[[f64; CHANNELS]; ROWS],
        doubts: &Doubts,
        threshold: f64,
    ) -> Option<[Option<Found>; CHANNELS]> {
        let learnt = self.learnt.as_ref().as_ref()?;
        let mut found = [const { None }; CHANNELS];
        let evidence = learnt.evidence(&differences(rows), doubts);
        let explained = evidence.and_then(|evidence| Some((evidence.explained(threshold)?, evidence)));
        if let Some((taken, evidence)) = explained {
            self.unusual += evidence.unusual(&taken);
            self.explained += 1;
            for (&place, &excess) in taken.places().iter().zip(&taken.sizes).filter(|(place, _)| **place < CHANNELS) {
                found[place] = Some(Found { excess, sigma: evidence.sigma(place) });
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
        let is_tried = self.learnt.is_some()
            && self.refused * REFUSED < self.rows
            && self.unusual < AVERAGE * f64::from(self.explained);
        // the inverse of a covariance from so few windows is too large by this on average (Wishart)
        let covariance = *self.sum / (f64::from(self.taken) - SIZE as f64 - 1.0);
        *self.learnt = Learnt::of(&covariance);
        self.trusted = is_tried && self.learnt.as_ref().as_ref().is_some_and(|learnt| learnt.is_worth(alone));
        self.begin_block();
    }

    fn begin_block(&mut self) {
        self.sum.fill(0.0);
        (self.rows, self.taken, self.refused) = (0, 0, 0);
        (self.unusual, self.explained) = (0.0, 0);
    }
}

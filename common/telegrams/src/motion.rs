//! The deck's attitude of the last moments, and where it will be in the next ones.

use crate::Attitude;
use frames::{Nav, Rot, Sub, Vec3, unit};

/// An attitude may be carried forward for so long, ns.
pub const LONGEST_NS: i64 = 50_000_000;
/// Instants that a rate is taken between lie at least so far apart, ns: the noise of attitudes a millisecond apart would drown it.
const SPACING_NS: i64 = 9_000_000;
/// Attitudes further apart than this tell no rate, ns.
const GAP_NS: i64 = 250_000_000;

/// The attitude at an instant.
#[derive(Clone, Copy, Debug)]
struct Point {
    time_ns: i64,
    deck: Rot<Nav, Sub>,
    sigma: Vec3<Nav>,
}

/// The attitudes from which rate and extrapolation are taken.
///
/// The rate is the median, component by component, of those over the last three intervals: a step of the main INS or of the filter
/// lies in one interval only, and so never shows as a rate.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion {
    newest: Option<Point>,
    /// The newest last.
    spaced: [Option<Point>; 4],
}

impl Motion {
    /// Takes in `C_s^n` and the standard deviations of its error about east, north and up (rad) at a data time.
    pub fn see(&mut self, time_ns: i64, deck: Rot<Nav, Sub>, sigma: Vec3<Nav>) {
        let since_ns = self.newest.map_or(0, |newest| time_ns - newest.time_ns);
        if !(0..=GAP_NS).contains(&since_ns) {
            *self = Self::default();
        }
        let point = Point { time_ns, deck, sigma };
        self.newest = Some(point);
        if self.spaced[3].is_none_or(|last| time_ns - last.time_ns >= SPACING_NS) {
            self.spaced.rotate_left(1);
            self.spaced[3] = Some(point);
        }
    }

    /// The attitude at a data time, or at the latest one that the newest attitude may be carried forward to; with that time.
    ///
    /// `None` before there is a rate, and when the newest attitude is older than [`LONGEST_NS`] or newer than the time.
    pub fn at(&self, time_ns: i64, lead_ns: i64) -> Option<(Attitude, i64)> {
        let newest = self.newest?;
        let age_ns = time_ns - newest.time_ns;
        if !(0..=LONGEST_NS).contains(&age_ns) {
            return None;
        }
        let forward_ns = (age_ns + lead_ns).clamp(0, LONGEST_NS);
        let forward_s = unit::seconds(forward_ns);
        let (rate, change, age_s) = self.rate()?;
        let deck = Rot::<Nav, Nav>::exp(rate * forward_s) * newest.deck;
        // the rate is that of a while ago, and it does not stay what it is
        let missed = forward_s * (0.5 * forward_s + age_s);
        let widened = [0, 1, 2].map(|i| newest.sigma.array()[i].hypot(change.array()[i] * missed));
        Attitude::new(deck, widened.into(), rate).map(|attitude| (attitude, newest.time_ns + forward_ns))
    }

    /// The rate, by how much it changes in a second, and for how long it has been the rate of the past, s.
    fn rate(&self) -> Option<(Vec3<Nav>, Vec3<Nav>, f64)> {
        let [Some(a), Some(b), Some(c), Some(d)] = self.spaced else { return None };
        let rates = [mean_rate(&a, &b), mean_rate(&b, &c), mean_rate(&c, &d)];
        let between_s = unit::seconds((d.time_ns + c.time_ns - b.time_ns - a.time_ns) / 2);
        let change = (rates[2] - rates[0]) / between_s;
        let median = [0, 1, 2].map(|i| middle(rates.map(|rate| rate.array()[i])));
        let newest_ns = self.newest?.time_ns;
        Some((median.into(), change, unit::seconds(newest_ns - (b.time_ns + c.time_ns) / 2)))
    }
}

fn mean_rate(from: &Point, to: &Point) -> Vec3<Nav> {
    (to.deck * from.deck.inverse()).log() / unit::seconds(to.time_ns - from.time_ns)
}

fn middle([a, b, c]: [f64; 3]) -> f64 {
    a.min(b).max(a.max(b).min(c))
}

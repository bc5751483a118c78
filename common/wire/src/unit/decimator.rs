//! A unit that samples faster than the run: so many of its samples are summed to one.

use super::Heard;
use frames::{Rot, Sub, Vec3};
use messages::{Flags, ImuSample};

/// A sum that lacks at most so large a share of its samples stands for all of them.
const LARGEST_SHARE: f64 = 0.25;

/// Sums samples whose numbers follow each other. Sum `k` ends with sample `k` times the factor, at which a slower unit would have sampled.
#[derive(Debug)]
pub(super) struct Decimator {
    factor: u64,
    sum: Option<Sum>,
}

/// What has come of a sum.
#[derive(Clone, Copy, Debug)]
struct Sum {
    number: u64,
    taken: u64,
    /// The turn by the angle increments, which do not commute.
    turn: Rot<Sub, Sub>,
    dvel: [f64; 3],
    flags: Flags,
    last: Heard,
}

impl Decimator {
    /// Of so many samples to one.
    pub fn new(factor: u32) -> Self {
        Self { factor: u64::from(factor.max(1)), sum: None }
    }

    /// Forgets what has come: the numbers start anew.
    pub fn restart(&mut self) {
        self.sum = None;
    }

    /// Takes a sample, and gives the sum that it ends; one whose last samples were lost comes with the next sample.
    pub fn take(&mut self, heard: Heard) -> Option<Heard> {
        if self.factor == 1 {
            return Some(heard);
        }
        let number = heard.sample.header.sequence.div_ceil(self.factor);
        let overdue = self.sum.take_if(|sum| sum.number != number).and_then(|sum| self.end(&sum));
        let sample = &heard.sample;
        let sum = self.sum.get_or_insert(Sum {
            number,
            taken: 0,
            turn: Rot::identity(),
            dvel: [0.0; 3],
            flags: Flags::empty(),
            last: heard,
        });
        sum.taken += 1;
        sum.turn = sum.turn * Rot::<Sub, Sub>::exp(Vec3::from(sample.dtheta));
        sum.dvel = std::array::from_fn(|axis| sum.dvel[axis] + sample.dvel[axis]);
        sum.flags |= sample.flags;
        sum.last = heard;
        // a sum of two or more never ends with the sample that shows that the one before has ended
        if overdue.is_some() || sample.header.sequence != number * self.factor {
            return overdue;
        }
        self.sum.take().and_then(|sum| self.end(&sum))
    }

    /// The sum as a sample; `None` if too little of it came. What is missing of it felt what the others felt on the mean.
    fn end(&self, sum: &Sum) -> Option<Heard> {
        let Sum { number, taken, turn, dvel, mut flags, last } = *sum;
        let missing = self.factor - taken;
        if missing as f64 > LARGEST_SHARE * self.factor as f64 {
            return None;
        }
        let whole = self.factor as f64 / taken as f64;
        flags.set(Flags::BRIDGED, missing > 0);
        let interval_ns = last.sample.interval_ns * self.factor as i64;
        let late_ns = (number * self.factor - last.sample.header.sequence) as i64 * last.sample.interval_ns;
        let mut header = last.sample.header;
        (header.sequence, header.time_ns) = (number, header.time_ns + late_ns);
        let sample = ImuSample {
            header,
            interval_ns,
            dtheta: (turn.log() * whole).array(),
            dvel: dvel.map(|v| v * whole),
            flags,
            ..last.sample
        };
        let attitude =
            last.attitude.filter(|_| late_ns == 0).map(|attitude| messages::MainAttitude { header, ..attitude });
        Some(Heard { sample, attitude, ..last })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Header;

    const INTERVAL_NS: i64 = 500_000;

    fn increment(k: u64) -> [f64; 3] {
        let t = k as f64;
        [1e-3 * (t * 0.3).sin(), 2e-3 * (t * 0.5).cos(), -1e-3]
    }

    fn heard(k: u64) -> Heard {
        let header = Header { sequence: k, time_ns: k as i64 * INTERVAL_NS, ..Header::default() };
        let (dtheta, dvel) = (increment(k), [1.0, k as f64, 0.0]);
        let sample = ImuSample { header, interval_ns: INTERVAL_NS, dtheta, dvel, ..ImuSample::default() };
        Heard { sample, attitude: None, device_ns: 0, utc_offset_ns: None, arrival_ns: 0 }
    }

    fn sums(numbers: impl Iterator<Item = u64>) -> Vec<ImuSample> {
        let mut decimator = Decimator::new(20);
        numbers.filter_map(|k| decimator.take(heard(k))).map(|heard| heard.sample).collect()
    }

    /// The turn by the samples behind a number up to another one.
    fn turn(from: u64, to: u64) -> Rot<Sub, Sub> {
        (from + 1..=to).fold(Rot::identity(), |turn, k| turn * Rot::<Sub, Sub>::exp(increment(k).into()))
    }

    #[test]
    fn no_increment_is_lost_or_felt_twice() {
        let sums = sums(7..=2000);
        assert!(sums.iter().map(|sum| sum.header.sequence).eq(2..=100));
        let mut total = Rot::<Sub, Sub>::identity();
        for sum in &sums {
            let number = sum.header.sequence;
            assert_eq!((sum.header.time_ns, sum.interval_ns), (number as i64 * 10_000_000, 10_000_000));
            assert_eq!(sum.flags, Flags::empty());
            let expected = (20 * number - 19..=20 * number).map(|k| k as f64).sum::<f64>();
            assert_eq!(sum.dvel, [20.0, expected, 0.0]);
            total = total * Rot::<Sub, Sub>::exp(sum.dtheta.into());
        }
        assert!((total.inverse() * turn(20, 2000)).angle() < 1e-12);
    }

    #[test]
    fn what_is_missing_is_filled_in_where_it_is_little_and_else_not_given() {
        // one in the middle, the last one, a quarter, more than a quarter
        let lost = |k: &u64| *k != 47 && *k != 80 && !(105..110).contains(k) && !(121..=126).contains(k);
        let sums = sums((1..=200).filter(lost));
        let bridged = |sum: &ImuSample| sum.flags.contains(Flags::BRIDGED);
        let found: Vec<(u64, bool)> = sums.iter().map(|sum| (sum.header.sequence, bridged(sum))).collect();
        let expected =
            [(1, false), (2, false), (3, true), (4, true), (5, false), (6, true), (8, false), (9, false), (10, false)];
        assert_eq!(found, expected);
        for sum in &sums {
            let number = sum.header.sequence;
            assert_eq!(sum.header.time_ns, number as i64 * 10_000_000);
            let off = (turn(20 * number - 20, 20 * number).inverse() * Rot::<Sub, Sub>::exp(sum.dtheta.into())).angle();
            // no more than the five increments that are missing at most
            assert!(off < if bridged(sum) { 5.0 * 2.5e-3 } else { 1e-12 }, "{number}: {off}");
        }
    }

    #[test]
    fn a_unit_at_the_runs_rate_is_passed_on() {
        let mut decimator = Decimator::new(1);
        for k in 0..5 {
            let passed = decimator.take(heard(k)).expect("all are given").sample;
            assert_eq!(passed, heard(k).sample);
        }
    }
}

use super::{Block, Envelope, Trace, blocks::Blocks};
use frames::{Main, Nav, Rot, unit};
use messages::{ImuPair, MainAttitude};

/// The ship's motion: roll, pitch and heading, degrees.
#[derive(Clone, Debug)]
pub struct ShipRun {
    /// Against time; the heading goes on beyond 0 and 360.
    pub angles: Trace<[Envelope; 3]>,
    blocks: Blocks,
    heading: Heading,
    by_attitude: bool,
}

impl ShipRun {
    /// Of samples that come so often.
    pub fn new(interval_ns: i64) -> Self {
        Self {
            angles: Trace::new(interval_ns),
            blocks: Blocks::new(interval_ns),
            heading: Heading::default(),
            by_attitude: false,
        }
    }

    /// Takes the attitude by the main INS.
    pub fn attitude(&mut self, since_ns: i64, attitude: &MainAttitude) {
        self.by_attitude = true;
        self.take(since_ns, attitude.q);
    }

    /// Takes the attitude that stands in a pair, where the INS's own is not recorded.
    pub fn pair(&mut self, since_ns: i64, pair: &ImuPair) {
        if !self.by_attitude && pair.ins != [0.0; 4] {
            self.take(since_ns, pair.ins);
        }
    }

    fn take(&mut self, since_ns: i64, q: [f64; 4]) {
        let Some(attitude) = Rot::<Nav, Main>::from_quaternion(q) else { return };
        let euler = attitude.euler();
        let heading = self.heading.next(euler.heading);
        let degrees = [euler.roll, euler.pitch, heading].map(|angle| angle / unit::DEGREE);
        self.angles.take(since_ns, degrees.map(Envelope::of));
        self.blocks.take(since_ns, degrees);
    }

    /// Figures every ten minutes.
    pub fn blocks(&self) -> Vec<Block> {
        self.blocks.clone().finish()
    }
}

/// A heading that does not jump from 360 degrees to 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct Heading {
    last: Option<f64>,
}

impl Heading {
    /// The angle (rad) that is nearest to the one before.
    pub fn next(&mut self, angle: f64) -> f64 {
        use std::f64::consts::TAU;
        let last = self.last.unwrap_or(angle);
        let angle = angle + TAU * ((last - angle) / TAU).round();
        self.last = Some(angle);
        angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use frames::Euler;

    #[test]
    fn a_heading_through_north_does_not_jump() {
        let mut ship = ShipRun::new(1_000_000_000);
        for i in 0..40i64 {
            let heading = (340.0 + i as f64) * unit::DEGREE;
            let q = Euler { roll: 0.1, pitch: -0.05, heading }.rotation::<Main>().quaternion();
            ship.attitude(i * 1_000_000_000, &MainAttitude { q, ..MainAttitude::default() });
        }
        let [block] = &ship.blocks()[..] else { panic!("one block") };
        let [roll, _, heading] = block.components;
        assert!((heading.most - heading.least - 39.0).abs() < 1e-9, "{heading:?}");
        assert!((roll.mean - 0.1 / unit::DEGREE).abs() < 1e-9);
    }

    #[test]
    fn the_attitude_of_a_pair_counts_only_where_there_is_no_other() {
        let mut ship = ShipRun::new(1);
        ship.pair(0, &ImuPair::default());
        assert!(ship.angles.is_empty());
        ship.pair(0, &ImuPair { ins: [1.0, 0.0, 0.0, 0.0], ..ImuPair::default() });
        ship.attitude(1, &MainAttitude { q: [1.0, 0.0, 0.0, 0.0], ..MainAttitude::default() });
        ship.pair(2, &ImuPair { ins: [1.0, 0.0, 0.0, 0.0], ..ImuPair::default() });
        assert_eq!(ship.angles.cells().len(), 2);
    }
}

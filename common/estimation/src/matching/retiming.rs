//! The units' attitudes of one moment, although the sub unit's stamps are late.
//!
//! Source: the time base of paper 002's reworking. The sub unit's attitude stamped `t` is that of `t - tau`. Re-timing belongs into the
//! estimator, for only the filter knows the delay: it keeps the attitudes of the last second and asks for the main unit's of an earlier
//! instant (or, when the stamps are early, for the sub unit's), so that nothing has to be waited for. ATTITUDES are interpolated, never rates:
//! nothing is lost or felt twice whatever the shift does, and a change of it leaves the accumulated attitudes as they are.
//!
//! Four points on SO(3): Lagrange's polynomial through the rotation vectors from the node before the instant.

use super::Motion;
use super::increment::{Increment, Velocities};
use frames::{Frame, Main, MainStart, Rot, Sub, SubStart, Vec3};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The largest shift, s.
pub const LONGEST_S: f64 = 1.0;
/// So much more is kept, s.
const MARGIN_S: f64 = 0.2;
/// A longer hole between two nodes is not bridged, s.
const HOLE_S: f64 = 0.25;
/// A rest of the delay beyond this goes into the shift, s.
const REST_S: f64 = 1e-3;
/// Room for the attitudes of units of up to 1000 Hz, so that nothing is allocated later.
const ROOM: usize = 1280;
/// Points of the polynomial.
const POINTS: usize = 4;

/// Both units at one moment, but for what the shift is wrong by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Together {
    /// The main unit's accumulated attitude.
    pub a_m: Rot<MainStart, Main>,
    /// The sub unit's.
    pub a_s: Rot<SubStart, Sub>,
    /// Rate of the main unit, rad/s.
    pub w_m: Vec3<Main>,
    /// What both units' accelerometers have gained since some instant, each at the moment that it felt.
    pub gained: Velocities,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Node {
    time_s: f64,
    a_m: Rot<MainStart, Main>,
    a_s: Rot<SubStart, Sub>,
    gained: Velocities,
}

/// Where an instant lies between the nodes, with weight and slope of each of [`POINTS`] nodes from the first on.
struct Place {
    left: usize,
    first: usize,
    weights: [(f64, f64); POINTS],
}

/// Attitudes that a filter re-times by the delay as it is known.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Retimed {
    attitudes: Attitudes,
    /// Whether a rest of the delay goes into the shift at all.
    absorbs: bool,
    shift: f64,
    together: Option<Together>,
}

impl Retimed {
    /// Without a shift so far.
    pub fn new(absorbs: bool) -> Self {
        Self { attitudes: Attitudes::new(ROOM), absorbs, shift: 0.0, together: None }
    }

    /// By how much the sub unit's stamps are taken to be late, s.
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// Both units at the last moment that both have felt.
    pub fn together(&self) -> Option<Together> {
        self.together
    }

    /// Takes in what both units felt.
    pub fn advance(&mut self, motion: &Motion) {
        self.attitudes.push(motion);
        self.together = self.attitudes.together(self.shift);
    }

    /// Takes in what both units felt, with their velocities.
    pub fn take(&mut self, time_s: f64, step: &Increment) {
        self.attitudes.take(time_s, step);
        self.together = self.attitudes.together(self.shift);
    }

    /// Forgets all attitudes.
    pub fn restart(&mut self) {
        self.attitudes.nodes.clear();
        self.together = None;
    }

    /// Takes over the rest of the delay, if it is large enough and may be; what stays in the rest is left there.
    pub fn absorb(&mut self, rest: &mut f64) {
        if self.absorbs && rest.abs() > REST_S {
            let shift = (self.shift + *rest).clamp(-LONGEST_S, LONGEST_S);
            *rest -= shift - self.shift;
            self.shift = shift;
            self.together = self.attitudes.together(shift);
        }
    }
}

/// The attitudes of the last second.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Attitudes {
    nodes: VecDeque<Node>,
    /// How many are kept at most.
    room: usize,
}

impl Attitudes {
    /// Room for so many.
    pub fn new(room: usize) -> Self {
        Self { nodes: VecDeque::with_capacity(room), room }
    }

    /// Those of instants in order, s, without velocities.
    pub fn of(instants: impl Iterator<Item = (f64, Rot<MainStart, Main>, Rot<SubStart, Sub>)>) -> Self {
        let node = |(time_s, a_m, a_s)| Node { time_s, a_m, a_s, gained: Velocities::ZERO };
        let nodes: VecDeque<Node> = instants.map(node).collect();
        Self { room: nodes.len(), nodes }
    }

    /// Takes in what both units felt.
    pub fn push(&mut self, motion: &Motion) {
        let Motion { time_s, a_m, a_s, .. } = *motion;
        self.keep(Node { time_s, a_m, a_s, gained: Velocities::ZERO });
    }

    /// Takes in what both units felt, with their velocities.
    fn take(&mut self, time_s: f64, step: &Increment) {
        let before = self.nodes.back().map_or(Velocities::ZERO, |node| node.gained);
        let more = step.velocities.unwrap_or(Velocities::ZERO);
        let gained = Velocities { m: before.m + more.m, s: before.s + more.s };
        self.keep(Node { time_s, a_m: step.a_m, a_s: step.a_s, gained });
    }

    fn keep(&mut self, node: Node) {
        let oldest_s = node.time_s - LONGEST_S - MARGIN_S;
        while self.nodes.len() > POINTS && self.nodes[0].time_s < oldest_s {
            self.nodes.pop_front();
        }
        if self.nodes.len() >= self.room {
            self.nodes.pop_front();
        }
        self.nodes.push_back(node);
    }

    /// Both units at the last moment that both have felt when the sub unit's stamps are late by `shift_s`; `None` while that is not covered.
    pub fn together(&self, shift_s: f64) -> Option<Together> {
        self.at(self.nodes.len().checked_sub(1)?, shift_s)
    }

    /// Both units at one moment: the sub unit's of a node where its stamps are late by `shift_s`, the main unit's where they are early.
    pub fn at(&self, node: usize, shift_s: f64) -> Option<Together> {
        let node = self.nodes.get(node)?;
        let main = self.place(node.time_s - shift_s.max(0.0))?;
        let (a_m, w_m) = self.attitude(&main, |node| node.a_m);
        let m = self.velocity(&main, |node| node.gained.m);
        let (a_s, s) = match shift_s {
            0.0.. => (node.a_s, node.gained.s),
            _ => {
                let sub = self.place(node.time_s + shift_s)?;
                (self.attitude(&sub, |node| node.a_s).0, self.velocity(&sub, |node| node.gained.s))
            }
        };
        Some(Together { a_m, a_s, w_m, gained: Velocities { m, s } })
    }

    /// Where an instant lies; `None` where it is not covered.
    fn place(&self, time_s: f64) -> Option<Place> {
        let nodes = &self.nodes;
        let right = nodes.partition_point(|node| node.time_s < time_s);
        if right == 0 || right == nodes.len() || nodes.len() < POINTS {
            return None;
        }
        let (left, first) = (right - 1, right.saturating_sub(2).min(nodes.len() - POINTS));
        let from_s = nodes[left].time_s;
        let at = |i: usize| nodes[first + i].time_s - from_s;
        let weights = std::array::from_fn(|i| lagrange(i, time_s - from_s, at));
        (nodes[right].time_s - from_s <= HOLE_S).then_some(Place { left, first, weights })
    }

    /// An attitude between the nodes, with its rate.
    fn attitude<A: Frame, B: Frame>(&self, place: &Place, of: impl Fn(&Node) -> Rot<A, B>) -> (Rot<A, B>, Vec3<B>) {
        let origin = of(&self.nodes[place.left]);
        let (mut turn, mut rate) = (Vec3::<B>::ZERO, Vec3::<B>::ZERO);
        for (i, (weight, slope)) in place.weights.into_iter().enumerate().filter(|(i, _)| place.first + i != place.left)
        {
            let phi = (origin.inverse() * of(&self.nodes[place.first + i])).log();
            turn += phi * weight;
            rate += phi * slope;
        }
        (origin * Rot::<B, B>::exp(turn), rate)
    }

    /// A velocity between the nodes.
    fn velocity<A: Frame>(&self, place: &Place, of: impl Fn(&Node) -> Vec3<A>) -> Vec3<A> {
        let origin = of(&self.nodes[place.left]);
        let weights = place.weights.into_iter().enumerate();
        weights.fold(origin, |sum, (i, (weight, _))| sum + (of(&self.nodes[place.first + i]) - origin) * weight)
    }
}

/// Lagrange's polynomial that is 1 at point `i` and 0 at the others, at `t`, with its slope.
fn lagrange(i: usize, t: f64, at: impl Fn(usize) -> f64) -> (f64, f64) {
    let (mut value, mut slope) = (1.0, 0.0);
    for j in (0..POINTS).filter(|&j| j != i) {
        let length = at(i) - at(j);
        slope = (slope * (t - at(j)) + value) / length;
        value *= (t - at(j)) / length;
    }
    (value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::conformance::{STEP_S, Voyage};
    use frames::unit::ARCSEC;

    fn voyage(delay_s: f64) -> Voyage {
        Voyage { installation: Rot::identity(), flexure: 0.0, delay_s, lever_arm: Vec3::ZERO }
    }

    fn attitudes(voyage: &Voyage, upto: usize) -> Attitudes {
        let mut attitudes = Attitudes::new(256);
        (1..=upto).for_each(|k| attitudes.push(&voyage.motion(k)));
        attitudes
    }

    #[test]
    fn two_units_on_a_rigid_ship_stay_as_they_were_whatever_the_delay() {
        for delay_s in [0.0, 0.0123, 0.2, -0.0577, 0.937] {
            let voyage = voyage(delay_s);
            let mut first = None;
            let mut attitudes = Attitudes::new(256);
            for k in 1..700 {
                attitudes.push(&voyage.motion(k));
                let Some(Together { a_m, a_s, w_m, .. }) = attitudes.together(delay_s) else { continue };
                let constant: Rot<MainStart, SubStart> = a_m * Rot::<Main, Sub>::identity() * a_s.inverse();
                let first = *first.get_or_insert(constant);
                assert!((constant * first.inverse()).angle() < 1e-4 * ARCSEC, "{delay_s} {k}");
                let moment = k as f64 * STEP_S - delay_s.max(0.0);
                assert!((w_m - voyage.rate(moment)).norm() < 2.0 * ARCSEC, "{delay_s} {k}");
            }
            assert!(first.is_some());
        }
    }

    #[test]
    fn an_instant_without_data_gives_nothing() {
        let mut attitudes = attitudes(&voyage(0.0), 50);
        assert!(attitudes.together(0.6).is_none() && attitudes.together(0.4).is_some());
        let mut late = voyage(0.0).motion(51);
        late.time_s += 0.5;
        attitudes.push(&late);
        assert!(attitudes.together(0.2).is_none() && attitudes.together(0.6).is_some());
        assert!(Attitudes::new(8).together(0.0).is_none());
    }
}

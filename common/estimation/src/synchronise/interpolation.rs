//! The sub unit's accumulated attitude at an instant between its samples.

use super::stream::Node;
use frames::{Rot, Sub, SubStart, Vec3};
use messages::Flags;
use std::collections::VecDeque;

/// The sub unit at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub attitude: Rot<SubStart, Sub>,
    /// Sum of the velocity increments, each in the body axes of its time.
    pub velocity: Vec3<Sub>,
    pub disturbance: f64,
    pub segment: u64,
    /// Index of the node at or before the instant.
    pub left: usize,
    pub source_ns: i64,
    pub flags: Flags,
}

/// What the data say of an instant.
#[derive(Clone, Copy, Debug)]
pub(super) enum Found {
    At(Point),
    /// Later samples are needed to say.
    Wait,
    /// No later sample can help: the instant lies in a hole, or before the first samples.
    Never,
}

type Nodes = VecDeque<Node<SubStart, Sub>>;

/// Looks up the instant; `ended` says that no further samples will come.
pub(super) fn at(nodes: &Nodes, time_ns: i64, near_ns: i64, ended: bool) -> Found {
    let right = nodes.partition_point(|node| node.header.time_ns < time_ns - near_ns);
    let Some(node) = nodes.get(right) else {
        return if ended { Found::Never } else { Found::Wait };
    };
    if node.header.time_ns <= time_ns + near_ns {
        return Found::At(beside(node, right, time_ns));
    }
    // two samples on either side, so that a restart at this instant gives the same bits
    if right < 2 || nodes[right - 2].segment != node.segment {
        return Found::Never;
    }
    match nodes.get(right + 1) {
        None if !ended => Found::Wait,
        next => Found::At(between(nodes, right, next.is_some_and(|next| next.segment == node.segment), time_ns)),
    }
}

/// At a sample that is as good as at the instant: turned on by its own rate over the rest, at most 1 % of an interval.
fn beside(node: &Node<SubStart, Sub>, index: usize, time_ns: i64) -> Point {
    let share = (time_ns - node.header.time_ns) as f64 / node.interval_ns as f64;
    Point {
        attitude: node.attitude * Rot::<Sub, Sub>::exp(node.dtheta * share),
        velocity: node.velocity + node.dvel * share,
        disturbance: node.disturbance,
        segment: node.segment,
        left: index,
        source_ns: node.header.stamps.source_ns,
        flags: node.flags,
    }
}

/// Four points (three at the end of a segment): Lagrange's polynomial through the rotation vectors from the left node.
fn between(nodes: &Nodes, right: usize, four: bool, time_ns: i64) -> Point {
    let left = &nodes[right - 1];
    let last = if four { right + 1 } else { right };
    let at = |i: usize| (nodes[i].header.time_ns - left.header.time_ns) as f64;
    let t = (time_ns - left.header.time_ns) as f64;
    let mut turn = Vec3::<Sub>::ZERO;
    for i in (right - 2..=last).filter(|&i| i != right - 1) {
        let weight: f64 = (right - 2..=last).filter(|&j| j != i).map(|j| (t - at(j)) / (at(i) - at(j))).product();
        turn += (left.attitude.inverse() * nodes[i].attitude).log() * weight;
    }
    let node = &nodes[right];
    let share = t / at(right);
    Point {
        attitude: left.attitude * Rot::<Sub, Sub>::exp(turn),
        velocity: left.velocity + (node.velocity - left.velocity) * share,
        // the whole of a sample's disturbance goes to the first pair that touches it
        disturbance: node.disturbance,
        segment: node.segment,
        left: right - 1,
        source_ns: nodes[last].header.stamps.source_ns,
        flags: node.flags | Flags::INTERPOLATED,
    }
}

//! The one table of topics.
//!
//! | topic | type | publisher | depth | history |
//! |---|---|---|---|---|
//! | `main/imu` | [`ImuSample`] | simulate, replay or acquire | 2048 | 0 |
//! | `main/attitude` | [`MainAttitude`] | simulate, replay or acquire | 2048 | 0 |
//! | `area/<name>/imu` | [`ImuSample`] | simulate, replay or acquire | 2048 | 0 |
//! | `area/<name>/truth` | [`Truth`] | simulate | 2048 | 0 |
//! | `area/<name>/pair` | [`ImuPair`] | synchronise | 2048 | 0 |
//! | `area/<name>/solution` | [`Solution`] | estimate | 2048 | 0 |
//! | `area/<name>/parameters` | [`FlexureParams`] | identify | 16 | 1 |
//! | `area/<name>/state` | [`StatePart`] | estimate | 512 | 0 |
//! | `area/<name>/state_wish` | [`StateWish`] | record | 16 | 1 |
//! | `line/main`, `line/area/<name>` | [`LineHealth`] | acquire | 16 | 1 |
//! | `output/<number>` | [`OutputState`] | output | 16 | 1 |
//! | `health/<stage>[/<name>]` | [`Health`] | each stage | 16 | 1 |
//!
//! Depth is the number of messages a reader may fall behind before the oldest are dropped: 20 s at 100 Hz. History is what a
//! reader that comes later still gets: 1 makes the topic latched.

use crate::{
    FlexureParams, Health, ImuPair, ImuSample, LineHealth, MainAttitude, Message, OutputState, Solution, Stage,
    StatePart, StateWish, Truth,
};
use std::marker::PhantomData;

/// A topic: a name and the quality of service that all its users share.
#[derive(Clone, Debug)]
pub struct Topic<M: Message> {
    /// Name of the service.
    pub name: String,
    /// How many messages a reader may fall behind.
    pub depth: usize,
    /// How many past messages a late reader gets.
    pub history: usize,
    message: PhantomData<M>,
}

const STREAM: (usize, usize) = (2048, 0);
const PARTS: (usize, usize) = (512, 0);
const LATCHED: (usize, usize) = (16, 1);

fn topic<M: Message>(name: String, (depth, history): (usize, usize)) -> Topic<M> {
    Topic { name, depth, history, message: PhantomData }
}

/// The main unit's samples.
pub fn main_imu() -> Topic<ImuSample> {
    topic("main/imu".into(), STREAM)
}

/// The main unit's attitude.
pub fn main_attitude() -> Topic<MainAttitude> {
    topic("main/attitude".into(), STREAM)
}

/// The samples of an area's unit.
pub fn area_imu(area: &str) -> Topic<ImuSample> {
    topic(format!("area/{area}/imu"), STREAM)
}

/// The truth of an area.
pub fn truth(area: &str) -> Topic<Truth> {
    topic(format!("area/{area}/truth"), STREAM)
}

/// The pairs of an area.
pub fn pair(area: &str) -> Topic<ImuPair> {
    topic(format!("area/{area}/pair"), STREAM)
}

/// The solutions of an area.
pub fn solution(area: &str) -> Topic<Solution> {
    topic(format!("area/{area}/solution"), STREAM)
}

/// The flexure parameters of an area.
pub fn parameters(area: &str) -> Topic<FlexureParams> {
    topic(format!("area/{area}/parameters"), LATCHED)
}

/// The states of an area's estimator, in parts.
pub fn state(area: &str) -> Topic<StatePart> {
    topic(format!("area/{area}/state"), PARTS)
}

/// The wish for them.
pub fn state_wish(area: &str) -> Topic<StateWish> {
    topic(format!("area/{area}/state_wish"), LATCHED)
}

/// The wire of a unit; `area` is `None` for the main unit.
pub fn line(area: Option<&str>) -> Topic<LineHealth> {
    let name = match area {
        Some(area) => format!("line/area/{area}"),
        None => "line/main".into(),
    };
    topic(name, LATCHED)
}

/// What a destination of `output` has been sent; its number is the place in the configuration.
pub fn output(number: usize) -> Topic<OutputState> {
    topic(format!("output/{number}"), LATCHED)
}

/// The health of a stage; `area` is `None` for the sources, which serve all.
pub fn health(stage: Stage, area: Option<&str>) -> Topic<Health> {
    let name = match area {
        Some(area) => format!("health/{}/{area}", stage.name()),
        None => format!("health/{}", stage.name()),
    };
    topic(name, LATCHED)
}

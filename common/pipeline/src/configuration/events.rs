//! What goes wrong with a simulated unit.

use super::{quantity, table};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use simulation::{Event, Trouble};

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    DeadAccelerometers,
    StuckGyro,
    Gap,
    DelayStep,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Axis {
    X,
    Y,
    Z,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EventTable {
    #[serde(deserialize_with = "quantity::change_s")]
    at_s: f64,
    kind: Kind,
    axis: Option<Axis>,
    #[serde(default, deserialize_with = "quantity::gap_s")]
    length_s: Option<f64>,
    #[serde(default, deserialize_with = "quantity::delay_ms")]
    by_ms: Option<f64>,
}

impl EventTable {
    fn event(&self) -> Result<Event, &'static str> {
        let trouble = match (self.kind, self.axis, self.length_s, self.by_ms) {
            (Kind::DeadAccelerometers, None, None, None) => Trouble::DeadAccelerometers,
            (Kind::StuckGyro, Some(axis), None, None) => Trouble::StuckGyro(axis as usize),
            (Kind::Gap, None, Some(length_s), None) => Trouble::Gap(length_s),
            (Kind::DelayStep, None, None, Some(by_s)) => Trouble::DelayStep(by_s),
            _ => {
                return Err("\"dead_accelerometers\" goes with no other key but `at_s`, \"stuck_gyro\" with `axis`, \
                            \"gap\" with `length_s`, \"delay_step\" with `by_ms`");
            }
        };
        Ok(Event { at_s: self.at_s, trouble })
    }
}

/// Events, in any order.
pub(super) fn events<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Event>, D::Error> {
    let tables: Vec<EventTable> = table::many(deserializer)?;
    tables.iter().map(EventTable::event).collect::<Result<_, _>>().map_err(D::Error::custom)
}

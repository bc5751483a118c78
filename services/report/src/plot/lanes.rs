//! What was the case when: a lane for each state, filled where it held.

use super::chart::{at, grid};
use super::layer::{HIGH, WIDE};
use super::{Axis, Layer};
use maud::{Markup, html};

/// A lane.
pub struct Lane {
    /// The state.
    pub name: String,
    /// Style of the stretches.
    pub class: &'static str,
    /// From when to when it held, s.
    pub stretches: Vec<(f64, f64)>,
}

/// The lanes below each other, against time from 0 to so many seconds.
pub fn lanes(about: &str, length_s: f64, lanes: &[Lane]) -> Markup {
    let x = Axis::time(length_s);
    let ticks = x.times(8);
    let y = Axis::time(1.0);
    html! {
        figure class="chart lanes" role="img" aria-label=(about) {
            @for lane in lanes {
                div class="lane" {
                    span class="name" { (lane.name) }
                    svg viewBox={ "0 0 " (WIDE) " " (HIGH) } preserveAspectRatio="none" aria-hidden="true" {
                        (grid(&ticks, &Vec::new()))
                        ({
                            // what is shorter than a point would not be seen
                            let least = length_s / 600.0;
                            let bars = lane.stretches.iter().map(|(from, to)| (*from, to.max(from + least), 1.0));
                            Layer::Bars { class: lane.class, bars: bars.collect() }.draw(&x, &y)
                        })
                    }
                }
            }
            div class="lane" { span class="name" {} div class="xs" {
                @for (i, (place, text)) in ticks.iter().enumerate() {
                    span class=[(i % 2 == 1).then_some("odd")] style=(at("left", *place)) { (text) }
                }
            } }
            p class="along" { "time since the first sample, min:s" }
        }
    }
}

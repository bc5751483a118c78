//! Panels below each other that share the axis along them.

use super::layer::{HIGH, WIDE};
use super::{Axis, Layer, Ticks};
use maud::{Markup, html};

/// An entry of the legend.
pub struct Key {
    /// Style of its sign.
    pub class: &'static str,
    /// What it is.
    pub text: String,
}

impl Key {
    /// A sign with its meaning.
    pub fn new(class: &'static str, text: impl Into<String>) -> Self {
        Self { class, text: text.into() }
    }
}

/// One panel.
pub struct Panel {
    /// What it shows, with the unit.
    pub title: String,
    /// The axis across.
    pub y: Axis,
    /// What is drawn, from behind to the front.
    pub layers: Vec<Layer>,
    /// How high it is.
    pub height: Height,
}

/// Heights of panels.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Height {
    /// Of a row of many.
    Low,
    /// Of one of three.
    Usual,
    /// Of one alone that has much to show.
    Tall,
}

impl Height {
    fn class(self) -> &'static str {
        match self {
            Self::Low => "frame low",
            Self::Usual => "frame",
            Self::Tall => "frame tall",
        }
    }

    fn ticks(self) -> usize {
        match self {
            Self::Low => 2,
            Self::Usual => 5,
            Self::Tall => 8,
        }
    }
}

/// A chart.
pub struct Chart {
    /// What it shows, for who cannot see it.
    pub about: String,
    /// The signs.
    pub keys: Vec<Key>,
    /// The axis along.
    pub x: Axis,
    /// Its numbers.
    pub ticks: Ticks,
    /// What it is of, with the unit.
    pub along: &'static str,
    /// The panels.
    pub panels: Vec<Panel>,
}

impl Chart {
    /// Against time from 0 to so many seconds.
    pub fn of_time(about: impl Into<String>, length_s: f64, keys: Vec<Key>, panels: Vec<Panel>) -> Self {
        let x = Axis::time(length_s);
        let ticks = x.times(8);
        Self { about: about.into(), keys, x, ticks, along: "time since the first sample, min:s", panels }
    }

    /// The chart as a figure of the page.
    pub fn draw(&self) -> Markup {
        html! {
            figure class="chart" role="img" aria-label=(self.about) {
                (legend(&self.keys))
                @for panel in &self.panels { (self.panel(panel)) }
                div class="frame" { div class="xs" {
                    @for (i, (place, text)) in self.ticks.iter().enumerate() {
                        span class=[(i % 2 == 1).then_some("odd")] style=(at("left", *place)) { (text) }
                    }
                } }
                p class="along" { (self.along) }
            }
        }
    }

    fn panel(&self, panel: &Panel) -> Markup {
        let ys = panel.y.ticks(panel.height.ticks());
        html! {
            p class="across" { (panel.title) }
            div class=(panel.height.class()) {
                div class="ys" { @for (place, text) in &ys { span style=(at("top", 1.0 - place)) { (text) } } }
                svg viewBox={ "0 0 " (WIDE) " " (HIGH) } preserveAspectRatio="none" aria-hidden="true" {
                    (grid(&self.ticks, &ys))
                    @for layer in &panel.layers { (layer.draw(&self.x, &panel.y)) }
                }
            }
        }
    }
}

/// The signs with their meanings.
pub fn legend(keys: &[Key]) -> Markup {
    html! {
        @if !keys.is_empty() { p class="legend" { @for key in keys {
            span { i class={ "sign " (key.class) } {} (key.text) }
        } } }
    }
}

/// Lines across the drawing where the edges have numbers.
pub fn grid(xs: &Ticks, ys: &Ticks) -> Markup {
    let mut path = String::new();
    for (place, _) in ys {
        path += &format!("M0 {}h{WIDE}", ((1.0 - place) * HIGH).round());
    }
    for (place, _) in xs {
        path += &format!("M{} 0v{HIGH}", (place * WIDE).round());
    }
    html! { path class="grid" d=(path) {} }
}

/// A place along an edge in the words of the style sheet.
pub fn at(edge: &str, place: f64) -> String {
    format!("{edge}:{:.2}%", 100.0 * place)
}

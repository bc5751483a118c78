//! What is drawn within a chart: paths in a square of [`WIDE`] by [`HIGH`] that is stretched to the chart.

use super::Axis;
use maud::{Markup, html};
use std::fmt::Write;

/// Width of the square, fine enough for 1200 cells.
pub const WIDE: f64 = 2400.0;
/// Its height.
pub const HIGH: f64 = 1000.0;

/// A place in terms of the axes, or a break.
pub type Place = Option<(f64, f64)>;

/// Something drawn. The class is one of the style sheet's.
pub enum Layer {
    /// A line through places.
    Line {
        /// Style.
        class: &'static str,
        /// The places, in order.
        places: Vec<Place>,
    },
    /// What lies between two lines: place, least, greatest.
    Band {
        /// Style.
        class: &'static str,
        /// Along the axis, and from where to where across it.
        spans: Vec<Option<(f64, f64, f64)>>,
    },
    /// A value that holds all along.
    Level {
        /// Style.
        class: &'static str,
        /// The value.
        value: f64,
    },
    /// Bars from the lower edge: from, to, height.
    Bars {
        /// Style.
        class: &'static str,
        /// The bars.
        bars: Vec<(f64, f64, f64)>,
    },
}

impl Layer {
    /// Drawn between two axes.
    pub fn draw(&self, x: &Axis, y: &Axis) -> Markup {
        let across = |value: f64| ((1.0 - y.place(value)) * HIGH).clamp(-2.0 * HIGH, 3.0 * HIGH);
        let along = |value: f64| (x.place(value) * WIDE).clamp(-WIDE, 2.0 * WIDE);
        match self {
            Self::Line { class, places } => {
                let mut path = Path::default();
                for piece in places.split(Option::is_none) {
                    path.line(piece.iter().flatten().map(|(a, b)| (along(*a), across(*b))));
                }
                html! { path class=(class) d=(path.text) {} }
            }
            Self::Band { class, spans } => {
                let mut path = Path::default();
                for piece in spans.split(Option::is_none) {
                    let upper = piece.iter().flatten().map(|(a, _, high)| (along(*a), across(*high)));
                    let lower = piece.iter().flatten().rev().map(|(a, low, _)| (along(*a), across(*low)));
                    path.area(upper.chain(lower));
                }
                html! { path class=(class) d=(path.text) {} }
            }
            Self::Level { class, value } => {
                let place = y.place(*value);
                let within = (0.0..=1.0).contains(&place);
                html! { @if within { path class=(class) d={ "M0 " (across(*value).round()) "h" (WIDE) } {} } }
            }
            Self::Bars { class, bars } => {
                let mut path = Path::default();
                for (from, to, height) in bars.iter().filter(|bar| bar.2 > 0.0) {
                    let [left, right, top] = [along(*from), along(*to), across(*height)];
                    path.area([(left, HIGH), (left, top), (right, top), (right, HIGH)].into_iter());
                }
                html! { path class=(class) d=(path.text) {} }
            }
        }
    }

    /// The values that it has across the axis, for a range to hold them.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::Line { places, .. } => places.iter().flatten().map(|(_, value)| *value).collect(),
            Self::Band { spans, .. } => spans.iter().flatten().flat_map(|(_, low, high)| [*low, *high]).collect(),
            Self::Level { value, .. } => vec![*value],
            Self::Bars { bars, .. } => bars.iter().map(|(_, _, height)| *height).collect(),
        }
    }
}

/// The text of a path, in whole numbers and steps, which is short.
#[derive(Default)]
struct Path {
    text: String,
}

impl Path {
    /// Places that are no numbers are left out.
    fn line(&mut self, places: impl Iterator<Item = (f64, f64)>) -> bool {
        let mut last: Option<(i32, i32)> = None;
        let mut count = 0;
        for (a, b) in places.filter(|(a, b)| a.is_finite() && b.is_finite()) {
            let now = (a.round() as i32, b.round() as i32);
            // text in memory takes all
            let _ = match last {
                None => write!(self.text, "M{} {}", now.0, now.1),
                Some(last) => write!(self.text, "l{} {}", now.0 - last.0, now.1 - last.1),
            };
            last = Some(now);
            count += 1;
        }
        if count == 1 {
            self.text.push_str("h1");
        }
        count > 0
    }

    fn area(&mut self, places: impl Iterator<Item = (f64, f64)>) {
        if self.line(places) {
            self.text.push('z');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(layer: &Layer) -> String {
        layer.draw(&Axis::time(10.0), &Axis::around([0.0, 10.0].into_iter())).into_string()
    }

    #[test]
    fn breaks_and_numbers_that_are_none_break_a_line() {
        let places = vec![Some((0.0, 5.0)), Some((1.0, 5.0)), None, Some((3.0, f64::NAN)), Some((4.0, 5.0)), None];
        let text = drawn(&Layer::Line { class: "line x", places });
        assert_eq!(text, "<path class=\"line x\" d=\"M0 500l240 0M960 500h1\"></path>");
    }

    #[test]
    fn a_band_goes_there_and_back() {
        let spans = vec![Some((0.0, 5.0, 5.0)), Some((10.0, 5.0, 10.0))];
        let text = drawn(&Layer::Band { class: "band", spans });
        assert_eq!(text, "<path class=\"band\" d=\"M0 500l2400 -446l0 446l-2400 0z\"></path>");
    }

    #[test]
    fn what_lies_outside_is_not_marked() {
        assert_eq!(drawn(&Layer::Level { class: "limit", value: 50.0 }), "");
        assert!(drawn(&Layer::Level { class: "limit", value: 5.0 }).contains("M0 500h2400"));
        assert!(drawn(&Layer::Bars { class: "bars", bars: vec![(0.0, 1.0, 0.0)] }).contains("d=\"\""));
    }
}

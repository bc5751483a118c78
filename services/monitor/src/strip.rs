//! A strip chart: one axis of the deformation against time, between the ends of its range.

use crate::page::{AreaState, SHOWN_S};
use frames::unit;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Axis, Block, Chart, Dataset, GraphType};

/// Of Okabe and Ito's colours, which most colour-blind readers can tell apart too.
const COLOURS: [Color; 3] = [Color::Rgb(86, 180, 233), Color::Rgb(230, 159, 0), Color::Rgb(0, 158, 115)];
const NAMES: [&str; 3] = ["x", "y", "z"];
/// The charts never show less than this from bottom to top, arcmin.
const LEAST_SPAN: f64 = 0.1;

/// Draws the chart of an axis, 0 to 2.
pub fn draw(frame: &mut Frame, place: Rect, area: &AreaState, axis: usize) {
    let now = area.last.map_or(0.0, |last| unit::seconds(last.header.time_ns));
    let of = |value: fn(f64, f64) -> f64| -> Vec<(f64, f64)> {
        area.past.iter().map(|past| (past.t - now, value(past.phi[axis], past.range[axis]))).collect()
    };
    let (middle, below, above) = (of(|phi, _| phi), of(|phi, range| phi - range), of(|phi, range| phi + range));
    let bounds = bounds(&below, &above);
    let set =
        |data, style| Dataset::default().marker(Marker::Braille).graph_type(GraphType::Line).style(style).data(data);
    let dim = Style::new().fg(Color::DarkGray);
    let sets = vec![set(&below, dim), set(&above, dim), set(&middle, Style::new().fg(COLOURS[axis]))];
    let label = |value: f64| Span::raw(format!("{value:.1}"));
    let chart = Chart::new(sets)
        .block(Block::bordered().title(title(area, axis)))
        .x_axis(Axis::default().bounds([-SHOWN_S, 0.0]))
        .y_axis(Axis::default().bounds(bounds).labels([label(bounds[0]), label(bounds[1])]));
    frame.render_widget(chart, place);
}

fn title(area: &AreaState, axis: usize) -> Line<'static> {
    let name = Span::styled(format!(" {} ", NAMES[axis]), Style::new().fg(COLOURS[axis]).bold());
    let text = match area.last {
        Some(last) if last.is_valid() => {
            let [phi, range] = [last.phi[axis], last.range[axis]].map(|v| v / unit::ARCMIN);
            format!("{phi:+.2} ±{range:.2} arcmin ")
        }
        _ => "no valid value ".to_owned(),
    };
    Line::from(vec![name, Span::raw(text)])
}

fn bounds(below: &[(f64, f64)], above: &[(f64, f64)]) -> [f64; 2] {
    let values = || below.iter().chain(above).map(|point| point.1).filter(|value| value.is_finite());
    let (least, most) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if least > most {
        return [-1.0, 1.0];
    }
    let wanting = (LEAST_SPAN - (most - least)).max(0.0) / 2.0;
    let margin = 0.05 * (most - least) + wanting;
    [least - margin, most + margin]
}

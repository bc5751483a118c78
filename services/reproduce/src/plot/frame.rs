//! What every chart has around it: axes, their labels, the legend above.

use super::{Area, Drawn, GRID, INK, WIDTH};
use experiments::Label;
use plotters::chart::{ChartBuilder, ChartContext, MeshStyle};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{Cartesian2d, PathElement, Rectangle, SVGBackend, ShapeStyle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{IntoFont, TextStyle};
use std::ops::Range;

pub type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

pub type Mesh<'a, 'b, 'c> = MeshStyle<'a, 'c, RangedCoordf64, RangedCoordf64, SVGBackend<'b>>;

/// Size that the backend divides by about 1.24 for its letters.
const LETTERS: i32 = 19;
/// Mean width of a letter.
const LETTER_WIDTH: i32 = 8;

/// How an entry of the legend is shown.
#[derive(Clone, Copy, PartialEq)]
pub enum Sign {
    Line,
    Dashes,
    Dot,
    Cross,
    Box,
    Tick,
}

/// An entry of the legend.
pub struct Entry {
    pub name: String,
    pub sign: Sign,
    pub style: ShapeStyle,
}

/// Letters that stand at a place in a way.
pub fn letters(horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    ("sans-serif", LETTERS).into_font().color(&INK).pos(Pos::new(horizontal, vertical))
}

/// With its unit of measure.
pub fn told(label: &Label) -> String {
    if label.unit.is_empty() { label.text.clone() } else { format!("{} ({})", label.text, label.unit) }
}

/// The smallest range of all numbers, a little widened; 0 to 1 without any.
pub fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return 0.0..1.0;
    }
    let margin = if high > low { 0.05 * (high - low) } else { low.abs().max(1.0) * 0.5 };
    low - margin..high + margin
}

/// Height of the legend, px.
pub fn legend_height(entries: &[Entry]) -> u32 {
    let rows = places(entries).last().map_or(0, |(_, row)| row + 1);
    10 + 26 * rows as u32
}

/// Where each entry begins, px from the left, and in which row.
fn places(entries: &[Entry]) -> Vec<(i32, i32)> {
    let (mut x, mut row) = (LEFT as i32, 0);
    let mut places = Vec::new();
    for entry in entries {
        let width = 64 + LETTER_WIDTH * entry.name.chars().count() as i32;
        if x + width > WIDTH as i32 && x > LEFT as i32 {
            (x, row) = (LEFT as i32, row + 1);
        }
        places.push((x, row));
        x += width;
    }
    places
}

/// Left margin of charts whose vertical axis has numbers, px.
const LEFT: u32 = 84;

/// Draws the legend at the top of the area.
pub fn legend(area: &Area, entries: &[Entry]) -> Drawn {
    for (entry, (x, row)) in entries.iter().zip(places(entries)) {
        let y = 18 + 26 * row;
        let style = entry.style;
        match entry.sign {
            Sign::Line => area.draw(&PathElement::new(vec![(x, y), (x + 30, y)], style.stroke_width(3)))?,
            Sign::Dashes => {
                for start in [x, x + 12, x + 24] {
                    area.draw(&PathElement::new(vec![(start, y), (start + 7, y)], style.stroke_width(3)))?;
                }
            }
            Sign::Dot => area.draw(&plotters::prelude::Circle::new((x + 15, y), 5, style.filled()))?,
            Sign::Cross => area.draw(&plotters::prelude::Cross::new((x + 15, y), 7, style.stroke_width(3)))?,
            Sign::Box => area.draw(&Rectangle::new([(x + 6, y - 7), (x + 28, y + 7)], style.filled()))?,
            Sign::Tick => {
                area.draw(&PathElement::new(vec![(x + 16, y - 9), (x + 16, y + 9)], style.stroke_width(4)))?
            }
        }
        area.draw(&Text::new(entry.name.clone(), (x + 38, y), letters(HPos::Left, VPos::Center)))?;
    }
    Ok(())
}

/// A chart below the legend with both axes drawn.
pub fn chart<'a, 'b>(
    area: &'a Area<'b>,
    labels: [&Label; 2],
    ranges: [Range<f64>; 2],
    entries: &[Entry],
) -> Result<Chart<'a, 'b>, Box<dyn std::error::Error>> {
    legend(area, entries)?;
    let [x, y] = ranges;
    let mut chart = ChartBuilder::on(area)
        .margin_top(legend_height(entries))
        .margin_right(24)
        .margin_bottom(6)
        .margin_left(8)
        .x_label_area_size(58)
        .y_label_area_size(LEFT - 8)
        .build_cartesian_2d(x.clone(), y.clone())?;
    let [x_label, y_label] = labels.map(told);
    mesh(&mut chart)
        .y_labels(7)
        .x_label_formatter(&|value| tick(*value, &x))
        .y_label_formatter(&|value| tick(*value, &y))
        .x_desc(x_label)
        .y_desc(y_label)
        .draw()?;
    Ok(chart)
}

/// Grid and axes as all charts have them, still without labels.
pub fn mesh<'a, 'b, 'c>(chart: &'c mut Chart<'a, 'b>) -> Mesh<'a, 'b, 'c> {
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(plotters::style::TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(INK)
        .label_style(letters(HPos::Center, VPos::Center))
        .axis_desc_style(letters(HPos::Center, VPos::Center))
        .x_labels(9);
    mesh
}

/// A number on an axis, with as many decimals as its range wants.
pub fn tick(value: f64, range: &Range<f64>) -> String {
    let span = range.end - range.start;
    // ticks are a tenth of the span apart or so
    let decimals = (1.0 - span.log10()).ceil().clamp(0.0, 12.0) as usize;
    if !(1e-5..1e7).contains(&span) {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    (if text == "-0" { "0" } else { text }).to_owned()
}

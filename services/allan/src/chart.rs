//! The figure: deviation against averaging time, both as logarithms, with bars and the fitted model; a chart a triad.

use crate::AllanError;
use crate::report::{Report, Triad};
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    Cartesian2d, Circle, DrawingArea, IntoDrawingArea, IntoFont, LineSeries, PathElement, RGBColor, Rectangle,
    SVGBackend, Text, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, TextStyle};
use std::error::Error;
use std::ops::Range;

const WIDTH: u32 = 960;
/// Height of a triad's chart, px.
const HEIGHT: u32 = 480;
/// Px around the chart: left, right, top, bottom.
const MARGINS: [u32; 4] = [92, 40, 74, 66];
/// Size that the backend divides by about 1.24 for its letters.
const LETTERS: i32 = 19;
const INK: RGBColor = RGBColor(27, 31, 36);
const GRID: RGBColor = RGBColor(222, 226, 231);
/// Of Okabe and Ito's colours, which most colour-blind readers can tell apart too.
const AXES: [(&str, RGBColor); 3] =
    [("x", RGBColor(0, 114, 178)), ("y", RGBColor(213, 94, 0)), ("z", RGBColor(0, 158, 115))];
/// Of the axes' points one beside the other, as a part of the averaging time.
const BESIDE: f64 = 1.04;

type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type Drawn = Result<(), Box<dyn Error>>;

/// The figure of all triads, one below the other.
pub fn svg(report: &Report) -> Result<String, AllanError> {
    let mut text = String::new();
    let drawn = {
        let size = (WIDTH, HEIGHT * report.triads.len() as u32);
        draw(&SVGBackend::with_string(&mut text, size).into_drawing_area(), report)
    };
    drawn.map_err(|reason| AllanError::Drawing(reason.to_string()))?;
    Ok(text)
}

fn draw(canvas: &Canvas, report: &Report) -> Drawn {
    canvas.fill(&WHITE)?;
    for (triad, canvas) in report.triads.iter().zip(canvas.split_evenly((report.triads.len(), 1))) {
        chart(&canvas, triad)?;
    }
    canvas.present()?;
    Ok(())
}

fn letters(horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    ("sans-serif", LETTERS).into_font().color(&INK).pos(Pos::new(horizontal, vertical))
}

fn chart(canvas: &Canvas, triad: &Triad) -> Drawn {
    let [left, right, top, bottom] = MARGINS;
    heading(canvas, triad)?;
    let (times, deviations) = ranges(triad);
    let mut chart = ChartBuilder::on(canvas)
        .margin_left(left)
        .margin_right(right)
        .margin_top(top)
        .margin_bottom(bottom)
        .build_cartesian_2d(logarithms(&times), logarithms(&deviations))?;
    grid(canvas, &chart, &times, &deviations, triad.kind.deviation().name)?;
    let si = triad.kind.deviation().si;
    let height = |value: f64| (value / si).clamp(deviations.start, deviations.end).log10();
    for (axis, (_, colour)) in AXES.iter().enumerate() {
        let Some(analysis) = &triad.axes[axis] else { continue };
        let beside = BESIDE.powi(axis as i32 - 1);
        let model = analysis.points.iter().map(|point| (point.tau.log10(), height(point.model)));
        chart.draw_series(LineSeries::new(model, colour.stroke_width(1)))?;
        let bar = |point: &estimation::allan::Point| {
            let x = (point.tau * beside).log10();
            PathElement::new(vec![(x, height(point.lower)), (x, height(point.upper))], colour.stroke_width(2))
        };
        chart.draw_series(analysis.points.iter().map(bar))?;
        let dot = |point: &estimation::allan::Point| {
            Circle::new(((point.tau * beside).log10(), height(point.deviation)), 3, colour.filled())
        };
        chart.draw_series(analysis.points.iter().map(dot))?;
    }
    Ok(())
}

/// Title and legend.
fn heading(canvas: &Canvas, triad: &Triad) -> Drawn {
    let left = MARGINS[0] as i32;
    let title = format!("Allan deviation of the {}, 68 % bars, and the fitted model", triad.kind.title());
    canvas.draw(&Text::new(title, (left, 22), letters(HPos::Left, VPos::Center)))?;
    for (i, (name, colour)) in AXES.iter().enumerate() {
        let x = left + 110 * i as i32;
        canvas.draw(&PathElement::new(vec![(x, 50), (x + 30, 50)], colour.stroke_width(3)))?;
        canvas.draw(&Text::new(*name, (x + 38, 50), letters(HPos::Left, VPos::Center)))?;
    }
    Ok(())
}

/// Grid, frame, numbers and what they are of.
fn grid(canvas: &Canvas, chart: &Chart, times: &Range<f64>, deviations: &Range<f64>, unit: &str) -> Drawn {
    let (columns, rows) = chart.plotting_area().get_pixel_range();
    let (origin_x, origin_y) = canvas.get_base_pixel();
    let columns = columns.start - origin_x..columns.end - origin_x;
    let rows = rows.start - origin_y..rows.end - origin_y;
    let place = |tau: f64, deviation: f64| {
        let (x, y) = chart.backend_coord(&(tau.log10(), deviation.log10()));
        (x - origin_x, y - origin_y)
    };
    for tau in numbers(times) {
        let (x, _) = place(tau, deviations.start);
        canvas.draw(&PathElement::new(vec![(x, rows.start), (x, rows.end)], GRID))?;
        canvas.draw(&Text::new(short(tau), (x, rows.end + 18), letters(HPos::Center, VPos::Center)))?;
    }
    for deviation in numbers(deviations) {
        let (_, y) = place(times.start, deviation);
        canvas.draw(&PathElement::new(vec![(columns.start, y), (columns.end, y)], GRID))?;
        canvas.draw(&Text::new(short(deviation), (columns.start - 8, y), letters(HPos::Right, VPos::Center)))?;
    }
    canvas.draw(&Rectangle::new([(columns.start, rows.start), (columns.end, rows.end)], INK))?;
    let middle = (columns.start + columns.end) / 2;
    canvas.draw(&Text::new("averaging time (s)", (middle, rows.end + 46), letters(HPos::Center, VPos::Center)))?;
    let upright = ("sans-serif", LETTERS).into_font().transform(FontTransform::Rotate270);
    let upright = upright.color(&INK).pos(Pos::new(HPos::Center, VPos::Center));
    canvas.draw(&Text::new(format!("deviation ({unit})"), (18, (rows.start + rows.end) / 2), upright))?;
    Ok(())
}

fn logarithms(range: &Range<f64>) -> Range<f64> {
    range.start.log10()..range.end.log10()
}

/// Of averaging times (s) and deviations (in their unit), both a little widened. The long bars of the last points do not rule the scale.
fn ranges(triad: &Triad) -> (Range<f64>, Range<f64>) {
    let points = || triad.axes.iter().flatten().flat_map(|analysis| &analysis.points);
    let span = |values: &mut dyn Iterator<Item = f64>, widening: f64| {
        let (least, most) = values.fold((f64::INFINITY, 0.0f64), |(least, most), v| (least.min(v), most.max(v)));
        least / widening..most * widening
    };
    let si = triad.kind.deviation().si;
    (span(&mut points().map(|point| point.tau), 1.3), span(&mut points().map(|point| point.deviation / si), 1.7))
}

/// Where an axis has numbers: the fewer of each decade the more decades there are.
fn numbers(range: &Range<f64>) -> Vec<f64> {
    let steps: &[f64] = match (range.end / range.start).log10() {
        decades if decades < 1.2 => &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
        decades if decades < 3.0 => &[1.0, 2.0, 5.0],
        _ => &[1.0],
    };
    let all = (-12..=9).flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)));
    all.filter(|value| range.contains(value)).collect()
}

/// Without the digits that rounding leaves.
fn short(value: f64) -> String {
    if value < 1e-4 { format!("{value:.0e}") } else { format!("{}", (value * 1e9).round() / 1e9) }
}

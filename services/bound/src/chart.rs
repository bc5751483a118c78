//! The figure: standard deviation against time, both as logarithms, a chart for each area.

use crate::report::{Area, Report, time};
use crate::{BoundError, Point, SEEDS};
use frames::unit::ARCSEC;
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    Cartesian2d, DrawingArea, IntoDrawingArea, IntoFont, LineSeries, PathElement, RGBColor, Rectangle, SVGBackend,
    Text, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, TextStyle};
use std::error::Error;
use std::ops::Range;

const WIDTH: u32 = 960;
/// Height of an area's chart, px.
const HEIGHT: u32 = 460;
/// Px around the chart: left, right, top, bottom.
const MARGINS: [u32; 4] = [84, 40, 74, 66];
/// Size that the backend divides by about 1.24 for its letters.
const LETTERS: i32 = 19;
const INK: RGBColor = RGBColor(27, 31, 36);
const GRID: RGBColor = RGBColor(222, 226, 231);
/// Of Okabe and Ito's colours, which most colour-blind readers can tell apart too.
const AXES: [(&str, RGBColor); 3] =
    [("x", RGBColor(0, 114, 178)), ("y", RGBColor(213, 94, 0)), ("z", RGBColor(0, 158, 115))];
/// Where the time's axis has a number, s.
const TIMES_S: [f64; 20] = [
    1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0, 3600.0, 7200.0, 18e3, 36e3, 86.4e3,
    172.8e3, 432e3, 864e3,
];
/// So many points show all that a line of this width can.
const MOST: usize = 500;
/// Numbers of the time's axis stand at least so far apart, px.
const APART: i32 = 68;

type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type Drawn = Result<(), Box<dyn Error>>;

/// The figure of all areas, one below the other.
pub fn svg(report: &Report) -> Result<String, BoundError> {
    let mut text = String::new();
    let drawn = {
        let size = (WIDTH, HEIGHT * report.areas.len() as u32);
        draw(&SVGBackend::with_string(&mut text, size).into_drawing_area(), report)
    };
    drawn.map_err(|reason| BoundError::Drawing(reason.to_string()))?;
    Ok(text)
}

fn draw(canvas: &Canvas, report: &Report) -> Drawn {
    canvas.fill(&WHITE)?;
    for (area, canvas) in report.areas.iter().zip(canvas.split_evenly((report.areas.len(), 1))) {
        chart(&canvas, area)?;
    }
    canvas.present()?;
    Ok(())
}

fn letters(horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    ("sans-serif", LETTERS).into_font().color(&INK).pos(Pos::new(horizontal, vertical))
}

fn chart(canvas: &Canvas, area: &Area) -> Drawn {
    let [left, right, top, bottom] = MARGINS;
    heading(canvas, area)?;
    let (times, sigmas) = ranges(&area.curve);
    let mut chart = ChartBuilder::on(canvas)
        .margin_left(left)
        .margin_right(right)
        .margin_top(top)
        .margin_bottom(bottom)
        .build_cartesian_2d(logarithms(&times), logarithms(&sigmas))?;
    grid(canvas, &chart, &times, &sigmas)?;
    for (axis, (_, colour)) in AXES.iter().enumerate() {
        let points = thinned(&area.curve).map(|point| (point.t_s.log10(), (point.total[axis] / ARCSEC).log10()));
        chart.draw_series(LineSeries::new(points, colour.stroke_width(2)))?;
    }
    Ok(())
}

/// Title and legend.
fn heading(canvas: &Canvas, area: &Area) -> Drawn {
    let left = MARGINS[0] as i32;
    let title = format!("{}: {}, rms of {} runs, flexure's model known", area.name, area.sensors(), SEEDS.len());
    canvas.draw(&Text::new(title, (left, 22), letters(HPos::Left, VPos::Center)))?;
    for (i, (name, colour)) in AXES.iter().enumerate() {
        let x = left + 150 * i as i32;
        canvas.draw(&PathElement::new(vec![(x, 50), (x + 30, 50)], colour.stroke_width(3)))?;
        canvas.draw(&Text::new(format!("about {name}"), (x + 38, 50), letters(HPos::Left, VPos::Center)))?;
    }
    Ok(())
}

/// Grid, frame, numbers and what they are of.
fn grid(canvas: &Canvas, chart: &Chart, times: &Range<f64>, sigmas: &Range<f64>) -> Drawn {
    let (columns, rows) = chart.plotting_area().get_pixel_range();
    let (origin_x, origin_y) = canvas.get_base_pixel();
    let columns = columns.start - origin_x..columns.end - origin_x;
    let rows = rows.start - origin_y..rows.end - origin_y;
    let place = |t_s: f64, sigma: f64| {
        let (x, y) = chart.backend_coord(&(t_s.log10(), sigma.log10()));
        (x - origin_x, y - origin_y)
    };
    let mut free = 0;
    for t_s in TIMES_S.into_iter().filter(|t_s| times.contains(t_s)) {
        let (x, _) = place(t_s, sigmas.start);
        canvas.draw(&PathElement::new(vec![(x, rows.start), (x, rows.end)], GRID))?;
        if x < free {
            continue;
        }
        free = x + APART;
        canvas.draw(&Text::new(time(t_s), (x, rows.end + 18), letters(HPos::Center, VPos::Center)))?;
    }
    for sigma in numbers(sigmas) {
        let (_, y) = place(times.start, sigma);
        canvas.draw(&PathElement::new(vec![(columns.start, y), (columns.end, y)], GRID))?;
        canvas.draw(&Text::new(
            format!("{}", (sigma * 1e6).round() / 1e6),
            (columns.start - 8, y),
            letters(HPos::Right, VPos::Center),
        ))?;
    }
    canvas.draw(&Rectangle::new([(columns.start, rows.start), (columns.end, rows.end)], INK))?;
    let middle = (columns.start + columns.end) / 2;
    canvas.draw(&Text::new(
        "time since the first sample",
        (middle, rows.end + 46),
        letters(HPos::Center, VPos::Center),
    ))?;
    let upright = ("sans-serif", LETTERS).into_font().transform(plotters::style::FontTransform::Rotate270);
    let upright = upright.color(&INK).pos(Pos::new(HPos::Center, VPos::Center));
    canvas.draw(&Text::new("sigma (arcsec)", (18, (rows.start + rows.end) / 2), upright))?;
    Ok(())
}

fn logarithms(range: &Range<f64>) -> Range<f64> {
    range.start.log10()..range.end.log10()
}

/// Of times (s) and standard deviations (arcsec), the latter a little widened.
fn ranges(curve: &[Point]) -> (Range<f64>, Range<f64>) {
    let Some((first, last)) = curve.first().zip(curve.last()) else { return (1.0..100.0, 1.0..100.0) };
    let sigmas = curve.iter().flat_map(|point| point.total).map(|sigma| sigma / ARCSEC);
    let (least, most) = sigmas.fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), v| (least.min(v), most.max(v)));
    // the end is part of the range, so that a number may stand there
    let end = last.t_s.max(first.t_s + 1.0) * 1.0001;
    (first.t_s.max(0.1)..end, least / 1.15..most * 1.15)
}

/// Where the axis of standard deviations has numbers: the fewer of each decade the more decades there are.
fn numbers(range: &Range<f64>) -> Vec<f64> {
    let steps: &[f64] = match (range.end / range.start).log10() {
        decades if decades < 1.2 => &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0],
        decades if decades < 3.0 => &[1.0, 2.0, 5.0],
        _ => &[1.0],
    };
    let decades = -6..=7;
    let all = decades.flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)));
    all.filter(|sigma| range.contains(sigma)).collect()
}

/// Points that lie evenly on the logarithmic axis, with the last.
fn thinned(curve: &[Point]) -> impl Iterator<Item = &Point> {
    let step = curve.first().zip(curve.last()).map_or(1.0, |(a, b)| (b.t_s / a.t_s.max(0.1)).powf(1.0 / MOST as f64));
    let mut next = 0.0;
    curve.iter().enumerate().filter_map(move |(i, point)| {
        let wanted = point.t_s >= next || i + 1 == curve.len();
        if wanted {
            next = point.t_s * step;
        }
        wanted.then_some(point)
    })
}

use super::frame::{Entry, Sign, legend, legend_height, letters, mesh, tick, told};
use super::{Area, Drawn, INK, colour};
use experiments::Bars;
use plotters::chart::ChartBuilder;
use plotters::prelude::{PathElement, Rectangle, Text};
use plotters::style::Color;
use plotters::style::text_anchor::{HPos, VPos};

/// Height of a bar and of the space between groups, px.
const BAR: u32 = 22;
const SPACE: u32 = 22;
/// Of the groups' names, px.
const NAMES: u32 = 260;

/// How high the drawing has to be.
pub fn height(bars: &Bars) -> u32 {
    let group = BAR * bars.series.len() as u32 + SPACE;
    legend_height(&entries(bars)) + 70 + group * bars.groups.len() as u32
}

fn entries(bars: &Bars) -> Vec<Entry> {
    let of_series = bars.series.iter().enumerate();
    let mut entries: Vec<Entry> = of_series
        .map(|(index, series)| Entry { name: series.name.clone(), sign: Sign::Box, style: colour(index).filled() })
        .collect();
    if bars.series.iter().any(|series| series.bounds.iter().any(|bound| bound.is_finite())) {
        entries.push(Entry { name: "bound".into(), sign: Sign::Tick, style: INK.stroke_width(4) });
    }
    entries
}

/// Draws the groups from top to bottom.
pub fn draw(area: &Area, bars: &Bars) -> Drawn {
    let entries = entries(bars);
    legend(area, &entries)?;
    let values = bars.series.iter().flat_map(|series| &series.values);
    let ends = values.map(|&(value, sd)| value + if sd.is_finite() { sd } else { 0.0 });
    let bounds = bars.series.iter().flat_map(|series| &series.bounds).copied();
    let longest = ends.chain(bounds).filter(|end| end.is_finite()).fold(0.0, f64::max);
    let x = 0.0..if longest > 0.0 { 1.08 * longest } else { 1.0 };
    let groups = bars.groups.len() as f64;
    let mut chart = ChartBuilder::on(area)
        .margin_top(legend_height(&entries))
        .margin_right(24)
        .margin_bottom(6)
        .x_label_area_size(58)
        .margin_left(NAMES)
        .build_cartesian_2d(x.clone(), groups..0.0)?;
    mesh(&mut chart)
        .disable_y_mesh()
        .disable_y_axis()
        .x_label_formatter(&|value| tick(*value, &x))
        .x_desc(told(&bars.value))
        .draw()?;
    let unit = f64::from(BAR * bars.series.len() as u32 + SPACE);
    let (bar, space) = (f64::from(BAR) / unit, f64::from(SPACE) / unit);
    for (index, series) in bars.series.iter().enumerate() {
        let style = colour(index);
        for (group, &(value, sd)) in series.values.iter().enumerate() {
            let top = group as f64 + 0.5 * space + index as f64 * bar;
            let (above, middle, below) = (top + 0.08 * bar, top + 0.5 * bar, top + 0.92 * bar);
            if value.is_finite() {
                chart.draw_series([Rectangle::new([(0.0, above), (value, below)], style.mix(0.85).filled())])?;
            }
            if value.is_finite() && sd.is_finite() && sd > 0.0 {
                let whisker = vec![((value - sd).max(0.0), middle), (value + sd, middle)];
                chart.draw_series([PathElement::new(whisker, INK.stroke_width(1))])?;
            }
            if let Some(bound) = series.bounds.get(group).filter(|bound| bound.is_finite()) {
                let mark = vec![(*bound, top), (*bound, top + bar)];
                chart.draw_series([PathElement::new(mark, INK.stroke_width(4))])?;
            }
        }
    }
    for (group, name) in bars.groups.iter().enumerate() {
        let (x, y) = chart.backend_coord(&(0.0, group as f64 + 0.5));
        area.draw(&Text::new(name.clone(), (x - 12, y), letters(HPos::Right, VPos::Center)))?;
    }
    Ok(())
}

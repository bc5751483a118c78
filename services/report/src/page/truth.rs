//! How far the solutions were off.

use super::Section;
use super::lines::{ABOUT, component, table};
use super::table::Table;
use super::words::{clock, count, number, percent};
use crate::gather::{AreaRun, Envelope};
use crate::plot::{Axis, Chart, Height, Key, Layer, Panel};
use frames::unit;
use maud::html;

/// Error against range, where the truth is recorded; `None` without it.
pub fn error(area: &AreaRun, length_s: f64) -> Option<Section> {
    if area.errors.trace.is_empty() {
        return None;
    }
    let panel = |axis: usize| {
        let range = area.range.cells();
        let half = |cell: &Envelope| cell.mean().map(|_| cell.most);
        let spans = range
            .iter()
            .map(|cell| cell.and_then(|(t, cell)| half(&cell[axis]).map(|half| (t, -half, half))))
            .collect();
        let mut layers = vec![Layer::Band { class: ["band x", "band y", "band z"][axis], spans }];
        layers.extend(component(&area.errors.trace, None, axis));
        let mut halves: Vec<f64> = range.iter().flatten().map(|(_, cell)| cell[axis].most).collect();
        halves.sort_unstable_by(f64::total_cmp);
        let usual = halves.get(halves.len() * 9 / 10).copied().unwrap_or(0.0);
        let own = layers[1..].iter().flat_map(Layer::values);
        let y = Axis::around(own.chain([usual, -usual]));
        Panel { title: format!("{}, arcmin", ABOUT[axis]), y, layers, height: Height::Usual }
    };
    let signs = vec![
        Key::new("line any", "mean error of a stretch of time"),
        Key::new("span any", "least to greatest error"),
        Key::new("band any", "95 % range"),
    ];
    let about = format!("Error of area {} within its range against time", area.name);
    let chart = Chart::of_time(about, length_s, signs, [0, 1, 2].map(panel).into());
    let note =
        "The recording holds the truth of a simulation. A range is right if it holds the error 95 % of the time.";
    Some(Section::new(
        "Error against the truth",
        note,
        html! {
            (settled(area).draw())
            (chart.draw())
            (table(&area.errors.trace, ["x", "y", "z"], 3).folded("Numbers of this plot: error, arcmin"))
            (blocks(area).folded("Every ten minutes: error in arcmin, and its share within the range"))
        },
    ))
}

/// The figures of the summary.
fn settled(area: &AreaRun) -> Table {
    let summary = area.errors.summary();
    let first = format!("from {} on, {} solutions", clock(summary.settled_from_s), count(summary.settled_samples));
    let mut table = Table::new(&[&first, "x or east", "y or north", "z or up"]);
    let mut row = |name: &str, values: Option<[f64; 3]>, text: &dyn Fn(f64) -> String| {
        if let Some(values) = values {
            table.row(std::iter::once(name.to_owned()).chain(values.map(text)).collect());
        }
    };
    let arcmin = |arcsec: f64| number(arcsec * unit::ARCSEC / unit::ARCMIN, 3);
    row("root mean square error, arcmin", summary.rmse_arcsec, &arcmin);
    row("the filter's own standard deviation, arcmin", summary.sigma_arcsec, &arcmin);
    row("within the range", summary.coverage_95, &percent);
    row("deck's attitude: root mean square error, arcmin", summary.deck_rmse_arcsec, &arcmin);
    row("deck's attitude: within its range", summary.deck_coverage_95, &percent);
    table
}

fn blocks(area: &AreaRun) -> Table {
    let mut table = Table::new(&["from", "solutions", "x rms", "x within", "y rms", "y within", "z rms", "z within"]);
    for (from_s, figures) in &area.errors.blocks {
        let coverage = figures.coverage.unwrap_or([f64::NAN; 3]);
        let of = |axis: usize| [number(figures.rmse[axis] / unit::ARCMIN, 3), percent(coverage[axis])];
        table.row(
            [clock(*from_s), count(figures.count as u64)]
                .into_iter()
                .chain([0, 1, 2].into_iter().flat_map(of))
                .collect(),
        );
    }
    table
}

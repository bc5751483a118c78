//! How long the stages took.

use super::Section;
use super::deformation::one;
use super::table::Table;
use super::words::{count, latency_ticks, percent, time};
use crate::gather::AreaRun;
use crate::plot::{Axis, Chart, Height, Key, Layer, Panel};
use maud::html;
use runtime::Latency;

/// Bars of a histogram in a decade.
const IN_A_DECADE: i32 = 10;

/// Percentiles and histograms of each stage.
pub fn latency(area: &AreaRun, length_s: f64) -> Section {
    let title = "Latency";
    // a wait that never was is no stage
    let took = |(_, latency): &(&str, &Latency)| latency.summary().max_us >= 1.0;
    let all: Vec<(&str, &Latency)> = area.latencies.all().into_iter().filter(took).collect();
    if all.is_empty() {
        return Section::without(title, "The recording holds no solution with the times of the stages.");
    }
    let mut table = Table::new(&["stage", "values", "median", "90 %", "99 %", "99.9 %", "greatest"]);
    for (name, latency) in &all {
        let s = latency.summary();
        let figures = [s.p50_us, s.p90_us, s.p99_us, s.p999_us, s.max_us].map(time);
        table.row([(*name).to_owned(), count(s.count)].into_iter().chain(figures).collect());
    }
    let edges: Vec<u64> =
        (0..=8 * IN_A_DECADE).map(|i| 10f64.powf(3.0 + f64::from(i) / f64::from(IN_A_DECADE)).round() as u64).collect();
    let histograms: Vec<(&str, Vec<f64>)> =
        all.iter().map(|(name, latency)| (*name, shares(latency, &edges))).collect();
    let about = format!("Histograms of the latency of each stage of area {}", area.name);
    let note = "Of each solution: by the source from the sample's due time, by the others from their last input. Identification is slow on purpose and holds up nothing. \
        The wait is for the other unit's next sample and belongs to the method. Shares stand as logarithms, so that rare ones are seen.";
    let end_to_end = over_time(area, length_s);
    let mut numbers =
        Table::new(&std::iter::once("from").chain(histograms.iter().map(|(name, _)| *name)).collect::<Vec<_>>());
    for (place, edge) in edges.iter().enumerate().take(edges.len() - 1) {
        if histograms.iter().any(|(_, shares)| shares[place] >= 0.001) {
            let cells = histograms.iter().map(|(_, shares)| percent(shares[place]));
            numbers.row(std::iter::once(time(*edge as f64 / 1e3)).chain(cells).collect());
        }
    }
    Section::new(
        title,
        note,
        html! {
            (table.draw())
            (histogram(about, &histograms, &edges).draw())
            (numbers.folded("Numbers of this plot: share of values, where a stage has a thousandth or more"))
            @if let Some(chart) = end_to_end {
                (chart.draw())
                (one(&area.latencies.trace, "end to end, µs:", 0).folded("Numbers of this plot"))
            }
        },
    )
}

/// Share of the latencies between edges.
fn shares(latency: &Latency, edges: &[u64]) -> Vec<f64> {
    let total = latency.summary().count.max(1) as f64;
    latency.counts(edges).into_iter().map(|count| count as f64 / total).collect()
}

fn histogram(about: String, histograms: &[(&str, Vec<f64>)], edges: &[u64]) -> Chart {
    let shown = |place: &usize| histograms.iter().any(|(_, shares)| shares[*place] > 0.0);
    let mut places = (0..edges.len().saturating_sub(1)).filter(shown);
    let first = places.next().unwrap_or(0);
    let last = places.next_back().unwrap_or(first);
    let us = |place: usize| edges[place] as f64 / 1e3;
    let x = Axis::between_decades(us(first)..us(last + 1));
    let ticks = latency_ticks(&x);
    let panel = |(name, shares): &(&str, Vec<f64>)| {
        let bars: Vec<_> = (first..=last).map(|place| (us(place), us(place + 1), 100.0 * shares[place])).collect();
        let least = bars.iter().map(|bar| bar.2).filter(|share| *share > 0.0).fold(100.0, f64::min);
        let y = Axis::between_decades(0.5 * least..150.0);
        Panel {
            title: format!("{name}, % of values"),
            y,
            layers: vec![Layer::Bars { class: "bars", bars }],
            height: Height::Low,
        }
    };
    Chart { about, keys: Vec::new(), x, ticks, along: "latency", panels: histograms.iter().map(panel).collect() }
}

/// The whole way against time.
fn over_time(area: &AreaRun, length_s: f64) -> Option<Chart> {
    let cells = area.latencies.trace.cells();
    let span = cells.iter().map(|cell| cell.map(|(t, cell)| (t, cell.least.max(1.0), cell.most.max(1.0)))).collect();
    let mean = cells.iter().map(|cell| cell.and_then(|(t, cell)| Some((t, cell.mean()?.max(1.0))))).collect();
    let layers =
        vec![Layer::Band { class: "span other", spans: span }, Layer::Line { class: "line other", places: mean }];
    let y = Axis::decades(layers.iter().flat_map(Layer::values));
    let panel = Panel { title: "end to end, µs".to_owned(), y, layers, height: Height::Usual };
    let signs = vec![Key::new("line other", "mean"), Key::new("span other", "least to greatest")];
    let about = format!("End-to-end latency of area {} against time", area.name);
    (!cells.is_empty()).then(|| Chart::of_time(about, length_s, signs, vec![panel]))
}

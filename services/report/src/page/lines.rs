//! From what was gathered to what is drawn.

use crate::gather::{Envelope, Marks, Trace};
use crate::page::table::Table;
use crate::page::words::{clock, known, number};
use crate::plot::{Axis, Height, Key, Layer, Panel, Place};

/// Rows of a plot's table.
pub const ROWS: usize = 24;
/// The axes of m, of which deformations are told.
pub const ABOUT: [&str; 3] = ["about x, to starboard", "about y, to the bow", "about z, upwards"];
/// Roll, pitch and heading.
pub const ANGLES: [&str; 3] = ["roll, port side up", "pitch, bow up", "heading, clockwise"];
/// Styles of the three components: lines, areas, and what lies far behind.
pub const LINES: [&str; 3] = ["line x", "line y", "line z"];
const SPANS: [&str; 3] = ["span x", "span y", "span z"];
const BANDS: [&str; 3] = ["band x", "band y", "band z"];

/// Means of a component.
pub fn means(trace: &Trace<[Envelope; 3]>, axis: usize) -> Vec<Place> {
    let mean = |cell: Option<(f64, [Envelope; 3])>| cell.and_then(|(t, cell)| Some((t, cell[axis].mean()?)));
    trace.cells().into_iter().map(mean).collect()
}

/// From the least to the greatest of a component.
pub fn spans(trace: &Trace<[Envelope; 3]>, axis: usize) -> Vec<Option<(f64, f64, f64)>> {
    let span = |cell: Option<(f64, [Envelope; 3])>| {
        let (t, cell) = cell?;
        cell[axis].mean().map(|_| (t, cell[axis].least, cell[axis].most))
    };
    trace.cells().into_iter().map(span).collect()
}

/// A component with what it wanders between, and its range behind it where there is one.
pub fn component(trace: &Trace<[Envelope; 3]>, band: Option<&Trace<[Envelope; 3]>>, axis: usize) -> Vec<Layer> {
    let band = band.map(|band| Layer::Band { class: BANDS[axis], spans: spans(band, axis) });
    let own = [
        Layer::Band { class: SPANS[axis], spans: spans(trace, axis) },
        Layer::Line { class: LINES[axis], places: means(trace, axis) },
    ];
    band.into_iter().chain(own).collect()
}

/// Three panels of components.
pub fn panels(trace: &Trace<[Envelope; 3]>, names: [&str; 3], measure: &str) -> Vec<Panel> {
    let panel = |axis: usize| {
        let layers = component(trace, None, axis);
        let y = Axis::around(layers.iter().flat_map(Layer::values));
        Panel { title: format!("{}, {measure}", names[axis]), y, layers, height: Height::Usual }
    };
    [0, 1, 2].map(panel).into()
}

/// One panel with the means of all three components as logarithms.
pub fn together(trace: &Trace<[Envelope; 3]>, title: &str) -> Panel {
    let lines = [0, 1, 2].map(|axis| Layer::Line { class: LINES[axis], places: means(trace, axis) });
    let y = Axis::decades(lines.iter().flat_map(Layer::values));
    Panel { title: title.to_owned(), y, layers: lines.into(), height: Height::Usual }
}

/// The signs of the three components.
pub fn keys(names: [&str; 3]) -> Vec<Key> {
    names.iter().zip(LINES).map(|(name, class)| Key::new(class, *name)).collect()
}

/// A table of three components: of each least, mean and greatest.
pub fn table(trace: &Trace<[Envelope; 3]>, names: [&str; 3], decimals: usize) -> Table {
    let head: Vec<String> =
        names.iter().flat_map(|name| ["least", "mean", "greatest"].map(|f| format!("{name} {f}"))).collect();
    let head: Vec<&str> = std::iter::once("from").chain(head.iter().map(String::as_str)).collect();
    let mut table = Table::new(&head);
    for (time, cell) in trace.rows(ROWS) {
        let of =
            |cell: &Envelope| [number(cell.least, decimals), known(cell.mean(), decimals), number(cell.most, decimals)];
        table.row(std::iter::once(clock(time.start)).chain(cell.iter().flat_map(of)).collect());
    }
    table
}

/// From when to when a mark stood.
pub fn stretches(trace: &Trace<Marks>, is_set: impl Fn(u64) -> bool) -> Vec<(f64, f64)> {
    let cells = trace.cells();
    let times: Vec<f64> = cells.iter().flatten().map(|(t, _)| *t).collect();
    let half_s = 0.5 * times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    let half_s = if half_s.is_finite() { half_s } else { 0.0 };
    let mut stretches: Vec<(f64, f64)> = Vec::new();
    let mut goes_on = false;
    for cell in cells {
        let set = cell.filter(|(_, marks)| is_set(marks.any)).map(|(t, _)| t);
        if let Some(t) = set {
            match stretches.last_mut().filter(|_| goes_on) {
                Some(last) => last.1 = t + half_s,
                None => stretches.push((t - half_s, t + half_s)),
            }
        }
        goes_on = set.is_some();
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_become_stretches() {
        let mut trace = Trace::new(1_000_000_000);
        for t in 0..10i64 {
            trace.take(t * 1_000_000_000, Marks { any: u64::from((2..5).contains(&t) || t == 8) });
        }
        assert_eq!(stretches(&trace, |any| any & 1 != 0), [(2.0, 5.0), (8.0, 9.0)]);
        assert!(stretches(&trace, |any| any & 2 != 0).is_empty());
    }
}

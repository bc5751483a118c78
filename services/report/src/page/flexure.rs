//! What was learnt of the hull, and of the delay between the units.

use super::Section;
use super::deformation::one;
use super::lines::{ABOUT, LINES, ROWS, keys};
use super::table::Table;
use super::words::{NOTHING, clock, count, digits, number};
use crate::gather::{AreaRun, Envelope, Trace};
use crate::plot::{Axis, Chart, Height, Key, Layer, Panel, Place};
use frames::unit;
use maud::html;
use messages::FlexureParams;
use std::f64::consts::TAU;

/// Lines of a second mode.
const SECOND: [&str; 3] = ["line x dashed", "line y dashed", "line z dashed"];

type Value = fn(&FlexureParams, usize) -> f64;

const FIRST_MODE: [(&str, Value); 3] = [
    ("natural period, s", |set, axis| TAU / set.b[axis]),
    ("damping, 1/s", |set, axis| set.mu[axis]),
    ("standard deviation of the flexure, arcmin", |set, axis| set.sigma[axis] / unit::ARCMIN),
];
const SECOND_MODE: [Value; 3] = [
    |set, axis| TAU / set.second_b[axis],
    |set, axis| set.second_mu[axis],
    |set, axis| set.second_sigma[axis] / unit::ARCMIN,
];

/// The identified flexure model against time.
pub fn parameters(area: &AreaRun, length_s: f64) -> Section {
    let title = "Identified flexure";
    if area.sets.is_empty() {
        let why = "No parameter set is recorded: the run was too short for one, the configuration tells the flexure, or the key topics leaves them out.";
        return Section::without(title, why);
    }
    let has_second = area.sets.iter().any(|(_, set)| set.second_sigma.iter().any(|sigma| *sigma > 0.0));
    let panel = |figure: usize| {
        let (name, value) = FIRST_MODE[figure];
        let mut layers = Vec::new();
        for axis in [0, 1, 2] {
            layers
                .push(Layer::Line { class: LINES[axis], places: steps(area, length_s, |set| Some(value(set, axis))) });
            let second = |set: &FlexureParams| (set.second_sigma[axis] > 0.0).then(|| SECOND_MODE[figure](set, axis));
            layers.push(Layer::Line { class: SECOND[axis], places: steps(area, length_s, second) });
        }
        let y = Axis::decades(layers.iter().flat_map(Layer::values));
        Panel { title: name.to_owned(), y, layers, height: Height::Usual }
    };
    let mut signs = keys(ABOUT);
    if has_second {
        signs.push(Key::new("line any dashed", "second mode"));
    }
    let about = format!("Identified flexure of area {} against time", area.name);
    let chart = Chart::of_time(about, length_s, signs, [0, 1, 2].map(panel).into());
    let (adopted, late) = area.adopted;
    let note = format!(
        "{} sets were learnt. A set holds from its lead after the end of its window until the next; {} took effect, {} of them late.",
        count(area.sets.len() as u64),
        count(adopted),
        count(late),
    );
    Section::new(
        title,
        note,
        html! {
            (chart.draw())
            (numbers(area).folded("Numbers of this plot, with one standard deviation"))
        },
    )
}

/// A value from when its set is in force until the next one is.
fn steps(area: &AreaRun, length_s: f64, value: impl Fn(&FlexureParams) -> Option<f64>) -> Vec<Place> {
    let ends = area.sets.iter().skip(1).map(|(t, _)| *t).chain([length_s]);
    let mut places = Vec::new();
    for ((from_s, set), to_s) in area.sets.iter().zip(ends) {
        match value(set).filter(|value| value.is_finite()) {
            Some(value) => places.extend([Some((*from_s, value)), Some((to_s.max(*from_s), value))]),
            None => places.push(None),
        }
    }
    places
}

/// Some of the sets, the last among them.
fn numbers(area: &AreaRun) -> Table {
    let mut table = Table::new(&[
        "in force from",
        "axis",
        "window, s",
        "period, s",
        "damping, 1/s",
        "sigma, arcmin",
        "second period, s",
        "second sigma, arcmin",
    ])
    .words(2);
    let every = area.sets.len().div_ceil(ROWS / 3).max(1);
    let last = area.sets.len().saturating_sub(1);
    for (i, (from_s, set)) in area.sets.iter().enumerate().filter(|(i, _)| (last - i).is_multiple_of(every)) {
        let window_s = unit::seconds(set.header.time_ns.saturating_sub(set.window_begin_ns));
        for axis in [0, 1, 2] {
            let doubted = |value: f64, ln_sd: f64| format!("{} ± {}", digits(value), digits(value * ln_sd));
            let second = set.second_sigma[axis] > 0.0;
            let of_second =
                |figure: usize| if second { digits(SECOND_MODE[figure](set, axis)) } else { NOTHING.to_owned() };
            let first = |text: String| if axis == 0 { text } else { String::new() };
            table.row(vec![
                first(format!("{}{}", clock(*from_s), if i == last { ", the last" } else { "" })),
                ["x", "y", "z"][axis].to_owned(),
                first(number(window_s, 0)),
                doubted(TAU / set.b[axis], set.ln_b_sd[axis]),
                doubted(set.mu[axis], set.ln_mu_sd[axis]),
                doubted(set.sigma[axis] / unit::ARCMIN, set.ln_sigma_sd[axis]),
                of_second(0),
                of_second(2),
            ]);
        }
    }
    table
}

/// The delay between the units against time.
pub fn delay(area: &AreaRun, length_s: f64) -> Section {
    let title = "Delay";
    if area.delay.is_empty() {
        return Section::without(title, "No delay is estimated between this area's unit and the main unit.");
    }
    let span = |trace: &Trace<Envelope>| {
        trace.cells().into_iter().map(|cell| cell.map(|(t, cell)| (t, cell.least, cell.most))).collect()
    };
    let mean = area.delay.cells().into_iter().map(|cell| cell.and_then(|(t, cell)| Some((t, cell.mean()?)))).collect();
    let line = Layer::Line { class: "line other", places: mean };
    let mut widths: Vec<f64> =
        area.delay_band.cells().into_iter().flatten().map(|(_, cell)| cell.most.abs().max(cell.least.abs())).collect();
    widths.sort_unstable_by(f64::total_cmp);
    // before it is known its range says nothing
    let usual = widths.get(widths.len() * 9 / 10).copied().unwrap_or(1.0);
    let y = Axis::around(line.values().into_iter().chain([usual, -usual]));
    let layers = vec![Layer::Band { class: "band other", spans: span(&area.delay_band) }, line];
    let panel = Panel { title: "delay, ms".to_owned(), y, layers, height: Height::Usual };
    let signs = vec![Key::new("line other", "delay"), Key::new("band other", "95 % range")];
    let about = format!("Estimated delay of area {} against time", area.name);
    let chart = Chart::of_time(about, length_s, signs, vec![panel]);
    let skew = area.last.filter(|last| last.skew_sigma > 0.0).map(|last| {
        format!(
            " At the end it grew by {} ± {} ppm.",
            digits(last.skew / unit::PPM),
            digits(last.skew_sigma / unit::PPM)
        )
    });
    let note = format!(
        "By how much the area's unit's stamps are late, as the motion shows it; the estimator takes it into account.{}",
        skew.unwrap_or_default()
    );
    Section::new(
        title,
        note,
        html! { (chart.draw()) (one(&area.delay, "delay, ms:", 3).folded("Numbers of this plot")) },
    )
}

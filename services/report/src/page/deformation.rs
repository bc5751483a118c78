//! Deformation, its range, its statistics and its spectrum.

use super::Section;
use super::lines::{ABOUT, LINES, ROWS, component, keys, table, together};
use super::table::Table;
use super::words::{clock, digits, known, number, percent, plain};
use crate::gather::{AreaRun, Block, Envelope, Trace};
use crate::plot::{Axis, Chart, Height, Key, Layer, Panel};
use estimation::evaluate::Spectrum;
use frames::unit;
use maud::html;

/// Rows of statistics that stand on the page unasked.
const SHOWN: usize = 36;

/// Deformation and range against time.
pub fn deformation(area: &AreaRun, length_s: f64) -> Section {
    let title = "Deformation";
    if area.phi.is_empty() {
        return Section::without(title, "The recording holds no valid solution of this area.");
    }
    let limits = area.limits.and_then(|limits| limits.deformation).map(|limits| limits.map(|v| v / unit::ARCMIN));
    let panel = |axis: usize| {
        let mut layers = component(&area.phi, Some(&area.band), axis);
        let y = Axis::around(reach(&area.phi, &area.band, axis).into_iter());
        for limit in limits.iter() {
            layers.extend([limit[axis], -limit[axis]].map(|value| Layer::Level { class: "limit", value }));
        }
        Panel { title: format!("{}, arcmin", ABOUT[axis]), y, layers, height: Height::Usual }
    };
    let mut signs = vec![
        Key::new("line any", "mean of a stretch of time"),
        Key::new("span any", "least to greatest"),
        Key::new("band any", "95 % range"),
    ];
    signs.extend(limits.map(|_| Key::new("limit", "alarm limit")));
    let panels = [0, 1, 2].map(panel).into();
    let about = format!("Deformation of area {} and its range against time", area.name);
    let chart = Chart::of_time(about, length_s, signs, panels);
    let mut note = "The turn from the main unit's axes to the area's, as a rotation vector in the main unit's axes. \
        Where the range leaves the picture it is cut."
        .to_owned();
    if let Some([x, y, z]) = limits {
        note += &format!(" Alarm limits: {}, {} and {} arcmin.", plain(x), plain(y), plain(z));
    }
    let tables = html! {
        (table(&area.phi, ["x", "y", "z"], 2).folded("Numbers of this plot: deformation, arcmin"))
    };
    Section::new(title, note, html! { (chart.draw()) (tables) })
}

/// What the axis of a deformation has to reach: all of it, and of the ends of its range all but the widest twentieth.
fn reach(phi: &Trace<[Envelope; 3]>, band: &Trace<[Envelope; 3]>, axis: usize) -> Vec<f64> {
    let own = phi.cells().into_iter().flatten().flat_map(|(_, cell)| [cell[axis].least, cell[axis].most]);
    let most = |side: &dyn Fn(&Envelope) -> f64, share: f64| {
        let mut ends: Vec<f64> = band.cells().into_iter().flatten().map(|(_, cell)| side(&cell[axis])).collect();
        ends.sort_unstable_by(f64::total_cmp);
        ends.get((share * ends.len().saturating_sub(1) as f64).round() as usize).copied()
    };
    own.chain(most(&|cell| cell.least, 0.05)).chain(most(&|cell| cell.most, 0.95)).collect()
}

/// The half width of the range against time.
pub fn range(area: &AreaRun, length_s: f64) -> Section {
    let title = "Range";
    if area.range.is_empty() {
        return Section::without(title, "Without a valid solution there is no range.");
    }
    let mut panel = together(&area.range, "half width of the 95 % range, arcmin");
    let mut signs = keys(ABOUT);
    if let Some(limits) = area.limits.and_then(|limits| limits.range) {
        // limits that are the same lie on each other
        panel.layers.extend(limits.map(|limit| Layer::Level { class: "limit", value: limit / unit::ARCMIN }));
        panel.y = Axis::decades(panel.layers.iter().flat_map(Layer::values));
        signs.push(Key::new("limit", "alarm limit"));
    }
    let about = format!("Range of area {} against time", area.name);
    let chart = Chart::of_time(about, length_s, signs, vec![panel]);
    let note = "The deformation is to be off by no more than this 95 % of the time.";
    let numbers = table(&area.range, ["x", "y", "z"], 3).folded("Numbers of this plot: half width, arcmin");
    Section::new(title, note, html! { (chart.draw()) (numbers) })
}

/// Statistics of three components every ten minutes.
pub fn statistics(blocks: &[Block], names: [&str; 3], measure: &str, decimals: usize) -> Section {
    let title = "Statistics per 10 minutes";
    let Some(last) = blocks.last() else { return Section::without(title, "There is nothing to take statistics of.") };
    let of = |block: &Block, axis: usize| {
        let s = block.components[axis];
        let first = if axis == 0 {
            format!("{} to {}", clock(block.time_s.start), clock(block.time_s.end))
        } else {
            String::new()
        };
        let covered = if axis == 0 { clock(block.covered_s) } else { String::new() };
        let figures = [s.mean, s.deviation, s.least, s.most].map(|v| number(v, decimals));
        [first, names[axis].to_owned(), covered].into_iter().chain(figures).chain([known(s.period_s, 2)]).collect()
    };
    let columns = ["time", "component", "data", "mean", "std", "min", "max", "zero crossing, s"];
    let mut shown = Table::new(&columns).words(2);
    let mut folded = Table::new(&columns).words(2);
    for (i, block) in blocks.iter().enumerate() {
        let table = if 3 * i < SHOWN { &mut shown } else { &mut folded };
        (0..3).for_each(|axis| table.row(of(block, axis)));
    }
    let mut note = format!(
        "In {measure}. The zero-crossing period is the mean time from one way up through the mean to the next. Data is for how long there were values, min:s."
    );
    if last.time_s.end - last.time_s.start < 599.0 {
        note += &format!(" The last block is no whole one: {} of 10:00.", clock(last.time_s.end - last.time_s.start));
    }
    Section::new(title, note, html! { (shown.draw()) (folded.folded("Further blocks")) })
}

/// The spectrum of the deformation.
pub fn spectrum(area: &AreaRun) -> Section {
    let title = "Spectrum";
    let Some(spectra) = area.spectra() else {
        return Section::without(
            title,
            "Too short: a spectrum needs some ten seconds of valid solutions without a hole.",
        );
    };
    let fine = spectra.each_ref().map(|spectrum| spectrum.bands(40.0));
    let lines = [0, 1, 2].map(|axis| {
        let places = fine[axis].iter().map(|band| Some((band.frequency_hz, band.density))).collect();
        Layer::Line { class: LINES[axis], places }
    });
    let most = lines.iter().flat_map(Layer::values).fold(0.0, f64::max);
    let floor = most * 1e-10;
    let y = Axis::decades(lines.iter().flat_map(Layer::values).filter(|value| *value > floor));
    let x = Axis::decades(fine.iter().flatten().map(|band| band.frequency_hz));
    let [first, ..] = &spectra;
    let (step_hz, stretches) = (first.step_hz, first.stretches);
    let panel =
        Panel {
            title: "power spectral density, arcmin²/Hz".to_owned(), y, layers: lines.into(), height: Height::Tall
        };
    let about = format!("Spectrum of the deformation of area {}", area.name);
    let ticks = x.ticks(5);
    let chart = Chart { about, keys: keys(ABOUT), x, ticks, along: "frequency, Hz", panels: vec![panel] };
    let mut numbers =
        Table::new(&["Hz", "period, s", "x density", "share", "y density", "share", "z density", "share"]);
    let coarse = spectra.each_ref().map(|spectrum| spectrum.bands(6.0));
    for row in 0..coarse[0].len() {
        let frequency_hz = coarse[0][row].frequency_hz;
        let mut cells = vec![digits(frequency_hz), digits(1.0 / frequency_hz)];
        for (spectrum, bands) in spectra.iter().zip(&coarse) {
            let share = bands[row].variance / spectrum.variance().max(f64::MIN_POSITIVE);
            cells.extend([digits(bands[row].density), percent(share)]);
        }
        numbers.row(cells);
    }
    // the slowest that it shows is no peak but a slope
    let peak = |spectrum: &Spectrum| (spectrum.peak_hz() > 2.5 * spectrum.step_hz).then(|| 1.0 / spectrum.peak_hz());
    let peaks: Vec<String> = spectra
        .iter()
        .zip(["x", "y", "z"])
        .filter_map(|(spectrum, axis)| Some(format!("about {axis} at a period of {} s", digits(peak(spectrum)?))))
        .collect();
    let peaks = match peaks.len() {
        0 => "The density has no peak but grows towards what is slower.".to_owned(),
        _ => format!("The density has its peak {}.", peaks.join(", ")),
    };
    let note = format!(
        "By Welch's method: mean of {stretches} stretches of {} s, which overlap by half; what is slower is left out. {peaks}",
        digits(1.0 / step_hz),
    );
    Section::new(
        title,
        note,
        html! {
            (chart.draw())
            (numbers.folded("Numbers of this plot: density in arcmin²/Hz, and each band's share of the variance"))
        },
    )
}

/// What the end of the run says of the area as it is built.
pub fn static_part(area: &AreaRun) -> Section {
    let title = "Static part";
    let summary = area.errors.summary();
    let Some(found) = summary.static_deg else {
        return Section::without(title, "Without a valid solution there is none.");
    };
    let mut table = Table::new(&["at the end, degrees", "x", "y", "z"]);
    let mut row = |name: &str, values: Option<[f64; 3]>| {
        if let Some(values) = values {
            table.row(std::iter::once(name.to_owned()).chain(values.map(|v| number(v, 4))).collect());
        }
    };
    row("static part by the filter", Some(found));
    row("its standard deviation", summary.static_sigma_deg);
    row("installation as the motion alone shows it", summary.installation_deg);
    row("its standard deviation", summary.installation_sigma_deg);
    let note = "What of the deformation does not move: how the unit was installed, and how the ship is loaded. Rotation vectors.";
    Section::new(title, note, table.draw())
}

/// Rows of a trace of one number, with its name.
pub fn one(trace: &Trace<Envelope>, name: &str, decimals: usize) -> Table {
    let head = ["least", "mean", "greatest"].map(|figure| format!("{name} {figure}"));
    let mut table = Table::new(&["from", &head[0], &head[1], &head[2]]);
    for (time, cell) in trace.rows(ROWS) {
        table.row(vec![
            clock(time.start),
            number(cell.least, decimals),
            known(cell.mean(), decimals),
            number(cell.most, decimals),
        ]);
    }
    table
}

//! What the recording is, in words, and how each area did at a glance.

use super::Section;
use super::health::role;
use super::table::Table;
use super::words::{NOTHING, count, length, number, percent, time, utc};
use crate::gather::{AreaRun, Block, Run};
use frames::unit;
use maud::{Markup, html};
use std::path::Path;

/// When it was recorded.
pub fn when(run: &Run) -> String {
    run.recorded_ns.map_or("an empty recording".to_owned(), |(from_ns, _)| format!("{} UTC", utc(from_ns)))
}

/// The head of the page.
pub fn words(path: &Path, run: &Run) -> Markup {
    let name = path.file_name().map_or(path.display().to_string(), |name| name.to_string_lossy().into_owned());
    html! {
        p class="brand" { "deckflex report" }
        h1 { "Deck deformation, " span class="whole" { (when(run)) } }
        p class="lead" { (recorded(run)) " File " span class="file" { (name) } "." }
        ul class="findings" {
            @for area in &run.areas { li { (area_words(area)) } }
            @for (class, sentence) in losses(run) { li class=(class) { (sentence) } }
        }
        (glance(run))
    }
}

fn recorded(run: &Run) -> String {
    let by = format!("by deckflex {} with {}", run.about.version, run.about.path);
    match run.recorded_ns {
        Some((from_ns, to_ns)) => {
            format!("{} of data, recorded from {} to {} UTC {by}.", length(run.length_ns), utc(from_ns), utc(to_ns))
        }
        None => format!("No message, begun {by}."),
    }
}

fn area_words(area: &AreaRun) -> String {
    if area.solutions == 0 {
        return format!("Area {}: no solution is recorded.", area.name);
    }
    let share = percent(area.valid as f64 / area.solutions as f64);
    let first = area.first_valid_s.map_or(String::new(), |s| format!(", the first after {} s", number(s, 1)));
    let truth = match area.errors.summary().coverage_95 {
        Some([x, y, z]) => format!(
            " The range holds the error {}, {} and {} of the time about x, y and z.",
            percent(x),
            percent(y),
            percent(z)
        ),
        None => String::new(),
    };
    let alarms = match (&area.limits, area.alarms.spells.len()) {
        (None, _) => String::new(),
        (Some(_), 0) => " No alarm was raised.".to_owned(),
        (Some(_), 1) => " One alarm was raised.".to_owned(),
        (Some(_), n) => format!(" {} alarms were raised.", count(n as u64)),
    };
    format!("Area {}: {share} of {} solutions are valid{first}.{truth}{alarms}", area.name, count(area.solutions))
}

/// Whether all is there, a sentence each, with its style.
fn losses(run: &Run) -> Vec<(&'static str, String)> {
    let mut said = Vec::new();
    for (path, reason) in &run.cuts {
        let name = path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        said.push(("bad", format!("The recording is cut at the end of {name}: {reason}.")));
    }
    match run.ending {
        Some(ending) if ending.dropped.saturating_add(ending.lost) > 0 => {
            let (dropped, lost) = (count(ending.dropped), count(ending.lost));
            let sentence = format!(
                "{dropped} messages are in no file, because the disk was full or too slow, and {lost} did not reach the recorder."
            );
            said.push(("bad", sentence));
        }
        Some(ending) if ending.end_of_run && run.cuts.is_empty() => {
            said.push(("good", "The recording goes to the run's end, and no message of it is missing.".to_owned()));
        }
        Some(_) => {}
        None => said.push((
            "bad",
            "What the recorder dropped is not known, since it tells that at a recording's end.".to_owned(),
        )),
    }
    if !run.is_whole() && run.cuts.is_empty() {
        said.push(("bad", "The recording does not go to the run's end.".to_owned()));
    }
    if !run.about.from_the_start {
        let part = run.about.part;
        said.push(("bad", format!("It begins in the middle of the run: this is the run's file number {part}.")));
    }
    if run.unreadable > 0 {
        said.push(("bad", format!("{} messages cannot be read.", count(run.unreadable))));
    }
    for area in run.areas.iter().filter(|area| area.lost > 0) {
        said.push((
            "bad",
            format!("{} solutions of area {} are missing in their sequence.", count(area.lost), area.name),
        ));
    }
    for (topic, stage) in &run.stages {
        match stage.restarts() {
            0 => {}
            1 => said.push(("bad", format!("{} was started again once.", role(topic)))),
            times => said.push(("bad", format!("{} was started again {times} times.", role(topic)))),
        }
        let told = stage.troubles().map(|total| format!("{}: {} {}.", role(topic), count(total.count), total.said));
        said.extend(told.map(|sentence| ("warn", sentence)));
    }
    said
}

/// A row an area.
fn glance(run: &Run) -> Markup {
    let mut table = Table::new(&[
        "area",
        "valid",
        "std x, y, z, arcmin",
        "greatest x, y, z, arcmin",
        "range x, y, z, arcmin",
        "alarms",
        "median latency",
        "99 %",
    ]);
    for area in &run.areas {
        let blocks = area.blocks();
        let three =
            |values: Option<[f64; 3]>| values.map_or(NOTHING.to_owned(), |v| v.map(|v| number(v, 2)).join(", "));
        let range = area.last.map(|last| last.range.map(|range| range / unit::ARCMIN));
        let latency = area.latencies.whole.summary();
        let told = |us: f64| if latency.count > 0 { time(us) } else { NOTHING.to_owned() };
        let alarms = if area.limits.is_some() { count(area.alarms.spells.len() as u64) } else { NOTHING.to_owned() };
        table.row(vec![
            area.name.clone(),
            percent(area.valid as f64 / area.solutions.max(1) as f64),
            three(deviations(&blocks)),
            three(greatest(&blocks)),
            three(range),
            alarms,
            told(latency.p50_us),
            told(latency.p99_us),
        ]);
    }
    html! { (table.draw()) p class="note" { "Range: half width at the end. Latency: from the sample's due time to the solution." } }
}

/// Standard deviation over all blocks, about the mean of all.
fn deviations(blocks: &[Block]) -> Option<[f64; 3]> {
    let total = blocks.iter().map(|block| block.components[0].count as f64).sum::<f64>();
    let of = |axis: usize| {
        let parts = || blocks.iter().map(|block| (block.components[axis], block.components[axis].count as f64 / total));
        let mean: f64 = parts().map(|(part, weight)| weight * part.mean).sum();
        parts().map(|(part, weight)| weight * (part.deviation.powi(2) + (part.mean - mean).powi(2))).sum::<f64>().sqrt()
    };
    (total > 0.0).then(|| [0, 1, 2].map(of))
}

/// Largest value without its sign.
fn greatest(blocks: &[Block]) -> Option<[f64; 3]> {
    let of = |axis: usize| {
        let ends = blocks.iter().flat_map(|block| [block.components[axis].most, -block.components[axis].least]);
        ends.fold(0.0, f64::max)
    };
    (!blocks.is_empty()).then(|| [0, 1, 2].map(of))
}

/// What the recording holds.
pub fn topics(run: &Run) -> Section {
    let mut table = Table::new(&["topic", "messages"]);
    run.counts.iter().for_each(|(topic, messages)| table.row(vec![topic.clone(), count(*messages)]));
    Section::new("Topics", "", table.folded("Messages by topic"))
}

/// The configuration that it was recorded with.
pub fn configuration(run: &Run) -> Section {
    let about = &run.about;
    let note = format!("deckflex {}, run {:x}, {}", about.version, about.run_id, about.path);
    Section::new(
        "Configuration",
        note,
        html! {
            details { summary { "Text of the configuration" } pre { (about.configuration) } }
        },
    )
}

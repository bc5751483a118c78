//! Whether solutions could be used, and why not; alarms; the stages' counters.

use super::Section;
use super::deformation::one;
use super::lines::stretches;
use super::table::Table;
use super::words::{NOTHING, clock, count, digits, percent, plain};
use crate::gather::{AreaRun, Run, Spell, StageRun, VALID};
use crate::plot::{Axis, Chart, Height, Key, Lane, Layer, Panel, lanes};
use frames::unit;
use maud::{Markup, html};
use messages::{Flags, Scheduling, State};

/// Above this mean the estimator calls its data inconsistent.
const LARGEST_NIS: f64 = 3.0;
/// Rows of alarms that are told singly.
const SPELLS: usize = 40;

/// Validity and flags of the solutions.
pub fn flags(area: &AreaRun, length_s: f64) -> Section {
    let title = "Health of the solution";
    if area.solutions == 0 {
        return Section::without(title, "The recording holds no solution of this area.");
    }
    let carried: Vec<(Flags, &str)> =
        Flags::SENTENCES.into_iter().filter(|(flag, _)| area.share(*flag) > 0.0).collect();
    let mut all = vec![Lane {
        name: "valid".to_owned(),
        class: "bar good",
        stretches: stretches(&area.marks, |any| any & VALID != 0),
    }];
    let mut table = Table::new(&["flag", "meaning", "solutions", "share"]).words(2);
    let valid = area.valid as f64 / area.solutions as f64;
    table.row(vec!["valid".to_owned(), "The deformation may be used.".to_owned(), count(area.valid), percent(valid)]);
    for (flag, sentence) in &carried {
        let bits = u64::from(flag.bits());
        let class = if *flag == Flags::INTERPOLATED { "bar calm" } else { "bar warn" };
        all.push(Lane { name: named(*flag), class, stretches: stretches(&area.marks, |any| any & bits != 0) });
        let carriers = (area.share(*flag) * area.solutions as f64).round() as u64;
        table.row(vec![named(*flag), (*sentence).to_owned(), count(carriers), percent(area.share(*flag))]);
    }
    let about = format!("When the solutions of area {} were valid and which flags they carried", area.name);
    let note =
        "When solutions were valid, and what they said of themselves. Stretches too short to be seen are drawn wider.";
    Section::new(title, note, html! { (lanes(&about, length_s, &all)) (table.draw()) })
}

fn named(flag: Flags) -> String {
    flag.names().replace('_', " ")
}

/// Whether the data agree with the filter.
pub fn nis(area: &AreaRun, length_s: f64) -> Section {
    let title = "Consistency (NIS)";
    if area.nis.is_empty() {
        let why = "This recording does not tell the normalised innovations: it has no valid solution, or was made by an estimator or a version that does not tell them.";
        return Section::without(title, why);
    }
    let cells = area.nis.cells();
    let span = cells.iter().map(|cell| cell.map(|(t, cell)| (t, cell.least, cell.most))).collect();
    let mean = cells.iter().map(|cell| cell.and_then(|(t, cell)| Some((t, cell.mean()?)))).collect();
    let layers = vec![
        Layer::Band { class: "span other", spans: span },
        Layer::Line { class: "line other", places: mean },
        Layer::Level { class: "expected", value: 1.0 },
        Layer::Level { class: "limit", value: LARGEST_NIS },
    ];
    let y = Axis::decades(layers.iter().flat_map(Layer::values));
    let panel =
        Panel { title: "mean of the normalised innovations squared".to_owned(), y, layers, height: Height::Usual };
    let signs = vec![
        Key::new("line other", "NIS over the last minute"),
        Key::new("expected", "expected: 1"),
        Key::new("limit", "inconsistent above 3"),
    ];
    let chart = Chart::of_time(format!("Consistency of area {} against time", area.name), length_s, signs, vec![panel]);
    let inconsistent = area.share(Flags::INCONSISTENT);
    let note = format!(
        "How far the measurements lie from what the filter foresaw, in terms of its own covariance; less than 1 says that it is cautious. \
        {} of the solutions are flagged inconsistent.",
        percent(inconsistent)
    );
    Section::new(title, note, html! { (chart.draw()) (one(&area.nis, "NIS", 3).folded("Numbers of this plot")) })
}

/// Limits that were crossed.
pub fn alarms(area: &AreaRun, length_s: f64) -> Section {
    let title = "Alarms";
    let Some(limits) = &area.limits else {
        return Section::without(title, "The configuration sets no limits: it has no table [area.alarm].");
    };
    let arcmin = |limits: Option<[f64; 3]>| {
        limits.map_or("none".to_owned(), |v| format!("{} arcmin", v.map(|v| plain(v / unit::ARCMIN)).join(", ")))
    };
    let invalid = limits.invalid_s.map_or("none".to_owned(), |s| format!("{} s", plain(s)));
    let note = format!(
        "Limits of the deformation: {}; of the range: {}; beyond them for {} s. Longest time without a valid solution: {invalid}.",
        arcmin(limits.deformation),
        arcmin(limits.range),
        plain(limits.hold_s),
    );
    let spells = &area.alarms.spells;
    if spells.is_empty() {
        return Section::new(title, note, html! { p class="good" { "No limit was crossed." } });
    }
    let mut raised: Vec<messages::Alarms> = Vec::new();
    spells.iter().for_each(|spell| {
        if !raised.contains(&spell.alarm) {
            raised.push(spell.alarm)
        }
    });
    raised.sort_unstable_by_key(|alarm| alarm.bits());
    let lane = |alarm: &messages::Alarms| Lane {
        name: alarm.names().replace('_', " "),
        class: "bar bad",
        stretches: stretches(&area.alarms.trace, |any| any & u64::from(alarm.bits()) != 0),
    };
    let all: Vec<Lane> = raised.iter().map(lane).collect();
    let mut table = Table::new(&["alarm", "from", "to", "for, s", "largest, arcmin"]);
    spells.iter().take(SPELLS).for_each(|spell| table.row(row(spell, length_s)));
    let about = format!("When alarms of area {} stood", area.name);
    Section::new(
        title,
        note,
        html! {
            p { (count(spells.len() as u64)) @if spells.len() == 1 { " alarm was raised." } @else { " alarms were raised." } }
            (lanes(&about, length_s, &all))
            (table.draw())
            @if spells.len() > SPELLS { p { "And " (count((spells.len() - SPELLS) as u64)) " further ones." } }
        },
    )
}

fn row(spell: &Spell, length_s: f64) -> Vec<String> {
    vec![
        spell.alarm.names().replace('_', " "),
        clock(spell.from_s),
        spell.to_s.map_or("the end".to_owned(), clock),
        digits(spell.to_s.unwrap_or(length_s) - spell.from_s),
        spell.most.map_or(NOTHING.to_owned(), |most| digits(most / unit::ARCMIN)),
    ]
}

/// The counters of all stages.
pub fn stages(run: &Run) -> Section {
    let title = "Stages";
    if run.stages.is_empty() {
        return Section::without(title, "The recording holds no health of the stages: the key topics leaves it out.");
    }
    let names = StageRun::default().totals().map(|total| total.name);
    let columns: Vec<&str> = ["stage", "state", "class"].into_iter().chain(names).chain(["restarts"]).collect();
    let mut table = Table::new(&columns).words(3);
    for (topic, stage) in &run.stages {
        let state = State::from_code(stage.last.state).map_or(NOTHING, State::name);
        let class = Scheduling::from_code(stage.last.scheduling).map_or(NOTHING, Scheduling::name);
        let words = [role(topic), state.to_owned(), class.to_owned()];
        let totals = stage.totals().map(|total| count(total.count));
        table.row(words.into_iter().chain(totals).chain([count(stage.restarts() as u64)]).collect());
    }
    let note = "The last word of each stage in the recording, summed over the processes that carried it out.";
    Section::new(title, note, html! { (table.draw()) (troubles(run)) })
}

/// A stage by the topic of its health.
pub fn role(topic: &str) -> String {
    let name = topic.trim_start_matches("health/");
    name.split_once('/').map_or(name.to_owned(), |(stage, area)| format!("{stage} of {area}"))
}

fn troubles(run: &Run) -> Markup {
    let said = run.stages.iter().flat_map(|(topic, stage)| {
        stage.troubles().map(move |total| format!("{}: {} {}.", role(topic), count(total.count), total.said))
    });
    let said: Vec<String> = said.collect();
    html! { @if !said.is_empty() { ul { @for sentence in said { li { (sentence) } } } } }
}

//! The page: one file without a link to anything outside.

mod deformation;
mod flexure;
mod head;
mod health;
mod latency;
mod lines;
mod motion;
mod table;
mod truth;
mod words;

use crate::gather::{AreaRun, Run};
use frames::unit;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::path::Path;

const STYLE: &str = include_str!("style.css");

/// A part of the page.
pub struct Section {
    title: &'static str,
    note: String,
    body: Markup,
}

impl Section {
    /// With what is shown, and what to know about it.
    fn new(title: &'static str, note: impl Into<String>, body: Markup) -> Self {
        Self { title, note: note.into(), body }
    }

    /// Only the words why there is nothing.
    fn without(title: &'static str, why: &str) -> Self {
        Self::new(title, "", html! { p class="nothing" { (why) } })
    }

    fn draw(&self, within: &str) -> Markup {
        html! {
            section id=(anchor(within, self.title)) {
                h3 { (self.title) }
                @if !self.note.is_empty() { p class="note" { (self.note) } }
                (self.body)
            }
        }
    }
}

/// A place of the page that can be linked to.
fn anchor(within: &str, title: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    format!("{within}-{}", title.chars().map(plain).collect::<String>())
}

/// Sections under a heading.
struct Part {
    id: String,
    title: String,
    sections: Vec<Section>,
}

/// The text of the page about a recording.
pub fn of(path: &Path, run: &Run) -> String {
    let length_s = unit::seconds(run.length_ns);
    let mut parts: Vec<Part> = run.areas.iter().map(|area| of_area(area, length_s)).collect();
    parts.push(Part {
        id: "ship".to_owned(),
        title: "The ship".to_owned(),
        sections: motion::sway(&run.ship, length_s),
    });
    let recording = vec![health::stages(run), head::topics(run), head::configuration(run)];
    parts.push(Part { id: "run".to_owned(), title: "Stages and recording".to_owned(), sections: recording });
    let title = format!("deckflex: {}", head::when(run));
    let page = html! {
        (DOCTYPE)
        html lang="en-GB" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header { (head::words(path, run)) }
                (contents(&parts))
                main { @for part in &parts { (part.draw()) } }
            }
        }
    };
    page.into_string()
}

fn of_area(area: &AreaRun, length_s: f64) -> Part {
    let mut sections = vec![
        deformation::deformation(area, length_s),
        deformation::range(area, length_s),
        deformation::statistics(&area.blocks(), ["x", "y", "z"], "arcmin", 3),
    ];
    sections.extend(truth::error(area, length_s));
    sections.extend([
        deformation::spectrum(area),
        deformation::static_part(area),
        flexure::parameters(area, length_s),
        flexure::delay(area, length_s),
        motion::deck(area, length_s),
        health::alarms(area, length_s),
        health::flags(area, length_s),
        health::nis(area, length_s),
        latency::latency(area, length_s),
    ]);
    Part { id: format!("area-{}", area.name), title: format!("Area {}", area.name), sections }
}

impl Part {
    fn draw(&self) -> Markup {
        html! {
            h2 id=(self.id) { (self.title) }
            @for section in &self.sections { (section.draw(&self.id)) }
        }
    }
}

fn contents(parts: &[Part]) -> Markup {
    html! {
        nav aria-label="Contents" {
            @for part in parts { p {
                a class="part" href={ "#" (part.id) } { (part.title) } ": "
                @for (i, section) in part.sections.iter().enumerate() {
                    @if i > 0 { " · " }
                    a href={ "#" (anchor(&part.id, section.title)) } { (section.title) }
                }
            } }
        }
    }
}

//! The ship's and the deck's attitude.

use super::Section;
use super::deformation::statistics;
use super::lines::{ANGLES, keys, panels, table, together};
use crate::gather::{AreaRun, ShipRun};
use crate::plot::{Chart, Key};
use maud::html;

/// How the ship swayed.
pub fn sway(ship: &ShipRun, length_s: f64) -> Vec<Section> {
    let title = "Sway";
    if ship.angles.is_empty() {
        let why = "The recording holds no attitude of the ship: the main unit gives none, or the key topics leaves out samples and pairs.";
        return vec![Section::without(title, why)];
    }
    let chart = Chart::of_time(
        "Roll, pitch and heading of the ship",
        length_s,
        signs(),
        panels(&ship.angles, ANGLES, "degrees"),
    );
    let numbers = table(&ship.angles, ["roll", "pitch", "heading"], 2).folded("Numbers of this plot, degrees");
    let note = "Attitude of the ship at the main unit, by its INS. The heading goes on beyond 0° and 360°.";
    vec![
        Section::new(title, note, html! { (chart.draw()) (numbers) }),
        statistics(&ship.blocks(), ["roll", "pitch", "heading"], "degrees", 3),
    ]
}

fn signs() -> Vec<Key> {
    vec![Key::new("line any", "mean of a stretch of time"), Key::new("span any", "least to greatest")]
}

/// The attitude of the deck.
pub fn deck(area: &AreaRun, length_s: f64) -> Section {
    let title = "Attitude of the deck";
    if area.deck.is_empty() {
        return Section::without(
            title,
            "There is none: the main unit's attitude is not known, or no solution is valid.",
        );
    }
    let about = format!("Roll, pitch and heading of the deck at area {}", area.name);
    let chart = Chart::of_time(about, length_s, signs(), panels(&area.deck, ANGLES, "degrees"));
    let about = format!("Range of the deck's attitude at area {}", area.name);
    let width = together(&area.deck_width, "half width of its 95 % range, arcmin");
    let names = ["about east", "about north", "about up"];
    let width = Chart::of_time(about, length_s, keys(names), vec![width]);
    Section::new(
        title,
        "What equipment at the area needs: the main unit's attitude with the deformation.",
        html! {
            (chart.draw())
            (table(&area.deck, ["roll", "pitch", "heading"], 3).folded("Numbers of this plot, degrees"))
            (width.draw())
            (table(&area.deck_width, names, 3).folded("Numbers of this plot, arcmin"))
        },
    )
}

//! `{"experiments": [row, ...]}`.
//!
//! | key | value |
//! |---|---|
//! | `ours` | number; `null` if no trial gave one |
//! | `spread` | number; `null` if there was one trial only |
//! | `bound` | number, or the reason why there is none as a string |
//! | `paper` | number, or a string: `0.9 ± 0.1`, `1 to 2`, `at most 4.26`, a statement, or `not published: ` and why |
//! | `verdict` | `reproduces`, `reproduces in size`, `does not reproduce` or `not testable` |
//! | the others | strings |
//!
//! Numbers are in the row's unit and as short as they can be read back exactly.

use crate::number;
use experiments::{Bound, Published, Row};
use serde::Serialize;

#[derive(Serialize)]
struct Document<'a> {
    experiments: Vec<Entry<'a>>,
}

#[derive(Serialize)]
struct Entry<'a> {
    id: &'a str,
    table: &'a str,
    row: &'a str,
    axis: &'a str,
    unit: &'a str,
    ours: f64,
    spread: f64,
    bound: Figure<'a>,
    paper: Figure<'a>,
    verdict: String,
    why: &'a str,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Figure<'a> {
    Number(f64),
    Reason(&'a str),
    Words(String),
}

/// The text of the file.
pub fn of<'a>(rows: impl Iterator<Item = &'a Row>) -> serde_json::Result<String> {
    let document = Document { experiments: rows.map(entry).collect() };
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

fn entry(row: &Row) -> Entry<'_> {
    let claim = &row.claim;
    Entry {
        id: &claim.id,
        table: &claim.table,
        row: &claim.row,
        axis: &claim.axis,
        unit: &claim.unit,
        ours: row.ours,
        spread: row.spread,
        bound: match &claim.bound {
            Bound::Value(value) => Figure::Number(*value),
            Bound::None(reason) => Figure::Reason(reason),
        },
        paper: match &claim.paper {
            Published::Magnitude(value, _) | Published::Signed(value, _) => Figure::Number(*value),
            other => Figure::Words(number::published(other)),
        },
        verdict: row.verdict.to_string(),
        why: &claim.why,
    }
}

//! The tables of an experiment, which a terminal shows and Markdown understands.

use crate::number::{bound, brief, short};
use comfy_table::{Cell, CellAlignment, Table, presets};
use experiments::{Bound, Claim, Published, Row};
use std::fmt::Write;

/// The columns of every table.
pub const COLUMNS: [&str; 8] = ["row", "axis", "unit", "ours", "spread", "bound", "paper", "verdict"];

/// The cells of a row.
pub fn cells(row: &Row) -> [String; 8] {
    let claim = &row.claim;
    [
        claim.row.clone(),
        claim.axis.clone(),
        claim.unit.clone(),
        short(row.ours),
        short(row.spread),
        bound(&claim.bound),
        brief(&claim.paper),
        row.verdict.to_string(),
    ]
}

/// The rows that stand together, table by table, with the number of trials.
pub fn tables(rows: &[Row]) -> impl Iterator<Item = (String, &[Row])> {
    rows.chunk_by(|a, b| a.claim.table == b.claim.table).map(|rows| {
        let trials = |rows: &[Row]| rows.first().map_or(0, |row| row.trials);
        let told = match trials(rows) {
            1 => "one trial".to_owned(),
            trials if rows.iter().all(|row| row.trials == trials) => format!("{trials} trials"),
            _ => {
                let (least, most) =
                    rows.iter().fold((usize::MAX, 0), |(a, b), row| (a.min(row.trials), b.max(row.trials)));
                format!("{least} to {most} trials")
            }
        };
        (format!("{} ({told})", rows[0].claim.table), rows)
    })
}

/// What a claim has to say.
type Sentence = fn(&Claim) -> Option<&str>;

/// The sentences of a table, with what they are about: why the verdict is what it is, why there is no bound and nothing published. Rows
/// that follow each other and share a sentence share its line.
pub fn reasons(table: &[Row]) -> Vec<(String, &str)> {
    let kinds: [(&str, Sentence); 3] = [
        ("why", |claim| Some(&claim.why)),
        ("no bound", |claim| if let Bound::None(reason) = &claim.bound { Some(reason) } else { None }),
        ("not published", |claim| if let Published::Nothing(reason) = &claim.paper { Some(reason) } else { None }),
    ];
    let mut told = Vec::new();
    for (kind, sentence) in kinds {
        for rows in table.chunk_by(|a, b| sentence(&a.claim) == sentence(&b.claim)) {
            if let Some(sentence) = sentence(&rows[0].claim) {
                let all = rows.len() == table.len();
                told.push((if all { kind.to_owned() } else { format!("{kind}, {}", about(rows)) }, sentence));
            }
        }
    }
    told
}

/// Names of the rows with their axes.
fn about(rows: &[Row]) -> String {
    let groups = rows.chunk_by(|a, b| a.claim.row == b.claim.row);
    let names = groups.map(|rows| {
        let axes: Vec<&str> = rows.iter().map(|row| row.claim.axis.as_str()).collect();
        format!("{} {}", rows[0].claim.row, axes.join(" "))
    });
    names.collect::<Vec<String>>().join("; ")
}

/// The title, then each table with its reasons below.
pub fn of(title: &str, rows: &[Row]) -> String {
    let mut text = format!("{title}\n");
    for (name, rows) in tables(rows) {
        let mut table = Table::new();
        table.load_style(presets::ASCII_MARKDOWN);
        table.set_header(COLUMNS);
        for row in rows {
            let cell = |(column, text): (usize, String)| match column {
                3..=4 => Cell::new(text).set_alignment(CellAlignment::Right),
                _ => Cell::new(text),
            };
            table.add_row(cells(row).into_iter().enumerate().map(cell));
        }
        // writing into a String cannot fail
        let _ = writeln!(text, "\n{name}\n{}", table.trim_fmt());
        for (about, why) in reasons(rows) {
            let _ = writeln!(text, "  {about}: {why}");
        }
    }
    text
}

//! The page: tables and figures, one file without links to anything outside.

use crate::table::{COLUMNS, cells, reasons, tables};
use crate::{ReproduceError, plot};
use experiments::{Findings, Plan, Verdict};
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = "
body { font: 16px/1.5 system-ui, sans-serif; color: #1b1f24; background: #fff; max-width: 72rem; margin: 2rem auto; padding: 0 1.5rem; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.35rem; margin-top: 3rem; border-bottom: 2px solid #d5dae0; }
h3 { font-size: 1.05rem; margin: 2rem 0 .5rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: .3rem .9rem .3rem 0; border-bottom: 1px solid #e4e7eb; vertical-align: top; }
th { border-bottom: 2px solid #9aa4af; }
.number { text-align: right; }
.verdict { white-space: nowrap; font-weight: 600; }
.yes { color: #1a7f37; } .size { color: #8a6100; } .no { color: #b3261e; } .open { color: #5f6b77; }
.why { color: #47505a; font-size: .9rem; margin: .4rem 0; max-width: 60rem; }
figure { margin: 2rem 0; } figure svg { width: 100%; height: auto; max-width: 60rem; } figcaption { color: #47505a; font-size: .9rem; }
";

/// The text of the page.
pub fn of(experiments: &[(&'static str, Findings)], plan: &Plan) -> Result<String, ReproduceError> {
    let sections = experiments.iter().map(|(title, findings)| section(title, findings));
    let sections: Vec<Markup> = sections.collect::<Result<_, _>>()?;
    let kind = if plan.quick { "quick" } else { "full" };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "deckflex: the papers' experiments" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { "The papers' experiments" }
                p {
                    "Our figures beside the papers' and beside the statistical bound; a " (kind) " run, seed " (plan.seed) ". "
                    "The spread is the standard deviation of one trial."
                }
                @for section in sections { (section) }
            }
        }
    };
    Ok(page.into_string())
}

fn section(title: &str, findings: &Findings) -> Result<Markup, ReproduceError> {
    let figures = findings.figures.iter().map(|figure| Ok((figure, plot::svg(figure)?)));
    let figures: Vec<_> = figures.collect::<Result<_, ReproduceError>>()?;
    Ok(html! {
        h2 { (title) }
        @for (name, rows) in tables(&findings.rows) {
            h3 { (name) }
            div class="wide" { table {
                thead { tr { @for (i, column) in COLUMNS.iter().enumerate() { th class=[numeric(i)] { (column) } } } }
                tbody { @for row in rows {
                    tr id=(row.claim.id) { @for (i, cell) in cells(row).into_iter().enumerate() {
                        @if i == 7 { td class={ "verdict " (colour(row.verdict)) } { (cell) } }
                        @else { td class=[numeric(i)] { (cell) } }
                    } }
                } }
            } }
            @for (about, why) in reasons(rows) { p class="why" { strong { (about) ": " } (why) } }
        }
        @for (figure, svg) in figures {
            figure {
                h3 { (figure.title) }
                (PreEscaped(svg))
                figcaption { (figure.caption) }
            }
        }
    })
}

fn numeric(column: usize) -> Option<&'static str> {
    (3..=4).contains(&column).then_some("number")
}

fn colour(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Reproduces => "yes",
        Verdict::InSize => "size",
        Verdict::DoesNot => "no",
        Verdict::NotTestable => "open",
    }
}

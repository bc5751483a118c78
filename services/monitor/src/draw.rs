//! Draws the page; made for 80 columns and 24 rows or more.

use crate::page::{AreaState, Delays, Link, Page, SILENCE_NS, StageState};
use crate::{strip, words};
use frames::unit;
use messages::{FlexureParams, Scheduling, Stage, State};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Span, Text};
use ratatui::widgets::{Block, Paragraph, Row, Table, Wrap};
use std::f64::consts::TAU;

const KEYS: &str = "q leave   tab next area   e mark an event   z zero";

/// Draws the page as it is at `now_ns` of the monotonic clock.
pub fn draw(frame: &mut Frame, page: &Page, now_ns: i64) {
    let [head, body, foot] =
        Layout::vertical([Constraint::Length(1), Constraint::Min(0), Constraint::Length(1)]).areas(frame.area());
    frame.render_widget(Paragraph::new(heading(page)), head);
    let keys = if page.note.is_empty() { KEYS.to_owned() } else { format!("{}   {KEYS}", page.note) };
    frame.render_widget(Paragraph::new(keys).style(Style::new().fg(Color::DarkGray)), foot);
    match (&page.link, page.area()) {
        (Link::Live, Some(area)) => live(frame, body, page, area, now_ns),
        (Link::Waiting(reason), _) => {
            let text = Paragraph::new(reason.as_str()).wrap(Wrap { trim: true });
            frame.render_widget(text.block(Block::bordered().title(" nothing to show ")), body);
        }
        (Link::Live, None) => {}
    }
}

fn heading(page: &Page) -> Line<'static> {
    let mut spans = vec![Span::from("deckflex").bold(), Span::from(format!("  {}", page.title))];
    if page.link == Link::Live {
        spans.push(Span::from(format!("  {} Hz", page.rate_hz)));
    }
    if let Some(last) = page.area().and_then(|area| area.last) {
        spans.push(Span::from(format!("  t {:.1} s ", unit::seconds(last.header.time_ns))));
    }
    for (i, area) in page.areas.iter().enumerate() {
        let valid = area.last.is_some_and(|last| last.is_valid());
        let colour = if valid { Color::Green } else { Color::Red };
        let text = format!(" {} {} ", area.name, if valid { "valid" } else { "NOT VALID" });
        let style = Style::new().fg(colour);
        spans.push(Span::styled(text, if i == page.shown { style.reversed() } else { style }));
    }
    Line::from(spans)
}

fn live(frame: &mut Frame, place: Rect, page: &Page, area: &AreaState, now_ns: i64) {
    let said = sentences(page, area, now_ns);
    let told = (said.lines.len() as u16 + 2).clamp(4, 8);
    let [charts, words, numbers] =
        Layout::vertical([Constraint::Min(6), Constraint::Length(told), Constraint::Length(8)]).areas(place);
    let thirds: [Rect; 3] = Layout::horizontal([Constraint::Ratio(1, 3); 3]).areas(charts);
    thirds.into_iter().enumerate().for_each(|(axis, place)| strip::draw(frame, place, area, axis));
    let block = Block::bordered().title(format!(" {}: deformation over the last minute, in words ", area.name));
    frame.render_widget(Paragraph::new(said).wrap(Wrap { trim: true }).block(block), words);
    let [left, right] = Layout::horizontal([Constraint::Length(31), Constraint::Min(49)]).areas(numbers);
    let model = Paragraph::new(model(area)).block(Block::bordered().title(" flexure model in use "));
    frame.render_widget(model, left);
    frame.render_widget(stages(page, area, now_ns), right);
}

/// The gravest first: validity and flags, then silent stages, then counters.
fn sentences(page: &Page, area: &AreaState, now_ns: i64) -> Text<'static> {
    let mut lines: Vec<Line> = match &area.last {
        None => vec![Line::from("No solution has come yet.")],
        Some(last) => words::of_solution(last).into_iter().map(Line::from).collect(),
    };
    if let Some(first) = lines.first_mut() {
        let valid = area.last.is_some_and(|last| last.is_valid());
        *first = first.clone().fg(if valid { Color::Green } else { Color::Red }).bold();
    }
    if area.ended {
        lines.push(Line::from("The stream has come to its end."));
    }
    for stage in mine(page) {
        let name = stage.stage.name();
        match &stage.last {
            None => lines.push(Line::from(format!("{name} has not spoken yet.")).fg(Color::Yellow)),
            Some((health, at_ns)) => {
                let ended = health.state == State::Ended as u32;
                if !ended && now_ns - at_ns > SILENCE_NS {
                    let silent_s = unit::seconds(now_ns - at_ns);
                    let text = format!("{name} has been silent for {silent_s:.0} s: it may hang or be restarting.");
                    lines.push(Line::from(text).fg(Color::Red));
                }
                lines.extend(words::of_health(name, health).into_iter().map(|said| Line::from(said).fg(Color::Yellow)));
            }
        }
    }
    Text::from(lines)
}

/// The source and the stages of the area on show.
fn mine(page: &Page) -> impl Iterator<Item = &StageState> {
    page.stages.iter().filter(|stage| stage.area.is_none_or(|area| area == page.shown))
}

fn model(area: &AreaState) -> Text<'static> {
    let mut lines = Vec::new();
    match (&area.last, &area.parameters) {
        (Some(last), Some(parameters)) if last.params_id == parameters.id => lines.extend(of_model(parameters)),
        (Some(last), Some(parameters)) if last.params_id != 0 => {
            lines.extend(of_model(parameters));
            lines[0] = Line::from(format!("model {}, next {}", last.params_id, parameters.id));
        }
        _ => lines.push(Line::from("first guess, none learnt yet")),
    }
    if let Some(last) = area.last.filter(|last| last.delay_sigma > 0.0) {
        lines.push(Line::from(format!("delay {:+.2} ±{:.2} ms", last.delay / 1e-3, 1.96 * last.delay_sigma / 1e-3)));
    } else {
        lines.push(Line::from("delay: not estimated"));
    }
    lines.push(Line::from(format!("solutions {}, lost here {}", area.received, area.sequence.lost())));
    Text::from(lines)
}

fn of_model(parameters: &FlexureParams) -> Vec<Line<'static>> {
    let row = |name: &str, values: [f64; 3]| {
        let [x, y, z] = values;
        Line::from(format!("{name:<11}{x:>6.2}{y:>6.2}{z:>6.2}"))
    };
    let window_s = unit::seconds(parameters.header.time_ns - parameters.window_begin_ns);
    vec![
        Line::from(format!("model {}, of {window_s:.0} s", parameters.id)),
        row("period s", parameters.b.map(|b| TAU / b)),
        row("damping 1/s", parameters.mu),
        row("sigma '", parameters.sigma.map(|sigma| sigma / unit::ARCMIN)),
    ]
}

fn stages(page: &Page, area: &AreaState, now_ns: i64) -> Table<'static> {
    let [source, synchronise, estimate, whole] = &area.delays;
    let mut rows = Vec::new();
    let mut class = "";
    for stage in mine(page) {
        let delays = match stage.stage {
            Stage::Synchronise => Some(synchronise),
            Stage::Estimate => Some(estimate),
            Stage::Identify => None,
            _ => Some(source),
        };
        let name = stage.stage.name();
        rows.push(match &stage.last {
            None => row(name, "silent", None, delays),
            Some((health, at_ns)) => {
                if stage.stage == Stage::Estimate {
                    class = Scheduling::from_code(health.scheduling).map_or("", Scheduling::name);
                }
                let silent = now_ns - at_ns > SILENCE_NS && health.state != State::Ended as u32;
                let state = if silent { "silent" } else { State::from_code(health.state).map_or("?", State::name) };
                row(name, state, Some([health.taken, health.lost]), delays)
            }
        });
    }
    rows.push(row("end to end", class, Some([area.received, area.sequence.lost()]), Some(whole)));
    let widths = [12, 8, 9, 6, 6, 6].map(Constraint::Length);
    let header = Row::new(cells(["stage", "state"], ["in", "lost", "p50", "p99"].map(str::to_owned)));
    Table::new(rows, widths)
        .column_spacing(0)
        .header(header.style(Style::new().bold()))
        .block(Block::bordered().title(" stages, latency in us "))
}

fn row(name: &'static str, state: &'static str, counts: Option<[u64; 2]>, delays: Option<&Delays>) -> Row<'static> {
    let quantile = |share| delays.and_then(|delays| delays.quantile(share)).map(|us| format!("{us:.0}"));
    let [taken, lost] = counts.map_or_else(Default::default, |counts| counts.map(|count| count.to_string()));
    let [p50, p99] = [0.5, 0.99].map(|share| quantile(share).unwrap_or_default());
    Row::new(cells([name, state], [taken, lost, p50, p99]))
}

/// Words to the left, numbers to the right.
fn cells(words: [&'static str; 2], numbers: [String; 4]) -> Vec<Text<'static>> {
    let words = words.into_iter().map(Text::from);
    words.chain(numbers.into_iter().map(|number| Text::from(number).right_aligned())).collect()
}

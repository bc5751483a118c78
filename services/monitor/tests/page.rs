//! The page drawn on made terminals.
#![allow(clippy::unwrap_used)]

use frames::unit::ARCMIN;
use messages::{Flags, FlexureParams, Header, Health, Solution, Stage, Stamps, State};
use monitor::{Link, Page, draw};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

const SECOND: i64 = 1_000_000_000;

/// A solution of the second area's run: 1.5, -2.25 and 3 arcmin.
fn solution(k: u64) -> Solution {
    let due_ns = k as i64 * 10_000_000;
    let stamps = Stamps {
        due_ns,
        source_ns: due_ns + 100_000,
        complete_ns: due_ns + 100_000,
        pair_ns: due_ns + 120_000,
        solution_ns: due_ns + 180_000,
        ..Stamps::default()
    };
    Solution {
        header: Header { run_id: 7, sequence: k, time_ns: due_ns, stamps, ..Header::default() },
        params_id: 500,
        phi: [1.5 * ARCMIN, -2.25 * ARCMIN, (3.0 + 0.01 * k as f64).sin() * ARCMIN],
        range: [0.25 * ARCMIN; 3],
        delay: 2.5e-3,
        delay_sigma: 1e-4,
        valid: 1,
        ..Solution::default()
    }
}

fn health(stage: Stage) -> Health {
    Health { taken: 1234, stage: stage as u32, state: State::Running as u32, ..Health::default() }
}

/// Two areas, the first of which has had 12 s of solutions.
fn page() -> Page {
    let mut page = Page::attached("ship.toml".to_owned(), 100.0, &["radar", "mast"], Stage::Simulate);
    (1..=1200).filter(|k| *k != 600).for_each(|k| page.solution(0, &solution(k)));
    let header = Header { time_ns: 5 * SECOND, ..Header::default() };
    let parameters = FlexureParams {
        header,
        id: 500,
        b: [std::f64::consts::TAU / 10.0; 3],
        mu: [0.1; 3],
        sigma: [2.0 * ARCMIN; 3],
        ..FlexureParams::default()
    };
    page.parameters(0, &parameters);
    let stages: Vec<Stage> = page.stages.iter().map(|stage| stage.stage).collect();
    stages.iter().enumerate().for_each(|(i, stage)| page.health(i, &health(*stage), 10 * SECOND));
    page
}

fn drawn(page: &Page, width: u16, height: u16, now_ns: i64) -> String {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(frame, page, now_ns)).unwrap();
    let buffer = terminal.backend().buffer();
    let row = |y: u16| (0..width).map(|x| buffer[(x, y)].symbol()).collect::<String>().trim_end().to_owned() + "\n";
    (0..height).map(row).collect()
}

#[test]
fn a_small_terminal_shows_everything_that_matters() {
    for (width, height) in [(80, 24), (120, 40)] {
        let text = drawn(&page(), width, height, 11 * SECOND);
        for words in [
            "ship.toml  100 Hz  t 12.0 s",
            "radar valid",
            "mast NOT VALID",
            "x +1.50 ±0.25",
            "y -2.25 ±0.25",
            "Valid: the deformation may be used.",
            "model 500, of 5 s",
            "period s    10.00 10.00 10.00",
            "damping 1/s  0.10",
            "sigma '      2.00",
            "delay +2.50 ±0.20 ms",
            "solutions 1199, lost here 1",
            "q leave",
        ] {
            assert!(text.contains(words), "{width}x{height} has no {words:?}:\n{text}");
        }
        let line =
            |name: &str| text.lines().find(|line| line.contains(name)).unwrap_or_else(|| panic!("{name}:\n{text}"));
        // state, in, lost, p50 and p99
        for (name, cells) in [
            ("simulate", "running      1234     0   100   100"),
            ("synchronise", "running      1234     0    20    20"),
            ("estimate", "running      1234     0    60    60"),
            ("identify", "running      1234     0 "),
            ("end to end", "normal       1199     1   180   180"),
        ] {
            assert!(line(name).contains(cells), "{name}:\n{text}");
        }
        assert!(text.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)), "no chart is drawn:\n{text}");
    }
}

#[test]
fn trouble_is_told_in_words() {
    let mut page = page();
    let flags = Flags::SILENT | Flags::COASTING | Flags::PRIOR;
    page.solution(0, &Solution { valid: 0, flags, params_id: 0, delay_sigma: 0.0, ..solution(1201) });
    page.health(1, &Health { missing: 42, ..health(Stage::Synchronise) }, 10 * SECOND);
    let text = drawn(&page, 80, 24, 15 * SECOND);
    for words in [
        "radar NOT VALID",
        "no valid value",
        "NOT VALID: do not use the deformation.",
        "The area's unit gives no data",
        "The output is a prediction",
        "simulate has been silent for 5 s",
        "first guess, none learnt yet",
        "delay: not estimated",
    ] {
        assert!(text.contains(words), "no {words:?}:\n{text}");
    }
    assert!(
        drawn(&page, 120, 40, 12 * SECOND).contains("synchronise: 42 samples were missing in the units' own streams.")
    );
}

#[test]
fn tab_shows_the_next_area_and_its_stages() {
    let mut page = page();
    page.next_area();
    let text = drawn(&page, 80, 24, 11 * SECOND);
    assert!(text.contains("mast: deformation") && text.contains("No solution has come yet."), "{text}");
    page.next_area();
    assert_eq!(page.shown, 0);
}

#[test]
fn the_past_is_kept_for_a_minute_and_the_end_is_told() {
    let mut page = page();
    (1201..=9000).for_each(|k| page.solution(0, &solution(k)));
    let area = page.area().unwrap();
    assert!((600..=602).contains(&area.past.len()), "{}", area.past.len());
    page.solution(0, &Solution { header: Header { end: 1, ..Header::default() }, ..Solution::default() });
    assert!(drawn(&page, 80, 24, 11 * SECOND).contains("The stream has come to its end."));
}

#[test]
fn without_a_launch_the_page_says_so_and_no_size_is_too_small() {
    let page_of_nothing = Page::waiting("No launch of this user runs now.".to_owned());
    assert!(matches!(page_of_nothing.link, Link::Waiting(_)));
    assert!(drawn(&page_of_nothing, 80, 24, 0).contains("No launch of this user runs now."));
    for (width, height) in [(1, 1), (10, 3), (40, 10), (300, 100)] {
        drawn(&page(), width, height, 0);
        drawn(&page_of_nothing, width, height, 0);
    }
}

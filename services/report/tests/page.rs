//! Recordings that lack things, or hold nonsense: the page says so.
#![allow(clippy::unwrap_used)]

use messages::{Flags, FlexureParams, Header, Health, MainAttitude, Solution, Stamps, Truth};
use recording::{About, Adoption, Ending, Record, Writer};
use std::fs::{self, File};
use std::path::Path;

const CONFIGURATION: &str = include_str!("../../../config/outputs.toml");

/// Writes a recording and gives the text of the page about it.
fn page(records: &[(&str, Record)], ending: Option<Ending>) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run_000.mcap");
    let about = About {
        version: "9.9.9".into(),
        run_id: 7,
        part: 0,
        from_the_start: true,
        path: "ship & <deck>.toml".into(),
        configuration: CONFIGURATION.into(),
    };
    let mut writer = Writer::new(File::create(&path).unwrap(), &about).unwrap();
    for (number, (topic, record)) in records.iter().enumerate() {
        writer.write(topic, 1_700_000_000_000_000_000 + 10_000_000 * number as u64, record).unwrap();
    }
    match ending {
        Some(ending) => _ = writer.finish(&ending).unwrap(),
        None => {
            writer.flush().unwrap();
            writer.abandon();
        }
    }
    let report = report::run(&path, None).unwrap();
    assert_eq!(report.path, folder.path().join("run_000.html"));
    let text = fs::read_to_string(&report.path).unwrap();
    assert_eq!(text.len(), report.bytes);
    assert!(text.starts_with("<!DOCTYPE html>") && text.ends_with("</html>"));
    let cells = text.split("<td").map(|rest| rest.split('<').next().unwrap());
    let wrong: Vec<&str> = cells.filter(|cell| cell.contains("NaN") || cell.ends_with("inf")).collect();
    assert!(wrong.is_empty() && !text.contains("NaN"), "{wrong:?}");
    text
}

fn header(sequence: u64, time_ns: i64) -> Header {
    let stamps = Stamps {
        due_ns: 1,
        source_ns: 20_001,
        complete_ns: 20_001,
        pair_ns: 50_001,
        solution_ns: 120_001,
        parameters_ns: 0,
    };
    Header { run_id: 7, sequence, time_ns, stamps, ..Header::default() }
}

fn solution(sequence: u64, x: f64) -> Record {
    let range = [1e-4; 3];
    let header = header(sequence, 10_000_000 * sequence as i64);
    Record::Solution(Solution {
        header,
        q: [1.0, 0.0, 0.0, 0.0],
        phi: [x, 0.0, -x],
        range,
        valid: 1,
        nis: 0.9,
        ..Solution::default()
    })
}

const SOLUTION: &str = "area/radar/solution";

#[test]
fn an_empty_recording_says_what_it_lacks() {
    let text = page(&[], None);
    for words in [
        "No message, begun by deckflex 9.9.9 with ship &amp; &lt;deck&gt;.toml.",
        "Area radar: no solution is recorded.",
        "The recording is cut at the end of run_000.mcap",
        "The recording holds no valid solution of this area.",
        "There is nothing to take statistics of.",
        "Too short: a spectrum needs",
        "No parameter set is recorded",
        "No delay is estimated",
        "The recording holds no attitude of the ship",
        "The recording holds no solution with the times of the stages.",
        "The recording holds no health of the stages",
    ] {
        assert!(text.contains(words), "{words} is not in {text}");
    }
    assert!(!text.contains("Error against the truth"));
}

#[test]
fn what_is_lost_is_told() {
    let health = Health { taken: 5, missing: 3, stage: 2, pid: 1, ..Health::default() };
    let records = [
        ("health/synchronise/radar", Record::Health(health)),
        ("health/synchronise/radar", Record::Health(Health { pid: 2, ..health })),
        (SOLUTION, solution(0, 1e-4)),
        (SOLUTION, solution(4, 1e-4)),
    ];
    let text = page(&records, Some(Ending { end_of_run: true, dropped: 12, lost: 1 }));
    for words in [
        "12 messages are in no file, because the disk was full or too slow, and 1 did not reach the recorder.",
        "synchronise of radar was started again once.",
        "synchronise of radar: 6 samples were missing",
        "3 solutions of area radar are missing in their sequence.",
        "recorded from 2023-11-14 22:13:20",
    ] {
        assert!(text.contains(words), "{words} is not in {text}");
    }
}

#[test]
fn a_crossed_limit_and_its_length_are_told() {
    let far = 50.0 / 60.0 * std::f64::consts::PI / 180.0;
    let records: Vec<(&str, Record)> =
        (0..2000).map(|n| (SOLUTION, solution(n, if (500..1200).contains(&n) { far } else { 0.0 }))).collect();
    let text = page(&records, Some(Ending { end_of_run: true, dropped: 0, lost: 0 }));
    let row = "<td>deformation x</td><td class=\"number\">0:07</td><td class=\"number\">0:14</td><td class=\"number\">7.00</td><td class=\"number\">50.0</td>";
    assert!(text.contains(row) && text.contains("One alarm was raised."), "{text}");
    assert!(text.contains("NIS over the last minute") && text.contains("no message of it is missing"));
    assert!(
        text.contains("<td class=\"number\">120\u{a0}µs</td>") || text.contains("<td class=\"number\">120 µs</td>"),
        "{text}"
    );
}

#[test]
fn nonsense_harms_nothing() {
    let wild = [f64::NAN, f64::INFINITY, -1e300];
    let broken = |sequence, time_ns| Solution {
        header: header(sequence, time_ns),
        phi: wild,
        range: wild,
        deck: [f64::NAN, 0.0, 1e300, 0.0],
        deck_sigma: wild,
        delay: f64::NAN,
        delay_sigma: f64::INFINITY,
        nis: f64::INFINITY,
        valid: 1,
        flags: Flags::all(),
        ..Solution::default()
    };
    let set =
        FlexureParams { header: header(3, i64::MIN), mu: wild, b: [0.0; 3], sigma: wild, ..FlexureParams::default() };
    let mut records = vec![
        ("main/attitude", Record::Attitude(MainAttitude { q: [0.0; 4], ..MainAttitude::default() })),
        ("area/radar/parameters", Record::Parameters(set)),
        ("area/radar/adoption", Record::Adoption(Adoption { late: 1, ..Adoption::default() })),
        ("area/radar/truth", Record::Truth(Truth { header: header(1, 5), q: [f64::NAN; 4], ..Truth::default() })),
        ("health/unknown", Record::Health(Health { stage: 99, state: 99, taken: u64::MAX, ..Health::default() })),
        ("health/unknown", Record::Health(Health { stage: 99, pid: 1, taken: u64::MAX, ..Health::default() })),
        ("somewhere/else", solution(9, 1.0)),
        ("area/radar/pair", Record::Solution(Solution::default())),
    ];
    for (sequence, time_ns) in [(1, 0), (0, i64::MIN), (2, i64::MAX), (u64::MAX, 5), (3, -5)] {
        records.push((SOLUTION, Record::Solution(broken(sequence, time_ns))));
    }
    page(&records, Some(Ending { end_of_run: false, dropped: u64::MAX, lost: 1 }));
}

#[test]
fn what_is_no_recording_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("no.mcap");
    fs::write(&file, "no recording").unwrap();
    for path in [file.as_path(), Path::new("/nowhere/at.all")] {
        let error = report::run(path, Some(&folder.path().join("page.html"))).unwrap_err();
        assert!(error.is_unusable(), "{error}");
    }
    assert!(!folder.path().join("page.html").exists());
}

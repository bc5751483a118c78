//! Telegrams of real processes, read back by a parser that is not ours and by published offsets.
#![allow(clippy::unwrap_used)]

mod common;

use common::launch::{Ended, Launch, of_stage, one_at_a_time, send};
use common::receiver::{Binary, Receiver, SerialLine};
use common::{Place, demo};
use libc::{SIGCONT, SIGKILL, SIGSTOP};
use nmea::{ParseResult, SentenceType, parse_nmea_sentence, parse_str};
use std::collections::BTreeMap;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

const MS: i64 = 1_000_000;

fn output(to: &str, sentences: &str, rest: &str) -> String {
    format!("[[output]]\narea = \"radar\"\nto = {{ {to} }}\nsentences = [{sentences}]\n{rest}\n")
}

fn udp(receiver: &Receiver, sentences: &str, rest: &str) -> String {
    output(&format!("kind = \"udp\", address = \"127.0.0.1:{}\"", receiver.port), sentences, rest)
}

fn serial(device: &Path, sentences: &str, rest: &str) -> String {
    output(&format!("kind = \"serial\", device = \"{}\", baud = 921600", device.display()), sentences, rest)
}

fn assert_increasing(telegrams: &[Binary]) {
    for pair in telegrams.windows(2) {
        assert!(pair[0].utc_ns < pair[1].utc_ns, "{pair:?}");
    }
}

/// Row of the solution file: in order `t_s`, the columns.
fn rows(ended: &Ended) -> Vec<Vec<String>> {
    let file = ended.solutions("radar");
    file.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// The solution behind each telegram, by its stamp in milliseconds of UTC: the first valid telegram is that of the fourth valid row,
/// since a rate takes four, and the others follow at the distance of their data times.
fn behind<'a>(telegrams: &[Binary], rows: &'a [Vec<String>]) -> BTreeMap<i64, &'a Vec<String>> {
    let time_ns = |row: &[String]| (row[0].parse::<f64>().unwrap() * 1e9).round() as i64;
    let first = rows.iter().filter(|row| row[1] == "1").nth(3).unwrap();
    let begin_ns = telegrams.iter().find(|telegram| telegram.is_valid()).unwrap().utc_ns - time_ns(first);
    // the host's clock is steered while the test runs
    rows.iter().map(|row| ((begin_ns + time_ns(row) + 5 * MS) / (10 * MS), row)).collect()
}

fn slot(utc_ns: i64) -> i64 {
    (utc_ns + 5 * MS) / (10 * MS)
}

#[test]
fn telegrams_tell_the_solutions_at_their_rates() {
    // silence_ms: a host that is loaded must not make its data look old
    let _alone = one_at_a_time();
    let place = Place::new();
    let (binary, text) = (Receiver::start(), Receiver::start());
    let mut full = SerialLine::new();
    let outputs = [
        udp(&binary, "\"KMB\"", "rate_hz = 100\nsilence_ms = 10000"),
        udp(&text, "\"HDT\", \"ROT\", \"PASHR\", \"XDR\"", "rate_hz = 10\ndecimals = 3\nsilence_ms = 10000"),
        serial(&full.device, "\"PASHR\", \"XDR\"", "rate_hz = 100\nsilence_ms = 10000"),
    ];
    let zeroed = demo(11, 1.0).replacen("name = \"radar\"\n", "name = \"radar\"\nzero_deg = [0.1, -0.25, 1.5]\n", 1);
    let configuration = place.write("outputs.toml", &(zeroed + &outputs.concat()));
    let ended = Launch::start(&place, "live", &configuration, Some("12s")).end();
    let report = ended.well();
    let rows = rows(&ended);

    let telegrams: Vec<Binary> = binary.end().iter().map(|bytes| Binary::read(bytes)).collect();
    assert_increasing(&telegrams);
    // one a solution, and the last word
    assert_eq!(telegrams.len(), rows.len() + 1);
    assert!(!telegrams[rows.len()].is_valid(), "the last word is that nothing is valid");
    let solutions = behind(&telegrams, &rows);
    let valid = telegrams.iter().filter(|telegram| telegram.is_valid());
    let mut told = 0;
    for telegram in valid {
        let row = solutions[&slot(telegram.utc_ns)];
        assert_eq!(row[1], "1");
        // `Attitude` goes through radians, the file through degrees
        for (angle, column) in telegram.angles.iter().zip([17, 18, 19]) {
            let off = f64::from(*angle) - row[column].parse::<f64>().unwrap();
            assert!(off.abs() < 2e-5, "{telegram:?} beside {row:?}");
        }
        told += 1;
    }
    assert_eq!(told + 3, rows.iter().filter(|row| row[1] == "1").count());
    assert!(told > 400, "only {told} valid telegrams");

    let datagrams = text.end();
    assert_eq!(datagrams.len(), rows.len().div_ceil(10) + 1);
    let mut valid = 0;
    for (k, datagram) in datagrams.iter().enumerate().take(datagrams.len() - 1) {
        valid += u32::from(assert_tells(datagram, telegrams[10 * k], &solutions));
    }
    assert!(valid > 40, "only {valid} valid sentences");

    assert_eq!(report["outputs"][0]["sent"], telegrams.len());
    assert_eq!(report["outputs"][1]["sent"], datagrams.len());
    for output in [0, 1] {
        assert_eq!(report["outputs"][output]["zeroed"], report["outputs"][output]["sent"]);
        assert_eq!(
            (&report["outputs"][output]["unsendable"], &report["outputs"][output]["withheld"]),
            (&0.into(), &0.into())
        );
    }
    // nobody has read the serial line: it took whole telegrams until it was full, and held up nobody
    let (sent, unsendable) = (&report["outputs"][2]["sent"], &report["outputs"][2]["unsendable"]);
    assert_eq!(sent.as_u64().unwrap() + unsendable.as_u64().unwrap(), telegrams.len() as u64);
    assert!(unsendable.as_u64().unwrap() > 100, "{report:#}");
    let read = full.read();
    let (whole, begun) = read.rsplit_once("\r\n").unwrap();
    assert!(begun.is_empty() || begun.starts_with('$'), "{begun}");
    for line in whole.lines() {
        assert!(line.starts_with("$PASHR,") || parse_nmea_sentence(line).is_ok(), "{line}");
    }
}

/// One datagram with sentences beside the binary telegram of the same instant; gives whether it is valid.
fn assert_tells(datagram: &[u8], binary: Binary, solutions: &BTreeMap<i64, &Vec<String>>) -> bool {
    let text = std::str::from_utf8(datagram).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let [hdt, rot, pashr, deformation, range, zero] = lines[..] else { panic!("{text}") };
    // that one is in force is told while nothing is valid too
    assert_eq!(parse_nmea_sentence(zero).unwrap().data, "A,0.10000,D,ZERX,A,-0.25000,D,ZERY,A,1.50000,D,ZERZ");
    let Ok(ParseResult::HDT(heading)) = parse_str(hdt) else { panic!("{hdt}") };
    assert_eq!(heading.heading.is_some(), binary.is_valid(), "{text}");
    let turn = parse_nmea_sentence(rot).unwrap();
    assert_eq!((turn.message_id, turn.data.ends_with(",A")), (SentenceType::ROT, binary.is_valid()));
    let Some(heading) = heading.heading else { return false };
    assert!((heading - binary.angles[2]).abs() < 1e-3);
    let fields: Vec<&str> = pashr.split([',', '*']).collect();
    let of_day = binary.utc_ns.rem_euclid(86_400_000 * MS) / MS;
    let clock = [of_day / 3_600_000, of_day / 60_000 % 60, of_day / 1000 % 60];
    assert_eq!(fields[1], format!("{:02}{:02}{:02}.{:03}", clock[0], clock[1], clock[2], of_day % 1000));
    for (field, angle) in [(4, binary.angles[0]), (5, binary.angles[1])] {
        assert!((fields[field].parse::<f32>().unwrap() - angle).abs() < 1e-3, "{text}");
    }
    let row = solutions[&slot(binary.utc_ns)];
    for (line, column) in [(deformation, 2), (range, 22)] {
        let sentence = parse_nmea_sentence(line).unwrap();
        assert_eq!(sentence.message_id, SentenceType::XDR);
        for (axis, transducer) in sentence.data.split(',').collect::<Vec<_>>().chunks(4).enumerate() {
            let told = transducer[1].parse::<f64>().unwrap();
            let arcsec = row[column + axis].parse::<f64>().unwrap();
            assert!((told - arcsec / 3600.0).abs() <= 0.51e-5, "{line} beside {row:?}");
        }
    }
    true
}

/// What has come since the telegram number `from`, once there are `count` that please.
fn since(
    launch: &mut Launch,
    receiver: &Receiver,
    from: usize,
    count: usize,
    what: &str,
    pleases: fn(&Binary) -> bool,
) {
    launch.eventually(what, |_| {
        let telegrams = receiver.binary();
        (telegrams[from..].iter().filter(|telegram| pleases(telegram)).count() >= count).then_some(())
    });
}

#[test]
fn silence_is_told_and_a_killed_stage_goes_on() {
    let _alone = one_at_a_time();
    let place = Place::new();
    let receiver = Receiver::start();
    let outputs = udp(&receiver, "\"KMB\"", "rate_hz = 50\nsilence_ms = 500\nextrapolate_ms = 10");
    let configuration = place.write("outputs.toml", &(demo(12, 1.0) + &outputs));
    let mut launch = Launch::start(&place, "live", &configuration, None);
    since(&mut launch, &receiver, 0, 20, "valid telegrams", Binary::is_valid);

    let estimate = launch.stage("estimate", None);
    send(estimate, SIGSTOP);
    // what was under way may still come
    sleep(Duration::from_millis(100));
    let from = receiver.binary().len();
    since(&mut launch, &receiver, from, 20, "telegrams of silence", |telegram| !telegram.is_valid());
    let silent = receiver.binary().split_off(from);
    let mut told = silent.iter().skip_while(|telegram| telegram.is_valid());
    assert!(told.all(|telegram| !telegram.is_valid()), "an old value was told: {silent:?}");
    let from = receiver.binary().len();
    send(estimate, SIGCONT);
    since(&mut launch, &receiver, from, 20, "valid telegrams after the silence", Binary::is_valid);

    // the counts are told once a second, and what was not told dies with the process
    sleep(Duration::from_millis(1500));
    let first = launch.stage("output", None);
    send(first, SIGKILL);
    launch.stage("output", Some(first));
    let from = receiver.binary().len();
    since(&mut launch, &receiver, from, 20, "valid telegrams of the next stage", Binary::is_valid);
    launch.signal(libc::SIGINT);
    let ended = launch.end();
    let report = ended.well();
    assert_eq!(of_stage(report, "output", "restarts"), 1);
    assert_eq!(of_stage(report, "estimate", "restarts"), 0);
    let telegrams: Vec<Binary> = receiver.end().iter().map(|bytes| Binary::read(bytes)).collect();
    assert_increasing(&telegrams);
    assert!(telegrams.iter().filter(|t| t.is_valid()).all(|t| t.status >> 17 & 0b11 == 0b11), "carried forward");
    let output = &report["outputs"][0];
    assert!(output["withheld"].as_u64().unwrap() > 0, "the solutions of the stop were too old: {output:#}");
    assert!(output["extrapolated"].as_u64().unwrap() > 0);
}

#[test]
fn a_device_that_is_not_there_is_named() {
    let _alone = one_at_a_time();
    let place = Place::new();
    let outputs = serial(&place.path("nowhere"), "\"HDT\"", "");
    let configuration = place.write("outputs.toml", &(demo(13, 1.0) + &outputs));
    let ended = Launch::start(&place, "live", &configuration, Some("5s")).end();
    assert_eq!(ended.status.code(), Some(2), "{}", ended.errors);
    for word in ["output[0].to", "nowhere", "No such file"] {
        assert!(ended.errors.contains(word), "no {word} in: {}", ended.errors);
    }
    ended.assert_nothing_left();
}

//! The demonstration through wires: emulated devices that speak their own protocols, real processes that read them.
//!
//! Counts are asserted, and that what comes out is near the truth; how near the times come is measured where no other process can be in
//! the way, in the crate `wire`.
#![allow(clippy::unwrap_used)]

mod common;

use common::launch::{Launch, of_stage, one_at_a_time, send};
use common::receiver::{Binary, Receiver};
use common::{Place, quick, shipped};
use estimation::Estimator;
use estimation::synchronise::Synchroniser;
use frames::{Main, Nav, Rot, Sub, Vec3, unit};
use libc::{SIGINT, SIGKILL};
use messages::Solution;
use pipeline::configuration::Configuration;
use pipeline::lane;
use pipeline::source::{Batch, Source};
use serde_json::Value;
use std::fs;
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{SystemTime, UNIX_EPOCH};

/// A program of its own that speaks as the units would; dropped, it is killed.
struct Emulator(Child);

impl Emulator {
    fn start(place: &Place, configuration: &Path, more: &[&str]) -> Self {
        let mut command: Command = place.deckflex();
        command.arg("simulate").arg("--wire").arg(configuration).args(more);
        Self(command.stdin(Stdio::null()).stdout(Stdio::null()).spawn().unwrap())
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // both fail only where it has ended
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A port that nobody has at present.
fn free_port() -> u16 {
    UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// The shipped configuration on wires of the test's own, with windows short enough for it and `keys` added to both sources.
fn wires(place: &Place, keys: [&str; 2]) -> String {
    let terminal = place.path("radar");
    let text = shipped("wires.toml")
        .replace("127.0.0.1:5001\"", &format!("127.0.0.1:{}\"{}", free_port(), keys[0]))
        .replace("/tmp/deckflex_radar\"", &format!("{}\"{}", terminal.display(), keys[1]));
    quick(&text)
}

/// Column `name` of the rows of a CSV text.
fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let index = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(index).unwrap().parse().unwrap_or(f64::NAN)).collect()
}

fn rotations(text: &str) -> Vec<Rot<Main, Sub>> {
    let [w, x, y, z] = ["q_w", "q_x", "q_y", "q_z"].map(|name| column(text, name));
    (0..w.len()).map(|k| Rot::from_wxyz([w[k], x[k], y[k], z[k]])).collect()
}

/// Of each solution the time since the nearest true instant (s) and the error of the deformation (rad).
fn errors(solutions: &str, truth: &str) -> Vec<(f64, f64)> {
    let (times, true_times) = (column(solutions, "t_s"), column(truth, "t_s"));
    let (found, truths) = (rotations(solutions), rotations(truth));
    let nearest = |t: f64| {
        let after = true_times.partition_point(|s| *s < t).clamp(1, true_times.len() - 1);
        if true_times[after] - t < t - true_times[after - 1] { after } else { after - 1 }
    };
    let error = |(t, q): (&f64, &Rot<Main, Sub>)| {
        let k = nearest(*t);
        (t - true_times[k], (*q * truths[k].inverse()).angle())
    };
    times.iter().zip(&found).map(error).collect()
}

#[test]
fn the_demonstration_runs_through_bytes() {
    let place = Place::new();
    let (raw, truth) = (place.path("main.raw"), place.path("truth"));
    let kept = format!(", raw = \"{}\"", raw.display());
    let receiver = Receiver::start();
    let to = format!("to = {{ kind = \"udp\", address = \"127.0.0.1:{}\" }}", receiver.port);
    let output = format!("\n[[output]]\narea = \"radar\"\n{to}\nsentences = [\"KMB\"]\nsilence_ms = 10000\n");
    let configuration = place.write("wires.toml", &(wires(&place, [&kept, ""]) + &output));
    let _alone = one_at_a_time();
    let truth_and_utc = ["--truth", truth.to_str().unwrap(), "--utc-ahead", "1h"];
    let emulator = Emulator::start(&place, &configuration, &truth_and_utc);
    let ended = Launch::start(&place, "out", &configuration, Some("11s")).end();
    let report = ended.well().clone();
    send(emulator.0.id(), SIGINT);
    let mut emulator = emulator;
    assert!(emulator.0.wait().unwrap().success());
    assert!(report["pairs"].as_u64().unwrap() > 500, "{report}");
    assert_eq!((of_stage(&report, "acquire", "overflow"), of_stage(&report, "synchronise", "lost")), (0, 0));
    let lines = report["lines"].as_array().unwrap();
    assert_eq!(lines.len(), 2);
    for line in lines {
        assert!(line["frames"].as_u64().unwrap() > 800, "{line}");
        assert_eq!([&line["damaged"], &line["restarts"], &line["invalid"]], [0, 0, 0], "{line}");
    }
    let solutions = ended.solutions("radar");
    let truth = fs::read_to_string(truth.join("truth_radar.csv")).unwrap();
    let errors = errors(&solutions, &truth);
    let valid: Vec<f64> =
        errors.iter().zip(column(&solutions, "valid")).filter(|(_, valid)| *valid == 1.0).map(|(e, _)| e.1).collect();
    let late = errors.iter().filter(|(late, _)| late.abs() > 3e-3).count();
    assert!(late * 10 < errors.len(), "{late} of {} times are off by more than 3 ms", errors.len());
    let last = valid.last().expect("some solutions are valid") / unit::ARCMIN;
    assert!(valid.len() > 100 && last < 12.0, "{} valid, {last} arcmin", valid.len());
    assert_told_by_the_ins(&report["outputs"][0], &receiver.binary());
    again_from_its_bytes(&place, &configuration, &raw);
}

/// The INS's clock is an hour ahead of the host's, and telegrams follow it as soon as it has told UTC.
fn assert_told_by_the_ins(report: &Value, telegrams: &[Binary]) {
    assert_eq!(report["utc"], "INS", "{report}");
    let age_ms = report["utc_age_ms"].as_f64().unwrap();
    assert!((0.0..5000.0).contains(&age_ms) && report["utc_error_ms"].is_null(), "{report}");
    assert!(telegrams.windows(2).all(|pair| pair[0].utc_ns < pair[1].utc_ns));
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs_f64();
    let ahead = |telegram: &Binary| telegram.utc_ns as f64 * 1e-9 - now;
    let last = ahead(telegrams.last().unwrap());
    assert!((3500.0..3601.0).contains(&last), "{last} s ahead of the host");
}

/// The kept bytes take the place of the main unit's port, with an emulator for the other unit.
fn again_from_its_bytes(place: &Place, configuration: &Path, raw: &Path) {
    let contents = fs::read(raw).unwrap();
    let pieces = wire::raw::pieces(&contents).unwrap().count();
    assert!(pieces > 800, "{pieces} pieces");
    let text = fs::read_to_string(configuration).unwrap();
    let from_file = text
        .lines()
        .map(|line| match line.contains("\"stdbin\"") {
            true => format!("source = {{ kind = \"stdbin\", file = \"{}\" }}", raw.display()),
            false => line.to_owned(),
        })
        .collect::<Vec<String>>()
        .join("\n");
    let replayed = place.write("replayed.toml", &from_file);
    let _emulator = Emulator::start(place, configuration, &[]);
    let ended = Launch::start(place, "again", &replayed, Some("5s")).end();
    let report = ended.well();
    assert!(report["pairs"].as_u64().unwrap() > 100, "{report}");
}

#[test]
fn a_stream_of_another_device_is_refused_in_words() {
    let place = Place::new();
    let right = wires(&place, ["", ""]);
    let configuration = place.write("wires.toml", &right);
    let wrong = place.write("wrong.toml", &right.replace("kind = \"stdbin\"", "kind = \"kvh\""));
    let _alone = one_at_a_time();
    let _emulator = Emulator::start(&place, &configuration, &[]);
    let ended = Launch::start(&place, "out", &wrong, Some("30s")).end();
    assert_eq!(ended.status.code(), Some(2), "{}", ended.errors);
    let words = "the configuration says \"kvh\", but the stream looks like iXblue STDBIN (\"stdbin\")";
    assert!(ended.errors.contains(words) && ended.errors.contains("main, udp 127.0.0.1:"), "{}", ended.errors);
    ended.assert_nothing_left();
}

#[test]
fn a_killed_acquire_goes_on_with_the_same_numbers() {
    let place = Place::new();
    let configuration = place.write("wires.toml", &wires(&place, ["", ""]));
    let _alone = one_at_a_time();
    let _emulator = Emulator::start(&place, &configuration, &[]);
    let mut launch = Launch::start(&place, "out", &configuration, Some("9s"));
    launch.eventually("solutions", |launch| launch.written("radar"));
    let pid = launch.stage("acquire", None);
    send(pid, SIGKILL);
    let ended = launch.end();
    let report = ended.well();
    assert_eq!(of_stage(report, "acquire", "restarts"), 1);
    let times = column(&ended.solutions("radar"), "t_s");
    assert!(times.windows(2).all(|pair| pair[1] > pair[0]), "time goes on");
    let hole = times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    assert!(hole > 0.5, "the clock filter settles anew, {hole} s");
}

/// The log names the units, how long they were silent, and that their clocks are others when they are back.
#[test]
fn units_that_fall_silent_and_come_back_are_told_by_the_log() {
    let place = Place::new();
    let configuration = place.write("wires.toml", &wires(&place, ["", ""]));
    let _alone = one_at_a_time();
    let emulator = Emulator::start(&place, &configuration, &[]);
    let mut launch = Launch::start(&place, "out", &configuration, None);
    launch.eventually("solutions", |launch| launch.written("radar"));
    let both = |words: &str, launch: &Launch| {
        let errors = launch.errors();
        ["unit=main", "unit=radar"]
            .iter()
            .all(|unit| errors.lines().any(|line| line.contains(words) && line.contains(unit)))
            .then_some(())
    };
    drop(emulator);
    launch.eventually("word of the silence", |launch| both("nothing comes on the wire any more", launch));
    let _emulator = Emulator::start(&place, &configuration, &[]);
    launch.eventually("word of their return", |launch| both("the device's clock has started anew", launch));
    launch.signal(SIGINT);
    let ended = launch.end();
    ended.well();
    assert_eq!(ended.not_logged(), "");
    for unit in ["unit=main", "unit=radar"] {
        let silent =
            ended.logged("WARN", "acquire", &["nothing comes on the wire any more", unit, "port=", "silent_s="]);
        let back = ended.logged("INFO", "acquire", &["the wire speaks again", unit]);
        let known = ended.logged("INFO", "acquire", &["the device's clock is known", unit, "skew_ppm=", "jitter_us="]);
        assert!((silent.len(), back.len()) == (1, 1) && !known.is_empty(), "{unit}: {}", ended.errors);
    }
    let closed = ended.logged("WARN", "acquire", &["the port is closed", "unit=radar", "reason="]);
    assert!(!closed.is_empty(), "{}", ended.errors);
}

/// All solutions of a configuration, with the main INS's heading reset by 90 degrees 15 s before the end where that is asked for.
fn solutions(configuration: &Configuration, reset: bool) -> Vec<Solution> {
    let mut source = Source::open(configuration, 0).unwrap();
    let mut synchroniser: Synchroniser = lane::synchroniser(configuration, 0);
    let mut estimator: Box<dyn Estimator> = lane::estimator(configuration, 0);
    let turn = Rot::<Nav, Nav>::exp(Vec3::new(0.0, 0.0, 90.0 * unit::DEGREE));
    let mut batch = Batch::default();
    let mut all = Vec::new();
    while source.next(&mut batch) {
        let mut attitude = batch.attitude.unwrap();
        if reset && attitude.header.time_ns > 25_000_000_000 {
            attitude.q = (turn * Rot::<Nav, Main>::from_wxyz(attitude.q)).quaternion();
        }
        synchroniser.attitude(&attitude);
        synchroniser.main(&batch.main);
        batch.sub.iter().for_each(|sample| synchroniser.sub(sample));
        all.extend(std::iter::from_fn(|| synchroniser.pair()).map(|pair| estimator.step(&pair)));
    }
    all
}

#[test]
fn a_heading_reset_of_the_main_ins_steps_the_deck_only() {
    for matching in ["so3", "deck", "rodrigues"] {
        let place = Place::new();
        let estimator = format!("[area.estimator]\nmatching = \"{matching}\"\n\n[area.identifier]");
        let text = shipped("demo.toml").replacen("[area.identifier]", &estimator, 1);
        let path: PathBuf = place.write("demo.toml", &text);
        let configuration = common::configuration(&path, 40.0);
        let (plain, reset) = (solutions(&configuration, false), solutions(&configuration, true));
        assert!(plain.iter().filter(|solution| solution.is_valid()).count() > 1000);
        let mut stepped = 0;
        for (a, b) in plain.iter().zip(&reset) {
            let deck = Rot::<Nav, Sub>::from_wxyz(a.deck).inverse() * Rot::<Nav, Sub>::from_wxyz(b.deck);
            if a.deck != b.deck {
                assert!((deck.angle() - 90.0 * unit::DEGREE).abs() < 1e-9, "{matching}");
                stepped += 1;
            }
            assert_eq!(*a, Solution { deck: a.deck, deck_sigma: a.deck_sigma, ..*b }, "{matching}");
        }
        assert!(stepped > 1000, "{matching}: {stepped}");
    }
}

//! Recordings of real processes: a replay gives the same bits, whatever the recorder met.
#![allow(clippy::unwrap_used)]

mod common;

use common::launch::{Ended, Launch, of_stage, one_at_a_time, send};
use common::page::{assert_sound, number, section};
use common::{Place, configuration, demo, first_difference, offline, recorded};
use libc::SIGKILL;
use pipeline::configuration::Configuration;
use recording::{About, Ending, Event, Reader, Record};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::thread::sleep;
use std::time::Duration;

/// A configuration with its run recorded, and the folder of the recording.
fn recording(place: &Place, name: &str, text: &str, keys: &str) -> (PathBuf, PathBuf) {
    let folder = place.path(&format!("{name}_recording"));
    let text = format!("{text}\n[record]\nfolder = \"{}\"\n{keys}\n", folder.display());
    (place.write(&format!("{name}.toml"), &text), folder)
}

/// The files of a recording in order.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// All that a file holds, and why it is cut if it is.
struct Contents {
    about: About,
    records: Vec<(String, Record)>,
    ending: Option<Ending>,
    cut: Option<String>,
}

fn read(path: &Path) -> Contents {
    let bytes = fs::read(path).unwrap();
    let mut reader = Reader::new(bytes.as_slice());
    let (mut about, mut records, mut ending) = (None, Vec::new(), None);
    for event in reader.by_ref() {
        match event {
            Event::Metadata(m) => {
                about = about.or(About::from_metadata(&m.name, &m.metadata));
                ending = ending.or(Ending::from_metadata(&m.name, &m.metadata));
            }
            Event::Message(message) => {
                records.push((message.channel.topic.clone(), message.record().unwrap().unwrap()));
            }
        }
    }
    Contents { about: about.unwrap(), records, ending, cut: reader.cut().map(str::to_owned) }
}

impl Contents {
    fn of<'a>(&'a self, topic: &'a str) -> impl DoubleEndedIterator<Item = &'a Record> {
        self.records.iter().filter(move |(of, _)| of == topic).map(|(_, record)| record)
    }
}

fn deckflex(place: &Place, arguments: &[&str]) -> Output {
    place.deckflex().args(arguments).output().unwrap()
}

fn told(output: &Output) -> String {
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    said
}

/// Goes through a recorded run again; gives its first area's solutions and what was said.
fn again(place: &Place, file: &Path, name: &str) -> (String, String) {
    let out = place.path(name);
    let said = told(&deckflex(place, &["process", file.to_str().unwrap(), "--out", out.to_str().unwrap()]));
    (fs::read_to_string(out.join("solution_radar.csv")).unwrap(), said)
}

/// With a lead of one sample parameters come late, at samples that only the recording knows.
#[test]
fn a_recorded_run_gives_its_solutions_again() {
    let place = Place::new();
    let output =
        "[[output]]\narea = \"radar\"\nto = { kind = \"udp\", address = \"127.0.0.1:9\" }\nsentences = [\"HDT\"]";
    let (path, folder) = recording(&place, "late", &demo(31, 0.01), &format!("flush_s = 0.2\n{output}"));
    let live = {
        let _alone = one_at_a_time();
        Launch::start(&place, "live", &path, Some("9s")).end()
    };
    let report = live.well();
    assert!(report["late_parameters"].as_u64().unwrap() > 0, "nothing came late");
    assert_ne!(live.solutions("radar"), offline(&configuration(&path, 9.0)).0, "a new run would have given the same");
    let [file] = &files(&folder)[..] else { panic!("one file") };
    let outputs = |path: &Path| Configuration::read(path).unwrap().outputs.len();
    assert_eq!((outputs(&path), outputs(file)), (1, 0), "what was recorded is not told to the radar again");
    let (solutions, said) = again(&place, file, "again");
    assert_eq!(first_difference(&live.solutions("radar"), &solutions), None, "{said}");
    assert!(said.contains("901 solutions are the recorded ones to the bit\n"), "{said}");
    assert_eq!(
        fs::read_to_string(live.out.join("summary.json")).unwrap(),
        fs::read_to_string(place.path("again/summary.json")).unwrap()
    );
    assert_whole(&read(file), &live, &path);
    exports(&place, file, &live);
    reports(&place, file, &live);
}

/// Everything that the run made stands in the recording.
fn assert_whole(contents: &Contents, live: &Ended, configuration: &Path) {
    let Contents { about, ending, cut, .. } = contents;
    assert_eq!((cut, *ending), (&None, Some(Ending { end_of_run: true, dropped: 0, lost: 0 })));
    assert_eq!(about.configuration, fs::read_to_string(configuration).unwrap());
    assert!(about.from_the_start && about.part == 0 && about.version == env!("CARGO_PKG_VERSION"));
    for topic in
        ["main/imu", "main/attitude", "area/radar/imu", "area/radar/truth", "area/radar/pair", "area/radar/solution"]
    {
        let numbers = contents.of(topic).map(|record| record.header().sequence);
        assert!(numbers.eq(0..901), "{topic}");
    }
    let report = live.report.as_ref().unwrap();
    assert_eq!(contents.of("area/radar/parameters").count() as u64, report["parameters"].as_u64().unwrap());
    let late = contents.of("area/radar/adoption").filter(|a| matches!(a, Record::Adoption(a) if a.late == 1)).count();
    assert_eq!(late as u64, report["late_parameters"].as_u64().unwrap());
    assert!(contents.of("health/estimate/radar").count() >= 5);
    assert!(of_stage(report, "record", "in") >= contents.records.len() as u64);
    assert_eq!(of_stage(report, "record", "overflow"), 0);
}

/// The exported solutions are those of the run, and the exported samples can be the source of another one.
fn exports(place: &Place, file: &Path, live: &Ended) {
    let out = place.path("csv");
    let said = told(&deckflex(place, &["export", file.to_str().unwrap(), "--out", out.to_str().unwrap()]));
    assert!(said.contains("901 rows") && said.contains("area_radar_pair.csv"), "{said}");
    let solutions = fs::read_to_string(out.join("solution_radar.csv")).unwrap();
    assert_eq!(first_difference(&live.solutions("radar"), &solutions), None);
    let truth = fs::read_to_string(out.join("area_radar_truth.csv")).unwrap();
    assert!(truth.starts_with("run_id,sequence,time_ns,") && truth.lines().count() == 902);
    let text = common::shipped("replay.toml").replace("recordings/", "csv/");
    let path = place.write("exported.toml", &text);
    let exported = offline(&configuration(&path, 2.0)).0;
    assert_eq!(exported.lines().count(), 202);
}

/// The page about the run holds the figures of its solutions and needs nothing but itself; one about half of the recording says that it is half.
fn reports(place: &Place, file: &Path, live: &Ended) {
    let report = |file: &Path, name: &str| {
        let out = place.path(name);
        let said = told(&deckflex(place, &["report", file.to_str().unwrap(), "--out", out.to_str().unwrap()]));
        (fs::read_to_string(out).unwrap(), said)
    };
    let (page, said) = report(file, "report.html");
    assert!(said.contains("area radar: 901 solutions"), "{said}");
    assert_sound(&page);
    assert!(page.contains("no message of it is missing"));
    let statistics = section(&page, "Statistics per 10 minutes");
    let solutions = live.solutions("radar");
    let mut rows = solutions.lines().map(|row| row.split(',').collect::<Vec<&str>>());
    let head = rows.next().unwrap();
    let valid: Vec<Vec<&str>> = rows.filter(|row| row[1] == "1").collect();
    for axis in ["x", "y", "z"] {
        let column = head.iter().position(|name| *name == format!("phi_{axis}_arcsec")).unwrap();
        let values: Vec<f64> = valid.iter().map(|row| row[column].parse::<f64>().unwrap() / 60.0).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        let figures = [mean, square.sqrt(), least, most].map(|value| number(value, 3));
        let cells = figures.map(|figure| format!("<td class=\"number\">{figure}</td>")).concat();
        assert!(statistics.contains(&cells), "{axis}: {cells} is not in {statistics}");
    }
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(live.out.join("summary.json")).unwrap()).unwrap();
    let rmse = summary["areas"][0]["rmse_arcsec"][2].as_f64().unwrap() / 60.0;
    assert!(section(&page, "Error against the truth").contains(&number(rmse, 3)));
    assert!(section(&page, "Latency").contains("end to end"));
    assert!(section(&page, "Alarms").contains("sets no limits"));
    assert!(section(&page, "Spectrum").contains("Too short") && section(&page, "Delay").contains("No delay"));
    let half = place.folder("half").join("run_000.mcap");
    let bytes = fs::read(file).unwrap();
    fs::write(&half, &bytes[..bytes.len() / 2]).unwrap();
    let (page, _) = report(&half, "half.html");
    assert_sound(&page);
    assert!(page.contains("The recording is cut at the end of run_000.mcap") && !page.contains("no message of it"));
}

/// The recorded run as the source of another configuration, and of another launch.
#[test]
fn a_recorded_run_is_a_source() {
    let place = Place::new();
    let first = recorded(&place, 32, 16.0, 4.0, 4.0);
    let (path, folder) = recording(&place, "first", &fs::read_to_string(first).unwrap(), "rotate_mb = 1");
    let live = {
        let _alone = one_at_a_time();
        Launch::start(&place, "first", &path, None).end()
    };
    assert_eq!(live.well()["late_parameters"], 0, "the host is too slow for a comparison");
    let parts = files(&folder);
    assert!(parts.len() > 1, "it was to be more than one file");
    for (number, part) in parts.iter().enumerate() {
        let Contents { about, ending, cut, .. } = read(part);
        let end_of_run = number + 1 == parts.len();
        assert_eq!((about.part, cut, ending), (number as u64, None, Some(Ending { end_of_run, dropped: 0, lost: 0 })));
    }
    let (solutions, said) = again(&place, &parts[0], "again");
    assert_eq!(first_difference(&live.solutions("radar"), &solutions), None, "{said}");
    // a later file is a run of its own, and says so
    let (_, said) = again(&place, &parts[1], "later");
    assert!(said.contains("begins in the middle of the run"), "{said}");
    let kind = format!("source = {{ kind = \"mcap\", path = \"{}\" }}", parts[0].display());
    let text: Vec<String> = fs::read_to_string(place.path("replay.toml"))
        .unwrap()
        .lines()
        .map(|line| if line.starts_with("source") { kind.clone() } else { line.to_owned() })
        .collect();
    let path = place.write("mcap.toml", &text.join("\n"));
    let _alone = one_at_a_time();
    let same = common::comparison::same_live_and_offline(&place, &path, "16s");
    assert_eq!(
        first_difference(&live.solutions("radar"), &same.solutions("radar")),
        None,
        "the same samples, the same run"
    );
}

#[test]
fn a_killed_recorder_loses_a_second_at_most() {
    let place = Place::new();
    let replayed = recorded(&place, 33, 20.0, 4.0, 4.0);
    let (path, folder) = recording(&place, "killed", &fs::read_to_string(replayed).unwrap(), "");
    let alone = one_at_a_time();
    let mut launch = Launch::start(&place, "live", &path, None);
    launch.eventually("a valid row", |launch| {
        launch.written("radar").filter(|row| row.lines().nth(1).is_some_and(|row| row.split(',').nth(1) == Some("1")))
    });
    let pid = launch.stage("record", None);
    let killed_ns = runtime::monotonic_ns();
    send(pid, SIGKILL);
    launch.stage("record", Some(pid));
    let live = launch.end();
    drop(alone);
    let report = live.well();
    for stage in ["replay", "synchronise", "estimate", "identify"] {
        assert_eq!((of_stage(report, stage, "restarts"), of_stage(report, stage, "lost")), (0, 0), "{stage}");
    }
    assert_eq!(of_stage(report, "record", "restarts"), 1);
    let all = live.solutions("radar");
    let [first, second] = &files(&folder)[..] else { panic!("two files") };
    let (cut, rest) = (read(first), read(second));
    assert!(cut.cut.is_some() && cut.ending.is_none());
    assert!(rest.cut.is_none() && rest.about.part == 1 && !rest.about.from_the_start);
    for topic in ["main/imu", "area/radar/imu", "area/radar/pair", "area/radar/solution"] {
        let last = cut.of(topic).next_back().unwrap();
        let lost_s = (killed_ns - last.published_ns().unwrap()) as f64 * 1e-9;
        assert!(lost_s < 1.0, "{lost_s} s of {topic} are lost");
        let numbers: Vec<u64> = cut.of(topic).map(|record| record.header().sequence).collect();
        assert!(numbers.iter().copied().eq(0..numbers.len() as u64), "{topic} has a hole before the cut");
        eprintln!("{lost_s:.3} s of {topic} lost");
    }
    let begin = |part: &Contents, topic| part.of(topic).next().unwrap().header().sequence;
    let hole = begin(&rest, "main/imu") - cut.of("main/imu").count() as u64;
    eprintln!("the next recorder came after {hole} samples");
    // the cut file alone, and what recover makes of it: the same bits up to the cut
    let alone = place.folder("alone").join("run_000.mcap");
    fs::copy(first, &alone).unwrap();
    let file = alone.to_str().unwrap();
    let said = told(&deckflex(&place, &["recover", file]));
    assert!(said.contains("area/radar/solution") && said.contains("cut: the end is missing"), "{said}");
    let whole = alone.with_extension("recovered.mcap");
    assert_eq!(read(&whole).cut, None);
    assert_eq!(read(&whole).records, cut.records);
    for (name, file) in [("cut", &alone), ("recovered", &whole)] {
        let (solutions, said) = again(&place, file, name);
        let rows = solutions.lines().count();
        let beginning: Vec<&str> = all.lines().take(rows).collect();
        assert_eq!(first_difference(&(beginning.join("\n") + "\n"), &solutions), None, "{said}");
        let recorded = cut.of("area/radar/solution").count();
        assert!(rows > recorded && !said.contains("differ") && !said.contains("lack"), "{rows} rows: {said}");
        assert!(said.contains("does not go to the run's end"), "{said}");
    }
    assert_eq!(deckflex(&place, &["recover", file]).status.code(), Some(2), "what exists is not overwritten");
}

/// Lets a process write so many bytes into a file, or as many as it likes.
fn limit_files(pid: u32, bytes: Option<u64>) {
    let mut limit = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: the process is a living child's child, and the limits live through the calls.
    unsafe {
        assert_eq!(libc::prlimit(pid as i32, libc::RLIMIT_FSIZE, std::ptr::null(), &mut limit), 0);
        limit.rlim_cur = bytes.unwrap_or(limit.rlim_max);
        assert_eq!(libc::prlimit(pid as i32, libc::RLIMIT_FSIZE, &limit, std::ptr::null_mut()), 0);
    }
}

/// A limit of the file's size stands for a disk that is full for a while, since every user may set one.
#[test]
fn a_full_disk_does_not_touch_the_estimator() {
    let place = Place::new();
    let replayed = recorded(&place, 34, 20.0, 4.0, 4.0);
    let (path, folder) = recording(&place, "full", &fs::read_to_string(replayed).unwrap(), "flush_s = 0.1");
    let _alone = one_at_a_time();
    let mut launch = Launch::start(&place, "live", &path, None);
    let pid = launch.stage("record", None);
    launch.eventually("a recording", |_| files_if_any(&folder).first().filter(|file| size(file) > 200_000).cloned());
    limit_files(pid, Some(20_000));
    sleep(Duration::from_secs(2));
    limit_files(pid, None);
    let live = launch.end();
    let report = live.well();
    for stage in ["replay", "synchronise", "estimate", "identify", "record"] {
        assert_eq!((of_stage(report, stage, "restarts"), of_stage(report, stage, "lost")), (0, 0), "{stage}");
    }
    assert_eq!(report["late_parameters"], 0, "the host is too slow for a comparison");
    assert_eq!(first_difference(&live.solutions("radar"), &offline(&configuration(&path, 20.0)).0), None);
    let dropped = of_stage(report, "record", "overflow");
    assert!(dropped > 500, "{dropped} dropped");
    assert_eq!(of_stage(report, "record", "in"), of_stage(report, "record", "out") + dropped);
    let refused = live.logged("ERROR", "record", &["cannot write", "path=", "reason="]);
    let again = live.logged("INFO", "record", &["recording goes on", "path=", &format!("dropped={dropped}")]);
    assert!(refused.len() == 1 && again.len() == 1, "{}", live.errors);
    let parts: Vec<Contents> = files(&folder).iter().map(|file| read(file)).collect();
    let (last, cut) = parts.split_last().unwrap();
    assert!(!cut.is_empty() && cut.iter().all(|part| part.ending.is_none() && !part.records.is_empty()));
    assert_eq!(last.ending, Some(Ending { end_of_run: true, dropped, lost: 0 }));
    let there: usize = parts.iter().map(|part| part.records.len()).sum();
    assert_eq!(there as u64, of_stage(report, "record", "out"), "what is counted as written is there");
}

fn files_if_any(folder: &Path) -> Vec<PathBuf> {
    if folder.exists() { files(folder) } else { Vec::new() }
}

fn size(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |data| data.len())
}

#[test]
fn what_cannot_be_recorded_or_read_is_told_before_anything_starts() {
    let place = Place::new();
    let text = demo(35, 1.0);
    for (keys, words) in [
        ("folder = \"r\"\nflush_s = 3", &["record.flush_s = 3", "0.05 to 1"][..]),
        ("folder = \"r\"\nrotate_mb = 100\nbudget_mb = 150", &["record.budget_mb = 150", "twice"]),
        ("folder = \"r\"\ntopics = [\"everything\"]", &["record.topics", "samples"]),
        ("flush_s = 0.5", &["record.folder", "missing"]),
        ("folder = \"demo.toml/r\"", &["cannot record in", "demo.toml/r"]),
    ] {
        let path = place.write("demo.toml", &format!("{text}\n[record]\n{keys}\n"));
        let output = deckflex(&place, &["launch", path.to_str().unwrap(), "--duration", "1s"]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{keys}: {said}");
        words.iter().for_each(|word| assert!(said.contains(word), "{keys}: {said}"));
    }
    let file = place.write("no.mcap", "no recording at all");
    let file = file.to_str().unwrap();
    let out = place.path("out");
    let out = out.to_str().unwrap();
    for arguments in [
        &["recover", file][..],
        &["export", file, "--out", out],
        &["process", file, "--out", out],
        &["report", file, "--out", out],
    ] {
        let output = deckflex(&place, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(
            !place.path("out").exists() && files(&place.path("")).iter().all(|file| !file.ends_with("recovered.mcap"))
        );
    }
    let text = common::shipped("replay.toml")
        .replace("csv", "mcap")
        .replace("recordings/main.mcap", "no.mcap")
        .replace("recordings/radar.mcap", "no.mcap");
    let path = place.write("mcap.toml", &text);
    let output = deckflex(&place, &["check", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("not a recorded run"));
    assert_eq!(fs::read_dir(place.path("run")).unwrap().count(), 0, "something was started");
    assert!(Configuration::read(&path).is_ok(), "only what the file holds is wrong");
}

//! A configuration run as processes and by the offline loop.

use super::launch::{Ended, Launch};
use super::{Place, first_difference};
use pipeline::configuration::Configuration;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Runs a configuration as processes and by `process`; gives the folder of the latter's files too.
pub fn both_ways(place: &Place, configuration: &Path, duration: &str) -> (Ended, PathBuf) {
    let live = Launch::start(place, "live", configuration, Some(duration)).end();
    let out = place.path("offline");
    let mut process = place.deckflex();
    process.arg("process").arg(configuration).args(["--duration", duration]).arg("--out").arg(&out);
    assert!(process.stdout(Stdio::null()).status().unwrap().success());
    (live, out)
}

/// Asserts that both ways lead to the same files.
pub fn same_live_and_offline(place: &Place, configuration: &Path, duration: &str) -> Ended {
    let (live, offline) = both_ways(place, configuration, duration);
    let shown = configuration.display();
    let report = live.well();
    assert_eq!(report["late_parameters"], 0, "{shown}: the host is too slow for a comparison");
    let areas = Configuration::read(configuration).unwrap().areas;
    let read = |out: &Path, name: &str| fs::read_to_string(out.join(name)).unwrap();
    for area in &areas {
        let name = format!("solution_{}.csv", area.name);
        assert_eq!(first_difference(&read(&live.out, &name), &read(&offline, &name)), None, "{shown}: {name}");
    }
    assert_eq!(read(&live.out, "summary.json"), read(&offline, "summary.json"), "{shown}");
    live
}

//! The key of the spike test.
#![allow(clippy::unwrap_used)]

use pipeline::configuration::Configuration;
use std::path::Path;

fn parse(key: &str) -> Result<Configuration, String> {
    let demo = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/demo.toml")).unwrap();
    Configuration::parse(Path::new("demo.toml"), &format!("{key}\n{demo}")).map_err(|error| error.to_string())
}

#[test]
fn the_test_is_off_unless_it_is_switched_on() {
    assert_eq!(parse("").unwrap().spike_threshold, 0.0);
    assert_eq!(parse("spike_threshold = 0").unwrap().spike_threshold, 0.0);
    assert_eq!(parse("spike_threshold = 8.5").unwrap().spike_threshold, 8.5);
}

#[test]
fn a_threshold_within_ordinary_noise_is_refused() {
    for (value, words) in [("1", "within 3 to 1000"), ("-4", "within 0 to 1000"), ("nan", "within 0 to 1000")] {
        let said = parse(&format!("spike_threshold = {value}")).unwrap_err();
        assert!(said.contains("spike_threshold") && said.contains(words), "{said}");
    }
}

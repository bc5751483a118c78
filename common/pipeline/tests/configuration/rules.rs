//! Keys that belong together, and what a contradiction is told.

use crate::text::{Folder, MINIMAL, good, message, message_with, read};
use estimation::identify::Method;
use pipeline::configuration::{Configuration, IdentifierMethod, Source};
use std::path::Path;

#[test]
fn sources_are_of_one_kind_and_recordings_exist() {
    let folder = Folder::new();
    folder.write("a.csv", "t_s");
    let main = MINIMAL.replacen("{ kind = \"simulator\" }", "{ kind = \"csv\", path = \"a.csv\" }", 1);
    let path = folder.write("ship.toml", &main);
    let told = |path: &Path| Configuration::read(path).expect_err("a fault").to_string();
    assert_eq!(
        told(&path),
        format!(
            "{}:7: area[0].source.kind = \"simulator\": all sources must be of one kind, and [main] has \"csv\"",
            path.display()
        )
    );
    let both = main.replacen("{ kind = \"simulator\" }", "{ kind = \"csv\", path = \"b.csv\" }", 1);
    let path = folder.write("ship.toml", &both);
    let missing = folder.0.path().join("b.csv");
    assert_eq!(
        told(&path),
        format!(
            "{}:7: area[0].source.path = \"b.csv\": cannot read {}: No such file or directory (os error 2)",
            path.display(),
            missing.display()
        )
    );
    folder.write("b.csv", "t_s");
    let c = Configuration::read(&path).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(c.areas[0].source, Source::Csv(missing));
    let pace = folder.write("pace.toml", &format!("{both}[replay]\npace = 20\n"));
    assert_eq!(Configuration::read(&pace).unwrap_or_else(|e| panic!("{e}")).replay_pace, 20.0);
    let path = folder.write("ship.toml", &format!("{both}[simulation]\n"));
    assert!(told(&path).ends_with(":9: simulation: has no effect with sources of kind \"csv\""));
    assert_eq!(
        message_with("[replay]\npace = 2"),
        "ship.toml:9: replay: has no effect with sources of kind \"simulator\""
    );
    assert_eq!(
        message("{ kind = \"simulator\" }", "{ kind = \"csv\" }"),
        "ship.toml:3: main.source: a source of kind \"csv\" needs the key `path`"
    );
}

#[test]
fn the_fixed_model_and_its_figures_belong_together() {
    assert_eq!(
        message_with("[area.identifier]\nmethod = \"fixed\""),
        "ship.toml:9: area[0].identifier: method \"fixed\" needs the key `flexure`"
    );
    let flexure = "flexure = { mu_per_s = [1, 1, 1], b_rad_per_s = [1, 1, 1], sigma_arcsec = [1, 1, 1] }";
    assert_eq!(
        message_with(&format!("[area.identifier]\n{flexure}")),
        "ship.toml:9: area[0].identifier: the key `flexure` goes with method \"fixed\" only, not with \"whittle\""
    );
    assert_eq!(
        message_with("[area.simulation]\nflexure = { tau_s = [1, 1, 1], mu_per_s = [1, 1, 1] }"),
        "ship.toml:10: area[0].simulation.flexure: needs either `tau_s`, or `mu_per_s` and `b_rad_per_s`, or `mu_per_s` and `frequency_hz`"
    );
}

#[test]
fn rules_of_several_keys_are_all_reported() {
    let text = MINIMAL.replace("rate_hz = 100", "rate_hz = 10\nsilence_s = 0.1")
        + "[area.estimator]\nfilter_hz = 50\n[area.identifier]\nminimum_s = 10\nwindow_s = 8\n"
        + MINIMAL.split_once("[[area]]").map_or("", |(_, tail)| tail).replace("\nname", "[[area]]\nname").as_str();
    let told = read(&text).expect_err("four faults");
    let lines: Vec<&str> = told.lines().collect();
    assert_eq!(
        lines,
        [
            "ship.toml:16: area[1].name = \"radar\": area[0] has the same name",
            "ship.toml:2: silence_s = 0.1: must be at least two samples, 0.2 s at 10 Hz",
            "ship.toml:11: area[0].estimator.filter_hz = 50: must not be above rate_hz = 10",
            "ship.toml:13: area[0].identifier.minimum_s = 10: 10 s is longer than window_s = 8",
        ]
    );
}

#[test]
fn every_method_of_identification_can_be_told() {
    for method in Method::ALL {
        for safety in [true, false] {
            let told = format!("[area.identifier]\nmethod = \"{}\"\nsafety = {safety}\n", method.name());
            let identifier = good(&format!("{MINIMAL}{told}")).areas[0].identifier;
            assert_eq!((identifier.method, identifier.safety), (IdentifierMethod::Learnt(method), safety));
        }
    }
    let wrong = message_with("[area.identifier]\nmethod = \"tufts_kumaresen\"");
    assert!(wrong.contains("method") && wrong.contains("tufts_kumaresen"), "{wrong}");
    assert!(wrong.ends_with("did you mean `tufts_kumaresan`?"), "{wrong}");
    let flexure = "flexure = { mu_per_s = [1, 1, 1], b_rad_per_s = [1, 1, 1], sigma_arcsec = [1, 1, 1] }";
    let wrong = message_with(&format!("[area.identifier]\nmethod = \"whittle\"\n{flexure}"));
    assert!(wrong.contains("not with \"whittle\""), "{wrong}");
}

#[test]
fn delay_and_network_go_with_the_matchings_that_have_them() {
    let faults = [
        ("matching = \"quaternion\"\ndelay = {}", "delay", "no delay"),
        ("matching = \"quaternion_delay\"\nnetwork = {}", "network", "no network"),
    ];
    for (estimator, key, others) in faults {
        let message = message_with(&format!("[area.estimator]\n{estimator}"));
        assert!(message.contains(&format!("estimator.{key}")) && message.ends_with(others), "{message}");
    }
    let message = message_with("[area.estimator]\nmatching = \"quaternion\"\nregistration = \"delay\"");
    assert!(message.ends_with("which goes with \"motion\", \"installation\""), "{message}");
}

//! What a mistake in the text or in a single key is told.

use crate::text::{FULL, Folder, MINIMAL, message, message_with, read};
use pipeline::configuration::Configuration;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::path::Path;

#[test]
fn a_misspelt_key_is_told_with_its_neighbour() {
    assert_eq!(
        message_with("[area.identifier]\nwindw_s = 3"),
        "ship.toml:10: unknown key `windw_s` in [area.identifier]; did you mean `window_s`?"
    );
    assert_eq!(
        message("bias_deg_per_h = 0.01", "bias_deg_h = 0.01"),
        "ship.toml:8: unknown key `bias_deg_h` in [area.gyro]; did you mean `bias_deg_per_h`?"
    );
    assert_eq!(
        message("rate_hz", "rate_khz"),
        "ship.toml:1: unknown key `rate_khz` at the top level; did you mean `rate_hz`?"
    );
    assert_eq!(
        message_with("[run]\nwind = 3"),
        "ship.toml:10: unknown key `wind` in [run]; known here: seed, duration_s, scheduling"
    );
    assert_eq!(
        message_with("[area.simulation.wire]\nlos = 0.1"),
        "ship.toml:10: unknown key `los` in [area.simulation.wire]; did you mean `loss`?"
    );
}

#[test]
fn a_value_out_of_its_range_is_told_with_the_range() {
    assert_eq!(message("rate_hz = 100", "rate_hz = -5"), "ship.toml:1: rate_hz = -5: must be within 10 to 1000");
    assert_eq!(message("rate_hz = 100", "rate_hz = nan"), "ship.toml:1: rate_hz = nan: must be within 10 to 1000");
    assert_eq!(
        message("bias_deg_per_h = 0.01", "bias_deg_per_h = inf"),
        "ship.toml:8: area[0].gyro.bias_deg_per_h = inf: must be within 0 to 100000"
    );
    assert_eq!(
        message("arw_deg_per_sqrt_h = 0.001", "arw_deg_per_sqrt_h = -1e-3"),
        "ship.toml:4: main.gyro.arw_deg_per_sqrt_h = -1e-3: must be within 0 to 1000"
    );
    assert_eq!(
        message_with("[area.identifier]\ndictionary = 101"),
        "ship.toml:10: area[0].identifier.dictionary = 101: must be within 1 to 100"
    );
    assert_eq!(
        message_with("lever_arm_m = [0, 0, 5000]"),
        "ship.toml:9: area[0].lever_arm_m: must be within -1000 to 1000"
    );
    assert_eq!(message_with("zero_deg = [0, 5.1, 0]"), "ship.toml:9: area[0].zero_deg: must be within -5 to 5");
    assert_eq!(
        message("\"radar\"", "\"Radar mast\""),
        "ship.toml:6: area[0].name = \"Radar mast\": must be 1 to 32 characters of a-z, 0-9, _ and -"
    );
}

#[test]
fn a_wrong_type_is_told_with_the_right_one() {
    assert_eq!(message("rate_hz = 100", "rate_hz = \"100\""), "ship.toml:1: rate_hz = \"100\": expected a number");
    assert_eq!(message_with("lever_arm_m = [1, 2]"), "ship.toml:9: area[0].lever_arm_m: expected 3 elements, found 2");
    assert_eq!(
        message_with("lever_arm_m = [1, 2, 3, 4]"),
        "ship.toml:9: area[0].lever_arm_m: expected 3 elements, found 4"
    );
    assert_eq!(
        message_with("lever_arm_m = [1, true, 2]"),
        "ship.toml:9: area[0].lever_arm_m[1] = true: expected a number"
    );
    assert_eq!(message_with("lever_arm_m = 3"), "ship.toml:9: area[0].lever_arm_m = 3: expected an array");
    assert_eq!(message_with("zero_deg = 1"), "ship.toml:9: area[0].zero_deg = 1: expected an array");
    assert_eq!(message_with("accel = [1, 2]"), "ship.toml:9: area[0].accel: expected a table");
    assert_eq!(message("\"radar\"", "5"), "ship.toml:6: area[0].name = 5: expected a string");
    assert_eq!(message("[[area]]", "[area]"), "ship.toml:5: area: expected an array");
    assert_eq!(message_with("[run]\nseed = -1"), "ship.toml:10: run.seed = -1: expected a whole number, 0 or more");
    assert_eq!(
        message_with("[run]\nscheduling = \"fif\""),
        "ship.toml:10: run.scheduling = \"fif\": must be one of \"auto\", \"normal\", \"fifo\"; did you mean `fifo`?"
    );
    assert_eq!(message_with("[run]\nscheduling = 1"), "ship.toml:10: run.scheduling = 1: expected a string");
    assert_eq!(
        message_with("[area.identifier]\nmethod = 1"),
        "ship.toml:10: area[0].identifier.method = 1: expected a string"
    );
    assert_eq!(
        message_with("[area.identifier]\nmethod = \"svr\""),
        "ship.toml:10: area[0].identifier.method = \"svr\": must be one of \"rvm\", \"rvm_gaussian\", \"support_vector\", \
         \"whale\", \"particle_swarm\", \"tufts_kumaresan\", \"tufts_kumaresan_printed\", \"yule_walker\", \
         \"matrix_pencil\", \"whittle\", \"fixed\""
    );
    assert_eq!(
        message_with("[area.estimator]\nmatching = \"ekf\""),
        "ship.toml:10: area[0].estimator.matching = \"ekf\": must be one of \"so3\", \"deck\", \"rate\", \
         \"residual_attitude\", \"small_angle\", \"exact_attitude\", \"rodrigues\", \"rodrigues_printed\", \"attitude_dcm\", \"quaternion\", \
         \"quaternion_delay\", \"quaternion_walk\", \"quaternion_network\", \"residual_attitude_network\", \
         \"residual_attitude_network_printed\", \"small_angle_network\", \"small_angle_network_printed\""
    );
    assert_eq!(
        message_with("[simulation]\nvelocity_follows_heading = 1"),
        "ship.toml:10: simulation.velocity_follows_heading = 1: expected true or false"
    );
}

#[test]
fn a_missing_key_is_told() {
    assert_eq!(message("rate_hz = 100", ""), "ship.toml: the required key `rate_hz` is missing");
    assert_eq!(message("name = \"radar\"", ""), "ship.toml:5: the required key `area[0].name` is missing");
    assert_eq!(
        message("arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.01", "bias_deg_per_h = 0.01"),
        "ship.toml:8: the required key `area[0].gyro.arw_deg_per_sqrt_h` is missing"
    );
    let (head, _) = MINIMAL.split_once("[[area]]").expect("an area");
    assert_eq!(read(head).expect_err("no area"), "ship.toml: area: at least one [[area]] is required");
    let (_, tail) =
        MINIMAL.split_once("gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.003 }\n").expect("main");
    let no_main = format!("rate_hz = 100\n{tail}");
    assert_eq!(read(&no_main).expect_err("no main"), "ship.toml: the required key `main` is missing");
    assert_eq!(read("").expect_err("nothing"), "ship.toml: the required key `rate_hz` is missing");
    let implicit = MINIMAL.replace("[main]\nsource = { kind = \"simulator\" }\ngyro =", "main.gyro =");
    assert!(read(&implicit).expect_err("no source").contains("required key `main.source` is missing"));
}

#[test]
fn text_that_is_not_toml_is_told_with_its_line() {
    let text = message("[[area]]", "[[area]");
    assert!(text.starts_with("ship.toml:5: not valid TOML: "), "{text}");
    let text = message("name = \"radar\"", "name = \"radar\"\nname = \"mast\"");
    assert!(text.starts_with("ship.toml:7: not valid TOML: duplicate key"), "{text}");
}

#[test]
fn a_file_that_is_not_there_is_told_with_the_reason() {
    let error = Configuration::read(Path::new("/nowhere/ship.toml")).expect_err("nowhere").to_string();
    assert_eq!(error, "/nowhere/ship.toml: cannot read the configuration: No such file or directory (os error 2)");
}

#[test]
fn mountings_that_are_no_rotation_are_refused() {
    assert_eq!(
        message_with("mounting = { matrix = [[1, 0, 0], [0, 1, 0.1], [0, 0, 1]] }"),
        "ship.toml:9: area[0].mounting: the matrix must be orthogonal within 0.001, but C C^T differs from the unit matrix by 0.1000"
    );
    assert_eq!(
        message_with("mounting = { matrix = [[0, 1, 0], [1, 0, 0], [0, 0, 1]] }"),
        "ship.toml:9: area[0].mounting: the matrix must have the determinant +1, but it has -1: it mirrors an axis"
    );
    assert_eq!(
        message_with("mounting = {}"),
        "ship.toml:9: area[0].mounting: needs either `rotation_vector_deg` or `matrix`"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn damaged_text_is_read_or_refused_but_never_a_panic(
        at in 0..FULL.len(), length in 0..40usize, patch in prop::collection::vec(any::<u8>(), 0..20)
    ) {
        let mut text = FULL.as_bytes().to_vec();
        text.splice(at..(at + length).min(FULL.len()), patch);
        let folder = Folder::new();
        let path = folder.0.path().join("ship.toml");
        std::fs::write(&path, &text).expect("a writable folder");
        if let Err(error) = Configuration::read(&path) {
            prop_assert!(error.to_string().starts_with(&path.display().to_string()));
        }
    }
}

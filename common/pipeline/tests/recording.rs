//! Recordings: both kinds of columns, uneven times, damaged files.

use frames::unit::{DEGREE, seconds};
use frames::{Main, Nav, Rot, Vec3};
use messages::{ClockDomain, Flags};
use pipeline::recording::{Counts, Recording, RecordingError, Row, head};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

const MEANS: &str = "t_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2\n";
const NOMINAL_NS: i64 = 10_000_000;

fn file(content: impl AsRef<[u8]>) -> NamedTempFile {
    let mut file = NamedTempFile::new().expect("a temporary file");
    file.write_all(content.as_ref()).expect("a writable file");
    file
}

fn open(file: &NamedTempFile, unit: u32) -> Recording {
    Recording::open(file.path(), unit, 77, NOMINAL_NS).unwrap_or_else(|error| panic!("{error}"))
}

fn rows(content: impl AsRef<[u8]>) -> (Vec<Row>, Counts) {
    let file = file(content);
    let mut recording = open(&file, 1);
    let rows: Vec<Row> = recording.by_ref().collect();
    assert!(recording.error().is_none());
    (rows, recording.counts())
}

/// Means of a unit at rest, with the given times as they stand.
fn at_times(times: &[&str]) -> String {
    times.iter().fold(MEANS.to_string(), |text, t| format!("{text}{t},0.1,-0.2,0.3,0,0,9.8\n"))
}

#[test]
fn means_become_increments() {
    let (rows, counts) = rows(at_times(&["5.00", "5.01", "5.022"]));
    let samples: Vec<_> = rows.iter().map(|row| row.sample).collect();
    assert_eq!(samples.iter().map(|s| s.header.sequence).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(
        samples.iter().map(|s| s.header.time_ns).collect::<Vec<_>>(),
        [5_000_000_000, 5_010_000_000, 5_022_000_000]
    );
    assert_eq!(samples.iter().map(|s| s.interval_ns).collect::<Vec<_>>(), [NOMINAL_NS, NOMINAL_NS, 12_000_000]);
    for s in &samples {
        let interval = seconds(s.interval_ns);
        assert_eq!(s.dtheta, [0.1 * interval, -0.2 * interval, 0.3 * interval]);
        assert_eq!(s.dvel, [0.0, 0.0, 9.8 * interval]);
        assert_eq!((s.header.run_id, s.unit, s.flags), (77, 1, Flags::empty()));
        assert_eq!((s.header.clock_domain, s.header.end), (ClockDomain::Recorded as u32, 0));
    }
    assert_eq!(counts, Counts { rows: 3, ..Counts::default() });
    assert!(rows.iter().all(|row| row.attitude.is_none()));
}

#[test]
fn increments_stay_what_they_are_in_any_order_of_columns() {
    let text = "dvel_z_m_s, dvel_y_m_s,dvel_x_m_s,temperature,t_s,dtheta_y_rad,dtheta_x_rad,dtheta_z_rad\r\n\
                0.098,2e-3,1e-3,warm,1.0,-2e-5,1e-5, 3e-5\r\n0.098,2e-3,1e-3,,1.013,-2e-5,1e-5,3e-5\r\n";
    let (rows, counts) = rows(text);
    assert_eq!((rows.len(), counts.refused), (2, 0));
    for row in &rows {
        assert_eq!(row.sample.dtheta, [1e-5, -2e-5, 3e-5]);
        assert_eq!(row.sample.dvel, [1e-3, 2e-3, 0.098]);
    }
    assert_eq!(rows[1].sample.interval_ns, 13_000_000);
}

#[test]
fn accelerometers_may_be_absent() {
    let (rows, _) = rows("t_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s\n0,1,2,3\n");
    assert_eq!(rows[0].sample.dvel, [0.0; 3]);
    assert_eq!(rows[0].sample.dtheta, [0.01, 0.02, 0.03]);
}

const WITH_ATTITUDE: &str = "t_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,roll_deg,pitch_deg,heading_deg\n\
    0.01,0,0,0,2,-3,210\n0.02,0,0,0,,,\n0.03,0,0,0,nan,1,2\n0.04,0,0,0,x,1,2\n";

#[test]
fn the_main_unit_may_have_an_attitude() {
    let file = file(WITH_ATTITUDE);
    let mut recording = open(&file, 0);
    assert!(recording.has_attitude());
    let rows: Vec<Row> = recording.by_ref().collect();
    let attitude = rows[0].attitude.expect("an attitude");
    assert_eq!(attitude.header, rows[0].sample.header);
    assert_eq!(attitude.sigma, [0.0; 3]);
    let euler = Rot::<Nav, Main>::from_wxyz(attitude.q).euler();
    assert!((euler.roll - 2.0 * DEGREE).abs() < 1e-12 && (euler.pitch + 3.0 * DEGREE).abs() < 1e-12);
    assert!((euler.heading - 210.0 * DEGREE).abs() < 1e-12);
    assert!(rows[1].attitude.is_none() && rows[2].attitude.is_none());
    assert_eq!((rows.len(), recording.counts().refused), (3, 1));
    assert!(open(&file, 1).all(|row| row.attitude.is_none()));
    assert!(!open(&file, 1).has_attitude());
}

#[test]
fn missing_and_uneven_stamps_get_the_nominal_interval() {
    let (rows, counts) = rows(at_times(&["0", "0.01", "0.03", "0.045", "0.0601", "0.0691"]));
    let intervals: Vec<i64> = rows.iter().map(|row| row.sample.interval_ns).collect();
    assert_eq!(intervals, [NOMINAL_NS, NOMINAL_NS, NOMINAL_NS, 15_000_000, NOMINAL_NS, 9_000_000]);
    assert!(rows.iter().all(|row| row.sample.flags.is_empty()));
    assert_eq!(counts, Counts { rows: 6, ..Counts::default() });
}

#[test]
fn repeated_and_backward_times_are_passed_on() {
    let (rows, counts) = rows(at_times(&["1.00", "1.01", "1.01", "1.02", "0.50", "0.51"]));
    let seen: Vec<(i64, Flags)> = rows.iter().map(|row| (row.sample.interval_ns, row.sample.flags)).collect();
    let fine = (NOMINAL_NS, Flags::empty());
    assert_eq!(seen, [fine, fine, fine, fine, (NOMINAL_NS, Flags::TIME_BACK), fine]);
    assert_eq!(rows[4].sample.header.time_ns, 500_000_000);
    assert_eq!(counts, Counts { rows: 6, repeated: 1, back: 1, ..Counts::default() });
}

#[test]
fn damaged_rows_use_up_their_number_and_are_counted() {
    let mut text = at_times(&["0.00"]).into_bytes();
    text.extend_from_slice(b"0.01,0.1,-0.2\n");
    text.extend_from_slice(b"0.02,0.1,-0.2,0.3,0,0,9.8,7\n");
    text.extend_from_slice(b"0.03,\"0.1,-0.2,0.3,0,0,9.8\n");
    text.extend_from_slice(b"\xff\xfe\0garbage\n");
    text.extend_from_slice(b"nan,0.1,-0.2,0.3,0,0,9.8\n1e300,0.1,-0.2,0.3,0,0,9.8\n0.06,,-0.2,0.3,0,0,9.8\n");
    text.extend_from_slice(b"0.07,0.1,-0.2,0.3,0,0,9.8\n");
    let (rows, counts) = rows(text);
    assert_eq!(rows.iter().map(|row| row.sample.header.sequence).collect::<Vec<_>>(), [0, 8]);
    assert_eq!(counts, Counts { rows: 2, refused: 7, ..Counts::default() });
    assert_eq!(rows[1].sample.interval_ns, NOMINAL_NS);
}

#[test]
fn a_file_cut_anywhere_loses_no_whole_row_and_invents_none() {
    let whole = at_times(&["0.00", "0.01", "0.02", "0.03"]);
    let (all, _) = rows(&whole);
    let data = &whole[MEANS.len()..];
    for length in 0..=data.len() {
        let (some, counts) = rows(&whole[..MEANS.len() + length]);
        let lines = data[..length].matches('\n').count();
        assert_eq!(some, all[..lines], "cut after {length}");
        let cut = u64::from(length > 0 && !data[..length].ends_with('\n'));
        assert_eq!((counts.rows, counts.refused), (lines as u64, cut), "cut after {length}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_passed_on_with_a_flag() {
    let text = format!("{MEANS}0,nan,0,0,0,0,9.8\n0.01,0,0,0,0,-inf,9.8\n0.02,0,0,0,0,0,9.8\n");
    let (rows, counts) = rows(text);
    assert!(rows[0].sample.dtheta[0].is_nan() && rows[1].sample.dvel[1] == f64::NEG_INFINITY);
    let flags: Vec<Flags> = rows.iter().map(|row| row.sample.flags).collect();
    assert_eq!(flags, [Flags::NOT_FINITE, Flags::NOT_FINITE, Flags::empty()]);
    assert_eq!(counts, Counts { rows: 3, not_finite: 2, ..Counts::default() });
}

fn refusal(header: &str) -> String {
    let file = file(header);
    let error = Recording::open(file.path(), 0, 1, NOMINAL_NS).expect_err(header);
    error.to_string().replace(&format!("{}: ", file.path().display()), "")
}

#[test]
fn headers_that_are_not_recognised_tell_what_is_missing() {
    let start = "the header is not recognised: ";
    assert_eq!(refusal(""), format!("{start}the column t_s is missing"));
    assert_eq!(refusal("time,x\n1,2\n"), format!("{start}the column t_s is missing"));
    assert_eq!(
        refusal("t_s,x\n"),
        format!(
            "{start}the columns gyro_x_rad_s, gyro_y_rad_s, gyro_z_rad_s (or dtheta_x_rad, dtheta_y_rad, dtheta_z_rad) are missing"
        )
    );
    assert_eq!(
        refusal("t_s,gyro_x_rad_s,gyro_z_rad_s\n"),
        format!("{start}of gyro_x_rad_s, gyro_y_rad_s, gyro_z_rad_s it lacks gyro_y_rad_s")
    );
    let gyro = "t_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s";
    assert_eq!(
        refusal(&format!("{gyro},roll_deg\n")),
        format!("{start}of roll_deg, pitch_deg, heading_deg it lacks pitch_deg, heading_deg")
    );
    assert!(refusal(&format!("{gyro},dtheta_x_rad,dtheta_y_rad,dtheta_z_rad\n")).contains("one kind is wanted"));
    let error = Recording::open(Path::new("/nowhere/a.csv"), 0, 1, NOMINAL_NS).expect_err("nowhere").to_string();
    assert_eq!(error, "/nowhere/a.csv: cannot read the recording: No such file or directory (os error 2)");
}

/// A ship that rolls 10 degrees in 8 s and weighs `gravity`, at `rate` Hz; rates are multiplied by `scale`.
fn ship(header: &str, rate: f64, scale: f64, gravity: f64) -> NamedTempFile {
    let mut text = header.to_string();
    for i in 0..2000 {
        let t = f64::from(i) / rate;
        let w = scale * 10.0 * DEGREE * (std::f64::consts::TAU / 8.0) * (std::f64::consts::TAU / 8.0 * t).cos();
        text += &format!("{t:.9},{:.9},{w:.9},0,0,0,{gravity:.9}\n", 0.3 * w);
    }
    file(text)
}

const INCREMENTS: &str = "t_s,dtheta_x_rad,dtheta_y_rad,dtheta_z_rad,dvel_x_m_s,dvel_y_m_s,dvel_z_m_s\n";

#[test]
fn the_head_of_a_sound_recording_raises_no_suspicion() {
    for (header, scale) in [(MEANS, 1.0), (INCREMENTS, 0.01)] {
        let head = head(ship(header, 100.0, scale, 9.8 * scale).path(), 1000, 100.0).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(head.suspicions, Vec::<String>::new());
        assert_eq!((head.rows, head.refused, head.gaps, head.repeated, head.back), (1000, 0, 0, 0, 0));
        assert!((head.rate_hz - 100.0).abs() < 1e-6, "{}", head.rate_hz);
        assert!((head.accel_norm.expect("accelerometers") - 9.8).abs() < 1e-6);
        let rms = 10.0 * DEGREE * (std::f64::consts::TAU / 8.0) * (1.09_f64 / 2.0).sqrt();
        assert!((head.gyro_rms - rms).abs() < 0.05 * rms, "{}", head.gyro_rms);
    }
}

fn suspicions(file: &NamedTempFile) -> String {
    head(file.path(), 2000, 100.0).unwrap_or_else(|e| panic!("{e}")).suspicions.join("; ")
}

#[test]
fn wrong_units_of_measure_are_suspected() {
    let degrees = 1.0 / DEGREE;
    assert!(suspicions(&ship(MEANS, 100.0, degrees, 9.8)).contains("look like degrees"));
    assert!(suspicions(&ship(INCREMENTS, 100.0, 0.01 * degrees, 0.098)).contains("dtheta looks like degrees or rates"));
    assert!(suspicions(&ship(MEANS, 100.0, 1.0, 1.0)).contains("looks like g"));
    assert!(suspicions(&ship(MEANS, 100.0, 1.0, 32.17)).contains("ft/s^2"));
    assert!(suspicions(&ship(MEANS, 100.0, 1.0, 980.0)).contains("cm/s^2"));
    assert!(suspicions(&ship(MEANS, 100.0, 1.0, 0.098)).contains("accel looks like increments"));
    assert!(suspicions(&ship(INCREMENTS, 100.0, 1.0, 9.8)).contains("dvel looks like accelerations"));
    assert!(suspicions(&ship(MEANS, 100.0, 1.0, 5.0)).contains("gravity is about 9.8"));
    assert_eq!(suspicions(&ship(MEANS, 98.0, 1.0, 9.8)), "the rate is 98.0000 Hz, but rate_hz is 100");
    assert_eq!(suspicions(&ship(MEANS, 99.5, 1.0, 9.8)), "");
    assert_eq!(
        suspicions(&ship(MEANS, 0.1, 1.0, 9.8)),
        "the rate is 0.1000 Hz, but rate_hz is 100: t_s looks like milliseconds"
    );
}

#[test]
fn the_head_counts_gaps_and_refuses_a_file_without_rows() {
    let sound = at_times(&["0.00", "0.01", "0.02", "0.05", "0.06", "0.06", "0.03", "0.04"]);
    let head_of = |text: &str| head(file(text).path(), 100, 100.0);
    let h = head_of(&format!("{sound}garbage\n0.05,nan,0,0,0,0,9.8\n")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((h.rows, h.refused, h.gaps, h.repeated, h.back, h.not_finite), (9, 1, 1, 1, 1, 1));
    assert_eq!(h.span_s, [0.0, 0.06]);
    let empty = head_of(&format!("{MEANS}0.01,0.1")).expect_err("no rows");
    assert!(matches!(empty, RecordingError::Empty { refused: 1, .. }), "{empty}");
    let blind = head_of(&format!("{MEANS}0,nan,0,0,0,0,9.8\n0.01,nan,0,0,0,0,9.8\n")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(blind.suspicions, ["every row has a NaN or an infinity"]);
    let one = head_of(&format!("{INCREMENTS}1,1e-5,0,0,0,0,0.098\n")).unwrap_or_else(|e| panic!("{e}"));
    assert!(one.rate_hz.is_nan() && one.suspicions == ["there are not two different times"]);
}

fn data() -> PathBuf {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    std::env::var_os("DECKFLEX_DATA").map_or_else(beside, PathBuf::from)
}

#[test]
#[allow(clippy::print_stdout)]
fn real_recordings_are_read() {
    for k in 1..=3 {
        let path = data().join(format!("mimu4444/exp1_imu{k}.csv"));
        if !path.exists() {
            println!("skipped: no data");
            return;
        }
        let mut recording = Recording::open(&path, k, 1, 16_000_000).unwrap_or_else(|e| panic!("{e}"));
        let samples: Vec<_> = recording.by_ref().map(|row| row.sample).collect();
        assert_eq!(recording.counts(), Counts { rows: 37_439, ..Counts::default() });
        let length: i64 = samples[1..].iter().map(|s| s.interval_ns).sum();
        assert_eq!(length, samples[samples.len() - 1].header.time_ns - samples[0].header.time_ns);
        let mut force: Vec<f64> =
            samples[1..].iter().map(|s| Vec3::<Main>::from(s.dvel).norm() / seconds(s.interval_ns)).collect();
        force.sort_unstable_by(f64::total_cmp);
        assert!((force[force.len() / 2] - 9.8).abs() < 0.3, "{}", force[force.len() / 2]);
        let head = head(&path, 40_000, 62.5).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((head.suspicions.len(), head.gaps), (0, 0), "{:?}", head.suspicions);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: RngSeed::Fixed(2), ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_anywhere_are_counted_and_never_a_panic(
        at in 0..400usize, removed in 0..50usize, bytes in prop::collection::vec(any::<u8>(), 0..200)
    ) {
        let mut text = at_times(&["0.00", "0.01", "0.02", "0.03", "0.04", "0.05", "0.06", "0.07", "0.08", "0.09"]).into_bytes();
        let at = at.min(text.len());
        let end = (at + removed).min(text.len());
        text.splice(at..end, bytes);
        let file = file(&text);
        let _ = head(file.path(), 100, 100.0);
        if let Ok(mut recording) = Recording::open(file.path(), 0, 1, NOMINAL_NS) {
            let rows: Vec<Row> = recording.by_ref().collect();
            let counts = recording.counts();
            prop_assert_eq!(rows.len() as u64, counts.rows);
            prop_assert!(recording.error().is_none() && recording.next().is_none());
            prop_assert!(rows.windows(2).all(|pair| pair[0].sample.header.sequence < pair[1].sample.header.sequence));
            prop_assert!(rows.iter().all(|row| row.sample.interval_ns > 0 && 2 * row.sample.interval_ns <= 3 * NOMINAL_NS));
            if at >= MEANS.len() {
                let last = rows.last().map_or(0, |row| row.sample.header.sequence + 1);
                prop_assert!(last <= counts.rows + counts.refused);
            }
        }
    }
}

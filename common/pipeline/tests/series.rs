//! Recordings of a unit at rest as evenly spaced rates: holes, jitter, increments.

use pipeline::recording::{RecordingError, Series, series};
use std::io::Write;
use tempfile::NamedTempFile;

const MEANS: &str = "t_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2\n";
const INCREMENTS: &str = "dtheta_x_rad,dtheta_y_rad,dtheta_z_rad,t_s\n";

fn read(content: &str) -> Result<Series, RecordingError> {
    let mut file = NamedTempFile::new().expect("a temporary file");
    file.write_all(content.as_bytes()).expect("a writable file");
    series(file.path())
}

fn sound(content: &str) -> Series {
    read(content).unwrap_or_else(|error| panic!("{error}"))
}

/// Means that are their own number.
fn row(k: usize) -> String {
    format!("{},{k},0,0,0,0,9.8\n", k as f64 * 0.01)
}

#[test]
fn a_short_hole_is_bridged_and_a_long_one_breaks_the_series() {
    let rows: String = (0..100).filter(|k| !(10..13).contains(k) && !(50..80).contains(k)).map(row).collect();
    let series = sound(&(MEANS.to_owned() + &rows));
    assert_eq!(series.stretches, [0..50, 50..70]);
    assert_eq!((series.bridged, series.counts.rows), (3, 67));
    assert!((0..50).all(|k| (series.gyro[0][k] - k as f64).abs() < 1e-9), "{:?}", series.gyro[0]);
    assert_eq!(series.cut(&series.gyro[0])[1][0], 80.0);
    assert!((series.interval - 0.01).abs() < 1e-12);
    assert_eq!(series.accel.as_ref().map(|accel| accel[2].len()), Some(70));
    // its rates are above 35 rad/s
    assert!(series.suspicions.len() == 1 && series.suspicions[0].contains("degrees"), "{:?}", series.suspicions);
}

#[test]
fn rows_of_no_use_are_holes_and_counted() {
    let mut rows: Vec<String> = (0..60).map(row).collect();
    rows[20] = "0.2,NaN,0,0,0,0,9.8\n".to_owned();
    rows[30] = "0.3,thirty,0,0,0,0,9.8\n".to_owned();
    rows[40] = row(39);
    let series = sound(&(MEANS.to_owned() + &rows.concat()));
    let counts = series.counts;
    assert_eq!((counts.refused, counts.not_finite, counts.repeated, series.bridged), (1, 1, 1, 3));
    assert_eq!(series.stretches.len(), 1);
    assert_eq!(series.stretches[0], 0..60);
    assert!((0..60).all(|k| (series.gyro[0][k] - k as f64).abs() < 1e-9));
}

#[test]
fn a_time_that_goes_back_begins_anew() {
    let rows: String = (0..30).chain(10..40).map(row).collect();
    let series = sound(&(MEANS.to_owned() + &rows));
    assert_eq!((series.stretches.as_slice(), series.counts.back), ([0..30, 30..60].as_slice(), 1));
}

/// By the interval of its own stamps a tenth of an interval's jitter would be a tenth of the rate.
#[test]
fn jitter_of_the_stamps_does_not_become_noise_of_increments() {
    let rows: String =
        (0..200).map(|k| format!("0.002,0,0,{}\n", f64::from(k) * 0.01 + f64::from(k % 7) * 1e-3)).collect();
    let series = sound(&(INCREMENTS.to_owned() + &rows));
    assert!(series.accel.is_none() && series.stretches.len() == 1 && series.bridged == 0);
    let rates = &series.gyro[0];
    assert!(rates.iter().all(|rate| (rate - rates[0]).abs() < 1e-12 && (rate - 0.2).abs() < 1e-3), "{rates:?}");
}

#[test]
fn a_file_without_rows_is_refused() {
    assert!(matches!(read(MEANS), Err(RecordingError::Empty { .. })));
    assert!(matches!(read("a,b\n1,2\n"), Err(RecordingError::Header { .. })));
    let one = sound(&(MEANS.to_owned() + &row(3)));
    assert_eq!((one.stretches.len(), one.stretches[0].clone(), one.gyro[0].as_slice()), (1, 0..1, [3.0].as_slice()));
    let far = sound(&format!("{MEANS}-8e9,0,0,0,0,0,9.8\n8e9,0,0,0,0,0,9.8\n8e9,0,0,0,0,0,9.8\n"));
    assert!(far.interval > 0.0, "{}", far.interval);
}

//! Texts of configurations, and what reading them gives.

use pipeline::configuration::Configuration;
use std::path::PathBuf;

/// The required keys and no others: 8 lines.
pub const MINIMAL: &str = r#"rate_hz = 100
[main]
source = { kind = "simulator" }
gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.003 }
[[area]]
name = "radar"
source = { kind = "simulator" }
gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.01 }
"#;

/// Keys of every table.
pub const FULL: &str = r#"rate_hz = 62.5
silence_s = 1
settle_s = 5
[run]
seed = 9
duration_s = 60
scheduling = "fifo"
[main]
source = { kind = "simulator" }
gyro = { arw_deg_per_sqrt_h = 0.6, bias_deg_per_h = 3600, scale_ppm = 5, misalignment_arcsec = 10, stamp_jitter_us = 50, range_deg_per_s = 180 }
accel = { vrw_ug_per_sqrt_hz = 10, bias_ug = 50, scale_ppm = 2, misalignment_arcsec = 3, range_g = 8 }
mounting = { matrix = [[0, 1, 0], [1, 0, 0], [0, 0, -1]] }
[[area]]
name = "a-1_b"
source = { kind = "simulator" }
lever_arm_m = [1, -2.5, 3]
gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.01, stamp_jitter_us = 50 }
mounting = { rotation_vector_deg = [0, 0, 90] }
installation = { rotation_vector_deg = [1, 2, 3], sigma_deg = 0.5 }
[area.estimator]
matching = "so3"
filter_hz = 20
registration_s = 40
static_rate_noise_arcsec2_per_s3 = 2
[area.identifier]
method = "fixed"
window_s = 100
period_s = 5
lead_s = 2
minimum_s = 20
dictionary = 3
flexure = { mu_per_s = [0.1, 0.2, 0.3], b_rad_per_s = [0.4, 0.5, 0.6], sigma_arcsec = [60, 120, 180] }
[area.simulation]
installation_rotation_vector_arcmin = [60, 0, 0]
flexure = { mu_per_s = [1, 2, 3], b_rad_per_s = [4, 5, 6], sigma_arcmin = [1, 2, 3] }
dynamic_lever_arm = 0
wire = { delay_ms = 5, skew_ppm = 10, phase_ms = 3, rate_error_ppm = 20, loss = 1e-3, duplicate = 2e-3, swap = 3e-3, transit_ms = 4 }
gyro = { arw_deg_per_sqrt_h = 0.1, bias_deg_per_h = 1, stamp_jitter_us = 70 }
[simulation]
speed_knots = 10
latitude_deg = -30
course_deg = 90
velocity_follows_heading = true
heading = { amplitude_deg = 5 }
roll = { period_s = 12, phase_deg = 90 }
ins = { heading_arcsec = 30 }
accel = { bias_ug = 7 }
"#;

/// A folder that goes with its drop.
pub struct Folder(pub tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, text).expect("a writable folder");
        path
    }
}

/// The message names the file without its folder.
pub fn read(text: &str) -> Result<Configuration, String> {
    let folder = Folder::new();
    let path = folder.write("ship.toml", text);
    let prefix = format!("{}/", folder.0.path().display());
    Configuration::read(&path).map_err(|error| error.to_string().replace(&prefix, ""))
}

/// The minimal configuration with lines added to its area, from line 9.
pub fn read_with(lines: &str) -> Result<Configuration, String> {
    read(&format!("{MINIMAL}{lines}\n"))
}

pub fn good(text: &str) -> Configuration {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

/// The message of the minimal configuration with `from` replaced by `to`.
pub fn message(from: &str, to: &str) -> String {
    assert!(MINIMAL.contains(from), "{from}");
    read(&MINIMAL.replacen(from, to, 1)).expect_err(to)
}

/// The message of the minimal configuration with lines added.
pub fn message_with(lines: &str) -> String {
    read_with(lines).expect_err(lines)
}

/// Whether two figures are the same but for rounding.
pub fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-14 * b.abs()
}

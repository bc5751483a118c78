//! The file of marked events.

use messages::Solution;
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

const HEADER: &str = "utc_s,t_s,run_id,area\n";

/// Appends a line for now; `t_s` is the time of the area's newest solution.
pub fn mark(path: &Path, area: &str, last: &Solution) -> io::Result<()> {
    let mut file = OpenOptions::new().create(true).append(true).open(path)?;
    let is_new = file.metadata()?.len() == 0;
    let utc = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64());
    let t = frames::unit::seconds(last.header.time_ns);
    let heading = if is_new { HEADER } else { "" };
    // in one write, so that two monitors do not mix their lines
    file.write_all(format!("{heading}{utc:.3},{t},{},{area}\n", last.header.run_id).as_bytes())
}

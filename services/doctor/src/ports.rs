//! Serial ports: who may open them, and how long their converters hold bytes back.

use crate::{Finding, Host, process};

/// A converter should hand its bytes on after so many milliseconds.
const TIMER_MS: u32 = 1;

/// Whether this user may open the serial ports that there are.
pub(crate) fn serial(host: &Host) -> Vec<Finding> {
    let subject = "serial ports";
    let is_serial = |name: &String| ["ttyUSB", "ttyACM", "ttyAMA"].iter().any(|kind| name.starts_with(kind));
    let ports: Vec<String> = host.names("/dev").into_iter().filter(is_serial).collect();
    if ports.is_empty() {
        return vec![Finding::ok(subject, "none is plugged in (ttyUSB, ttyACM, ttyAMA)")];
    }
    let list = ports.join(", ");
    let dialout = host.read("/etc/group").and_then(|groups| {
        let line = groups.lines().find_map(|line| line.strip_prefix("dialout:").map(str::to_owned))?;
        line.split(':').nth(1)?.parse::<u32>().ok()
    });
    let member = dialout.is_some_and(|id| process::groups(host).contains(&id));
    vec![match member || process::is_root(host) {
        true => Finding::ok(subject, format!("{list}: this user may open them")),
        false => Finding::bad(
            subject,
            format!("{list}: this user is not in the group dialout, which owns them"),
            "sudo usermod -aG dialout $USER, and log in anew",
        ),
    }]
}

/// USB converters of FTDI's kind wait 16 ms for more bytes unless told otherwise.
pub(crate) fn latency_timers(host: &Host) -> Vec<Finding> {
    let folder = "/sys/bus/usb-serial/devices";
    let timer = |port: String| {
        let path = format!("{folder}/{port}/latency_timer");
        let held = host.read(&path)?.parse::<u32>().ok()?;
        let subject = format!("latency timer of {port}");
        Some(match held <= TIMER_MS {
            true => Finding::ok(&subject, format!("{held} ms")),
            false => Finding::warning(
                &subject,
                format!("{held} ms: samples arrive in clumps, and so late"),
                format!(
                    "echo {TIMER_MS} | sudo tee {path}; for good a udev rule: ACTION==\"add\", SUBSYSTEM==\"usb-serial\", \
                     DRIVER==\"ftdi_sio\", ATTR{{latency_timer}}=\"{TIMER_MS}\""
                ),
            ),
        })
    };
    host.names(folder).into_iter().filter_map(timer).collect()
}

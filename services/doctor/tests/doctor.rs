//! The doctor on made computers: a sound one, a poor one, and an empty one.
#![allow(clippy::unwrap_used)]

use doctor::{Finding, Grade, Host, Report, run};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const LIMITS: &str = "Limit                     Soft Limit           Hard Limit           Units\n\
Max locked memory         MEMLOCK    unlimited            bytes\n\
Max realtime priority     RTPRIO     99\n";

fn put(root: &Path, path: &str, text: &str) {
    let path = root.join(path.trim_start_matches('/'));
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

/// An ordinary user of the group 20 at a computer with two cores.
fn computer(limits: [&str; 2], governor: &str, load: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    put(root, "/proc/self/limits", &LIMITS.replace("MEMLOCK", limits[0]).replace("RTPRIO", limits[1]));
    put(
        root,
        "/proc/self/status",
        "Name:\tx\nUid:\t1000\t1000\t1000\t1000\nGid:\t1000\t1000\nGroups:\t20 27\nCapEff:\t0000000000000000\n",
    );
    put(root, "/proc/loadavg", &format!("{load} 0.1 0.1 1/100 1234\n"));
    put(root, "/sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
    for core in ["cpu0", "cpu1"] {
        put(root, &format!("/sys/devices/system/cpu/{core}/cpufreq/scaling_governor"), &format!("{governor}\n"));
    }
    fs::create_dir_all(root.join("dev/shm")).unwrap();
    folder
}

fn report(folder: &TempDir, shared_memory: Option<[u64; 2]>) -> Report {
    run(&Host { root: folder.path().to_owned(), shared_memory }, None).unwrap()
}

fn of<'a>(report: &'a Report, subject: &str) -> &'a Finding {
    report
        .findings
        .iter()
        .find(|finding| finding.subject == subject)
        .unwrap_or_else(|| panic!("no {subject}: {report}"))
}

#[test]
fn a_sound_computer_is_ok_in_every_point() {
    let folder = computer(["unlimited", "99"], "performance", "0.10");
    put(folder.path(), "/dev/ttyUSB0", "");
    put(folder.path(), "/etc/group", "root:x:0:\ndialout:x:20:me\n");
    put(folder.path(), "/sys/bus/usb-serial/devices/ttyUSB0/latency_timer", "1\n");
    put(folder.path(), "/tmp/deckflex-1000/df0123abcd/owner", "1 1\n");
    put(folder.path(), "/dev/shm/df0123abcd_x", "");
    let report = report(&folder, Some([1 << 30, 1 << 30]));
    assert_eq!(report.worst(), Grade::Ok, "{report}");
    assert!(report.findings.iter().all(|finding| finding.remedy.is_empty()), "{report}");
    assert!(report.to_string().ends_with("0 bad, 0 warnings, 9 looked at\n"), "{report}");
}

#[test]
fn every_trouble_is_told_with_its_remedy() {
    let folder = computer(["8388608", "0"], "powersave", "1.90");
    put(folder.path(), "/dev/ttyUSB3", "");
    put(folder.path(), "/etc/group", "dialout:x:30:\n");
    put(folder.path(), "/sys/bus/usb-serial/devices/ttyUSB3/latency_timer", "16\n");
    put(folder.path(), "/sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n");
    put(folder.path(), "/dev/shm/df0123abcd_x", "");
    put(folder.path(), "/dev/shm/other", "");
    let report = report(&folder, Some([64 << 20, 1 << 20]));
    for (subject, grade, word) in [
        ("real-time priority", Grade::Warning, "rtprio 40"),
        ("locked memory", Grade::Warning, "memlock unlimited"),
        ("serial ports", Grade::Bad, "usermod -aG dialout"),
        ("latency timer of ttyUSB3", Grade::Warning, "/sys/bus/usb-serial/devices/ttyUSB3/latency_timer"),
        ("clock source", Grade::Warning, "tsc"),
        ("processor's frequency", Grade::Warning, "echo performance"),
        ("load", Grade::Warning, "stop other programs"),
        ("shared memory", Grade::Bad, "remount"),
        ("leftovers in shared memory", Grade::Warning, "rm /dev/shm/df0123abcd_*"),
    ] {
        let finding = of(&report, subject);
        assert!(finding.grade == grade && finding.remedy.contains(word), "{finding:?}");
    }
    assert_eq!((report.worst(), report.findings.len()), (Grade::Bad, 9));
    assert!(report.to_string().contains("2 bad, 7 warnings"), "{report}");
}

#[test]
fn what_cannot_be_looked_at_is_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    let report = report(&folder, None);
    assert_eq!(of(&report, "shared memory").grade, Grade::Bad);
    assert_eq!(of(&report, "real-time priority").grade, Grade::Warning);
    assert_eq!(of(&report, "serial ports").grade, Grade::Ok);
}

#[test]
fn root_is_granted_what_limits_forbid() {
    let folder = computer(["8388608", "0"], "performance", "0.10");
    put(folder.path(), "/proc/self/status", "Uid:\t0\t0\t0\t0\nCapEff:\t000001ffffffffff\n");
    put(folder.path(), "/dev/ttyACM0", "");
    assert_eq!(report(&folder, Some([1 << 30, 1 << 30])).worst(), Grade::Ok);
}

#[test]
fn this_computer_is_looked_at_and_a_configuration_counts_its_areas() {
    let demo = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/two_areas.toml");
    let report = run(&Host::this(), Some(&demo)).unwrap();
    assert!(of(&report, "shared memory").found.contains("2 areas"), "{report}");
    assert!(run(&Host::this(), Some(Path::new("/nowhere.toml"))).is_err());
}

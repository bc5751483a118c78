//! Clock source, frequency governor and load.

use crate::{Finding, Host};

/// Clock sources that are read without a system call and are good to a microsecond.
const QUICK: [&str; 3] = ["tsc", "arch_sys_counter", "kvm-clock"];

pub(crate) fn findings(host: &Host) -> Vec<Finding> {
    vec![clock(host), governor(host), load(host)]
}

fn clock(host: &Host) -> Finding {
    let subject = "clock source";
    let folder = "/sys/devices/system/clocksource/clocksource0";
    match host.read(&format!("{folder}/current_clocksource")) {
        Some(source) if QUICK.contains(&source.as_str()) => Finding::ok(subject, source),
        Some(source) => Finding::warning(
            subject,
            format!("{source}: each look at the clock costs a microsecond or more"),
            format!("echo tsc | sudo tee {folder}/current_clocksource, if tsc stands in available_clocksource there"),
        ),
        None => Finding::warning(subject, "is not known", format!("look into {folder}")),
    }
}

fn governor(host: &Host) -> Finding {
    let subject = "processor's frequency";
    let folder = "/sys/devices/system/cpu";
    let governors: Vec<String> = host
        .names(folder)
        .into_iter()
        .filter_map(|cpu| host.read(&format!("{folder}/{cpu}/cpufreq/scaling_governor")))
        .collect();
    let slow = governors.iter().find(|governor| *governor != "performance");
    match (governors.first(), slow) {
        (None, _) => Finding::ok(subject, "is not governed by this system (a guest, or fixed)"),
        (_, None) => Finding::ok(subject, "governor performance on every core"),
        (_, Some(slow)) => Finding::warning(
            subject,
            format!("governor {slow}: a core that has slept wakes slowly"),
            format!("echo performance | sudo tee {folder}/cpu*/cpufreq/scaling_governor"),
        ),
    }
}

fn load(host: &Host) -> Finding {
    let subject = "load";
    let is_core = |name: &String| name.strip_prefix("cpu").is_some_and(|n| n.parse::<u32>().is_ok());
    let cores = host.names("/sys/devices/system/cpu").iter().filter(|name| is_core(name)).count().max(1);
    let minute = host.read("/proc/loadavg").and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    match minute {
        Some(load) if load > 0.7 * cores as f64 => Finding::warning(
            subject,
            format!("{load} over the last minute on {cores} cores"),
            "stop other programs, or grant real-time priority, so that they cannot delay the estimator",
        ),
        Some(load) => Finding::ok(subject, format!("{load} over the last minute on {cores} cores")),
        None => Finding::warning(subject, "is not known (/proc/loadavg)", "mount /proc"),
    }
}

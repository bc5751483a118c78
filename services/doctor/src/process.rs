//! What the operating system grants to processes of this user.

use crate::{Finding, Host};

/// The fast stages ask for this real-time priority.
const PRIORITY: u64 = 40;
const LIMITS_FILE: &str = "/etc/security/limits.d/deckflex.conf";

/// Real-time limits, by those that this process has.
pub(crate) fn limits(host: &Host) -> Vec<Finding> {
    let limits = host.read("/proc/self/limits").unwrap_or_default();
    let soft = |name: &str| -> Option<u64> {
        let line = limits.lines().find_map(|line| line.strip_prefix(name))?;
        let first = line.split_whitespace().next()?;
        if first == "unlimited" { Some(u64::MAX) } else { first.parse().ok() }
    };
    vec![priority(soft("Max realtime priority"), may_anyway(host)), memory(soft("Max locked memory"), is_root(host))]
}

fn priority(limit: Option<u64>, may_anyway: bool) -> Finding {
    let subject = "real-time priority";
    let remedy = format!(
        "write \"@deckflex - rtprio {PRIORITY}\" into {LIMITS_FILE}, put the user into the group deckflex and log in anew; \
         under systemd LimitRTPRIO={PRIORITY}"
    );
    match limit {
        _ if may_anyway => Finding::ok(subject, "granted by privilege (root or CAP_SYS_NICE)"),
        Some(limit) if limit >= PRIORITY => Finding::ok(subject, format!("up to {limit} (RLIMIT_RTPRIO)")),
        Some(limit) => {
            let found = format!(
                "up to {limit} (RLIMIT_RTPRIO), the fast stages ask for {PRIORITY}: under load solutions come milliseconds late"
            );
            Finding::warning(subject, found, remedy)
        }
        None => Finding::warning(subject, "the limit is not known (/proc/self/limits)", remedy),
    }
}

fn memory(limit: Option<u64>, is_root: bool) -> Finding {
    let subject = "locked memory";
    match limit {
        _ if is_root => Finding::ok(subject, "granted to root"),
        Some(u64::MAX) => Finding::ok(subject, "without limit (RLIMIT_MEMLOCK)"),
        other => {
            let found = other.map_or("the limit is not known".to_owned(), |bytes| format!("up to {} kB", bytes / 1024));
            let remedy = format!(
                "write \"@deckflex - memlock unlimited\" into {LIMITS_FILE} and log in anew; under systemd LimitMEMLOCK=infinity"
            );
            Finding::warning(subject, format!("{found} (RLIMIT_MEMLOCK): page faults can delay a solution"), remedy)
        }
    }
}

fn status(host: &Host, name: &str) -> Option<String> {
    let status = host.read("/proc/self/status")?;
    Some(status.lines().find_map(|line| line.strip_prefix(name))?.trim().to_owned())
}

/// By the effective user.
pub(crate) fn is_root(host: &Host) -> bool {
    status(host, "Uid:").and_then(|ids| ids.split_whitespace().nth(1).map(|id| id == "0")).unwrap_or(false)
}

/// Bit of CAP_SYS_NICE.
const SYS_NICE: u32 = 23;

fn may_anyway(host: &Host) -> bool {
    let capabilities = status(host, "CapEff:").and_then(|hex| u64::from_str_radix(&hex, 16).ok());
    capabilities.is_some_and(|bits| bits >> SYS_NICE & 1 == 1)
}

/// Numbers of this process's groups.
pub(crate) fn groups(host: &Host) -> Vec<u32> {
    let own = status(host, "Gid:").unwrap_or_default();
    let others = status(host, "Groups:").unwrap_or_default();
    own.split_whitespace().chain(others.split_whitespace()).filter_map(|id| id.parse().ok()).collect()
}

//! Shared memory: how much there is, and what dead launches left in it.

use crate::{Finding, Host};
use std::collections::BTreeSet;
use std::ffi::CString;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;

/// What the topics of an area take at most, bytes: one area with the main unit has files of 25 MB.
const AN_AREA: u64 = 32 << 20;

/// Size and free space of a file system, bytes.
pub(crate) fn size(path: &Path) -> Option<[u64; 2]> {
    let path = CString::new(path.as_os_str().as_bytes()).ok()?;
    // SAFETY: all zeros is a value of the structure; the path ends in zero and both live through the call.
    unsafe {
        let mut told: libc::statvfs = std::mem::zeroed();
        let known = libc::statvfs(path.as_ptr(), &mut told) == 0;
        known.then(|| [told.f_blocks * told.f_frsize, told.f_bavail * told.f_frsize])
    }
}

pub(crate) fn findings(host: &Host, areas: usize) -> Vec<Finding> {
    vec![room(host, areas), leftovers(host)]
}

fn room(host: &Host, areas: usize) -> Finding {
    let subject = "shared memory";
    let wanted = AN_AREA * areas as u64;
    let remedy = "mount -o remount,size=1G /dev/shm as root; in a container --shm-size=1g";
    match host.shared_memory {
        Some([size, free]) => {
            let found = format!("{} of {} MB free, {areas} areas take up to {}", free >> 20, size >> 20, wanted >> 20);
            if free < wanted {
                Finding::bad(subject, found + ": a stage dies of it when its queues fill", remedy)
            } else {
                Finding::ok(subject, found)
            }
        }
        None => Finding::bad(subject, "/dev/shm cannot be used", remedy),
    }
}

/// Files of domains in shared memory whose folder is not there any more; the others are swept by the next launch.
fn leftovers(host: &Host) -> Finding {
    let subject = "leftovers in shared memory";
    let domain = |name: &String| {
        let (domain, _) = name.split_once('_')?;
        let digits = domain.strip_prefix("df")?;
        let is_domain = digits.len() == 8 && digits.bytes().all(|c| c.is_ascii_hexdigit());
        is_domain.then(|| domain.to_owned())
    };
    let present: BTreeSet<String> = host.names("/dev/shm").iter().filter_map(domain).collect();
    let known = |domain: &String| {
        let bases = ["/tmp", "/run/user"].map(|base| (base, host.names(base)));
        bases.iter().any(|(base, names)| {
            names.iter().any(|name| {
                let inside = |folder: &str| host.path(&format!("{folder}/{domain}")).exists();
                match *base {
                    "/tmp" => name.starts_with("deckflex-") && inside(&format!("/tmp/{name}")),
                    _ => {
                        let folder = format!("/run/user/{name}");
                        let ours =
                            |inner: &String| inner.starts_with("deckflex-") && inside(&format!("{folder}/{inner}"));
                        host.names(&folder).iter().any(ours)
                    }
                }
            })
        })
    };
    let lost: Vec<String> = present.into_iter().filter(|domain| !known(domain)).collect();
    match lost.as_slice() {
        [] => Finding::ok(subject, "none that no launch owns"),
        lost => Finding::warning(
            subject,
            format!("files of {} which no launch owns any more", lost.join(", ")),
            format!(
                "while no launch runs: {}",
                lost.iter().map(|d| format!("rm /dev/shm/{d}_*")).collect::<Vec<_>>().join("; ")
            ),
        ),
    }
}

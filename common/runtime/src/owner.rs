//! Who owns a domain: a process, told from a later one of the same number by when it started.

use std::fs;

/// A process that once lived on this host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Owner {
    /// Process number.
    pub pid: u32,
    /// When it started, in clock ticks since the host did.
    pub started: u64,
}

impl Owner {
    /// This process; `None` where `/proc` does not tell.
    pub fn this_process() -> Option<Self> {
        let pid = std::process::id();
        Some(Self { pid, started: start_of(pid)? })
    }

    /// Whether the process still runs; a zombie does not.
    pub fn lives(self) -> bool {
        start_of(self.pid) == Some(self.started)
    }

    /// The content of an owner file.
    pub fn to_text(self) -> String {
        format!("{} {}\n", self.pid, self.started)
    }

    /// The reverse of [`Owner::to_text`].
    pub fn from_text(text: &str) -> Option<Self> {
        let mut words = text.split_whitespace();
        let (pid, started) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
        words.next().is_none().then_some(Self { pid, started })
    }
}

/// Field 22 of `/proc/<pid>/stat`; `None` for a process that does not run.
fn start_of(pid: u32) -> Option<u64> {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The name of the program stands in brackets and may hold brackets and blanks itself.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace();
    let state = fields.next()?;
    if matches!(state, "Z" | "X") {
        return None;
    }
    fields.nth(18)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_process_lives() {
        let owner = Owner::this_process().expect("Linux has /proc");
        assert!(owner.lives());
        assert_eq!(Owner::from_text(&owner.to_text()), Some(owner));
    }

    #[test]
    fn a_number_used_again_is_another_process() {
        let owner = Owner::this_process().expect("Linux has /proc");
        assert!(!Owner { started: owner.started + 1, ..owner }.lives());
    }

    #[test]
    fn a_zombie_is_dead() {
        let mut child = std::process::Command::new("sleep").arg("60").spawn().expect("sleep starts");
        let owner = Owner { pid: child.id(), started: start_of(child.id()).expect("it runs") };
        assert!(owner.lives());
        child.kill().expect("it is ours");
        let deadline = std::time::Instant::now() + std::time::Duration::from_secs(5);
        while owner.lives() && std::time::Instant::now() < deadline {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        assert!(!owner.lives());
        child.wait().expect("it is ours");
    }

    #[test]
    fn nonsense_is_no_owner() {
        for text in ["", "12", "a b", "1 2 3", "-1 5"] {
            assert_eq!(Owner::from_text(text), None, "{text:?}");
        }
    }
}

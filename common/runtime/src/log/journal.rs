use super::Speaker;
use super::line::Line;
use std::io;
use std::os::unix::net::UnixDatagram;
use std::path::{Path, PathBuf};
use tracing::Level;

/// Where the journal listens.
pub const SOCKET: &str = "/run/systemd/journal/socket";

/// The journal of systemd: one datagram an event, a line a field (systemd.io/JOURNAL_NATIVE_PROTOCOL).
#[derive(Debug)]
pub struct Journal {
    socket: UnixDatagram,
    path: PathBuf,
}

impl Journal {
    /// Errors: nobody listens there.
    pub fn open(path: &Path) -> io::Result<Self> {
        let journal = Self { socket: UnixDatagram::unbound()?, path: path.to_owned() };
        // the journal passes over an empty entry
        journal.send(&[])?;
        Ok(journal)
    }

    /// By the path each time, so that a journal that is started anew is found.
    pub fn send(&self, entry: &[u8]) -> io::Result<()> {
        self.socket.send_to(entry, &self.path).map(|_| ())
    }
}

/// The entry of a line.
pub fn entry(line: &Line, speaker: &Speaker) -> Vec<u8> {
    let mut entry = Vec::with_capacity(512);
    let priority = match line.level {
        Level::ERROR => "3",
        Level::WARN => "4",
        Level::INFO => "6",
        _ => "7",
    };
    let mut words = String::new();
    line.sentence(speaker, &mut words);
    put(&mut entry, "MESSAGE", &words);
    put(&mut entry, "PRIORITY", priority);
    put(&mut entry, "SYSLOG_IDENTIFIER", "deckflex");
    put(&mut entry, "TARGET", line.target);
    if let Some((file, number)) = line.place {
        put(&mut entry, "CODE_FILE", file);
        put(&mut entry, "CODE_LINE", &number.to_string());
    }
    put(&mut entry, "DECKFLEX_STAGE", &speaker.stage);
    speaker.area.iter().for_each(|area| put(&mut entry, "DECKFLEX_AREA", area));
    for (name, value) in &line.fields.all {
        put(&mut entry, &format!("DECKFLEX_{}", name.to_uppercase().replace('.', "_")), value);
    }
    entry
}

/// A value of several lines goes with its length.
fn put(entry: &mut Vec<u8>, name: &str, value: &str) {
    entry.extend(name.bytes());
    if value.contains('\n') {
        entry.push(b'\n');
        entry.extend((value.len() as u64).to_le_bytes());
    } else {
        entry.push(b'=');
    }
    entry.extend(value.bytes());
    entry.push(b'\n');
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::log::fields::Fields;
    use std::time::SystemTime;

    #[test]
    fn the_journal_gets_every_field_by_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        assert!(Journal::open(&path).is_err(), "nobody listens yet");
        let listener = UnixDatagram::bind(&path).unwrap();
        let journal = Journal::open(&path).unwrap();
        let mut buffer = [0; 2000];
        assert_eq!(listener.recv(&mut buffer).unwrap(), 0);

        let fields = Fields { words: "gone".into(), all: vec![("silent_s", "1.5".into()), ("reason", "a\nb".into())] };
        let place = Some(("src/x.rs", 7));
        let line = Line { time: SystemTime::now(), level: Level::WARN, target: "acquire::wired", place, fields };
        let speaker = Speaker { stage: "acquire".into(), area: None };
        journal.send(&entry(&line, &speaker)).unwrap();
        let length = listener.recv(&mut buffer).unwrap();
        let expected =
            b"MESSAGE=acquire: gone  silent_s=1.5  reason=\"a\\nb\"\nPRIORITY=4\nSYSLOG_IDENTIFIER=deckflex\n\
            TARGET=acquire::wired\nCODE_FILE=src/x.rs\nCODE_LINE=7\nDECKFLEX_STAGE=acquire\nDECKFLEX_SILENT_S=1.5\n\
            DECKFLEX_REASON\n\x03\0\0\0\0\0\0\0a\nb\n";
        assert_eq!(String::from_utf8_lossy(&buffer[..length]), String::from_utf8_lossy(expected));

        // a journal that was started anew
        drop(listener);
        std::fs::remove_file(&path).unwrap();
        assert!(journal.send(b"MESSAGE=lost\n").is_err());
        let listener = UnixDatagram::bind(&path).unwrap();
        journal.send(b"MESSAGE=back\n").unwrap();
        let length = listener.recv(&mut buffer).unwrap();
        assert_eq!(&buffer[..length], b"MESSAGE=back\n");
    }
}

use super::Speaker;
use super::fields::Fields;
use std::fmt::Write;
use std::time::SystemTime;
use tracing::Level;

/// An event, ready to be written by either way.
#[derive(Debug)]
pub struct Line {
    pub time: SystemTime,
    pub level: Level,
    pub target: &'static str,
    pub place: Option<(&'static str, u32)>,
    pub fields: Fields,
}

impl Line {
    /// What is told in the place of lines that found no room.
    pub fn dropped(lines: u64) -> Self {
        let fields =
            Fields { words: "lines of this log were dropped".to_owned(), all: vec![("lines", lines.to_string())] };
        Self { time: SystemTime::now(), level: Level::WARN, target: module_path!(), place: None, fields }
    }

    /// For the error output: time, level, stage, words, fields.
    pub fn text(&self, speaker: &Speaker, colour: bool) -> String {
        let mut line = String::with_capacity(160);
        let (begin, level, end) = match (colour, self.level) {
            (false, level) => ("", level, ""),
            (true, Level::ERROR) => (RED, Level::ERROR, PLAIN),
            (true, Level::WARN) => (YELLOW, Level::WARN, PLAIN),
            (true, level) => (FAINT, level, PLAIN),
        };
        let time = humantime::format_rfc3339_millis(self.time);
        // the launcher's live line stands on a terminal without an end: it is drawn again below
        let clear = if colour { CLEAR } else { "" };
        // writing to a text cannot fail
        let _ = write!(line, "{clear}{time} {begin}{:<5}{end} ", level.as_str());
        self.sentence(speaker, &mut line);
        line.push('\n');
        line
    }

    /// What is left of a line whose time and level are told otherwise.
    pub fn sentence(&self, speaker: &Speaker, line: &mut String) {
        line.push_str(&speaker.stage);
        speaker.area.iter().for_each(|area| line.extend(["/", area.as_str()]));
        line.push_str(": ");
        self.fields.write(line);
    }
}

const RED: &str = "\x1b[31m";
const YELLOW: &str = "\x1b[33m";
const FAINT: &str = "\x1b[2m";
const PLAIN: &str = "\x1b[0m";
const CLEAR: &str = "\r\x1b[2K";

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn line(words: &str, all: &[(&'static str, &str)]) -> Line {
        let all = all.iter().map(|(name, value)| (*name, (*value).to_owned())).collect();
        let fields = Fields { words: words.to_owned(), all };
        let time = SystemTime::UNIX_EPOCH + Duration::from_millis(1_800_000_000_250);
        Line { time, level: Level::WARN, target: "estimate", place: None, fields }
    }

    fn speaker() -> Speaker {
        Speaker { stage: "estimate".into(), area: Some("aft deck".into()) }
    }

    #[test]
    fn one_line_tells_time_level_stage_words_and_fields() {
        let text = line("no pairs", &[("silent_s", "1.5"), ("reason", "a \"b\" c")]).text(&speaker(), false);
        let expected =
            "2027-01-15T08:00:00.250Z WARN  estimate/aft deck: no pairs  silent_s=1.5  reason=\"a \\\"b\\\" c\"\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn what_comes_from_outside_neither_ends_the_line_nor_speaks_to_the_terminal() {
        let text = line("a\nb\x1b[2J", &[("port", "x\r\ny"), ("none", "")]).text(&speaker(), false);
        assert!(text.ends_with(": a b [2J  port=\"x\\r\\ny\"  none=\"\"\n"), "{text}");
        assert_eq!(text.chars().filter(|c| c.is_control()).count(), 1, "{text:?}");
        assert!(line("a", &[]).text(&speaker(), true).contains("\x1b[33mWARN \x1b[0m"));
    }
}

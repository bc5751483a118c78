use std::fmt::{self, Debug, Write};
use tracing::field::{Field, Visit};

/// The words of an event and its fields, each as a text.
#[derive(Debug, Default, PartialEq)]
pub struct Fields {
    pub words: String,
    pub all: Vec<(&'static str, String)>,
}

impl Fields {
    fn add(&mut self, field: &Field, value: String) {
        match field.name() {
            "message" => self.words = value,
            name => self.all.push((name, value)),
        }
    }

    /// The words with all fields behind them, in one line.
    pub fn write(&self, line: &mut String) {
        // writing to a text cannot fail
        let _ = plain(line, &self.words);
        for (name, value) in &self.all {
            let simple = !value.is_empty() && value.chars().all(|c| !c.is_whitespace() && !c.is_control() && c != '"');
            let _ = if simple { write!(line, "  {name}={value}") } else { write!(line, "  {name}={value:?}") };
        }
    }
}

/// Without characters that would begin another line or speak to a terminal.
fn plain(line: &mut String, words: &str) -> fmt::Result {
    words.chars().try_for_each(|c| line.write_char(if c.is_control() { ' ' } else { c }))
}

impl Visit for Fields {
    fn record_f64(&mut self, field: &Field, value: f64) {
        // six digits are all that a reader wants of a measured time
        let short = format!("{value:.5e}").parse().unwrap_or(value);
        self.add(field, short.to_string());
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        self.add(field, value.to_owned());
    }

    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        self.add(field, format!("{value:?}"));
    }
}

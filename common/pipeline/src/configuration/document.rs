//! The TOML text with the place of every key, so that an error can name line, key and value.

use super::ConfigurationError;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A key with its value, or an element of an array.
struct Entry {
    /// Full key, such as `area[0].gyro.range_deg_per_s`.
    key: String,
    key_span: Range<usize>,
    value_span: Range<usize>,
    is_table: bool,
}

/// The keys of a configuration, in the order of the text's tables.
pub(super) struct Document<'a> {
    path: &'a Path,
    text: &'a str,
    entries: Vec<Entry>,
}

impl<'a> Document<'a> {
    /// Errors: text that is not TOML.
    pub(super) fn parse(path: &'a Path, text: &'a str) -> Result<Self, ConfigurationError> {
        let mut document = Self { path, text, entries: Vec::new() };
        match DeTable::parse(text) {
            Ok(root) => document.collect("", root.get_ref()),
            Err(error) => {
                let line = error.span().map(|span| document.line(span.start));
                return Err(document.error(line, format!("not valid TOML: {}", error.message())));
            }
        }
        Ok(document)
    }

    fn collect(&mut self, prefix: &str, table: &DeTable) {
        for (name, value) in table {
            let key =
                if prefix.is_empty() { name.get_ref().to_string() } else { format!("{prefix}.{}", name.get_ref()) };
            self.add(key, name.span(), value);
        }
    }

    fn add(&mut self, key: String, key_span: Range<usize>, value: &Spanned<DeValue>) {
        let is_table = matches!(value.get_ref(), DeValue::Table(_));
        self.entries.push(Entry { key: key.clone(), key_span, value_span: value.span(), is_table });
        match value.get_ref() {
            DeValue::Table(table) => self.collect(&key, table),
            DeValue::Array(array) => {
                for (i, element) in array.iter().enumerate() {
                    self.add(format!("{key}[{i}]"), element.span(), element);
                }
            }
            _ => {}
        }
    }

    fn line(&self, offset: usize) -> usize {
        1 + self.text.bytes().take(offset).filter(|&b| b == b'\n').count()
    }

    /// Whether the key stands in the file.
    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.iter().any(|entry| entry.key == key)
    }

    /// An error of the value of a key; one that is absent is told with the line of its table.
    pub(super) fn fault(&self, key: &str, message: &str) -> ConfigurationError {
        let find = |key: &str| self.entries.iter().find(|entry| entry.key == key);
        match find(key) {
            Some(entry) => self.at(entry, message),
            None => {
                let table = key.rsplit_once('.').and_then(|(table, _)| find(table));
                self.error(table.map(|table| self.line(table.key_span.start)), format!("{key}: {message}"))
            }
        }
    }

    fn at(&self, entry: &Entry, message: &str) -> ConfigurationError {
        let line = Some(self.line(entry.key_span.start));
        match self.text.get(entry.value_span.clone()) {
            Some(value) if !entry.is_table && !value.starts_with('[') => {
                self.error(line, format!("{} = {value}: {message}", entry.key))
            }
            _ => self.error(line, format!("{}: {message}", entry.key)),
        }
    }

    fn error(&self, line: Option<usize>, message: String) -> ConfigurationError {
        ConfigurationError::Invalid { path: self.path.to_path_buf(), line, message }
    }

    /// Says an error of serde in the words of the configuration.
    pub(super) fn explain(&self, error: &toml::de::Error) -> ConfigurationError {
        let span = error.span();
        let message = error.message();
        let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        if message.starts_with("unknown field `")
            && let Some((unknown, known)) = quoted.split_first()
        {
            return self.unknown_key(span, unknown, known);
        }
        let entry = span.and_then(|span| self.entries.iter().rfind(|entry| entry.value_span == span));
        if message.starts_with("missing field `")
            && let Some(key) = quoted.first()
        {
            let prefix = entry.map_or(String::new(), |entry| format!("{}.", entry.key));
            let line = entry.map(|entry| self.line(entry.key_span.start));
            return self.error(line, format!("the required key `{prefix}{key}` is missing"));
        }
        let message = plain(message, &quoted);
        match entry {
            Some(entry) => self.at(entry, &message),
            None => self.error(error.span().map(|span| self.line(span.start)), message),
        }
    }

    fn unknown_key(&self, span: Option<Range<usize>>, unknown: &str, known: &[&str]) -> ConfigurationError {
        let entry = span.and_then(|span| self.entries.iter().find(|entry| entry.key_span == span));
        let table = entry.and_then(|entry| entry.key.rsplit_once('.')).map(|(table, _)| table);
        let place = table.map_or("at the top level".into(), |table| format!("in [{}]", without_indices(table)));
        let line = entry.map(|entry| self.line(entry.key_span.start));
        self.error(line, format!("unknown key `{unknown}` {place}; {}", suggestion(unknown, known)))
    }
}

fn without_indices(key: &str) -> String {
    let mut depth = 0;
    key.chars()
        .filter(|&c| {
            depth += i32::from(c == '[');
            let keep = depth == 0;
            depth -= i32::from(c == ']');
            keep
        })
        .collect()
}

/// The known word nearest to an unknown one, or all of them if none is near.
fn suggestion(unknown: &str, known: &[&str]) -> String {
    let nearest = known
        .iter()
        .map(|word| (strsim::normalized_damerau_levenshtein(unknown, word), word))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((likeness, word)) if likeness > 0.5 => format!("did you mean `{word}`?"),
        _ => format!("known here: {}", known.join(", ")),
    }
}

/// serde speaks of Rust's types; the reader thinks of TOML's.
fn plain(message: &str, quoted: &[&str]) -> String {
    if message.starts_with("unknown variant `")
        && let Some((unknown, known)) = quoted.split_first()
    {
        let known: Vec<String> = known.iter().map(|word| format!("\"{word}\"")).collect();
        let near = suggestion(unknown, &quoted[1..]);
        let near = if near.starts_with("did") { format!("; {near}") } else { String::new() };
        return format!("must be one of {}{near}", known.join(", "));
    }
    if message == "wanted string or table" {
        return "expected a string".into();
    }
    match message.split_once(", expected ") {
        Some((_, "usize" | "u64")) => "expected a whole number, 0 or more".into(),
        Some((_, "a sequence")) => "expected an array".into(),
        Some((_, "a boolean")) => "expected true or false".into(),
        Some((_, "path string")) => "expected a string".into(),
        Some((start, wanted)) if start.starts_with("invalid ") => format!("expected {wanted}"),
        _ => message.into(),
    }
}

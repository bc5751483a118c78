use std::fmt;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Grade {
    /// As it should be.
    Ok,
    /// A live run works, but not as well as it could.
    Warning,
    /// A live run fails or stalls.
    Bad,
}

/// One thing that was looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// What was looked at.
    pub subject: String,
    /// How it is.
    pub grade: Grade,
    /// What was found.
    pub found: String,
    /// What to do about it; empty where nothing is to be done.
    pub remedy: String,
}

impl Finding {
    pub(crate) fn ok(subject: &str, found: impl Into<String>) -> Self {
        Self { subject: subject.to_owned(), grade: Grade::Ok, found: found.into(), remedy: String::new() }
    }

    pub(crate) fn warning(subject: &str, found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { subject: subject.to_owned(), grade: Grade::Warning, found: found.into(), remedy: remedy.into() }
    }

    pub(crate) fn bad(subject: &str, found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { grade: Grade::Bad, ..Self::warning(subject, found, remedy) }
    }
}

/// Everything that was looked at; it displays as a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// In the order of the list.
    pub findings: Vec<Finding>,
}

impl Report {
    /// The worst grade.
    pub fn worst(&self) -> Grade {
        self.findings.iter().map(|finding| finding.grade).max().unwrap_or(Grade::Ok)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Finding { subject, grade, found, remedy } in &self.findings {
            let grade = match grade {
                Grade::Ok => "ok",
                Grade::Warning => "warning",
                Grade::Bad => "bad",
            };
            writeln!(f, "{grade:<8} {subject}: {found}")?;
            if !remedy.is_empty() {
                writeln!(f, "         -> {remedy}")?;
            }
        }
        let count = |grade| self.findings.iter().filter(|finding| finding.grade == grade).count();
        writeln!(f, "{} bad, {} warnings, {} looked at", count(Grade::Bad), count(Grade::Warning), self.findings.len())
    }
}

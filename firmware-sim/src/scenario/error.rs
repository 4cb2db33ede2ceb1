//! Why a scenario was rejected.

use core::fmt;
use std::path::{Path, PathBuf};

/// What is wrong with a scenario, where, and what would be right. Indices count from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScenarioError {
    /// The file, if the scenario came from one.
    pub file: Option<PathBuf>,
    /// The line (`line 3`) or the key (`target[1].path[0]`); empty if it is the file as a whole.
    pub place: String,
    /// The offending text or value.
    pub value: String,
    /// What would be right.
    pub expected: String,
}

impl ScenarioError {
    pub(super) fn new(place: impl Into<String>, value: impl fmt::Display, expected: impl Into<String>) -> Self {
        ScenarioError { file: None, place: place.into(), value: value.to_string(), expected: expected.into() }
    }

    pub(super) fn unreadable(path: &Path, error: &std::io::Error) -> Self {
        ScenarioError::new("", "cannot be read", error.to_string()).in_file(path)
    }

    /// From the TOML reader's own error, which knows a byte range of the text.
    pub(super) fn toml(text: &str, error: &toml::de::Error) -> Self {
        let at = error.span().map_or(0, |span| span.start.min(text.len()));
        let line = text.bytes().take(at).filter(|&byte| byte == b'\n').count();
        let content = text.lines().nth(line).unwrap_or("").trim();
        ScenarioError::new(format!("line {}", line + 1), content, error.message().trim().replace('\n', ", "))
    }

    #[must_use]
    pub(super) fn in_file(mut self, path: &Path) -> Self {
        self.file = Some(path.to_owned());
        self
    }
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.file {
            Some(file) => write!(f, "{}: ", file.display())?,
            None => write!(f, "scenario: ")?,
        }
        if !self.place.is_empty() {
            write!(f, "{}: ", self.place)?;
        }
        write!(f, "{}: {}", self.value, self.expected)
    }
}

impl core::error::Error for ScenarioError {}

//! What is wrong with a file that a person wrote.

use std::error::Error;
use std::fmt;
use std::path::{Path, PathBuf};

/// A place in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The whole line.
    pub text: String,
    /// How many bytes of the line the fault takes, from the column on.
    pub length: usize,
}

impl Place {
    /// The place of a range of bytes of a text; of its first line, if it takes several.
    pub fn of(text: &str, range: std::ops::Range<usize>) -> Place {
        let start = (0..=range.start.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
        let (before, after) = text.split_at(start);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let rest = after.split('\n').next().unwrap_or_default().trim_end_matches('\r');
        Place {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            text: before[line_start..].to_owned() + rest,
            length: range.end.saturating_sub(start).min(rest.len()),
        }
    }
}

/// What is wrong with a file, where, and what would be right.
///
/// Shown as `FILE:LINE:COLUMN: KEY = VALUE: what would be right`; what is not known is left out.
pub struct InputError(Box<Inner>);

#[derive(Debug)]
struct Inner {
    file: Option<PathBuf>,
    place: Option<Place>,
    key: String,
    value: String,
    expected: String,
    source: Option<Box<dyn Error + Send + Sync>>,
}

impl InputError {
    /// A fault of a key such as `target[1].path[0]` (indices from 0, empty if the file as a whole is wrong), its value
    /// (empty if it has none), and what would be right: why, and the way out.
    pub fn new(key: impl Into<String>, value: impl fmt::Display, expected: impl Into<String>) -> Self {
        let (key, value, expected) = (key.into(), value.to_string(), expected.into());
        InputError(Box::new(Inner { file: None, place: None, key, value, expected, source: None }))
    }

    /// With the file that it is about, unless it names one already.
    #[must_use]
    pub fn in_file(mut self, path: &Path) -> Self {
        self.0.file.get_or_insert_with(|| path.to_owned());
        self
    }

    /// With the place in the text, unless it has one already.
    #[must_use]
    pub fn at(mut self, place: Place) -> Self {
        self.0.place.get_or_insert(place);
        self
    }

    /// With the value as it is written in the file.
    #[must_use]
    pub fn written(mut self, value: &str) -> Self {
        value.clone_into(&mut self.0.value);
        self
    }

    /// With the error that it comes from.
    #[must_use]
    pub fn from_source(mut self, source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        self.0.source = Some(source.into());
        self
    }

    /// The file it is about.
    pub fn file(&self) -> Option<&Path> {
        self.0.file.as_deref()
    }

    /// The place in the text.
    pub fn place(&self) -> Option<&Place> {
        self.0.place.as_ref()
    }

    /// The key, with dots and indices.
    pub fn key(&self) -> &str {
        &self.0.key
    }

    /// The wrong value.
    pub fn value(&self) -> &str {
        &self.0.value
    }

    /// What would be right.
    pub fn expected(&self) -> &str {
        &self.0.expected
    }
}

impl fmt::Debug for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Inner { file, place, key, value, expected, .. } = &*self.0;
        if let Some(file) = file {
            write!(f, "{}:", file.display())?;
        }
        if let Some(Place { line, column, .. }) = place {
            let unnamed = if file.is_none() { "line " } else { "" };
            write!(f, "{unnamed}{line}:{column}:")?;
        }
        if file.is_some() || place.is_some() {
            write!(f, " ")?;
        }
        // What comes from a file may not command the terminal.
        let value = value.replace(char::is_control, "\u{fffd}");
        match (key.is_empty(), value.is_empty()) {
            (false, false) => write!(f, "{key} = {value}: ")?,
            (false, true) => write!(f, "{key}: ")?,
            (true, false) => write!(f, "{value}: ")?,
            (true, true) => {}
        }
        f.write_str(expected)
    }
}

impl Error for InputError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.0.source.as_deref().map(|source| source as &(dyn Error + 'static))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_lines_and_characters_from_one() {
        let text = "a = 1\nß = 22\r\nc = 3";
        let at = text.find("22").unwrap();
        let place = Place::of(text, at..at + 2);
        assert_eq!(place, Place { line: 2, column: 5, text: "ß = 22".into(), length: 2 });
        assert_eq!(Place::of(text, 0..1).line, 1);
        assert_eq!(Place::of(text, 99..100).line, 3);
        assert_eq!(Place::of("", 0..0), Place { line: 1, column: 1, text: String::new(), length: 0 });
        // The middle of a character is taken as its beginning.
        assert_eq!(Place::of("ß", 1..2).column, 1);
    }

    #[test]
    fn the_line_is_made_for_grep() {
        let error = InputError::new("ring.d_max", 1e9, "must be 0.1 to 100 metres");
        assert_eq!(error.to_string(), "ring.d_max = 1000000000: must be 0.1 to 100 metres");
        let error = error.in_file(Path::new("s.toml")).at(Place::of("\nx = 1e9", 5..8)).written("1e9");
        assert_eq!(error.to_string(), "s.toml:2:5: ring.d_max = 1e9: must be 0.1 to 100 metres");
    }
}

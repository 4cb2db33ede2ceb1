//! Reading files that may be anything.

use crate::InputError;
use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The most bytes of a file: a scenario with as many points as it may have takes less than a tenth.
pub const MOST_BYTES: u64 = 4 << 20;

/// What a file turns out to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// Nothing is in it.
    Empty,
    /// A controller.
    Blob,
    /// A world.
    Scenario,
    /// A comparison of methods.
    Campaign,
    /// The conditions of a simulation.
    Laboratory,
    /// JSON.
    Json,
    /// SVG or another kind of XML.
    Picture,
    /// Text with two bytes a character.
    Utf16,
    /// Text in an old encoding, or no text.
    Binary,
    /// Some other text.
    Text,
}

impl Found {
    /// What these bytes look like.
    pub fn of(bytes: &[u8]) -> Found {
        let text = match std::str::from_utf8(bytes) {
            _ if bytes.is_empty() => return Found::Empty,
            _ if bytes.starts_with(b"GRNb") => return Found::Blob,
            _ if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) => return Found::Utf16,
            Ok(text) if !text.contains('\0') => text.trim_start_matches('\u{feff}'),
            _ => return Found::Binary,
        };
        let begins = |mark: &str| text.trim_start().starts_with(mark);
        let has = |key: &str| text.lines().any(|line| line.trim_start().starts_with(key));
        match () {
            () if text.trim().is_empty() => Found::Empty,
            () if begins("{") => Found::Json,
            () if begins("<") => Found::Picture,
            () if has("[[method]]") || has("[[scenario]]") => Found::Campaign,
            () if has("[morphogen]") || has("[[target]]") || has("[ring]") => Found::Scenario,
            () if ["[localisation]", "[radio]", "[wheels]", "[timing]", "[proximity]"].into_iter().any(has) => {
                Found::Laboratory
            }
            () => Found::Text,
        }
    }

    /// What would be right where another kind of file is wanted.
    pub fn instead_of(self, wanted: Found) -> String {
        let example = match wanted {
            Found::Scenario => "; give a scenario such as scenarios/channel.toml",
            Found::Campaign => "; give a campaign such as campaigns/paper.toml",
            Found::Laboratory => "; give a laboratory: `grn lab ideal` prints one",
            Found::Blob => "; give a controller, a .grn file",
            _ => "",
        };
        let way_out = match (self, wanted) {
            (Found::Campaign, Found::Scenario) => "; run it with grn campaign, or give one of the scenarios it names",
            (Found::Scenario, Found::Campaign) => {
                "; a campaign is a file that names scenarios, such as campaigns/paper.toml"
            }
            (Found::Utf16 | Found::Binary, Found::Scenario | Found::Campaign | Found::Laboratory) => {
                "; save it as UTF-8 text if it is a text"
            }
            _ => example,
        };
        format!("this is {self}, not {wanted}{way_out}")
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Found::Empty => "an empty file",
            Found::Blob => "a blob (a controller)",
            Found::Scenario => "a scenario (a world)",
            Found::Campaign => "a campaign",
            Found::Laboratory => "a laboratory",
            Found::Json => "a JSON file",
            Found::Picture => "a picture or web page",
            Found::Utf16 => "a text in UTF-16",
            Found::Binary => "a binary file",
            Found::Text => "some other text",
        })
    }
}

/// All bytes of a file, pipe or device, of which at most [`MOST_BYTES`] are read.
///
/// # Errors
/// A folder, a file that is too long, or what the operating system says.
pub fn read_bytes(path: &Path, wanted: Found) -> Result<Vec<u8>, InputError> {
    let fault = |error: io::Error| {
        let expected = match error.kind() {
            io::ErrorKind::IsADirectory => format!("this is a folder, not {wanted}; give a file in it"),
            _ => format!("cannot be read: {error}"),
        };
        InputError::new("", "", expected).from_source(error).in_file(path)
    };
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| {
        if file.metadata()?.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        file.take(MOST_BYTES + 1).read_to_end(&mut bytes)
    });
    read.map_err(fault)?;
    if bytes.len() as u64 > MOST_BYTES {
        let expected = format!("longer than {} MiB, so it is not {wanted}; give another file", MOST_BYTES >> 20);
        return Err(InputError::new("", "", expected).in_file(path));
    }
    Ok(bytes)
}

/// The text of a file, without the mark that some editors put at its beginning (BOM).
///
/// # Errors
/// As [`read_bytes`], or something else than UTF-8 text.
pub fn read_text(path: &Path, wanted: Found) -> Result<String, InputError> {
    let bytes = read_bytes(path, wanted)?;
    let found = Found::of(&bytes);
    match String::from_utf8(bytes) {
        Ok(text) if !matches!(found, Found::Empty | Found::Blob | Found::Binary | Found::Json | Found::Picture) => {
            Ok(text.trim_start_matches('\u{feff}').to_owned())
        }
        _ => Err(InputError::new("", "", found.instead_of(wanted)).in_file(path)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_say_what_a_file_is_instead() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let cases: [(&[u8], &str); 8] = [
            (b"", "an empty file"),
            (b" \n", "an empty file"),
            (b"GRNb\x01\xff", "a blob"),
            (b"\xff\xfen\0a\0", "UTF-16"),
            (b"name = \"caf\xe9\"", "a binary file"),
            (b"\x7fELF\0\0", "a binary file"),
            (b"{\"a\": 1}", "JSON"),
            (b"<svg/>", "a picture"),
        ];
        for (bytes, words) in cases {
            std::fs::write(&path, bytes).unwrap();
            let error = read_text(&path, Found::Scenario).unwrap_err().to_string();
            assert!(error.contains(words) && error.contains("not a scenario"), "{error}");
        }
        assert!(read_text(folder.path(), Found::Scenario).unwrap_err().to_string().contains("this is a folder"));
        assert!(
            read_text(&folder.path().join("no"), Found::Scenario).unwrap_err().to_string().contains("cannot be read")
        );
        std::fs::write(&path, "\u{feff}a = 1").unwrap();
        assert_eq!(read_text(&path, Found::Scenario).unwrap(), "a = 1");
        std::fs::write(&path, vec![b'#'; MOST_BYTES as usize + 1]).unwrap();
        assert!(read_text(&path, Found::Scenario).unwrap_err().to_string().contains("longer than 4 MiB"));
    }
}

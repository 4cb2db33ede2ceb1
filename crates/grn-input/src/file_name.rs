//! Names that people give to things, as names of files.

use crate::InputError;
use sha2::Digest;

/// The most bytes of a file name; with what is added to it, such as `-seed-18446744073709551615.svg`, it stays far below
/// the 255 that file systems allow.
const MOST_BYTES: usize = 80;
/// Hexadecimal digits of the hash that tells changed names apart.
const DIGITS: usize = 12;
/// Names of devices, which Windows takes for no file even with an extension.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];

/// The most bytes of a name.
const MOST_NAME_BYTES: usize = 1000;

/// Checks that a text can name something: one line with letters or digits, not too long for a table.
///
/// # Errors
/// The key, the name and what is wrong with it.
pub fn check_name(key: &str, name: &str) -> Result<(), InputError> {
    let fault = |expected: String| Err(InputError::new(key, format!("{name:?}"), expected));
    match () {
        () if !name.chars().any(char::is_alphanumeric) => fault("a name with letters or digits is needed".into()),
        () if name.chars().any(char::is_control) => fault("a name is one line without control characters".into()),
        () if name.len() > MOST_NAME_BYTES => {
            let shown: String = name.chars().take(20).collect();
            let expected = format!("a name of {} bytes is too long; at most {MOST_NAME_BYTES} are allowed", name.len());
            Err(InputError::new(key, format!("\"{shown} …\""), expected))
        }
        () => Ok(()),
    }
}

/// The name of the file or folder for something that a person has named: one part of a path that is safe everywhere.
///
/// A name of letters, digits, spaces and `- _ . , + ( )`, that begins with a letter or digit, does not end with a dot or
/// space, is no name of a device and has at most 80 bytes, stays as it is. Of every other name the forbidden parts become
/// dashes, it is cut, and the beginning of its SHA-256 is added, so that two names never get the same file name.
pub fn file_name(name: &str) -> String {
    let allowed = |character: char| character.is_alphanumeric() || " -_.,+()".contains(character);
    let begins_well = name.chars().next().is_some_and(char::is_alphanumeric);
    let ends_well = !name.ends_with(['.', ' ']);
    if begins_well && ends_well && name.len() <= MOST_BYTES && name.chars().all(allowed) && !is_device(name) {
        return name.to_owned();
    }
    let mut kept = String::new();
    for character in name.chars() {
        let room = kept.len() + character.len_utf8() + 1 + DIGITS <= MOST_BYTES;
        if character.is_alphanumeric() && room {
            kept.push(character);
        } else if !kept.is_empty() && !kept.ends_with('-') && room {
            kept.push('-');
        }
    }
    let hash = sha2::Sha256::digest(name);
    let digits: String = hash.iter().map(|byte| format!("{byte:02x}")).collect();
    let kept = match kept.trim_end_matches('-') {
        "" => "name",
        kept => kept,
    };
    format!("{kept}-{}", &digits[..DIGITS])
}

fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_lowercase();
    DEVICES.contains(&stem.trim_end_matches(|last: char| last.is_ascii_digit())) && stem.len() <= 4
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::{Component, Path};

    #[test]
    fn usual_names_stay() {
        for name in ["channel", "compound-channel", "MOGP, all motifs", "my_world 2", "Ring (wide)", "v1.2", "Äpfel"] {
            assert_eq!(file_name(name), name);
        }
    }

    #[test]
    fn name_leaves_runs_no_more() {
        let long = "x".repeat(300);
        let longer = "x".repeat(301);
        let wide = "ü".repeat(200);
        let hostile = [
            "../../x",
            "/etc/passwd",
            "",
            ".",
            "..",
            "a/../b",
            "a\\b",
            "C:x",
            "nul",
            "NUL.txt",
            "com1",
            "lpt9.svg",
            "a.",
            "a ",
            " a",
            "-rf",
            ".hidden",
            "a\0b",
            "a\nb",
            "~root",
            "$HOME",
            "a*b",
            "\u{202e}x",
            "💥",
            &long,
            &longer,
            &wide,
        ];
        let mut seen = std::collections::HashSet::new();
        for name in hostile {
            let safe = file_name(name);
            let parts: Vec<_> = Path::new(&safe).components().collect();
            assert!(matches!(parts[..], [Component::Normal(_)]), "{name:?} became {safe:?}");
            assert!(safe.len() <= MOST_BYTES && !safe.starts_with(['.', '-', ' ']), "{name:?} became {safe:?}");
            assert!(!safe.ends_with(['.', ' ']) && !is_device(&safe), "{name:?} became {safe:?}");
            assert!(!safe.contains(['/', '\\', ':', '\0', '\n', '*', '$', '~']), "{name:?} became {safe:?}");
            assert!(seen.insert(safe.clone()), "{name:?} became {safe:?}, as another did");
        }
        assert!(file_name("con-1").eq("con-1") && file_name("computer").eq("computer"));
    }
}

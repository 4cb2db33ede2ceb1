//! Paths in commands for other programs: a POSIX shell, and GDB's own command language.

use std::borrow::Cow;

/// One word for a POSIX shell.
pub fn shell_word(text: &str) -> Cow<'_, str> {
    // The only text that cannot be quoted holds a NUL, which no path and no argument of a program does.
    shlex::try_quote(text).unwrap_or(Cow::Borrowed(text))
}

/// The GDB command that loads a file into the target's memory.
///
/// GDB splits the arguments of `load` at white space; backslashes and quotes protect it (libiberty's `buildargv`). A line
/// of a script cannot hold a line break, but the format string of `eval` can.
pub fn gdb_load(path: &str) -> String {
    let command = format!("load {}", gdb_word(path));
    if !command.contains('\n') {
        return command;
    }
    let format = command.replace('\\', r"\\").replace('"', "\\\"").replace('%', "%%").replace('\n', r"\n");
    format!("eval \"{format}\"")
}

/// One word for `buildargv`. Old and new releases of GDB read a backslash between quotes differently, and a backslash
/// before a line break as well; so backslashes stay outside quotes, and only control characters go inside them.
fn gdb_word(text: &str) -> String {
    let mut word = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            ' ' | '\t' | '\\' | '"' | '\'' => word.extend(['\\', letter]),
            control if control.is_ascii_control() => word.extend(['\'', control, '\'']),
            other => word.push(other),
        }
    }
    word
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words that `buildargv` of GDB 13 (`posix` false) or of GDB 15 and later (`posix` true) makes of a line.
    fn buildargv(line: &str, posix: bool) -> Vec<String> {
        let mut words = vec![String::new()];
        let (mut quote, mut letters) = (None, line.chars());
        while let Some(letter) = letters.next() {
            let word = words.last_mut().unwrap();
            match (quote, letter) {
                (Some('\''), '\\') if posix => word.push(letter),
                (_, '\\') => match letters.next() {
                    Some('\n') if posix => {}
                    next => word.extend(next),
                },
                (Some(open), close) if open == close => quote = None,
                (None, '\'' | '"') => quote = Some(letter),
                (None, space) if space.is_ascii_whitespace() || space == '\x0b' => words.push(String::new()),
                _ => word.push(letter),
            }
        }
        words
    }

    /// What `eval` makes of its format string.
    fn evaluated(command: &str) -> String {
        let Some(format) = command.strip_prefix("eval \"").and_then(|rest| rest.strip_suffix('"')) else {
            return command.into();
        };
        let (mut text, mut letters) = (String::new(), format.chars());
        while let Some(letter) = letters.next() {
            match letter {
                '\\' => text.push(letters.next().map(|next| if next == 'n' { '\n' } else { next }).unwrap()),
                '%' => assert_eq!(letters.next().inspect(|_| text.push('%')), Some('%')),
                '"' => panic!("the format string ends early"),
                other => text.push(other),
            }
        }
        text
    }

    #[test]
    fn awkward_paths_stay_one_word_for_gdb_and_for_the_shell() {
        let awkward = [
            "fl ash",
            "it's",
            "say \"ring\"",
            "back\\slash",
            "line\nbreak",
            "tab\there",
            "100 % sure",
            "%d",
            "a\\\nb",
            "a '\n' b",
            "a \r\x0b\x0c b",
            "$HOME `id` !x",
            "#;&|<>*?[]{}~",
            "größe",
            "trailing ",
            " leading",
            "'",
            "\"\n'",
        ];
        for name in awkward {
            let path = format!("/data/{name}/slot.hex");
            let command = gdb_load(&path);
            assert!(!command.contains('\n'), "{command:?}");
            for posix in [false, true] {
                assert_eq!(buildargv(&evaluated(&command), posix), ["load", &path], "{command:?}");
            }
            let line = format!("dfu-util -D {}", shell_word(&path));
            assert_eq!(shlex::split(&line).unwrap(), ["dfu-util", "-D", &path], "{line:?}");
        }
        assert_eq!(gdb_load("/data/slot.hex"), "load /data/slot.hex");
    }
}

//! Where a bracket or a long string was opened that is not closed: TOML readers tell only where they noticed.

/// The byte at which something was opened before the line of `noticed` that is still open there, and what it is: a bracket
/// whose list goes on into a line that is a key or a header, or a string of several lines without an end.
pub fn unclosed(text: &str, noticed: usize) -> Option<(usize, &'static str)> {
    let line_start = text.get(..noticed.min(text.len()))?.rfind('\n').map_or(0, |newline| newline + 1);
    let line = text.get(line_start..)?.lines().next().unwrap_or_default();
    let mut open: Vec<(usize, &'static str)> = Vec::new();
    let mut at = 0;
    while at < line_start {
        let rest = &text[at..];
        let first = rest.chars().next()?;
        let skipped = match first {
            '#' => rest.find('\n').unwrap_or(rest.len()),
            '"' | '\'' => match string_length(rest) {
                Some(length) => length,
                None if rest.starts_with("\"\"\"") || rest.starts_with("'''") => {
                    return Some(opened((at, &rest[..3])));
                }
                None => rest.find('\n').unwrap_or(rest.len()),
            },
            '[' => {
                open.push((at, "["));
                1
            }
            '{' => {
                open.push((at, "{"));
                1
            }
            ']' | '}' => {
                open.pop();
                1
            }
            other => other.len_utf8(),
        };
        at += skipped;
    }
    // Within a list, a wrong line that is no key and no header is wrong by itself.
    let goes_on = is_key_or_header(line) || line.trim().is_empty();
    open.pop().filter(|_| goes_on)
}

fn opened((at, mark): (usize, &str)) -> (usize, &'static str) {
    (at, if mark.starts_with('"') { "\"\"\"" } else { "'''" })
}

fn is_key_or_header(line: &str) -> bool {
    let line = line.trim_start();
    let name = line.trim_start_matches('[').trim_start();
    let (word, rest) =
        name.split_at(name.find(|c: char| !(c.is_alphanumeric() || "-_.".contains(c))).unwrap_or(name.len()));
    let is_word = word.chars().any(char::is_alphabetic);
    let header = line.starts_with('[') && rest.trim_start().starts_with(']');
    is_word && (header || rest.trim_start().starts_with('='))
}

/// The length of the string that a text begins with, quotes included; none if it does not end.
fn string_length(text: &str) -> Option<usize> {
    let quote = &text[..1];
    let long = quote.repeat(3);
    let (mark, one_line) = if text.starts_with(&long) { (long.as_str(), false) } else { (quote, true) };
    let mut at = mark.len();
    loop {
        let rest = text.get(at..)?;
        let next = rest.chars().next()?;
        match next {
            _ if rest.starts_with(mark) => return Some(at + mark.len()),
            '\n' if one_line => return None,
            '\\' if quote == "\"" => at += 1 + rest.chars().nth(1)?.len_utf8(),
            other => at += other.len_utf8(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_open_is_found_where_it_was_opened() {
        let at = |text: &str, noticed: &str| unclosed(text, text.find(noticed).unwrap());
        assert_eq!(at("a = [1, 2\nb = 3", "b"), Some((4, "[")));
        assert_eq!(at("a = [[1, 2]\n\n[[wall]]", "[[w"), Some((4, "[")));
        assert_eq!(at("a = [[1, 2], [3\n[ring]", "[r"), Some((13, "[")));
        assert_eq!(at("a = { b = 1\nc = 2", "c"), Some((4, "{")));
        assert_eq!(at("s = \"[\" # [\nb = 3", "b"), None);
        assert_eq!(at("s = '''x\ny = 1\nz", "z"), Some((4, "'''")));
        assert_eq!(at("s = \"\"\"x\ny\"\"\"\nz = ", "z"), None);
        // A comma is missing in the list itself.
        assert_eq!(at("a = [\n[1, 2]\n[3, 4]\n]", "[3"), None);
        assert_eq!(unclosed("", 0), None);
    }
}

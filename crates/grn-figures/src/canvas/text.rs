//! Text: how wide it is, and which parts of it are symbols and subscripts.

/// Widths of the printable ASCII characters in DejaVu Sans, in thousandths of the font size: the widest font that a viewer
/// is likely to take. In a narrower one (Helvetica, Arial, Liberation Sans) labels have room to spare.
#[rustfmt::skip]
const WIDTHS: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698,
    770, 632, 575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635, 611, 732,
    684, 989, 685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352, 635,
    634, 278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,
    525, 636, 337, 636, 838,
];

/// Size of a subscript relative to the text it belongs to.
pub(crate) const SUB: f64 = 0.74;

/// How much wider bold text is.
pub(crate) const BOLD: f64 = 1.12;

/// How a run of text is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Plain,
    /// A variable: italic.
    Symbol,
    /// An index: small and lowered.
    Sub,
}

/// A stretch of text set in one way.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Run {
    pub text: String,
    pub kind: Kind,
}

/// Splits text into runs: one letter followed by digits (`x1`, `G12`, `f₂`) is a symbol with an index,
/// Greek letters are symbols, all else is plain.
pub(crate) fn runs(text: &str) -> Vec<Run> {
    let chars: Vec<char> = text.chars().collect();
    let mut runs: Vec<Run> = Vec::new();
    let mut push = |text: &[char], kind: Kind, fresh: bool| match runs.last_mut() {
        Some(last) if last.kind == kind && !fresh => last.text.extend(text),
        _ => runs.push(Run { text: text.iter().collect(), kind }),
    };
    let mut at = 0;
    while at < chars.len() {
        let c = chars[at];
        let starts_word = at == 0 || !chars[at - 1].is_alphanumeric();
        let digits = chars[at + 1..].iter().take_while(|d| d.is_ascii_digit() || is_low_digit(**d)).count();
        let next_is_letter = chars.get(at + 1 + digits).is_some_and(|d| d.is_alphabetic());
        if c.is_alphabetic() && starts_word && digits > 0 && !next_is_letter {
            push(&[c], Kind::Symbol, true);
            let index: Vec<char> = chars[at + 1..=at + digits].iter().map(|d| plain_digit(*d)).collect();
            push(&index, Kind::Sub, true);
            at += 1 + digits;
        } else {
            let greek = ('α'..='ω').contains(&c);
            push(&[c], if greek { Kind::Symbol } else { Kind::Plain }, false);
            at += 1;
        }
    }
    runs
}

fn is_low_digit(c: char) -> bool {
    ('₀'..='₉').contains(&c)
}

fn plain_digit(c: char) -> char {
    match (c as u32).checked_sub('₀' as u32) {
        Some(value @ 0..=9) => char::from(b'0' + value as u8),
        _ => c,
    }
}

fn char_width(c: char) -> f64 {
    let thousandths = match (c as usize).checked_sub(32) {
        Some(index) if index < WIDTHS.len() => WIDTHS[index],
        _ => match c {
            '·' => 318,
            '°' | '–' => 500,
            '×' | '≥' | '≤' => 838,
            // Chinese, Japanese and Korean letters, wide forms and pictures fill a square.
            '…' | '\u{1100}'..='\u{11FF}' | '\u{2E80}'.. => 1000,
            _ => 634,
        },
    };
    f64::from(thousandths) / 1000.0
}

/// Width of a run at a font size, in the size's unit.
pub(crate) fn run_width(run: &Run, size: f64) -> f64 {
    let size = if run.kind == Kind::Sub { size * SUB } else { size };
    run.text.chars().map(char_width).sum::<f64>() * size
}

/// Width of text at a font size, as [`runs`] sets it.
pub(crate) fn width(text: &str, size: f64, bold: bool) -> f64 {
    let natural: f64 = runs(text).iter().map(|run| run_width(run, size)).sum();
    if bold { natural * BOLD } else { natural }
}

/// Breaks words or an expression after commas and spaces into lines no wider than `limit` where these allow it: no more
/// lines than it takes, and these as even as can be.
pub(crate) fn wrap(text: &str, size: f64, limit: f64) -> Vec<String> {
    let mut lines = filled(text, size, limit);
    loop {
        let widest = lines.iter().map(|line| width(line, size, false)).fold(0.0, f64::max);
        let narrower = filled(text, size, widest - 0.1);
        let its_widest = narrower.iter().map(|line| width(line, size, false)).fold(0.0, f64::max);
        if narrower.len() > lines.len() || its_widest >= widest {
            return lines;
        }
        lines = narrower;
    }
}

/// [`wrap`] into at most `most` lines, none wider than `limit`: words that are too wide are broken anywhere, and what is
/// left over is cut off with an ellipsis.
pub(crate) fn lines(text: &str, size: f64, limit: f64, most: usize) -> Vec<String> {
    let too_wide = |line: &str| width(line, size, false) > limit;
    let mut lines = wrap(text, size, limit);
    if lines.iter().any(|line| too_wide(line)) {
        lines = broken(text, size, limit);
    }
    if lines.len() > most.max(1) {
        lines.truncate(most.max(1));
        if let Some(last) = lines.last_mut() {
            while !last.is_empty() && too_wide(&format!("{last}…")) {
                last.pop();
            }
            last.push('…');
        }
    }
    lines
}

/// Lines that each take as many words as they can, and of a word that is too wide as many letters.
fn broken(text: &str, size: f64, limit: f64) -> Vec<String> {
    let mut pieces = Vec::new();
    for word in text.split_inclusive([',', ' ']) {
        let mut piece = String::new();
        for letter in word.chars() {
            if !piece.is_empty() && width(format!("{piece}{letter}").trim_end(), size, false) > limit {
                pieces.push(std::mem::take(&mut piece));
            }
            piece.push(letter);
        }
        pieces.push(piece);
    }
    filled_with(pieces.iter().map(String::as_str), size, limit)
}

/// Lines that each take as much as they can.
fn filled(text: &str, size: f64, limit: f64) -> Vec<String> {
    filled_with(text.split_inclusive([',', ' ']), size, limit)
}

fn filled_with<'a>(parts: impl Iterator<Item = &'a str>, size: f64, limit: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for part in parts {
        let Some(line) = lines.last_mut() else {
            continue;
        };
        if !line.is_empty() && width(&format!("{line}{}", part.trim_end()), size, false) > limit {
            lines.push(part.to_owned());
        } else {
            line.push_str(part);
        }
    }
    lines.iter().map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<(String, Kind)> {
        runs(text).into_iter().map(|run| (run.text, run.kind)).collect()
    }

    #[test]
    fn indices_are_subscripts_and_words_are_not() {
        let x2 = [("x".to_owned(), Kind::Symbol), ("2".to_owned(), Kind::Sub)];
        assert_eq!(kinds("x2"), x2);
        assert_eq!(kinds("x₂"), x2);
        assert_eq!(kinds("NAND"), [("NAND".to_owned(), Kind::Plain)]);
        assert_eq!(kinds("e-puck2"), [("e-puck2".to_owned(), Kind::Plain)]);
        assert_eq!(kinds("t = 3 s").len(), 1);
    }

    #[test]
    fn wrapping_loses_no_character() {
        let text = "XNOR(NAND(x1,x1),ANDN(x2,XOR(x1,x2)))";
        let lines = wrap(text, 8.0, 60.0);
        assert!(lines.len() > 1);
        assert_eq!(lines.concat(), text);
    }

    #[test]
    fn wrapped_lines_are_even() {
        let limit = width("printed NAND-XNOR (1", 8.0, false);
        assert_eq!(wrap("printed NAND-XNOR (1 B)", 8.0, limit), ["printed", "NAND-XNOR (1 B)"]);
        assert_eq!(wrap("one two", 8.0, 1000.0), ["one two"]);
        assert!(wrap("", 8.0, 10.0).is_empty());
    }

    #[test]
    fn a_long_name_is_broken_and_then_cut() {
        let name = "a".repeat(60);
        let all = lines(&name, 8.0, 60.0, 99);
        assert!(all.len() > 3 && all.concat() == name);
        assert!(all.iter().all(|line| width(line, 8.0, false) <= 60.0));
        let cut = lines(&name, 8.0, 60.0, 2);
        assert_eq!(cut.len(), 2);
        assert!(cut[1].ends_with('…') && width(&cut[1], 8.0, false) <= 60.0);
        assert_eq!(lines("one two", 8.0, 1000.0, 2), ["one two"]);
        assert!(lines("", 8.0, 10.0, 2).is_empty());
        assert!(!lines("wide", 8.0, 0.1, 3).is_empty());
    }

    #[test]
    fn widths_are_those_of_the_font() {
        assert!((width("Mi", 10.0, false) - 11.41).abs() < 1e-9);
    }
}

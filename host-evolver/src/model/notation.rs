//! The one notation for models: expressions in prefix form with θ in square brackets,
//! `(XNOR[0.9256] (NAND[0.8393] x1 x1) x2)`. Files, tables, figures and [`Tree`](super::tree::Tree)'s text are all written here.

use grn_core::motif::Motif;
use serde::{Deserialize, Serialize};
use std::fmt::{Display, Write as _};

/// One of the two inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Terminal {
    /// Morphogen of the targets.
    X1,
    /// Morphogen of the obstacles.
    X2,
}

/// How θ are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digits {
    /// With all digits, for files: reading gives the same number.
    All,
    /// With four decimals, for people.
    Four,
    /// Not at all: the structure alone, `(XNOR (NAND x1 x1) x2)`.
    None,
}

impl Digits {
    /// θ as text; `None` where it is left out.
    pub fn of(self, theta: impl Display) -> Option<String> {
        match self {
            Digits::All => Some(theta.to_string()),
            Digits::Four => Some(format!("{theta:.4}")),
            Digits::None => None,
        }
    }
}

/// A node of an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part<T> {
    /// An input.
    Input(Terminal),
    /// A motif with its θ and how many operands follow.
    Motif(Motif, T, usize),
}

/// The name of an input.
pub fn input_name(input: Terminal) -> &'static str {
    match input {
        Terminal::X1 => "x1",
        Terminal::X2 => "x2",
    }
}

/// The input of a name.
pub fn input_of(name: &str) -> Option<Terminal> {
    [Terminal::X1, Terminal::X2].into_iter().find(|&input| input_name(input) == name)
}

/// Writes an expression from its parts in prefix order.
pub fn expression<T: Display>(parts: impl IntoIterator<Item = Part<T>>, digits: Digits) -> String {
    let mut text = String::new();
    // For each open bracket: how many operands are still to come.
    let mut open: Vec<usize> = Vec::new();
    for part in parts {
        if !text.is_empty() {
            text.push(' ');
        }
        match part {
            Part::Input(input) => text.push_str(input_name(input)),
            Part::Motif(motif, theta, operands) => {
                let theta = digits.of(theta).map(|theta| format!("[{theta}]")).unwrap_or_default();
                // Writing to memory cannot fail.
                let _ = write!(text, "({}{theta}", motif.name());
                open.push(operands);
                continue;
            }
        }
        while let Some(missing) = open.last_mut() {
            *missing -= 1;
            if *missing > 0 {
                break;
            }
            open.pop();
            text.push(')');
        }
    }
    text
}

/// A motif and its θ from a word like `NAND[0.8393]`.
pub fn parse_motif(word: &str) -> Option<(Motif, f64)> {
    let (name, theta) = word.strip_suffix(']')?.split_once('[')?;
    let motif = Motif::ALL.into_iter().find(|motif| motif.name() == name)?;
    let theta = theta.parse().ok().filter(|theta: &f64| theta.is_finite())?;
    Some((motif, theta))
}

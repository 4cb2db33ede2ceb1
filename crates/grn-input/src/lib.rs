//! Reads the files that people write for grn, and says where and what is wrong with them.
//!
//! A TOML file is read in three steps: [`read_text`] reads a bounded number of bytes and says what else a file is if it is
//! no text; `toml` parses it; and its user checks what was parsed, naming a key and a value for whatever is wrong. The
//! place of that key in the text, line and column, is found afterwards, so checks need not carry places around.

mod error;
mod file_name;
mod found;
mod range;
mod syntax;
mod toml;

pub use error::{InputError, Place};
pub use file_name::{check_name, file_name};
pub use found::{Found, MOST_BYTES, read_bytes, read_text};
pub use range::Range;
pub use toml::{Pair, locate, parse};

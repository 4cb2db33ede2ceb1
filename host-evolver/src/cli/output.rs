//! What the command line says. The work does not depend on who listens: a message that nobody can read is dropped, and only
//! what a command was asked to print is missed when it cannot be printed.

use super::Failure;
use std::fmt;
use std::io::{self, ErrorKind, Write};

/// Tells on standard output what was done. It also stands in files or follows from the exit code, so it may get lost.
pub fn report(text: impl fmt::Display) {
    let _ = line(io::stdout(), text);
}

/// Tells on standard error.
pub fn notice(text: impl fmt::Display) {
    let _ = line(io::stderr(), text);
}

/// Whether somebody still reads standard output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reader {
    Listens,
    Gone,
}

/// Prints what the command was called for. A reader that has seen enough and went away, as `head` does, is no failure.
pub fn product(text: impl fmt::Display) -> Result<Reader, Failure> {
    match line(io::stdout(), text) {
        Ok(()) => Ok(Reader::Listens),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(Reader::Gone),
        Err(error) => Err(cannot_print(&error)),
    }
}

/// Standard output is the system's, whatever it says.
pub fn cannot_print(error: &io::Error) -> Failure {
    Failure::System(format!("standard output: cannot be written: {error}"))
}

/// Prints a value as JSON.
pub fn product_json(value: &serde_json::Value) -> Result<Reader, Failure> {
    product(format_args!("{value:#}"))
}

fn line(mut stream: impl Write, text: impl fmt::Display) -> io::Result<()> {
    // One piece, so that the lines of two threads or programs do not mix.
    stream.write_all(format!("{text}\n").as_bytes())?;
    stream.flush()
}

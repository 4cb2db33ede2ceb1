//! What goes wrong with a file, and whose fault it is.

use grn_input::InputError;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// What went wrong with a file.
#[derive(Debug)]
pub struct FileError {
    path: PathBuf,
    fault: String,
    source: Option<io::Error>,
    is_damage: bool,
}

impl FileError {
    /// `fault` says what is wrong with the file and what to do.
    pub fn new(path: impl Into<PathBuf>, fault: impl fmt::Display) -> Self {
        FileError { path: path.into(), fault: fault.to_string(), source: None, is_damage: false }
    }

    /// The content of a file is not what it was when it was written.
    pub fn damaged(path: impl Into<PathBuf>, fault: impl fmt::Display) -> Self {
        FileError { is_damage: true, ..FileError::new(path, format_args!("damaged: {fault}")) }
    }

    /// Whether the file is damaged, and neither out of reach nor of another kind.
    pub fn is_damage(&self) -> bool {
        self.is_damage
    }

    /// The operating system refused what was to be `done`: `written`, `read`.
    pub fn from_system(path: impl Into<PathBuf>, done: &str, source: io::Error) -> Self {
        let source = with_way_out(source);
        FileError { path: path.into(), fault: format!("cannot be {done}"), source: Some(source), is_damage: false }
    }
}

/// What the user may do about it, where that is not plain.
fn with_way_out(error: io::Error) -> io::Error {
    let way_out = match error.kind() {
        io::ErrorKind::PermissionDenied => "change its permissions, or name another place",
        io::ErrorKind::ReadOnlyFilesystem => "name a place on a disk that can be written",
        io::ErrorKind::NotADirectory => "a part of its path is no folder; name another place",
        _ => return error,
    };
    io::Error::new(error.kind(), format!("{error}; {way_out}"))
}

impl From<InputError> for FileError {
    fn from(error: InputError) -> Self {
        FileError::new(error.file().unwrap_or(Path::new("")), error.expected())
    }
}

/// Whether the system failed, and not what it was asked for: a full disk, a broken device, too many open files.
pub fn is_fault_of_system(error: &io::Error) -> bool {
    use io::ErrorKind as Kind;
    /// EIO, ENFILE and EMFILE of every Unix, for which the standard library has no names.
    const UNNAMED: [i32; 3] = [5, 23, 24];
    matches!(
        error.kind(),
        Kind::StorageFull
            | Kind::QuotaExceeded
            | Kind::FileTooLarge
            | Kind::WriteZero
            | Kind::OutOfMemory
            | Kind::BrokenPipe
    ) || cfg!(unix) && error.raw_os_error().is_some_and(|code| UNNAMED.contains(&code))
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.fault)
    }
}

impl std::error::Error for FileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.source.as_ref().map(|error| error as _)
    }
}

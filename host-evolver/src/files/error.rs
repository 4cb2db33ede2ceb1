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
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Out of reach, of another kind, or not to be written.
    Refused,
    /// Its content is not what it was when it was written.
    Damaged,
    /// This program cannot make its content.
    Internal,
}

impl FileError {
    /// `fault` says what is wrong with the file and what to do.
    pub fn new(path: impl Into<PathBuf>, fault: impl fmt::Display) -> Self {
        FileError { path: path.into(), fault: fault.to_string(), source: None, kind: Kind::Refused }
    }

    /// The content of a file is not what it was when it was written.
    pub fn damaged(path: impl Into<PathBuf>, fault: impl fmt::Display) -> Self {
        FileError { kind: Kind::Damaged, ..FileError::new(path, format_args!("damaged: {fault}")) }
    }

    /// Whether the file is damaged, and neither out of reach nor of another kind.
    pub fn is_damage(&self) -> bool {
        self.kind == Kind::Damaged
    }

    /// This program cannot make the content of a file, although all that it was given has been checked.
    pub fn internal(path: impl Into<PathBuf>, fault: impl fmt::Display) -> Self {
        FileError { kind: Kind::Internal, ..FileError::new(path, fault) }
    }

    /// Whether it is this program's fault.
    pub fn is_internal(&self) -> bool {
        self.kind == Kind::Internal
    }

    /// The operating system refused what was to be `done`: `written`, `read`.
    pub fn from_system(path: impl Into<PathBuf>, done: &str, source: io::Error) -> Self {
        let source = with_way_out(source);
        FileError { path: path.into(), fault: format!("cannot be {done}"), source: Some(source), kind: Kind::Refused }
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

/// Whether the system failed, and not what it was asked for: a full disk, a broken device, too many open files. Whatever is
/// none of the usual answers to a wrong name counts as such.
pub fn is_fault_of_system(error: &io::Error) -> bool {
    use io::ErrorKind as Kind;
    /// ENXIO, ENODEV and, of Linux and of macOS, ELOOP: a wrong device, a link to itself. The library has no names for them.
    const UNNAMED: [i32; 4] = [6, 19, 40, 62];
    let is_of_input = matches!(
        error.kind(),
        // Names and paths.
        Kind::NotFound
            | Kind::PermissionDenied
            | Kind::AlreadyExists
            | Kind::IsADirectory
            | Kind::NotADirectory
            | Kind::DirectoryNotEmpty
            | Kind::InvalidFilename
            | Kind::InvalidInput
            | Kind::ReadOnlyFilesystem
            | Kind::CrossesDevices
            | Kind::TooManyLinks
            | Kind::NotSeekable
            | Kind::Unsupported
            | Kind::ResourceBusy
            | Kind::ExecutableFileBusy
            // What was read.
            | Kind::InvalidData
            | Kind::UnexpectedEof
            // Hosts.
            | Kind::ConnectionRefused
            | Kind::HostUnreachable
            | Kind::NetworkUnreachable
            | Kind::AddrNotAvailable
    );
    let is_unnamed = cfg!(unix) && error.raw_os_error().is_some_and(|code| UNNAMED.contains(&code));
    !(is_of_input || is_unnamed)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_name_is_no_fault_of_the_system_and_a_broken_disk_is() {
        let faulty = |code| is_fault_of_system(&io::Error::from_raw_os_error(code));
        if cfg!(target_os = "linux") {
            // ENOENT, EACCES, EEXIST, ENOTDIR, EISDIR, EINVAL, ENXIO, ENAMETOOLONG, ELOOP, EROFS, ETXTBSY.
            let of_input = [2, 13, 17, 20, 21, 22, 6, 36, 40, 30, 26].map(faulty);
            // EIO, ENOMEM, ENFILE, EMFILE, EFBIG, ENOSPC, EPIPE, EDQUOT, ENOLCK, ESTALE, EUCLEAN of a broken file system.
            let of_system = [5, 12, 23, 24, 27, 28, 32, 122, 37, 116, 117].map(faulty);
            assert_eq!((of_input, of_system), ([false; 11], [true; 11]));
        }
    }
}

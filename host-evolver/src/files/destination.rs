//! Where something is written that a user has named: a file, through links if it is one, or a device or pipe that stays what
//! it is.

use super::error::FileError;
use std::fs::{File, Metadata, OpenOptions, Permissions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// How names of files and folders begin while they are being written.
pub(super) const UNFINISHED: &str = ".unfinished-";

/// Links that lead on to links, at most; as many as Linux follows.
const MOST_LINKS: usize = 40;

/// What a path leads to.
enum Destination {
    /// A file that is replaced as a whole, or is not there yet. The path is that of the file itself.
    File(PathBuf, Option<Metadata>),
    /// A device, a pipe, or an open file of a process: something that takes bytes and is never replaced.
    Stream,
}

/// Writes a file under a temporary name in the same folder and renames it: readers see the old content or the new. A link
/// stays and its target is written; a device or a pipe gets the bytes.
///
/// # Errors
/// What the operating system says, with the path.
pub fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), FileError> {
    let attempt = || match destination(path)? {
        Destination::File(file, old) => replace(&file, old.as_ref(), content.as_ref()),
        Destination::Stream => {
            let mut stream = open_stream(path)?;
            stream.write_all(content.as_ref())?;
            stream.flush()
        }
    };
    attempt().map_err(|error| FileError::from_system(path, "written", error))
}

/// Finds out whether a file can be written there, and leaves nothing but the folder that it is to be in.
///
/// # Errors
/// What the operating system says, with the path.
pub fn probe(path: &Path) -> Result<(), FileError> {
    let attempt = || match destination(path)? {
        Destination::File(file, _) => {
            let folder = folder_of(&file);
            std::fs::create_dir_all(folder)?;
            temporary(folder).map(drop)
        }
        Destination::Stream => Ok(()),
    };
    attempt().map_err(|error| FileError::from_system(path, "written", error))
}

/// Writes several files that belong together: the first is replaced after all have been written under temporary names, so a
/// full disk, or a folder in the place of one of them, leaves the old ones as they were.
///
/// # Errors
/// What the operating system says, with the path.
pub fn write_together<'c>(files: impl IntoIterator<Item = (PathBuf, &'c [u8])>) -> Result<(), FileError> {
    let mut written = Vec::new();
    let mut streams = Vec::new();
    for (path, content) in files {
        let attempt = || match destination(&path)? {
            Destination::File(file, old) => Ok(Some((temporary_with(&file, old.as_ref(), content)?, file))),
            Destination::Stream => Ok(None),
        };
        match attempt().map_err(|error| FileError::from_system(&path, "written", error))? {
            Some(file) => written.push(file),
            None => streams.push((path, content)),
        }
    }
    for (temporary, path) in written {
        temporary.persist(&path).map_err(|error| FileError::from_system(&path, "written", error.error))?;
    }
    streams.into_iter().try_for_each(|(path, content)| write(&path, content))
}

fn destination(path: &Path) -> io::Result<Destination> {
    if names_a_folder(path) && !path.exists() {
        let fault = "it names a folder; add the name of a file";
        return Err(io::Error::new(ErrorKind::IsADirectory, fault));
    }
    match std::fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(io::Error::new(ErrorKind::IsADirectory, "it is a folder")),
        Ok(found) if found.is_file() => {
            // Behind /dev/stdout and the like is a file that a process has open: a new one in its place would not reach it.
            if ["/dev", "/proc"].iter().any(|of_system| path.starts_with(of_system)) {
                return Ok(Destination::Stream);
            }
            // A file that may not be written is not replaced either.
            OpenOptions::new().write(true).open(path)?;
            Ok(Destination::File(path.canonicalize()?, Some(found)))
        }
        Ok(found) => {
            check_stream(&found)?;
            Ok(Destination::Stream)
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Destination::File(end_of_links(path)?, None)),
        Err(error) => Err(error),
    }
}

#[cfg(unix)]
fn check_stream(found: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::FileTypeExt;
    let kind = found.file_type();
    let what = if kind.is_block_device() { "a disk" } else { "a socket" };
    if kind.is_block_device() || kind.is_socket() {
        return Err(io::Error::new(
            ErrorKind::InvalidInput,
            format!("it is {what}; name a file, a pipe or a terminal"),
        ));
    }
    Ok(())
}

#[cfg(not(unix))]
fn check_stream(_: &Metadata) -> io::Result<()> {
    Ok(())
}

/// The path at the end of links that lead to nothing yet.
fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    let mut end = path.to_owned();
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&end) {
            Ok(next) => end = folder_of(&end).join(next),
            Err(_) => return Ok(end),
        }
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "its links lead in a circle"))
}

/// Whether a path ends with `/` or `/.`, which the standard library leaves out where it takes paths apart.
fn names_a_folder(path: &Path) -> bool {
    let text = path.as_os_str().as_encoded_bytes();
    text.strip_suffix(b".").unwrap_or(text).last().is_some_and(|&last| std::path::is_separator(last.into()))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    // The library's own way to open it wraps errors, which hides their codes and names the temporary file to the user.
    tempfile::Builder::new().prefix(UNFINISHED).make_in(folder, create_private)
}

fn create_private(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true).write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path)
}

fn replace(path: &Path, old: Option<&Metadata>, content: &[u8]) -> io::Result<()> {
    temporary_with(path, old, content)?.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// A file beside `path` with the content and the permissions that it is to have.
fn temporary_with(path: &Path, old: Option<&Metadata>, content: &[u8]) -> io::Result<tempfile::NamedTempFile> {
    let folder = folder_of(path);
    std::fs::create_dir_all(folder)?;
    let mut file = temporary(folder)?;
    file.as_file_mut().write_all(content)?;
    file.as_file().sync_data()?;
    if let Some(permissions) = old.map(Metadata::permissions).or_else(usual_permissions) {
        file.as_file().set_permissions(permissions)?;
    }
    Ok(file)
}

/// Temporary files are private; results are for everybody.
#[cfg(unix)]
fn usual_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn usual_permissions() -> Option<Permissions> {
    None
}

/// A pipe is opened without waiting for somebody to read it, for nobody may ever do so.
#[cfg(unix)]
fn open_stream(path: &Path) -> io::Result<File> {
    use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
    use rustix::io::Errno;
    use std::os::unix::fs::OpenOptionsExt;
    use std::time::{Duration, Instant};
    const PATIENCE: Duration = Duration::from_secs(2);
    let begin = Instant::now();
    let no_wait = OFlags::NONBLOCK.bits() as i32;
    loop {
        match OpenOptions::new().append(true).custom_flags(no_wait).open(path) {
            Ok(stream) => {
                let flags = fcntl_getfl(&stream)?;
                fcntl_setfl(&stream, flags - OFlags::NONBLOCK)?;
                return Ok(stream);
            }
            Err(error) if Errno::from_io_error(&error) == Some(Errno::NXIO) => {
                if begin.elapsed() > PATIENCE {
                    return Err(io::Error::new(
                        ErrorKind::InvalidInput,
                        "nobody reads this pipe; start the reader first",
                    ));
                }
                std::thread::sleep(Duration::from_millis(20));
            }
            Err(error) => return Err(error),
        }
    }
}

#[cfg(not(unix))]
fn open_stream(path: &Path) -> io::Result<File> {
    OpenOptions::new().append(true).open(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_temporary_files_keep_their_code_and_do_not_name_them() {
        let scratch = tempfile::tempdir().unwrap();
        let error = temporary(&scratch.path().join("missing")).unwrap_err();
        assert!(error.raw_os_error().is_some() && !error.to_string().contains("unfinished"), "{error}");
    }
}

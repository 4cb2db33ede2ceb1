//! A folder belongs to one process while it is written.
//!
//! The lock is the operating system's own on a small file in the folder, so it ends with its holder, however that dies. The
//! file says who holds it; alone it means nothing.

use super::error::FileError;
use super::owner::check_place;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The name of the file that is locked.
pub(super) const LOCK: &str = ".grn-lock";

/// A new holder needs a moment to write down who it is. Whoever finds the lock taken reads the note this many times before
/// it reports an unknown holder.
const LOOKS: u32 = 10;

/// Keeps other processes out of a folder until it is dropped.
#[derive(Debug)]
pub struct FolderLock {
    folder: PathBuf,
    /// The operating system unlocks it when it is closed.
    _file: File,
    folder_is_new: bool,
}

impl FolderLock {
    /// Makes the folder if there is none, and locks it for `command`, which others are told if they want it meanwhile.
    ///
    /// # Errors
    /// What is no folder, a folder that somebody else holds, that a run or campaign further up fills, or that cannot be
    /// written.
    pub fn take(folder: &Path, command: &str) -> Result<FolderLock, FileError> {
        let cannot = |error| FileError::from_system(folder, "written", error);
        check_is_folder(folder)?;
        check_place(folder)?;
        let folder_is_new = !folder.exists();
        std::fs::create_dir_all(folder).map_err(cannot)?;
        let path = folder.join(LOCK);
        loop {
            let mut file = open(&path).map_err(cannot)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(held(folder)),
                Err(TryLockError::Error(error)) => return Err(FileError::from_system(folder, "locked", error)),
            }
            // The holder before may have deleted the file between our opening and locking it.
            if !is_at(&file, &path) {
                continue;
            }
            file.set_len(0).and_then(|()| file.write_all(holder(command).as_bytes())).map_err(cannot)?;
            return Ok(FolderLock { folder: folder.to_owned(), _file: file, folder_is_new });
        }
    }

    /// Refuses a folder that somebody writes.
    ///
    /// # Errors
    /// A locked folder, with its holder.
    pub fn check_free(folder: &Path) -> Result<(), FileError> {
        // Where there is no such file, or none that we may read, nobody of ours writes.
        let Ok(file) = File::open(folder.join(LOCK)) else { return Ok(()) };
        match file.try_lock_shared() {
            Err(TryLockError::WouldBlock) => Err(held(folder)),
            _ => Ok(()),
        }
    }

    /// The folder that is locked.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // Still locked, so this is no other holder's file. Elsewhere an open file cannot be deleted; it does no harm.
        if cfg!(unix) {
            let _ = std::fs::remove_file(self.folder.join(LOCK));
        }
        if self.folder_is_new {
            // Goes only if nothing has been written into it.
            let _ = std::fs::remove_dir(&self.folder);
        }
    }
}

fn check_is_folder(path: &Path) -> Result<(), FileError> {
    let Ok(found) = path.symlink_metadata() else { return Ok(()) };
    let what = match path.metadata() {
        Ok(found) if found.is_dir() => return Ok(()),
        Ok(found) if found.is_file() => "a file",
        Ok(_) => "a device, pipe or socket",
        Err(_) if found.is_symlink() => "a link that leads to nothing",
        // Whoever makes or opens it will say what is wrong.
        Err(_) => return Ok(()),
    };
    Err(FileError::new(path, format!("cannot be written: it is {what} and no folder; choose a folder with --out")))
}

fn open(path: &Path) -> io::Result<File> {
    if path.symlink_metadata().is_ok_and(|found| !found.is_file()) {
        let fault = format!("{LOCK} in it is no file; remove it");
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, fault));
    }
    OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)
}

#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), path.metadata()) {
        (Ok(ours), Ok(there)) => (ours.dev(), ours.ino()) == (there.dev(), there.ino()),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

fn held(folder: &Path) -> FileError {
    let mut holder = String::new();
    for _ in 0..LOOKS {
        holder = std::fs::read_to_string(folder.join(LOCK)).unwrap_or_default();
        if !holder.is_empty() {
            break;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let holder = if holder.is_empty() { "another process" } else { holder.trim() };
    FileError::new(folder, format!("in use by {holder}; wait for its end, or choose another folder with --out"))
}

fn holder(command: &str) -> String {
    let since = humantime::format_rfc3339_seconds(SystemTime::now());
    format!("process {}{} since {since}: {command}\n", std::process::id(), on_host())
}

#[cfg(unix)]
fn on_host() -> String {
    format!(" on {}", rustix::system::uname().nodename().to_string_lossy())
}

#[cfg(not(unix))]
fn on_host() -> String {
    String::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_has_one_holder_at_a_time_and_is_left_as_it_was() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = scratch.path().join("new");
        let first = FolderLock::take(&folder, "grn first").unwrap();
        let refused = FolderLock::take(&folder, "grn second").unwrap_err().to_string();
        let process = format!("process {}", std::process::id());
        for word in [process.as_str(), "since 2", "grn first", "--out"] {
            assert!(refused.contains(word), "{word} is not in {refused}");
        }
        assert!(FolderLock::check_free(&folder).is_err());
        drop(first);
        assert!(!folder.exists() && FolderLock::check_free(&folder).is_ok());
        std::fs::create_dir(&folder).unwrap();
        drop(FolderLock::take(&folder, "grn third").unwrap());
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
    }
}

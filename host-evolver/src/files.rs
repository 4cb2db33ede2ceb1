//! Reading and writing files: whole or not at all, with errors that name the file.

use grn_core::blob::{Blob, max_encoded_size};
use grn_core::network::DEFAULT_GENES;
use grn_input::{Found, InputError};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::DirEntry;
use std::io;
use std::path::{Path, PathBuf};

mod destination;
mod error;
mod ledger;
mod lock;
mod owner;
mod seal;

use destination::UNFINISHED;
pub use destination::{probe, write, write_together};
pub use error::{FileError, is_fault_of_system};
pub use ledger::{Contents, Ledger, remove_empty};
pub use lock::FolderLock;
pub use owner::{Owner, owner};
pub use seal::{sealed, sha256, unsealed};

/// Fills a new folder under a temporary name beside its place and renames it: it is there whole or not at all.
///
/// # Errors
/// What `fill` says, or the operating system.
pub fn write_folder(place: &Path, fill: impl FnOnce(&Path) -> Result<(), FileError>) -> Result<(), FileError> {
    let cannot = |error| FileError::from_system(place, "written", error);
    let above = place.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(above).map_err(cannot)?;
    let unfinished = tempfile::Builder::new().prefix(UNFINISHED).tempdir_in(above).map_err(cannot)?;
    fill(unfinished.path())?;
    set_usual_folder_permissions(unfinished.path()).map_err(cannot)?;
    std::fs::rename(unfinished.path(), place).map_err(cannot)?;
    // It is no longer where it would be deleted from.
    let _ = unfinished.keep();
    Ok(())
}

/// Deletes what killed processes left behind in a folder, and in those below it that are named; not in others, which may be
/// anybody's. Only for who holds the folder's lock: others may be writing those files.
///
/// # Errors
/// What the operating system says.
pub fn remove_unfinished(lock: &FolderLock, below: &[impl AsRef<str>]) -> Result<(), FileError> {
    remove_unfinished_in(lock.folder(), &|name| below.iter().any(|folder| folder.as_ref() == name))
}

fn remove_unfinished_in(folder: &Path, goes_into: &dyn Fn(&str) -> bool) -> Result<(), FileError> {
    for (name, entry) in entries(folder)? {
        let cannot = |error| FileError::from_system(entry.path(), "removed", error);
        let is_folder = entry.file_type().map_err(cannot)?.is_dir();
        match (is_folder, name.starts_with(UNFINISHED)) {
            (true, true) => std::fs::remove_dir_all(entry.path()).map_err(cannot)?,
            (true, false) if goes_into(&name) => remove_unfinished_in(&entry.path(), &|_| true)?,
            (false, true) => std::fs::remove_file(entry.path()).map_err(cannot)?,
            _ => {}
        }
    }
    Ok(())
}

/// What is in a folder, by name and in its order.
///
/// # Errors
/// What the operating system says.
pub fn entries(folder: &Path) -> Result<Vec<(String, DirEntry)>, FileError> {
    let cannot = |error| FileError::from_system(folder, "read", error);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(cannot)? {
        let entry = entry.map_err(cannot)?;
        found.push((entry.file_name().to_string_lossy().into_owned(), entry));
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(found)
}

/// The first thing in a folder that is none of `ours`, nor a leftover of a killed process.
///
/// # Errors
/// What the operating system says.
pub fn first_foreign(folder: &Path, ours: &dyn Fn(&str) -> bool) -> Result<Option<String>, FileError> {
    let is_ours = |name: &str| name == lock::LOCK || name.starts_with(UNFINISHED) || ours(name);
    Ok(entries(folder)?.into_iter().map(|(name, _)| name).find(|name| !is_ours(name)))
}

/// Finds out whether files with such paths can be written in a folder, by making and removing the like.
///
/// # Errors
/// What the operating system says, with the path.
pub fn probe_folder(lock: &FolderLock, paths: &[PathBuf]) -> Result<(), FileError> {
    let folder = lock.folder();
    let scratch = tempfile::Builder::new().prefix(UNFINISHED).tempdir_in(folder);
    let scratch = scratch.map_err(|error| FileError::from_system(folder, "written", error))?;
    for path in paths {
        let attempt = || -> io::Result<()> {
            let copy = scratch.path().join(path);
            std::fs::create_dir_all(copy.parent().unwrap_or(scratch.path()))?;
            std::fs::File::create(copy)?;
            match folder.join(path).parent().filter(|folder| folder.exists()) {
                Some(existing) => tempfile::Builder::new().prefix(UNFINISHED).tempfile_in(existing).map(drop),
                None => Ok(()),
            }
        };
        attempt().map_err(|error| FileError::from_system(folder.join(path), "written", error))?;
    }
    Ok(())
}

#[cfg(unix)]
fn set_usual_folder_permissions(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn set_usual_folder_permissions(_: &Path) -> io::Result<()> {
    Ok(())
}

/// The text of a file.
///
/// # Errors
/// What the operating system says, with the path.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    std::fs::read_to_string(path).map_err(|error| FileError::from_system(path, "read", error))
}

/// The blob in a file.
///
/// # Errors
/// An unreadable file, or what is wrong with the blob.
pub fn read_blob(path: &Path) -> Result<Blob, InputError> {
    let bytes = grn_input::read_bytes(path, Found::Blob)?;
    Blob::decode(&bytes).map_err(|error| {
        let expected = match Found::of(&bytes) {
            Found::Blob => error.to_string(),
            found => found.instead_of(Found::Blob),
        };
        InputError::new("", "", expected).in_file(path)
    })
}

/// The bytes of a blob.
///
/// # Errors
/// A parameter out of range, as [`Blob::encode`] says.
pub fn blob_bytes(blob: &Blob) -> Result<Vec<u8>, grn_core::blob::BlobError> {
    let mut buffer = vec![0; max_encoded_size(DEFAULT_GENES)];
    Ok(blob.encode(&mut buffer)?.to_vec())
}

/// A value as JSON text.
pub fn json(value: &impl Serialize) -> String {
    // Plain structures of numbers and text always have a JSON form.
    serde_json::to_string_pretty(value).map(|text| text + "\n").unwrap_or_default()
}

/// The version of this software with its commit, in every manifest: `0.1.0 (1a2b3c4d5e6f)`.
pub const VERSION: &str = env!("GRN_VERSION");

/// Refuses a manifest that another version of this software has written, whatever else is in it.
///
/// # Errors
/// A file that cannot be read, or another version, with the way out.
pub fn check_version(path: &Path) -> Result<(), FileError> {
    #[derive(serde::Deserialize)]
    struct Versioned {
        grn: String,
    }
    let Versioned { grn } = read_json(path)?;
    if grn == VERSION {
        return Ok(());
    }
    let way_out = format!("go on with grn {grn}, or begin anew in another folder with --out");
    Err(FileError::new(path, format!("made by grn {grn}, and this is grn {VERSION}: {way_out}")))
}

/// The value in a JSON file.
///
/// # Errors
/// An unreadable file, or one that does not hold such a value.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, FileError> {
    let damaged = |error: serde_json::Error| {
        FileError::damaged(path, format!("{error}; delete its folder or choose another with --out"))
    };
    let bytes = std::fs::read(path).map_err(|error| FileError::from_system(path, "read", error))?;
    serde_json::from_slice(&bytes).map_err(damaged)
}

/// The first difference between two values as JSON, in words: `settings.seed is 2 there and 1 now`.
pub fn difference<T: Serialize>(ours: &T, theirs: &T) -> Option<String> {
    let (ours, theirs) = (serde_json::to_value(ours).ok()?, serde_json::to_value(theirs).ok()?);
    first_difference("", &ours, &theirs)
}

fn first_difference(place: &str, ours: &serde_json::Value, theirs: &serde_json::Value) -> Option<String> {
    match (ours.as_object(), theirs.as_object()) {
        (Some(a), Some(b)) => a.iter().find_map(|(key, value)| {
            let other = b.get(key).unwrap_or(&serde_json::Value::Null);
            first_difference(&format!("{place}{}{key}", if place.is_empty() { "" } else { "." }), value, other)
        }),
        _ if ours == theirs => None,
        _ => Some(format!("{place} is {theirs} there and {ours} now")),
    }
}

/// Lines of text fields as CSV.
pub fn csv<H, L>(header: H, lines: impl IntoIterator<Item = L>) -> Vec<u8>
where
    H: IntoIterator<Item: AsRef<[u8]>>,
    L: IntoIterator<Item: AsRef<[u8]>>,
{
    let mut csv = csv::Writer::from_writer(Vec::new());
    // Writing to memory cannot fail.
    let _ = csv.write_record(header);
    for line in lines {
        let _ = csv.write_record(line);
    }
    csv.into_inner().unwrap_or_default()
}

/// Records as CSV, with a header of their fields' names if there are any.
pub fn csv_records<T: Serialize>(records: &[T]) -> Vec<u8> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    for record in records {
        // Writing plain records to memory cannot fail.
        let _ = csv.serialize(record);
    }
    csv.into_inner().unwrap_or_default()
}

/// The records of a CSV file with a header.
///
/// # Errors
/// An unreadable file, or the first line that is no such record.
pub fn read_csv<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, FileError> {
    let damaged = |error| FileError::damaged(path, format!("{error}; delete it or its folder"));
    parse_csv(&read_text(path)?).map_err(damaged)
}

/// The records of CSV text with a header.
///
/// # Errors
/// The first line that is no such record.
pub fn parse_csv<T: DeserializeOwned>(text: &str) -> Result<Vec<T>, csv::Error> {
    csv::Reader::from_reader(text.as_bytes()).into_deserialize().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_remains() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/file");
        write(&path, "old").unwrap();
        write(&path, "new").unwrap();
        assert_eq!(read_text(&path).unwrap(), "new");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn errors_name_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing.grn");
        assert!(read_blob(&missing).unwrap_err().to_string().contains("missing.grn: cannot be read"));
        write(&missing, b"GRNb").unwrap();
        assert!(read_blob(&missing).unwrap_err().to_string().contains("cut short"));
        assert!(write(folder.path(), "x").unwrap_err().to_string().contains("cannot be written"));
    }
}

//! Reading and writing files: whole or not at all, with errors that name the file.

use grn_core::blob::{Blob, max_encoded_size};
use grn_core::network::DEFAULT_GENES;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// How names of files and folders begin while they are being written.
const UNFINISHED: &str = ".unfinished-";

/// What went wrong with a file.
#[derive(Debug)]
pub struct FileError {
    path: PathBuf,
    fault: String,
    source: Option<io::Error>,
}

impl FileError {
    /// `fault` says what is wrong with the file and what to do.
    pub fn new(path: impl Into<PathBuf>, fault: impl fmt::Display) -> Self {
        FileError { path: path.into(), fault: fault.to_string(), source: None }
    }

    /// The operating system refused what was to be `done`: `written`, `read`.
    pub fn from_system(path: impl Into<PathBuf>, done: &str, source: io::Error) -> Self {
        FileError { path: path.into(), fault: format!("cannot be {done}"), source: Some(source) }
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

/// Writes a file under a temporary name in the same folder and renames it: readers see the old content or the new.
///
/// # Errors
/// What the operating system says, with the path.
pub fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), FileError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let attempt = || -> io::Result<()> {
        std::fs::create_dir_all(folder)?;
        let mut file = tempfile::Builder::new().prefix(UNFINISHED).tempfile_in(folder)?;
        file.write_all(content.as_ref())?;
        file.as_file().sync_data()?;
        set_usual_permissions(&file)?;
        file.persist(path).map_err(|error| error.error)?;
        Ok(())
    };
    attempt().map_err(|error| FileError::from_system(path, "written", error))
}

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

/// Copies the files of a folder into another.
///
/// # Errors
/// What the operating system says.
pub fn copy_files(from: &Path, to: &Path) -> Result<(), FileError> {
    let cannot = |error| FileError::from_system(from, "copied", error);
    for entry in std::fs::read_dir(from).map_err(cannot)? {
        let entry = entry.map_err(cannot)?;
        std::fs::copy(entry.path(), to.join(entry.file_name())).map_err(cannot)?;
    }
    Ok(())
}

/// Deletes what killed processes left behind in a folder and below.
///
/// # Errors
/// What the operating system says.
pub fn remove_unfinished(folder: &Path) -> Result<(), FileError> {
    let cannot = |error| FileError::from_system(folder, "tidied", error);
    for entry in std::fs::read_dir(folder).map_err(cannot)? {
        let entry = entry.map_err(cannot)?;
        let is_folder = entry.file_type().map_err(cannot)?.is_dir();
        let unfinished = entry.file_name().to_string_lossy().starts_with(UNFINISHED);
        match (is_folder, unfinished) {
            (true, true) => std::fs::remove_dir_all(entry.path()).map_err(cannot)?,
            (true, false) => remove_unfinished(&entry.path())?,
            (false, true) => std::fs::remove_file(entry.path()).map_err(cannot)?,
            (false, false) => {}
        }
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

/// Temporary files are private; results are for everybody.
#[cfg(unix)]
fn set_usual_permissions(file: &tempfile::NamedTempFile) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn set_usual_permissions(_: &tempfile::NamedTempFile) -> io::Result<()> {
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
pub fn read_blob(path: &Path) -> Result<Blob, FileError> {
    let bytes = std::fs::read(path).map_err(|error| FileError::from_system(path, "read", error))?;
    Blob::decode(&bytes).map_err(|error| FileError::new(path, error))
}

/// Writes a blob, whole or not at all.
///
/// # Errors
/// A parameter out of range, or what the operating system says.
pub fn write_blob(path: &Path, blob: &Blob) -> Result<(), FileError> {
    write(path, blob_bytes(blob).map_err(|error| FileError::new(path, error))?)
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

/// The value in a JSON file.
///
/// # Errors
/// An unreadable file, or one that does not hold such a value.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, FileError> {
    let damaged = |error: serde_json::Error| {
        FileError::new(path, format!("damaged: {error}; delete its folder or choose another with --out"))
    };
    serde_json::from_str(&read_text(path)?).map_err(damaged)
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

/// Writes records as CSV, with a header of their fields' names if there are any.
///
/// # Errors
/// What the operating system says, with the path.
pub fn write_csv<T: Serialize>(path: &Path, records: &[T]) -> Result<(), FileError> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    for record in records {
        csv.serialize(record).map_err(|error| FileError::new(path, error))?;
    }
    write(path, csv.into_inner().unwrap_or_default())
}

/// The records of a CSV file with a header.
///
/// # Errors
/// An unreadable file, or the first line that is no such record.
pub fn read_csv<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, FileError> {
    let text = read_text(path)?;
    let records = csv::Reader::from_reader(text.as_bytes()).into_deserialize().collect::<Result<_, _>>();
    records.map_err(|error| FileError::new(path, format!("damaged: {error}; delete it or its folder")))
}

/// The SHA-256 of some bytes, hexadecimal.
pub fn sha256(bytes: impl AsRef<[u8]>) -> String {
    use sha2::Digest;
    sha2::Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
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

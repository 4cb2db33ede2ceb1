//! Reading and writing files: whole or not at all, with errors that name the file.

use grn_core::blob::{Blob, max_encoded_size};
use grn_core::network::DEFAULT_GENES;
use std::fmt;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What went wrong with a file.
#[derive(Debug)]
pub struct FileError {
    path: PathBuf,
    fault: String,
}

impl FileError {
    /// `fault` says what is wrong with the file and what to do.
    pub fn new(path: impl Into<PathBuf>, fault: impl fmt::Display) -> Self {
        FileError { path: path.into(), fault: fault.to_string() }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.fault)
    }
}

impl std::error::Error for FileError {}

/// Writes a file under a temporary name in the same folder and renames it: readers see the old content or the new.
///
/// # Errors
/// What the operating system says, with the path.
pub fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), FileError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let attempt = || {
        std::fs::create_dir_all(folder)?;
        let mut file = tempfile::Builder::new().prefix(".unfinished-").tempfile_in(folder)?;
        file.write_all(content.as_ref())?;
        file.as_file().sync_data()?;
        set_usual_permissions(&file)?;
        file.persist(path).map_err(|error| error.error)?;
        Ok(())
    };
    attempt().map_err(|error: std::io::Error| FileError::new(path, format!("cannot be written: {error}")))
}

/// Temporary files are private; results are for everybody.
#[cfg(unix)]
fn set_usual_permissions(file: &tempfile::NamedTempFile) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn set_usual_permissions(_: &tempfile::NamedTempFile) -> std::io::Result<()> {
    Ok(())
}

/// The text of a file.
///
/// # Errors
/// What the operating system says, with the path.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    std::fs::read_to_string(path).map_err(|error| FileError::new(path, format!("cannot be read: {error}")))
}

/// The blob in a file.
///
/// # Errors
/// An unreadable file, or what is wrong with the blob.
pub fn read_blob(path: &Path) -> Result<Blob, FileError> {
    let bytes = std::fs::read(path).map_err(|error| FileError::new(path, format!("cannot be read: {error}")))?;
    Blob::decode(&bytes).map_err(|error| FileError::new(path, error))
}

/// The bytes of a blob.
///
/// # Errors
/// A parameter out of range, as [`Blob::encode`] says.
pub fn blob_bytes(blob: &Blob) -> Result<Vec<u8>, grn_core::blob::BlobError> {
    let mut buffer = vec![0; max_encoded_size(DEFAULT_GENES)];
    Ok(blob.encode(&mut buffer)?.to_vec())
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

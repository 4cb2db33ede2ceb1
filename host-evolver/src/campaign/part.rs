//! Sealed tables that a campaign makes from its runs: each is in its folder whole and unchanged, or it is made anew.

use crate::files::{self, FileError};
use serde::de::DeserializeOwned;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Digits of the digest in a name.
const DIGITS: usize = 12;

/// The name of a part's file. It tells what the part was made from, so an old file is never taken for a new one.
pub fn name(number: u64, origin: &str) -> String {
    format!("{number:03}-{}.csv", &files::sha256(origin)[..DIGITS])
}

/// The records of a part: read if they were made before and the file is whole, else made and written; `notice` hears of damage.
/// `None` if `make`, which gives them as CSV, was stopped.
///
/// # Errors
/// A file that cannot be read or written, or what `make` says.
pub fn read_or_make<T: DeserializeOwned>(
    path: &Path,
    origin: &str,
    notice: &dyn Fn(&str),
    make: impl FnOnce() -> Result<Option<Vec<u8>>, FileError>,
) -> Result<Option<Vec<T>>, FileError> {
    if path.exists() {
        // Whatever is not text of ours is damage like any other.
        let text = std::fs::read(path).map_err(|error| FileError::from_system(path, "read", error))?;
        let text = String::from_utf8_lossy(&text);
        match files::unsealed(&text, origin).and_then(|text| files::parse_csv(text).ok()) {
            Some(records) => return Ok(Some(records)),
            None => notice(&format!("{}: damaged, or made from something else: made anew", path.display())),
        }
    }
    let Some(csv) = make()? else { return Ok(None) };
    let text = String::from_utf8_lossy(&csv).into_owned();
    files::write(path, files::sealed(&text, origin))?;
    files::parse_csv(&text).map(Some).map_err(|error| FileError::new(path, error))
}

/// Deletes the parts below this folder of a campaign that are none of `wanted`: parts of the campaign as it was before. A file
/// without the name of a part is somebody's and stays.
///
/// # Errors
/// What the operating system says.
pub fn remove_others(campaign: &Path, folder: &Path, wanted: &HashSet<PathBuf>) -> Result<(), FileError> {
    if !campaign.join(folder).exists() {
        return Ok(());
    }
    for (name, entry) in files::entries(&campaign.join(folder))? {
        let (path, within) = (entry.path(), folder.join(&name));
        if path.is_dir() {
            remove_others(campaign, &within, wanted)?;
        } else if is_part(&name) && !wanted.contains(&within) {
            std::fs::remove_file(&path).map_err(|error| FileError::from_system(&path, "removed", error))?;
            files::remove_empty(campaign, &path);
        }
    }
    Ok(())
}

fn is_part(name: &str) -> bool {
    let parts = name.strip_suffix(".csv").and_then(|name| name.split_once('-'));
    parts.is_some_and(|(number, digest)| {
        let hexadecimal = digest.bytes().all(|byte| byte.is_ascii_hexdigit());
        number.parse::<u64>().is_ok() && digest.len() == DIGITS && hexadecimal
    })
}

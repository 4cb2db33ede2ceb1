//! What a folder's manifest answers for: the names of its files and the SHA-256 of each.
//!
//! The manifest is written before the files, with what they are going to be, and again when they are all there. So after any
//! kill it is known which files of the folder are ours, which of them are whole, and which belong to an earlier state.

use super::destination::write;
use super::error::FileError;
use super::seal::sha256;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Component, Path};

/// The content of files by their path in the folder, with `/`.
pub type Contents = BTreeMap<String, Vec<u8>>;

/// Paths in the folder, with `/`, and SHA-256 of the files there, hexadecimal.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Ledger(BTreeMap<String, String>);

impl Ledger {
    /// The ledger of such files.
    pub fn of(contents: &Contents) -> Ledger {
        Ledger(contents.iter().map(|(name, content)| (name.clone(), sha256(content))).collect())
    }

    /// The names of the files.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// Whether the file is there as it was written.
    pub fn holds(&self, folder: &Path, name: &str) -> bool {
        let Some(expected) = self.0.get(name) else { return false };
        std::fs::read(folder.join(name)).is_ok_and(|content| sha256(content) == *expected)
    }

    /// The first file that is missing or not as it was written.
    pub fn first_damaged(&self, folder: &Path) -> Option<&str> {
        self.names().find(|name| !self.holds(folder, name))
    }

    /// Writes `contents` into a folder whose manifest tells of this ledger; `manifest` writes another ledger into it. Files of
    /// this one stay for the time being. Returns what the folder answers for.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn add(
        &self,
        folder: &Path,
        contents: &Contents,
        manifest: impl Fn(&Ledger) -> Result<(), FileError>,
    ) -> Result<Ledger, FileError> {
        let new = Ledger::of(contents);
        let mut all = self.clone();
        all.0.extend(new.0.clone());
        manifest(&all)?;
        for (name, content) in contents.iter().filter(|(name, _)| !new.holds(folder, name)) {
            write(&folder.join(name), content)?;
        }
        Ok(all)
    }

    /// Brings a folder to hold `contents` as [`add`](Self::add) does; `manifest` hears at last that all is there. Files of
    /// this ledger that are no longer wanted are deleted, unless somebody has changed them since.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn publish(
        &self,
        folder: &Path,
        contents: &Contents,
        manifest: impl Fn(&Ledger, bool) -> Result<(), FileError>,
    ) -> Result<Ledger, FileError> {
        self.add(folder, contents, |all| manifest(all, false))?;
        let new = Ledger::of(contents);
        for name in self.names().filter(|name| !contents.contains_key(*name)) {
            self.remove(folder, name)?;
        }
        manifest(&new, true)?;
        Ok(new)
    }

    /// Deletes a file if it is as it was written, and the folders that it leaves empty.
    fn remove(&self, folder: &Path, name: &str) -> Result<(), FileError> {
        let is_below = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        if !is_below || !self.holds(folder, name) {
            return Ok(());
        }
        let path = folder.join(name);
        std::fs::remove_file(&path).map_err(|error| FileError::from_system(&path, "removed", error))?;
        remove_empty(folder, &path);
        Ok(())
    }
}

/// Deletes the folders above `path` that are empty, up to `folder`.
pub fn remove_empty(folder: &Path, path: &Path) {
    for above in path.ancestors().skip(1).take_while(|above| *above != folder) {
        // Fails where something else lies in it, and that is meant.
        if std::fs::remove_dir(above).is_err() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contents(files: &[(&str, &str)]) -> Contents {
        files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec())).collect()
    }

    #[test]
    fn old_files_go_and_what_others_wrote_or_changed_stays() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = scratch.path();
        let outside = folder.join("../outside-of-the-ledger");
        let old = contents(&[("a", "1"), ("deep/er/b", "2"), ("edited", "3"), ("kept", "4")]);
        let manifest = |_: &Ledger, _: bool| Ok(());
        let ledger = Ledger::default().publish(folder, &old, manifest).unwrap();
        assert_eq!(ledger.first_damaged(folder), None);
        std::fs::write(folder.join("edited"), "mine").unwrap();
        std::fs::write(folder.join("foreign"), "mine").unwrap();
        assert_eq!(ledger.first_damaged(folder), Some("edited"));
        let new = ledger.publish(folder, &contents(&[("kept", "5")]), manifest).unwrap();
        assert_eq!(new.names().collect::<Vec<_>>(), ["kept"]);
        assert!(!folder.join("a").exists() && !folder.join("deep").exists());
        assert_eq!(std::fs::read_to_string(folder.join("edited")).unwrap(), "mine");
        assert_eq!(std::fs::read_to_string(folder.join("foreign")).unwrap(), "mine");

        std::fs::write(&outside, "1").unwrap();
        let hostile = Ledger(BTreeMap::from([("../outside-of-the-ledger".into(), sha256("1"))]));
        hostile.publish(folder, &Contents::new(), manifest).unwrap();
        assert!(outside.exists());
        std::fs::remove_file(outside).unwrap();
    }

    #[test]
    fn the_manifest_tells_of_files_before_they_are_written() {
        let scratch = tempfile::tempdir().unwrap();
        let told = std::cell::RefCell::new(Vec::new());
        let manifest = |ledger: &Ledger, finished: bool| {
            told.borrow_mut().push((ledger.names().count(), finished, scratch.path().join("a").exists()));
            Ok(())
        };
        Ledger::default().publish(scratch.path(), &contents(&[("a", "1")]), manifest).unwrap();
        assert_eq!(*told.borrow(), [(1, false, false), (1, true, true)]);
    }
}

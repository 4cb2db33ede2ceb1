//! Sealed tables that a campaign makes from its runs: each is in its folder whole and unchanged, or it is made anew.

use super::job::{Job, Product, Refusal};
use super::team::{Batch, Site, Team};
use crate::files::{self, FileError};
use rayon::prelude::*;
use serde::de::DeserializeOwned;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Digits of the digest in a name.
const DIGITS: usize = 12;

/// The name of a part's file. It tells what the part was made from, so an old file is never taken for a new one.
pub fn name(number: u64, origin: &str) -> String {
    format!("{number:03}-{}.csv", &files::sha256(origin)[..DIGITS])
}

/// A sealed table that one job makes.
pub trait Part: Sync {
    /// A line of it.
    type Record: DeserializeOwned + Send + Sync;
    /// Where all tables of this sort are, within the campaign's folder.
    const FOLDER: &'static str;

    /// Its file within the campaign's folder.
    fn path(&self) -> PathBuf;

    /// All that it is made from.
    fn origin(&self) -> String;

    /// What it is worth, in evaluations of f2.
    fn worth(&self) -> u64;

    /// What has to be done for it.
    fn job(&self) -> Job;

    /// The table as CSV; `None` if the product is of another sort of job.
    fn csv(&self, product: Product) -> Option<Vec<u8>>;
}

/// The records of all parts: read where they were made before and the file is whole, else made and written. `None` if stopped. Else
/// files of other parts are deleted.
///
/// # Errors
/// A file that cannot be read or written, or why a part cannot be made.
pub fn complete<P: Part>(
    parts: &[P],
    site: &Site<'_>,
    team: &mut Team,
) -> Result<Option<Vec<Vec<P::Record>>>, FileError> {
    let path = |part: &P| site.folder.join(part.path());
    let find = |part: &P| {
        let found = read(&path(part), &part.origin(), &|text| site.listener.notice(text))?;
        if found.is_some() {
            site.listener.found(part.worth());
        }
        Ok(found)
    };
    let found: Result<Vec<Option<Vec<P::Record>>>, FileError> =
        team.pool().install(|| parts.par_iter().with_max_len(1).map(find).collect());
    let records: Vec<OnceLock<Vec<P::Record>>> =
        found?.into_iter().map(|found| found.map_or_else(OnceLock::new, OnceLock::from)).collect();
    let missing: Vec<usize> = (0..parts.len()).filter(|&place| records[place].get().is_none()).collect();
    let batch = Batch { count: missing.len(), job: &|number| parts[missing[number]].job() };
    team.make(site, &batch, &|number, product| {
        let part = &parts[missing[number]];
        let other = || Refusal::internal("is made by another sort of job");
        let csv = product.and_then(|product| part.csv(product).ok_or_else(other));
        let csv = csv.map_err(|refusal| refusal.about(&path(part)))?;
        // Each is handed over once.
        let _ = records[missing[number]].set(write(&path(part), &part.origin(), &csv)?);
        site.listener.done(part.worth());
        Ok(())
    })?;
    let records: Option<Vec<Vec<P::Record>>> = records.into_iter().map(OnceLock::into_inner).collect();
    if records.is_some() {
        let wanted = parts.iter().map(P::path).collect();
        remove_others(site.folder, Path::new(P::FOLDER), &wanted)?;
    }
    Ok(records)
}

/// The records in a part's file, if it is there and whole; `notice` hears of damage.
fn read<T: DeserializeOwned>(path: &Path, origin: &str, notice: &dyn Fn(&str)) -> Result<Option<Vec<T>>, FileError> {
    if !path.exists() {
        return Ok(None);
    }
    // Whatever is not text of ours is damage like any other.
    let text = std::fs::read(path).map_err(|error| FileError::from_system(path, "read", error))?;
    let text = String::from_utf8_lossy(&text);
    let records = files::unsealed(&text, origin).and_then(|text| files::parse_csv(text).ok());
    if records.is_none() {
        notice(&format!("{}: damaged, or made from something else: made anew", path.display()));
    }
    Ok(records)
}

/// Writes a part's file; its records.
fn write<T: DeserializeOwned>(path: &Path, origin: &str, csv: &[u8]) -> Result<Vec<T>, FileError> {
    let text = String::from_utf8_lossy(csv);
    files::write(path, files::sealed(&text, origin))?;
    files::parse_csv(&text).map_err(|error| FileError::new(path, error))
}

/// Deletes the parts below this folder of a campaign that are none of `wanted`: parts of the campaign as it was before. A file
/// without the name of a part is somebody's and stays.
///
/// # Errors
/// What the operating system says.
fn remove_others(campaign: &Path, folder: &Path, wanted: &HashSet<PathBuf>) -> Result<(), FileError> {
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

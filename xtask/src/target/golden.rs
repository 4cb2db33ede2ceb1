//! What images should say and weigh.

use std::fs;
use std::path::{Path, PathBuf};

/// Golden files.
pub struct Golden {
    /// Where they are.
    pub folder: PathBuf,
    /// Write them instead of comparing with them.
    pub bless: bool,
    /// The task that does so when asked to.
    pub task: &'static str,
    /// How far a size or a cost may be from its golden value, per cent.
    pub tolerance: usize,
}

impl Golden {
    /// Compares lines `name … value` with a file's: the same names in the same order, values within the tolerance.
    pub fn near(&self, file: &str, found: &str) -> Result<(), String> {
        let path = self.folder.join(file);
        if self.bless {
            return fs::write(&path, found).map_err(|error| format!("{}: {error}", path.display()));
        }
        let expected = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let mut lines = found.lines();
        let mut differences: Vec<String> = expected
            .lines()
            .map(|expected| (expected, lines.next().unwrap_or_default()))
            .filter(|(expected, found)| !line_near(expected, found, self.tolerance))
            .map(|(expected, found)| format!("{found:?} instead of {expected:?}"))
            .collect();
        differences.extend(lines.map(|line| format!("{line:?} is new")));
        if differences.is_empty() {
            return Ok(());
        }
        let (all, task, tolerance) = (differences.join("\n"), self.task, self.tolerance);
        Err(format!(
            "{all}\nmore than {tolerance} % off firmware/golden/{file}: if that is meant, cargo xtask {task} --bless"
        ))
    }
}

/// Name and value of a line that ends in a number, with or without a unit after it.
fn parted(line: &str) -> Option<(&str, usize)> {
    let line = line.strip_suffix(" bytes").unwrap_or(line);
    let (name, value) = line.rsplit_once(' ')?;
    Some((name, value.parse().ok()?))
}

fn line_near(expected: &str, found: &str, tolerance: usize) -> bool {
    match (parted(expected), parted(found)) {
        (Some((name, golden)), Some((found_name, value))) => {
            name == found_name && golden.abs_diff(value) * 100 <= golden * tolerance
        }
        _ => expected == found,
    }
}

/// The value of the line with this name.
pub fn value(output: &str, name: &str) -> Option<usize> {
    output.lines().filter_map(parted).find(|(found, _)| *found == name).map(|(_, value)| value)
}

/// Compares printed digests with those of `tests/golden/digest.txt` of these number types: exactly.
pub fn digests(root: &Path, output: &str, numbers: &[&str]) -> Result<(), String> {
    const FILE: &str = "tests/golden/digest.txt";
    let text = fs::read_to_string(root.join(FILE)).map_err(|error| format!("{FILE}: {error}"))?;
    let of_board = |line: &&str| line.split(' ').next().is_some_and(|number| numbers.contains(&number));
    let expected: Vec<&str> = text.lines().filter(of_board).collect();
    if expected.is_empty() || output.lines().ne(expected.iter().copied()) {
        return Err(format!("{output}instead of, from {FILE},\n{}", expected.join("\n")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_may_be_a_little_off_but_not_their_names() {
        let near = |expected, found| line_near(expected, found, 2);
        assert!(near("f32 tick 10000", "f32 tick 10200") && near("stack 100 bytes", "stack 98 bytes"));
        assert!(!near("f32 tick 10000", "f32 tick 10201") && !near("f32 tick 100", "f32 tock 100"));
        assert!(near("bss 0", "bss 0") && !near("bss 0", "bss 1"));
        assert_eq!(value("text 7\nstack 5 bytes\n", "stack"), Some(5));
    }
}

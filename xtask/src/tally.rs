//! Adds up what the test harnesses of many crates report.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// Counts over all `test result:` lines.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Tests that passed.
    pub passed: usize,
    /// Tests that failed.
    pub failed: usize,
    /// Tests marked ignored.
    pub ignored: usize,
}

impl Tally {
    /// Runs a command, shows its output and counts; whether it succeeded.
    pub fn follow(&mut self, command: &mut Command) -> bool {
        let child = command.stdout(Stdio::piped()).spawn();
        let mut child = match child {
            Ok(child) => child,
            Err(error) => {
                eprintln!("cannot be run: {error}");
                return false;
            }
        };
        for line in child.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines()).map_while(Result::ok) {
            println!("{line}");
            self.count(&line);
        }
        child.wait().is_ok_and(|status| status.success())
    }

    /// Prints the closing line; whether all is well. `succeeded`: no command failed, whatever it counted.
    pub fn close(&self, succeeded: bool) -> bool {
        let failed = self.failed.max(usize::from(!succeeded));
        println!("{} passed, {failed} failed, {} skipped", self.passed, self.ignored);
        failed == 0 && self.passed > 0
    }

    /// Counts a line like `test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; …`, or like pytest's
    /// `===== 1 failed, 3 passed, 1 skipped in 0.10s =====`.
    fn count(&mut self, line: &str) {
        let counts = match line.split_once("test result: ") {
            Some((_, counts)) => counts,
            None if line.starts_with("===") && line.contains(" in ") => line.trim_matches(['=', ' ']),
            None => return,
        };
        for part in counts.split([';', '.', ',']) {
            let mut words = part.split_whitespace();
            let (Some(number), Some(what)) = (words.next().and_then(|word| word.parse::<usize>().ok()), words.next())
            else {
                continue;
            };
            match what {
                "passed" => self.passed += number,
                "failed" => self.failed += number,
                "ignored" | "skipped" => self.ignored += number,
                // Of pytest: what fails before or after a test.
                "error" | "errors" => self.failed += number,
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_the_harness_are_added_up() {
        let mut tally = Tally::default();
        tally.count("running 4 tests");
        tally.count("test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s");
        tally.count("test result: FAILED. 2 passed; 1 failed; 0 ignored; 0 measured; 5 filtered out");
        assert_eq!(tally, Tally { passed: 5, failed: 1, ignored: 1 });
        tally.count("============================= test session starts ==============================");
        tally.count("========== 1 failed, 40 passed, 2 skipped, 1 error in 12.34s ==========");
        assert_eq!(tally, Tally { passed: 45, failed: 3, ignored: 3 });
    }
}

//! How a command ends, as whoever called it sees: README, "Exit codes".

use std::process::ExitCode;

/// The exit codes, all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// Done.
    Yes = 0,
    /// Done, but the answer is no.
    No = 1,
    /// What was given cannot be worked with.
    BadInput = 2,
    /// The system or this program failed.
    Fault = 3,
    /// Somebody asked to stop: 128 and the number of SIGINT, as shells have it.
    Interrupted = 130,
}

impl Exit {
    /// As the operating system is told.
    pub fn code(self) -> i32 {
        self as i32
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}

/// What help says about them.
pub const WORDS: &str = "Exit codes: 0 done; 1 done, but the answer is no (it does not work, infeasible); 2 bad input; \
                         3 the system failed (disk full, broken device, no threads), or grn itself; 130 interrupted.";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_tells_every_code() {
        for exit in [Exit::Yes, Exit::No, Exit::BadInput, Exit::Fault, Exit::Interrupted] {
            assert!(WORDS.contains(&format!(" {} ", exit.code())), "{exit:?}");
        }
    }
}

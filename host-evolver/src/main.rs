//! The command `grn`.

use std::process::ExitCode;

fn main() -> ExitCode {
    host_evolver::cli::run()
}

//! Ctrl-C and its relatives: the first asks for an orderly stop, the second ends the process, and so does [`PATIENCE`].

use super::exit::Exit;
use super::{Failure, output};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// How long an orderly stop may take. Work that does not look whether it is to stop, such as reading a large campaign, is
/// ended then; every file is written whole or not at all, so nothing is damaged.
const PATIENCE: Duration = Duration::from_secs(10);
/// How often it is looked whether a stop is asked for.
const GLANCE: Duration = Duration::from_millis(200);

/// From now on Ctrl-C, SIGTERM, a terminal that goes away (SIGHUP), and SIGUSR1, which mpirun passes on to its ranks, set the flag
/// that is returned.
///
/// # Errors
/// The system's, whatever it says.
pub fn watch() -> Result<Arc<AtomicBool>, Failure> {
    watched().map_err(|error| Failure::System(format!("signals cannot be handled: {error}")))
}

fn watched() -> io::Result<Arc<AtomicBool>> {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        flag::register_conditional_shutdown(signal, Exit::Interrupted.code(), Arc::clone(&asked))?;
        flag::register(signal, Arc::clone(&asked))?;
    }
    #[cfg(unix)]
    flag::register(signal_hook::consts::SIGUSR1, Arc::clone(&asked))?;
    #[cfg(unix)]
    if !is_ignored(signal_hook::consts::SIGHUP) {
        flag::register(signal_hook::consts::SIGHUP, Arc::clone(&asked))?;
    }
    let seen = Arc::clone(&asked);
    thread::Builder::new().name("patience".into()).spawn(move || end_in_time(&seen))?;
    Ok(asked)
}

/// Waits until a stop is asked for, and ends the process if it is still there after [`PATIENCE`].
fn end_in_time(asked: &AtomicBool) {
    while !asked.load(Ordering::Relaxed) {
        thread::sleep(GLANCE);
    }
    thread::sleep(PATIENCE);
    output::notice("grn: interrupted. What was under way is not kept; go on with the same command");
    std::process::exit(Exit::Interrupted.code());
}

/// Whether who started this process has it ignore a signal, as `nohup` does. Where this cannot be read, nobody has.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

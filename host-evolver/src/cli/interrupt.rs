//! Ctrl-C and its relatives: the first asks for an orderly stop, the second ends the process.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The exit code of a command that was interrupted.
pub const CODE: u8 = 130;

/// From now on Ctrl-C, SIGTERM and a terminal that goes away (SIGHUP) set the flag that is returned.
///
/// # Errors
/// What the operating system says.
pub fn watch() -> io::Result<Arc<AtomicBool>> {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        flag::register_conditional_shutdown(signal, i32::from(CODE), Arc::clone(&asked))?;
        flag::register(signal, Arc::clone(&asked))?;
    }
    #[cfg(unix)]
    if !is_ignored(signal_hook::consts::SIGHUP) {
        flag::register(signal_hook::consts::SIGHUP, Arc::clone(&asked))?;
    }
    Ok(asked)
}

/// Whether who started this process has it ignore a signal, as `nohup` does. Where this cannot be read, nobody has.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

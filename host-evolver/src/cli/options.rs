//! Ranges of numeric options.

use super::{Failure, no_threads};
use grn_input::Range;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::fmt::Debug;
use std::num::NonZeroUsize;
use std::str::FromStr;

/// Threads per core that may be asked for: more gain nothing, and each costs megabytes.
const MOST_THREADS_PER_CORE: usize = 8;

/// Parses a number and checks its range, for clap.
pub fn within<T: FromStr + PartialOrd + Copy + Debug>(text: &str, range: &Range<T>) -> Result<T, String> {
    let number = text.trim().parse().ok().filter(|number| range.holds(*number));
    number.ok_or_else(|| range.to_string())
}

/// Parses a number of threads.
pub fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let cores = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let most = cores * MOST_THREADS_PER_CORE;
    let count: Option<NonZeroUsize> = text.trim().parse().ok();
    count.filter(|count| count.get() <= most).ok_or_else(|| {
        format!("must be a number from 1 to {most} ({MOST_THREADS_PER_CORE} for each of this machine's {cores} cores)")
    })
}

/// So many threads, or as many as the machine has cores.
pub fn pool(threads: Option<NonZeroUsize>) -> Result<ThreadPool, Failure> {
    ThreadPoolBuilder::new().num_threads(threads.map_or(0, NonZeroUsize::get)).build().map_err(no_threads)
}

/// Parses a seed.
pub fn seed(text: &str) -> Result<u64, String> {
    within(text, &Range::new(0, u64::MAX, "(a whole one)"))
}

/// Parses a baud rate.
pub fn baud(text: &str) -> Result<u32, String> {
    within(text, &Range::new(1, u32::MAX, "(a whole one; usual are 9600, 115200 and 230400)"))
}

/// Parses a speed of targets; what is possible follows from world and robots, too.
pub fn speed(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "must be a number, metres per second".into())
}

/// World metres per scenario metre: what a blob can hold.
pub fn scale(text: &str) -> Result<f32, String> {
    within(text, &Range::new(0.01, 10.0, ""))
}

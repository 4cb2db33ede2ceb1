//! Progress bars, and how long a command still takes as far as that can be told.

use indicatif::{ProgressState, ProgressStyle};
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Before this a pace is chance.
const FIRST: Duration = Duration::from_secs(2);

/// The part of a bar's work that was there when the command began, and so tells nothing of its pace.
#[derive(Clone, Default)]
pub struct Found(Arc<AtomicU64>);

impl Found {
    /// So much more was there.
    pub fn add(&self, work: u64) {
        self.0.fetch_add(work, Ordering::Relaxed);
    }

    fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    /// How long `total` still takes, of which `position` is done after `elapsed`; `None` before that can be told.
    pub fn left(&self, elapsed: Duration, position: u64, total: u64) -> Option<Duration> {
        let done = position.saturating_sub(self.get());
        if done == 0 || elapsed < FIRST {
            return None;
        }
        let seconds = elapsed.as_secs_f64() * total.saturating_sub(position) as f64 / done as f64;
        Duration::try_from_secs_f64(seconds).ok()
    }
}

/// The style of a bar; in the template `{left}` is the time left in words.
pub fn style(template: &str, found: &Found) -> ProgressStyle {
    let found = found.clone();
    let left = move |state: &ProgressState, text: &mut dyn fmt::Write| {
        let left = found.left(state.elapsed(), state.pos(), state.len().unwrap_or(0));
        // Writing to the bar's memory cannot fail.
        let _ = text.write_str(&words(left));
    };
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    style.with_key("left", left)
}

/// `about 5 min left`, or that it is not known.
pub fn words(left: Option<Duration>) -> String {
    let Some(left) = left else { return "time left not known yet".into() };
    let (seconds, minute, hour) = (left.as_secs(), 60, 3600);
    match seconds {
        0..100 => format!("about {} s left", seconds.max(1)),
        100..6000 => format!("about {} min left", (seconds + minute / 2) / minute),
        _ => format!("about {} h left", (seconds + hour / 2) / hour),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_follows_from_what_this_process_did() {
        let found = Found::default();
        let left =
            |seconds, position| found.left(Duration::from_secs(seconds), position, 1000).map(|left| left.as_secs());
        assert_eq!(left(60, 0), None, "nothing is done: it once showed 20,253,681,186 s");
        assert_eq!(left(1, 500), None);
        assert_eq!(left(60, 250), Some(180));
        assert_eq!(left(60, 1000), Some(0));
        found.add(900);
        assert_eq!((left(60, 900), left(60, 950), left(60, 800)), (None, Some(60), None));
    }

    #[test]
    fn the_time_left_is_said_as_people_do() {
        let said = |seconds| words(Some(Duration::from_secs(seconds)));
        assert_eq!(
            [0, 99, 170, 5999, 20_000].map(said),
            ["about 1 s left", "about 99 s left", "about 3 min left", "about 100 min left", "about 6 h left"]
        );
        assert_eq!(words(None), "time left not known yet");
    }
}

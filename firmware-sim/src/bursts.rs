//! Things that fail now and then, alone or several times in a row.

use crate::random::Stream;

/// A chain of two states (Gilbert 1960): things work or fail, and what it is now makes the same more likely next time.
#[derive(Clone, Copy, Debug)]
pub struct Bursts {
    /// Probability that failing begins, at a step at which things work.
    begin: f64,
    /// Probability that it ends.
    end: f64,
    share: f64,
}

impl Bursts {
    /// Failures of this share of all steps of `step_s` seconds, in rows that last `length_s` seconds on average; with 0,
    /// independently of each other.
    pub fn new(share: f64, length_s: f64, step_s: f64) -> Self {
        // A row cannot be shorter than independent failures make it.
        let independent = 1.0 - share;
        let end = if length_s > 0.0 { independent.min(step_s / length_s) } else { independent };
        let begin = if share < 1.0 { (end * share / (1.0 - share)).min(1.0) } else { 1.0 };
        Bursts { begin, end, share }
    }

    /// Whether nothing ever fails.
    pub fn never(&self) -> bool {
        self.share <= 0.0
    }

    /// A state to begin with.
    pub fn first(&self, stream: &mut Stream) -> bool {
        !self.never() && stream.unit() < self.share
    }

    /// The next state: true while failing.
    pub fn next(&self, failing: bool, stream: &mut Stream) -> bool {
        if self.never() {
            return false;
        }
        let draw = stream.unit();
        if failing { draw >= self.end } else { draw < self.begin }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Component;

    /// Share of failures and mean length of a row.
    fn measured(bursts: Bursts) -> (f64, f64) {
        let mut stream = Stream::new(1, Component::Radio, 0);
        let (mut failing, mut failures, mut rows) = (bursts.first(&mut stream), 0, 0);
        let n = 400_000;
        for _ in 0..n {
            let next = bursts.next(failing, &mut stream);
            rows += u32::from(next && !failing);
            failures += u32::from(next);
            failing = next;
        }
        (f64::from(failures) / f64::from(n), f64::from(failures) / f64::from(rows.max(1)))
    }

    #[test]
    fn share_and_length_are_as_asked() {
        for (share, length, rows) in
            [(0.3, 0.0, 1.0 / 0.7), (0.1, 0.5, 16.0), (0.5, 1.0, 32.0), (0.02, 0.001, 1.0 / 0.98)]
        {
            let (failures, row) = measured(Bursts::new(share, length, 1.0 / 32.0));
            assert!((failures - share).abs() < 0.02 && (row / rows - 1.0).abs() < 0.06, "{share}: {failures} {row}");
        }
        assert_eq!(measured(Bursts::new(0.0, 1.0, 1.0 / 32.0)).0, 0.0);
        assert_eq!(measured(Bursts::new(1.0, 0.0, 1.0 / 32.0)).0, 1.0);
    }
}

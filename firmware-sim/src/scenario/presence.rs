//! When something is there.

use grn_input::{InputError, Pair};

/// The spans of a run's time, 0 to 1, in which a target or a wall is there: from the first moment of a span up to its second, and to
/// the very end if that is 1. Without spans it is always there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Presence(Vec<[f64; 2]>);

impl Presence {
    /// The spans; none if it is always there.
    pub fn spans(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Whether it is always there.
    pub fn is_always(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether it is there at a time.
    pub fn holds(&self, time: f64) -> bool {
        let within = |&[from, to]: &[f64; 2]| time >= from && (time < to || to >= 1.0);
        self.0.is_empty() || self.0.iter().any(within)
    }

    /// The times within the run at which it comes or goes.
    pub fn changes(&self) -> impl Iterator<Item = f64> + '_ {
        self.0.iter().flatten().copied().filter(|&time| time > 0.0 && time < 1.0)
    }

    /// The spans of a file, read under `key`.
    pub(super) fn checked(key: &str, spans: &[Pair]) -> Result<Presence, InputError> {
        let mut before = -1.0;
        for (index, &Pair([from, to])) in spans.iter().enumerate() {
            let fault = |words| Err(InputError::new(format!("{key}[{index}]"), format!("[{from:?}, {to:?}]"), words));
            if !((0.0..=1.0).contains(&from) && (0.0..=1.0).contains(&to)) {
                return fault("times go from 0, when the targets set out, to 1, when they have arrived");
            }
            if from >= to {
                return fault("a span ends after it begins");
            }
            if from <= before {
                return fault("spans follow each other, with a gap between two of them");
            }
            before = to;
        }
        Ok(Presence(spans.iter().map(|pair| pair.0).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_begin_and_end() {
        let doors = Presence(vec![[0.0, 0.25], [0.5, 1.0]]);
        let there: Vec<bool> = [0.0, 0.2499, 0.25, 0.4, 0.5, 0.9, 1.0].map(|time| doors.holds(time)).to_vec();
        assert_eq!(there, [true, true, false, false, true, true, true]);
        assert_eq!(doors.changes().collect::<Vec<_>>(), [0.25, 0.5]);
        assert!(Presence::default().holds(0.3) && !Presence(vec![[0.0, 0.5]]).holds(1.0));
    }

    #[test]
    fn wrong_spans_are_refused() {
        for (spans, words) in [
            (vec![[0.5, 0.5]], "present[0] = [0.5, 0.5]: a span ends after"),
            (vec![[0.0, 0.5], [0.5, 0.6]], "present[1] = [0.5, 0.6]: spans follow"),
            (vec![[0.0, 30.0]], "present[0] = [0.0, 30.0]: times go from 0"),
            (vec![[f64::NAN, 1.0]], "present[0] = [NaN, 1.0]: times go from 0"),
        ] {
            let spans: Vec<Pair> = spans.into_iter().map(Pair).collect();
            let error = Presence::checked("present", &spans).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}

//! A base station: how long the pattern is that it sends robots to, and what it did in a run.
//!
//! The paper assumes that "a sufficient number of robots can be called from the base station", as the circumference of the swarm's
//! pattern asks, and that everybody can talk with it. How long a pattern is, the simulator does not know: it is told in a
//! [`Circumference`], made by whoever knows the model.

use crate::faults::Absences;
use crate::timing::FRAME_S;
use grn_input::InputError;
use serde::{Deserialize, Serialize};

/// A pattern at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatternSize {
    /// Length of all its rings together, metres.
    pub circumference_m: f64,
    /// How many rings it has, at least one.
    pub rings: usize,
}

/// How long the pattern is in the course of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Circumference {
    frames: u64,
    sizes: Vec<Option<PatternSize>>,
}

impl Circumference {
    /// One size every so many frames, from the start on; `None` where the pattern does not close. `frames` is at least 1.
    pub fn new(frames: u64, sizes: Vec<Option<PatternSize>>) -> Self {
        Circumference { frames: frames.max(1), sizes }
    }

    /// As of this frame: the last size before it, or where that is not known, the next one. After the last it stays.
    pub fn at(&self, frame: u64) -> Option<PatternSize> {
        let last = self.sizes.len().checked_sub(1)?;
        let place = ((frame / self.frames) as usize).min(last);
        self.sizes[place].or_else(|| self.sizes.get(place + 1).copied().flatten())
    }
}

/// What a base station does with a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dispatch {
    /// It is sent to the pattern, from its place or on its way home.
    Sent,
    /// It has come near the pattern: from now on it is one of the swarm.
    Joined,
    /// It is called home.
    CalledHome,
    /// It is back at its place, and switched off.
    Back,
}

/// One deed of a base station.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dispatched {
    /// When, seconds from the start.
    pub at_s: f64,
    /// Which robot.
    pub robot: usize,
    /// What.
    pub what: Dispatch,
}

/// What a base station did in a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BaseRecord {
    /// In order of time.
    pub dispatched: Vec<Dispatched>,
    /// The most robots that the pattern needed.
    pub most_needed: usize,
    /// The most robots that were out at once and not called home.
    pub most_out: usize,
    /// For how long fewer robots were out than the pattern needed, because the base had no more, seconds.
    pub short_s: f64,
}

impl BaseRecord {
    /// Adds when each of so many robots was not one of the swarm: at the base, on its way from there or back.
    pub fn add_absences(&self, robots: usize, absences: &mut Absences) {
        let frames = |seconds: f64| (seconds / FRAME_S + 0.5) as u64;
        for robot in 0..robots {
            let mut away_since = Some(0);
            for deed in self.dispatched.iter().filter(|deed| deed.robot == robot) {
                match (deed.what, away_since) {
                    (Dispatch::Joined, Some(since)) => {
                        absences.add(robot, since..frames(deed.at_s));
                        away_since = None;
                    }
                    (Dispatch::CalledHome, None) => away_since = Some(frames(deed.at_s)),
                    _ => {}
                }
            }
            if let Some(since) = away_since {
                absences.add(robot, since..u64::MAX);
            }
        }
    }
}

/// The error of a swarm with a base station in a simulation that knows no pattern.
pub fn no_pattern() -> InputError {
    let why = "the base station sends as many robots as the pattern's circumference asks, and nobody has told this simulation how long \
               that is; set it to false, or simulate a blob with `grn simulate`";
    InputError::new("base_station.sends", "true", why)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circumference_holds_until_the_next_one_is_known() {
        let size = |circumference_m| Some(PatternSize { circumference_m, rings: 1 });
        let timetable = Circumference::new(10, vec![size(1.0), None, size(3.0), None]);
        assert_eq!(
            [0, 9, 10, 19, 20].map(|frame| timetable.at(frame)),
            [size(1.0), size(1.0), size(3.0), size(3.0), size(3.0)]
        );
        assert_eq!([30, 1000].map(|frame| timetable.at(frame)), [None, None]);
        assert_eq!(Circumference::new(0, Vec::new()).at(5), None);
    }

    #[test]
    fn robots_are_absent_unless_they_have_joined() {
        let deed = |at_s, robot, what| Dispatched { at_s, robot, what };
        let dispatched = vec![
            deed(0.0, 0, Dispatch::Sent),
            deed(0.0, 1, Dispatch::Sent),
            deed(1.0, 0, Dispatch::Joined),
            deed(2.0, 0, Dispatch::CalledHome),
            deed(3.0, 0, Dispatch::Sent),
            deed(4.0, 0, Dispatch::Joined),
        ];
        let mut absences = Absences::default();
        BaseRecord { dispatched, ..BaseRecord::default() }.add_absences(3, &mut absences);
        let present: Vec<u64> = (0..200).filter(|&frame| absences.none_in(0, frame..frame + 1)).collect();
        assert_eq!(present, (32..64).chain(128..200).collect::<Vec<_>>());
        assert!((1..3).all(|robot| (0..200).all(|frame| !absences.none_in(robot, frame..frame + 1))));
    }
}

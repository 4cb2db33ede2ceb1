//! Which missions are drawn.

use super::class::Class;
use super::draw::{chance, whole};
use crate::random::Stream;
use crate::scenario::limits::MOST_TARGETS;
use grn_input::{InputError, Range};

/// Targets of a mission.
pub const TARGETS: Range<usize> = Range::new(1, MOST_TARGETS, "(a whole one)");
/// Robots of a mission: what its targets need at least and have room for.
pub const ROBOTS: Range<usize> =
    Range::new(ROBOTS_OF_TARGET[0], ROBOTS_OF_TARGET[1] * MOST_TARGETS, "(a whole one; 10 to 20 go to each target)");
/// Clearances of a mission. In less a robot of the usual scale has no play; much more asks for no adaptation.
pub const CLEARANCE: Range<f64> = Range::new(0.3, 3.0, "metres");
/// Robots for each target: fewer do not close a ring, for more there is no room on it.
const ROBOTS_OF_TARGET: [usize; 2] = [10, 20];
/// How probable a single target is, where it is possible; more are equally probable.
const SINGLE: f64 = 0.5;

/// The distribution that missions are drawn from.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampling {
    classes: Vec<Class>,
    /// Least and most.
    targets: [usize; 2],
    robots: [usize; 2],
    clearance: [f64; 2],
}

impl Default for Sampling {
    /// All classes, 1 to 10 targets, 10 to 200 robots, clearances from 0.6 to 1.2 m.
    fn default() -> Self {
        Sampling {
            classes: Class::ALL.to_vec(),
            targets: [TARGETS.low, TARGETS.high],
            robots: [ROBOTS.low, ROBOTS.high],
            clearance: [0.6, 1.2],
        }
    }
}

impl Sampling {
    /// Missions of these classes, all if none is named, with the least and most of everything else, lengths in metres.
    ///
    /// # Errors
    /// [`InputError`] with the key `targets`, `robots` or `clearance`: a number out of [`TARGETS`], [`ROBOTS`] or [`CLEARANCE`], a
    /// least that is above the most, or numbers of robots that go with no number of targets.
    pub fn new(
        classes: &[Class],
        targets: [usize; 2],
        robots: [usize; 2],
        clearance: [f64; 2],
    ) -> Result<Sampling, InputError> {
        let classes = Class::ALL.into_iter().filter(|class| classes.is_empty() || classes.contains(class)).collect();
        for (key, [least, most], range) in [("targets", targets, &TARGETS), ("robots", robots, &ROBOTS)] {
            range.check(key, least)?;
            range.check(key, most)?;
            check_order(key, least, most)?;
        }
        clearance.into_iter().try_for_each(|metres| CLEARANCE.check("clearance", metres).map(drop))?;
        check_order("clearance", clearance[0], clearance[1])?;
        let sampling = Sampling { classes, targets, robots, clearance };
        if sampling.possible_targets().next().is_none() {
            let [least, most] = ROBOTS_OF_TARGET;
            let [few, many] = targets;
            let way_out = format!(
                "{few} to {many} targets need {} to {} robots, {least} to {most} each; choose other robots or targets",
                few * least,
                many * most
            );
            return Err(InputError::new("robots", format!("{} {}", robots[0], robots[1]), way_out));
        }
        Ok(sampling)
    }

    /// The classes, each once, in the order in which they take turns.
    pub fn classes(&self) -> &[Class] {
        &self.classes
    }

    /// The class of mission `number`, from 0.
    pub fn class_of(&self, number: usize) -> Class {
        self.classes[number % self.classes.len()]
    }

    /// Least and most, metres.
    pub(super) fn clearance(&self) -> [f64; 2] {
        self.clearance
    }

    /// Draws a number of targets and one of robots.
    pub(super) fn swarm(&self, stream: &mut Stream) -> (usize, usize) {
        let possible: Vec<usize> = self.possible_targets().collect();
        let several = if possible.first() == Some(&1) { &possible[1..] } else { &possible[..] };
        let targets = match several {
            [] => 1,
            _ if several.len() < possible.len() && chance(stream, SINGLE) => 1,
            _ => several[whole(stream, 0, several.len() - 1)],
        };
        let [least, most] = self.robots_of(targets);
        (targets, whole(stream, least, most))
    }

    /// Numbers of targets for which a number of robots is possible, rising; at least one.
    fn possible_targets(&self) -> impl Iterator<Item = usize> {
        let [few, many] = self.targets;
        (few..=many).filter(|&targets| {
            let [least, most] = self.robots_of(targets);
            least <= most
        })
    }

    fn robots_of(&self, targets: usize) -> [usize; 2] {
        let [least, most] = ROBOTS_OF_TARGET;
        [self.robots[0].max(targets * least), self.robots[1].min(targets * most)]
    }
}

fn check_order<T: PartialOrd + std::fmt::Debug>(key: &str, least: T, most: T) -> Result<(), InputError> {
    if least <= most {
        return Ok(());
    }
    Err(InputError::new(key, format!("{least:?} {most:?}"), "the least comes first, then the most"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Component;

    fn refused(targets: [usize; 2], robots: [usize; 2], clearance: [f64; 2]) -> String {
        Sampling::new(&[], targets, robots, clearance).unwrap_err().to_string()
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(refused([0, 3], [10, 20], [0.6, 1.2]).contains("targets = 0: must be a number from 1 to 10"));
        assert!(refused([1, 3], [10, 201], [0.6, 1.2]).contains("robots = 201: must be a number from 10 to 200"));
        assert!(refused([3, 1], [10, 20], [0.6, 1.2]).contains("targets = 3 1: the least comes first"));
        assert!(refused([1, 1], [10, 20], [f64::NAN, 1.2]).contains("clearance = NaN"));
        let impossible = refused([5, 6], [10, 40], [0.6, 1.2]);
        assert!(impossible.contains("robots = 10 40: 5 to 6 targets need 50 to 120 robots"), "{impossible}");
    }

    #[test]
    fn only_numbers_in_the_ranges_are_drawn() {
        let sampling = Sampling::new(&[Class::Door], [2, 9], [35, 64], [0.6, 0.6]).unwrap();
        let mut stream = Stream::new(1, Component::Missions, 0);
        let drawn: Vec<(usize, usize)> = (0..2000).map(|_| sampling.swarm(&mut stream)).collect();
        for targets in 1..=10 {
            let of_targets = || drawn.iter().filter(|drawn| drawn.0 == targets).map(|drawn| drawn.1);
            let range = of_targets().min().zip(of_targets().max());
            let expected = match targets {
                2 => Some((35, 40)),
                3 => Some((35, 60)),
                4 => Some((40, 64)),
                5 => Some((50, 64)),
                6 => Some((60, 64)),
                _ => None,
            };
            assert_eq!(range, expected, "{targets} targets");
        }
    }
}

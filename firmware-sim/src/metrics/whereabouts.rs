//! Whether a robot is on the pattern, came off it, or never arrived.

/// A robot is off the pattern while it is farther from it than this share of the ring's radius, or nobody knows how far,
/// and it is not [`NEAR_TARGET`] either.
pub const ON_PATTERN: f64 = 0.5;
/// Nearer to a target than so many ring radii a robot is not away, however far the pattern is: as targets meet, their rings
/// merge and leave robots in their middle.
pub const NEAR_TARGET: f64 = 1.5;
/// A robot that is off the pattern for so long has left it, seconds. Going around another robot takes less.
pub const LEFT_AFTER_S: f64 = 5.0;

/// Where one robot was during a run, told moment by moment.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Whereabouts {
    arrived: bool,
    /// It has been on the pattern since it is in service.
    settled: bool,
    left: bool,
    /// Moments since it was last on the pattern.
    off: usize,
}

impl Whereabouts {
    /// One moment later; `left_after` is [`LEFT_AFTER_S`] in moments.
    pub fn observe(&mut self, on_pattern: bool, left_after: usize) {
        if on_pattern {
            (self.arrived, self.settled) = (true, true);
            self.off = 0;
        } else {
            self.off += 1;
            self.left |= self.settled && self.off >= left_after;
        }
    }

    /// It is out of service: when it is back it has to reach the pattern anew.
    pub fn suspend(&mut self) {
        (self.settled, self.off) = (false, 0);
    }

    /// It is off the pattern at the end: it left it or never reached it.
    pub fn is_lost(&self, left_after: usize) -> bool {
        self.off >= left_after || !self.arrived
    }

    /// It left the pattern and came back.
    pub fn has_strayed(&self, left_after: usize) -> bool {
        self.left && !self.is_lost(left_after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (lost, strayed) after these moments, with 3 moments off the pattern for leaving it.
    fn after(moments: &str) -> (bool, bool) {
        let mut robot = Whereabouts::default();
        moments.chars().for_each(|moment| match moment {
            'x' => robot.suspend(),
            moment => robot.observe(moment == 'o', 3),
        });
        (robot.is_lost(3), robot.has_strayed(3))
    }

    #[test]
    fn a_robot_is_lost_at_the_end_or_strays_between() {
        assert_eq!(after("-----oooo"), (false, false), "a late arrival");
        assert_eq!(after("oo--oo--o"), (false, false), "a detour");
        assert_eq!(after("oo---oooo"), (false, true));
        assert_eq!(after("oo---oo--"), (false, true));
        assert_eq!(after("oo---oo---"), (true, false));
        assert_eq!(after("--"), (true, false), "never arrived");
        assert_eq!(after("ooxx----oo"), (false, false), "on its way back");
        assert_eq!(after("oo--x--"), (false, false), "not for long enough");
        assert_eq!(after("ooxx---"), (true, false), "not back");
    }
}

//! What is wrong with one robot at the moment.

use crate::faults::Fault;
use crate::lab::FaultKind;
use grn_core::geometry::Vector;
use grn_core::robot::epuck2::PROXIMITY_SENSORS;

/// A proximity sensor that reads nothing, and one that seems to be touched.
const READS_NOTHING: u16 = u16::MAX;
const READS_TOUCHING: u16 = 0;

/// The faults of one robot.
#[derive(Debug)]
pub(super) struct Ailments {
    /// Those to come, the next one last.
    to_come: Vec<Fault>,
    present: Vec<Fault>,
    changes_at: u64,
    now: Condition,
}

/// What the present faults amount to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Condition {
    /// It stands still, is silent and does not think.
    pub off: bool,
    /// It neither hears nor is heard.
    pub without_radio: bool,
    /// Wheels that do not turn.
    pub stuck: [bool; 2],
    /// By how much its poses are off, metres.
    pub jump: Vector<f64>,
    /// What sensors read whatever is in front of them.
    readings: [Option<u16>; PROXIMITY_SENSORS],
}

impl Condition {
    /// Nothing is wrong.
    const SOUND: Condition = Condition {
        off: false,
        without_radio: false,
        stuck: [false; 2],
        jump: Vector::ZERO,
        readings: [None; PROXIMITY_SENSORS],
    };

    /// What the proximity sensors read instead of this.
    pub fn readings(&self, sound: [u16; PROXIMITY_SENSORS]) -> [u16; PROXIMITY_SENSORS] {
        let mut readings = sound;
        for (reading, faulty) in readings.iter_mut().zip(self.readings) {
            *reading = faulty.unwrap_or(*reading);
        }
        readings
    }

    fn suffer(&mut self, fault: &Fault) {
        match (fault.kind, fault.part()) {
            (FaultKind::Stop | FaultKind::Reboot | FaultKind::Late, _) => self.off = true,
            (FaultKind::Radio, _) => self.without_radio = true,
            (FaultKind::TrackerJump, _) => self.jump = self.jump + fault.jump(),
            (FaultKind::Wheel, Some(wheel)) => self.stuck[wheel] = true,
            (FaultKind::SensorDead, Some(sensor)) => self.readings[sensor] = Some(READS_NOTHING),
            (FaultKind::SensorShorted, Some(sensor)) => self.readings[sensor] = Some(READS_TOUCHING),
            // The swarm has set it down elsewhere already.
            (FaultKind::Carried, _) => {}
            (FaultKind::Wheel | FaultKind::SensorDead | FaultKind::SensorShorted, None) => {}
        }
    }
}

impl Ailments {
    /// These faults, by when they begin.
    pub fn new(mut faults: Vec<Fault>) -> Self {
        faults.reverse();
        let changes_at = faults.last().map_or(u64::MAX, |first| first.from);
        Ailments { to_come: faults, present: Vec::new(), changes_at, now: Condition::SOUND }
    }

    /// Whether something begins or ends in this frame.
    pub fn change_in(&self, frame: u64) -> bool {
        frame >= self.changes_at
    }

    /// What is wrong now.
    pub fn now(&self) -> &Condition {
        &self.now
    }

    /// Lets faults begin and end; whether the robot reboots.
    pub fn update(&mut self, frame: u64) -> bool {
        let mut reboots = false;
        while let Some(begun) = self.to_come.pop_if(|next| next.from <= frame) {
            reboots |= begun.kind == FaultKind::Reboot;
            self.present.push(begun);
        }
        self.present.retain(|fault| fault.until.is_none_or(|until| until > frame));
        let ends = self.present.iter().filter_map(|fault| fault.until).min();
        let begins = self.to_come.last().map(|next| next.from);
        self.changes_at = ends.into_iter().chain(begins).min().unwrap_or(u64::MAX);
        self.now = Condition::SOUND;
        self.present.iter().for_each(|fault| self.now.suffer(fault));
        reboots
    }
}

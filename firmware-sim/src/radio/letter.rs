//! A message on its way.

use crate::random::Draws;
use grn_core::robot::message::MAX_REPORTED_OBSTACLES;
use grn_core::robot::radio::packed;
use grn_core::robot::{Message, Millimetres, ObstacleReport, TargetReport};

/// A message in a form of fixed size, which is copied faster than lists of variable length.
#[derive(Clone, Copy, Debug)]
pub struct Letter {
    /// When it was sent, microseconds since the start.
    pub sent_us: u64,
    sender: u16,
    position: Millimetres,
    target: Option<TargetReport>,
    reports: usize,
    obstacles: [ObstacleReport; MAX_REPORTED_OBSTACLES],
}

impl Letter {
    /// No message.
    pub const BLANK: Letter = Letter {
        sent_us: 0,
        sender: 0,
        position: Millimetres { x: 0, y: 0 },
        target: None,
        reports: 0,
        obstacles: [ObstacleReport { position: Millimetres { x: 0, y: 0 }, age: 0 }; MAX_REPORTED_OBSTACLES],
    };

    /// A message sent at this time.
    pub fn of(message: &Message, sent_us: u64) -> Self {
        let Message { sender, position, target, obstacles } = message;
        let (sender, position, target, reports) = (*sender, *position, *target, obstacles.len());
        let mut letter = Letter { sent_us, sender, position, target, reports, ..Letter::BLANK };
        for (slot, report) in letter.obstacles.iter_mut().zip(obstacles) {
            *slot = *report;
        }
        letter
    }

    /// What it says of a target.
    pub fn target(&self) -> Option<TargetReport> {
        self.target
    }

    /// The message.
    pub fn message(&self) -> Message {
        let obstacles = self.obstacles.into();
        let mut message = Message { sender: self.sender, position: self.position, target: self.target, obstacles };
        message.obstacles.truncate(self.reports);
        message
    }
}

/// What a receiver makes of a message of whose packed bytes one arrives wrong: nothing, unless the checksum fits by chance.
pub fn corrupted(message: &Message, draws: Draws, index: u32) -> Option<Message> {
    let mut bytes = packed::write(message);
    let draw = draws.at(index);
    let place = draw as usize % bytes.len();
    // Any other byte, each as likely.
    if let Some(byte) = bytes.get_mut(place) {
        *byte ^= 1 + ((draw >> 16) % 255) as u8;
    }
    packed::read(&bytes).ok()
}

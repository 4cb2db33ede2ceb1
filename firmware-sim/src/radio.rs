//! Broadcasts between robots: limited range, independent loss, the nearest first. Walls do not block it.

use crate::grid::Grid;
use crate::random::{Component, Stream};
use grn_core::geometry::Point;
use grn_core::robot::message::MAX_REPORTED_OBSTACLES;
use grn_core::robot::percept::MAX_HEARD;
use grn_core::robot::{Heard, Message, Millimetres, ObstacleReport, TargetReport};
use serde::{Deserialize, Serialize};

/// How far the radio reaches and how much it loses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RadioConfig {
    /// Farthest reception, real metres, positive; not scaled with the world.
    pub range_m: f64,
    /// Probability in [0, 1] that a receiver in range misses a message; independent for every receiver and message.
    pub loss: f64,
}

impl Default for RadioConfig {
    /// The range-and-bearing board: 0.7 m, and one message in ten lost.
    fn default() -> Self {
        RadioConfig { range_m: 0.7, loss: 0.1 }
    }
}

/// The ether: holds what was sent in the last tick and delivers it in the next.
#[derive(Debug)]
pub struct Radio {
    range_squared: f64,
    /// Below this draw a message is lost.
    lost_below: u64,
    grid: Grid,
    sent: Ether,
    sending: Ether,
    /// Messages lost, by receiver.
    losses: Vec<Stream>,
}

/// The broadcasts of one tick.
#[derive(Debug)]
struct Ether {
    senders: Vec<u16>,
    /// By robot number; only those of `senders` are of this tick.
    letters: Vec<Letter>,
}

/// A message in a form of fixed size, which is copied faster than lists of variable length.
#[derive(Clone, Copy, Debug)]
struct Letter {
    sender: u16,
    position: Millimetres,
    target: Option<TargetReport>,
    reports: usize,
    obstacles: [ObstacleReport; MAX_REPORTED_OBSTACLES],
}

impl Letter {
    const BLANK: Letter = Letter {
        sender: 0,
        position: Millimetres { x: 0, y: 0 },
        target: None,
        reports: 0,
        obstacles: [ObstacleReport { position: Millimetres { x: 0, y: 0 }, age: 0 }; MAX_REPORTED_OBSTACLES],
    };

    fn of(message: &Message) -> Self {
        let Message { sender, position, target, obstacles } = message;
        let mut letter =
            Letter { sender: *sender, position: *position, target: *target, reports: obstacles.len(), ..Letter::BLANK };
        for (slot, report) in letter.obstacles.iter_mut().zip(obstacles) {
            *slot = *report;
        }
        letter
    }

    fn message(&self) -> Message {
        let obstacles = self.obstacles.into();
        let mut message = Message { sender: self.sender, position: self.position, target: self.target, obstacles };
        message.obstacles.truncate(self.reports);
        message
    }
}

/// A sender as a number that sorts by distance and then by number: the squared distance's bits (nonnegative floats sort
/// like their bits), of which the last eight give way to the sender's number, at most 255.
fn rank(sender: u16, squared: f64) -> u64 {
    (squared.to_bits() & !0xff) | u64::from(sender & 0xff)
}

/// Ranks after every sender.
const NOBODY: u64 = u64::MAX;

impl Radio {
    /// An empty ether for this many robots.
    pub fn new(config: RadioConfig, seed: u64, robots: usize) -> Self {
        let ether = || Ether { senders: Vec::with_capacity(robots), letters: vec![Letter::BLANK; robots] };
        Radio {
            range_squared: config.range_m * config.range_m,
            lost_below: (config.loss * 4_294_967_296.0) as u64,
            grid: Grid::new(config.range_m, robots),
            sent: ether(),
            sending: ether(),
            losses: (0..robots).map(|robot| Stream::new(seed, Component::Radio, robot)).collect(),
        }
    }

    /// Begins a tick: says where the robots are when messages arrive. What was sent in a tick that was broken off is void.
    pub fn locate(&mut self, positions: &[Point<f64>]) {
        self.sending.senders.clear();
        self.grid.rebuild(self.sent.senders.iter().map(|&sender| (sender, positions[usize::from(sender)])));
    }

    /// What `sender` broadcasts in this tick, if anything, to be heard in the next; asked once a tick.
    pub fn send(&mut self, sender: usize, message: Option<&Message>) {
        if let Some(message) = message {
            self.sending.senders.push(sender as u16);
            self.sending.letters[sender] = Letter::of(message);
        }
    }

    /// Ends a tick: what was sent in it can now be heard, and nothing older.
    pub fn tick_over(&mut self) {
        core::mem::swap(&mut self.sent, &mut self.sending);
    }

    /// What `receiver` hears at `position`: of the messages from senders in range, each lost or not
    /// by an independent draw, as many as the inbox holds, nearest first (equally near ones by number).
    pub fn deliver(&mut self, receiver: usize, position: Point<f64>) -> heapless::Vec<Heard, MAX_HEARD> {
        let mut heard = heapless::Vec::new();
        if self.sent.senders.is_empty() {
            return heard;
        }
        let draws = self.losses[receiver].draws();
        let mut nearest = [NOBODY; MAX_HEARD];
        self.grid.around(position, |sender, squared| {
            let in_range = (squared <= self.range_squared) & (usize::from(sender) != receiver);
            let mut moving = if in_range { rank(sender, squared) } else { NOBODY };
            if moving < nearest[MAX_HEARD - 1] && u64::from(draws.at(sender)) >= self.lost_below {
                for slot in &mut nearest {
                    (*slot, moving) = (moving.min(*slot), moving.max(*slot));
                }
            }
        });
        for rank in nearest.into_iter().take_while(|&rank| rank != NOBODY) {
            // As many as fit were chosen.
            let message = self.sent.letters[(rank & 0xff) as usize].message();
            let _ = heard.push(Heard { message, age_ms: 0 });
        }
        heard
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grn_core::geometry::Vector;

    fn message(sender: usize) -> Message {
        let position = Millimetres { x: sender as i16, y: 0 };
        Message { sender: sender as u16, position, target: None, obstacles: Default::default() }
    }

    /// Who hears whom with robots on a line at these places (metres).
    fn heard(config: RadioConfig, places: &[f64], receiver: usize) -> Vec<u16> {
        let positions: Vec<Point<f64>> = places.iter().map(|&x| Vector::new(x, 0.0)).collect();
        let mut radio = Radio::new(config, 1, places.len());
        (0..places.len()).for_each(|sender| radio.send(sender, Some(&message(sender))));
        radio.tick_over();
        radio.locate(&positions);
        radio.deliver(receiver, positions[receiver]).iter().map(|heard| heard.message.sender).collect()
    }

    #[test]
    fn range_is_sharp_and_nobody_hears_itself() {
        let lossless = RadioConfig { range_m: 0.7, loss: 0.0 };
        assert_eq!(heard(lossless, &[0.0, 0.69, 0.71, -0.3, -5.0], 0), [3, 1]);
        assert!(heard(lossless, &[0.0, 0.8], 0).is_empty());
        assert!(heard(RadioConfig { loss: 1.0, ..lossless }, &[0.0, 0.1, 0.2], 0).is_empty());
    }

    #[test]
    fn the_nearest_fill_the_inbox() {
        let lossless = RadioConfig { range_m: 10.0, loss: 0.0 };
        let places: Vec<f64> = (0..60).map(|i| f64::from(i * 7 % 60) * 0.1).collect();
        let senders = heard(lossless, &places, 0);
        assert_eq!(senders.len(), MAX_HEARD);
        let far: Vec<f64> = senders.iter().map(|&s| places[usize::from(s)]).collect();
        assert_eq!(far, (1..=8).map(|i| f64::from(i) * 0.1).collect::<Vec<_>>());
    }

    #[test]
    fn losses_are_as_frequent_as_asked_and_independent() {
        let positions = [0.0, 0.1, 0.2].map(|x| Vector::new(x, 0.0));
        let mut radio = Radio::new(RadioConfig { range_m: 0.7, loss: 0.3 }, 5, 3);
        radio.send(1, Some(&message(1)));
        radio.send(2, Some(&message(2)));
        radio.tick_over();
        radio.locate(&positions);
        let (mut one, mut two, mut both) = (0, 0, 0);
        let n = 20_000;
        for _ in 0..n {
            let heard = radio.deliver(0, positions[0]);
            let has = |s: u16| heard.iter().any(|h| h.message.sender == s);
            one += u32::from(has(1));
            two += u32::from(has(2));
            both += u32::from(has(1) && has(2));
        }
        let share = |count: u32| f64::from(count) / f64::from(n);
        assert!((share(one) - 0.7).abs() < 0.015 && (share(two) - 0.7).abs() < 0.015, "{one} {two}");
        assert!((share(both) - 0.49).abs() < 0.015, "{both}");
    }

    #[test]
    fn a_crowd_with_heavy_losses_is_searched_to_the_end() {
        // Half the messages get lost in a crowd of 40, and the inbox still fills, with the nearest of the others.
        let positions: Vec<Point<f64>> = (0..40).map(|i| Vector::new(f64::from(i) * 0.01, 0.0)).collect();
        let mut radio = Radio::new(RadioConfig { range_m: 0.7, loss: 0.5 }, 6, 40);
        (0..40).for_each(|sender| radio.send(sender, Some(&message(sender))));
        radio.tick_over();
        radio.locate(&positions);
        for _ in 0..1000 {
            let heard = radio.deliver(0, positions[0]);
            assert_eq!(heard.len(), MAX_HEARD);
            assert!(heard.windows(2).all(|pair| pair[0].message.sender < pair[1].message.sender));
        }
    }
}

//! Broadcasts between robots: limited range, independent loss, the nearest first. Walls do not block it.

use crate::grid::{Grid, Neighbour, ROOM};
use crate::random::{Component, Stream};
use grn_core::geometry::Point;
use grn_core::robot::Message;
use grn_core::robot::percept::Percept;
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

/// Candidates looked at first: enough for a full inbox at usual losses.
const USUAL_CANDIDATES: usize = 12;

/// The ether: holds what was sent in the last tick and delivers it in the next.
#[derive(Debug)]
pub struct Radio {
    range_squared: f64,
    loss: f64,
    grid: Grid,
    /// What is in the air now, by sender.
    sent: Vec<Option<Message>>,
    /// What will be in the next tick.
    sending: Vec<Option<Message>>,
    receivers: Vec<Receiver>,
    candidates: Box<[Neighbour; ROOM]>,
}

#[derive(Debug)]
struct Receiver {
    losses: Stream,
    /// A guess, from the last tick, of the squared distance within which there are enough senders. It saves time and
    /// changes no result.
    enough: f64,
}

impl Radio {
    /// An empty ether for this many robots.
    pub fn new(config: RadioConfig, seed: u64, robots: usize) -> Self {
        let range_squared = config.range_m * config.range_m;
        let receiver = |robot| Receiver { losses: Stream::new(seed, Component::Radio, robot), enough: range_squared };
        Radio {
            range_squared,
            loss: config.loss,
            grid: Grid::new(config.range_m, robots),
            sent: vec![None; robots],
            sending: vec![None; robots],
            receivers: (0..robots).map(receiver).collect(),
            candidates: Box::new([Neighbour::default(); ROOM]),
        }
    }

    /// Says where the robots are when messages arrive.
    pub fn locate(&mut self, positions: &[Point<f64>]) {
        self.grid.rebuild(positions);
    }

    /// What `sender` broadcasts in this tick, to be heard in the next.
    pub fn send(&mut self, sender: usize, message: Option<Message>) {
        self.sending[sender] = message;
    }

    /// Ends a tick: what was sent in it can now be heard, and nothing older.
    pub fn tick_over(&mut self) {
        core::mem::swap(&mut self.sent, &mut self.sending);
        self.sending.fill(None);
    }

    /// Puts what `receiver` hears at `position` into its percept: senders in range, nearest first (equally near ones by
    /// number), each lost or not by an independent draw, until the inbox is full.
    pub fn deliver(&mut self, receiver: usize, position: Point<f64>, percept: &mut Percept) {
        percept.heard.clear();
        let Receiver { losses, enough } = &mut self.receivers[receiver];
        // All bits that a neighbour's number takes the place of are set: none of equal rank is cut off.
        let near = f64::from_bits(enough.to_bits() | 0xff).min(self.range_squared);
        // First the near senders; only if they do not fill the inbox, the others, which sort after them.
        let mut done = 0;
        for limit in [near, self.range_squared] {
            let count = self.grid.collect_within(position, limit, &mut self.candidates);
            let candidates = &mut self.candidates[..count];
            candidates.sort_unstable();
            *enough = match candidates.get(USUAL_CANDIDATES) {
                Some(last) => last.squared() * 1.1,
                None => limit * 2.0,
            };
            for sender in candidates.iter().skip(done).map(|candidate| candidate.robot()) {
                if sender == receiver {
                    continue;
                }
                let Some(message) = &self.sent[sender] else { continue };
                if losses.unit() >= self.loss && percept.heard.push(message.clone()).is_ok() && percept.heard.is_full()
                {
                    return;
                }
            }
            if limit >= self.range_squared {
                return;
            }
            done = count;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grn_core::geometry::Vector;
    use grn_core::robot::Millimetres;
    use grn_core::robot::percept::MAX_HEARD;

    fn message(sender: usize) -> Option<Message> {
        let position = Millimetres { x: sender as i16, y: 0 };
        Some(Message { sender: sender as u8, position, target: None, obstacles: Default::default() })
    }

    /// Who hears whom with robots on a line at these places (metres).
    fn heard(config: RadioConfig, places: &[f64], receiver: usize) -> Vec<u8> {
        let positions: Vec<Point<f64>> = places.iter().map(|&x| Vector::new(x, 0.0)).collect();
        let mut radio = Radio::new(config, 1, places.len());
        (0..places.len()).for_each(|sender| radio.send(sender, message(sender)));
        radio.tick_over();
        radio.locate(&positions);
        let mut percept = Percept::default();
        radio.deliver(receiver, positions[receiver], &mut percept);
        percept.heard.iter().map(|message| message.sender).collect()
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
        radio.send(1, message(1));
        radio.send(2, message(2));
        radio.tick_over();
        radio.locate(&positions);
        let (mut one, mut two, mut both) = (0, 0, 0);
        let n = 20_000;
        let mut percept = Percept::default();
        for _ in 0..n {
            radio.deliver(0, positions[0], &mut percept);
            let has = |s: u8| percept.heard.iter().any(|m| m.sender == s);
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
        // The shortcut's guess must not hide senders: half the messages get lost in a crowd of 40, and the inbox fills.
        let positions: Vec<Point<f64>> = (0..40).map(|i| Vector::new(f64::from(i) * 0.01, 0.0)).collect();
        let mut radio = Radio::new(RadioConfig { range_m: 0.7, loss: 0.5 }, 6, 40);
        (0..40).for_each(|sender| radio.send(sender, message(sender)));
        radio.tick_over();
        radio.locate(&positions);
        let mut percept = Percept::default();
        for _ in 0..1000 {
            radio.deliver(0, positions[0], &mut percept);
            assert_eq!(percept.heard.len(), MAX_HEARD);
            assert!(percept.heard.windows(2).all(|pair| pair[0].sender < pair[1].sender));
        }
    }
}

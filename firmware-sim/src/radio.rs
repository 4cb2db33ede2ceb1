//! Broadcasts between robots: limited range, delay, losses, the nearest first.
//!
//! How a message travels:
//!
//! 1. A robot sends it at one of its control ticks. If it does not fit into one packet, its packets leave one a frame.
//! 2. In the frame after its last packet, and `latency_s` later, it can be heard from where its sender was in that frame.
//! 3. A receiver in range misses it or not: alone, in a row of losses, or because a wall or a robot is in between.
//! 4. Of what it hears between two of its ticks a robot keeps as many messages as its inbox holds, nearest first.

mod letter;

pub use letter::Letter;

use crate::bursts::Bursts;
use crate::geometry::{Walls, length_squared};
use crate::grid::Grid;
use crate::lab::{self, MOST_PACKETS};
use crate::random::{Component, DrawSeries, Draws, Stream};
use crate::timing::{FRAME_US, frames_in};
use grn_core::geometry::Point;
use grn_core::robot::epuck2::BODY_RADIUS;
use grn_core::robot::percept::MAX_HEARD;
use grn_core::robot::{Heard, Message};
use letter::corrupted;

/// The farthest that noise carries a range, in standard deviations.
const MOST_DEVIATIONS: f64 = 3.5;

/// The ether: holds what was sent in the last frames until everybody can have heard it.
#[derive(Debug)]
pub struct Ether {
    radio: lab::Radio,
    seed: u64,
    latency_frames: u64,
    /// Below this draw a message of so many packets (less one) is lost.
    lost_below: [u64; MOST_PACKETS],
    bursts: Option<Bursts>,
    /// Whether messages are stopped by distance and by chance only, each in one packet.
    ordinary: bool,
    /// The frames that can still be heard, and those to come; frame f is at f modulo their number.
    frames: Vec<Sent>,
    now: u64,
}

/// The broadcasts whose last packet was sent in one frame.
#[derive(Debug)]
struct Sent {
    senders: Vec<u16>,
    /// By robot number; only those of `senders` are of this frame.
    letters: Vec<(Letter, u8)>,
    /// Where senders were at the frame's end.
    grid: Grid,
}

/// One robot's end of the radio.
#[derive(Clone, Debug)]
pub struct Receiver {
    robot: u16,
    stream: Stream,
    luck: DrawSeries,
    failing: bool,
    /// The first frame whose broadcasts it has not been offered.
    next_frame: u64,
}

/// A sender as a number that sorts by distance, then by the frame, then by the sender's number: the squared distance, whose
/// last twenty bits give way to the others (nonnegative floats sort like their bits).
fn rank(sender: u16, age: u64, squared: f64) -> f64 {
    f64::from_bits((squared.to_bits() & !0xf_ffff) | (age & 0xf) << 16 | u64::from(sender))
}

/// Ranks after every sender.
const NOBODY: f64 = f64::INFINITY;

/// Sorts a rank in among the nearest, of which the last drops out. Every place is computed beside the others, from what was in
/// it and before it.
#[inline]
fn sort_in(nearest: &mut [f64; MAX_HEARD], rank: f64) {
    // Not `f64::min` and `f64::max`, which care for NaN.
    let smaller = |a: f64, b: f64| if a < b { a } else { b };
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let before = *nearest;
    nearest[0] = smaller(before[0], rank);
    for place in 1..MAX_HEARD {
        nearest[place] = larger(before[place - 1], smaller(before[place], rank));
    }
}

/// The most frames that one tick of a receiver covers: a tick takes at most 0.2 s.
const MOST_OFFERED: u64 = 15;

impl Ether {
    /// An empty ether for this many robots.
    pub fn new(radio: &lab::Radio, seed: u64, robots: usize) -> Self {
        let latency_frames = frames_in(radio.latency_s);
        // A power of two, so that a frame's place is found without dividing.
        let kept = (latency_frames + MOST_OFFERED + MOST_PACKETS as u64 + 1).next_power_of_two();
        let reach = radio.range_m * (1.0 + MOST_DEVIATIONS * radio.range_noise);
        let sent =
            |_| Sent { senders: Vec::new(), letters: vec![(Letter::BLANK, 0); robots], grid: Grid::new(reach, robots) };
        let loss = if radio.burst_s > 0.0 { 0.0 } else { radio.loss };
        let mut arrived = 1.0;
        let lost_below = [(); MOST_PACKETS].map(|()| {
            arrived *= 1.0 - loss;
            ((1.0 - arrived) * 4_294_967_296.0) as u64
        });
        Ether {
            radio: *radio,
            seed,
            latency_frames,
            lost_below,
            bursts: (radio.burst_s > 0.0).then(|| Bursts::new(radio.loss, radio.burst_s, FRAME_US as f64 * 1e-6)),
            ordinary: radio.payload_bytes == 0
                && radio.range_noise <= 0.0
                && radio.echo <= 0.0
                && !(radio.walls_block || radio.bodies_block),
            frames: (0..kept).map(sent).collect(),
            now: 0,
        }
    }

    /// Robot number `robot`'s end.
    pub fn receiver(&self, robot: usize) -> Receiver {
        let mut stream = Stream::new(self.seed, Component::Radio, robot);
        let failing = self.bursts.is_some_and(|bursts| bursts.first(&mut stream));
        let luck = DrawSeries::new(self.seed, Component::Radio, robot);
        Receiver { robot: robot as u16, stream, luck, failing, next_frame: 0 }
    }

    fn slot(&self, frame: u64) -> usize {
        frame as usize & (self.frames.len() - 1)
    }

    /// Begins frame number `frame`: says where robots are now. What was sent before can be heard from there.
    pub fn begin(&mut self, frame: u64, positions: &[Point<f64>]) {
        self.now = frame;
        if let Some(last) = frame.checked_sub(1) {
            let slot = self.slot(last);
            let Sent { senders, grid, .. } = &mut self.frames[slot];
            grid.rebuild(senders.iter().map(|&sender| (sender, positions[usize::from(sender)])));
        }
        // The last frame in which a message that is sent now can end; its place still holds an old frame's.
        let last = self.slot(frame + MOST_PACKETS as u64 - 1);
        self.frames[last].senders.clear();
    }

    /// What `sender` broadcasts in this frame.
    pub fn send(&mut self, sender: usize, letter: &Letter) {
        let packets = match self.radio.payload_bytes {
            0 => 1,
            payload => lab::packets(&letter.message(), payload).clamp(1, MOST_PACKETS),
        };
        let slot = self.slot(self.now + packets as u64 - 1);
        let Sent { senders, letters, .. } = &mut self.frames[slot];
        senders.push(sender as u16);
        letters[sender] = (*letter, packets as u8 - 1);
    }

    /// Fills `heard` with what a receiver hears at the time `now_us`, in this frame, at `position`: of what it was not offered
    /// before.
    pub fn deliver(
        &self,
        receiver: &mut Receiver,
        position: Point<f64>,
        now_us: u64,
        obstruction: &Obstruction<'_>,
        heard: &mut heapless::Vec<Heard, MAX_HEARD>,
    ) {
        heard.clear();
        let Some(last) = self.now.checked_sub(1 + self.latency_frames) else { return };
        let first = receiver.next_frame.max((last + 1).saturating_sub(MOST_OFFERED));
        receiver.next_frame = last + 1;
        let mut nearest = [NOBODY; MAX_HEARD];
        for frame in first..last + 1 {
            self.offer(frame, last - frame, receiver, position, obstruction, &mut nearest);
        }
        for rank in nearest.into_iter().take_while(|&rank| rank < NOBODY).map(f64::to_bits) {
            let (sender, frame) = ((rank & 0xffff) as usize, last - (rank >> 16 & 0xf));
            let (letter, _) = &self.frames[self.slot(frame)].letters[sender];
            let age_ms = ((now_us.saturating_sub(letter.sent_us) + 500) / 1000).min(u64::from(u16::MAX)) as u16;
            // As many as fit were chosen.
            let _ = heard.push(Heard { message: letter.message(), age_ms });
            if self.radio.corruption > 0.0
                && let Some(sound) = heard.pop()
                && let Some(message) = self.received(sound.message, receiver.robot, frame)
            {
                let _ = heard.push(Heard { message, age_ms });
            }
        }
    }

    /// What could be heard by now passes a receiver by.
    pub fn miss(&self, receiver: &mut Receiver) {
        receiver.next_frame = receiver.next_frame.max(self.now.saturating_sub(self.latency_frames));
    }

    /// Sorts those of one frame's messages that the receiver does not miss in among the nearest.
    fn offer(
        &self,
        frame: u64,
        age: u64,
        receiver: &mut Receiver,
        position: Point<f64>,
        obstruction: &Obstruction<'_>,
        nearest: &mut [f64; MAX_HEARD],
    ) {
        if let Some(bursts) = self.bursts {
            receiver.failing = bursts.next(receiver.failing, &mut receiver.stream);
            if receiver.failing {
                return;
            }
        }
        let Sent { senders, letters, grid, .. } = &self.frames[self.slot(frame)];
        if senders.is_empty() {
            return;
        }
        let own = receiver.robot;
        let draws = receiver.luck.at(frame);
        let limit = self.radio.range_m * self.radio.range_m;
        if self.ordinary {
            return grid.within(position, limit, |sender, squared| {
                let rank = rank(sender, age, squared);
                let farther = rank >= nearest[MAX_HEARD - 1];
                if (sender == own) | farther || u64::from(draws.at(u32::from(sender))) < self.lost_below[0] {
                    return;
                }
                sort_in(nearest, rank);
            });
        }
        grid.around(position, |sender, squared| {
            let limit = if self.radio.range_noise > 0.0 { self.noisy_limit(draws, sender) } else { limit };
            let rank = rank(sender, age, squared);
            let hidden = sender == own && self.radio.echo <= 0.0;
            if squared > limit || hidden || rank >= nearest[MAX_HEARD - 1] {
                return;
            }
            let packets = usize::from(letters[usize::from(sender)].1);
            let arrives = u64::from(draws.at(u32::from(sender))) >= self.lost_below[packets];
            if arrives && self.passes(sender, own, draws, position, obstruction) {
                sort_in(nearest, rank);
            }
        });
    }

    /// The square of the range for a message of this sender.
    fn noisy_limit(&self, draws: Draws, sender: u16) -> f64 {
        // Four uniform draws, as for every noise.
        let draw = |k: u32| draws.at(u32::from(sender) | k << 16);
        let halves = |draw: u32| f64::from(draw >> 16) + f64::from(draw & 0xffff);
        let normal = (halves(draw(1)) - halves(draw(2))) * (1.732_050_807_568_877_2 / 65_536.0);
        let range = self.radio.range_m * (1.0 + self.radio.range_noise * normal);
        range * range
    }

    /// Whether nothing in between stops a message, and whether an own one comes back.
    fn passes(&self, sender: u16, own: u16, draws: Draws, position: Point<f64>, obstruction: &Obstruction<'_>) -> bool {
        if sender == own {
            return f64::from(draws.at(u32::from(sender) | 3 << 16)) < self.radio.echo * 4_294_967_296.0;
        }
        let from = obstruction.positions[usize::from(sender)];
        (!self.radio.walls_block || !obstruction.wall_between(from, position))
            && (!self.radio.bodies_block || !obstruction.body_between([sender, own], from, position))
    }

    /// The message as it arrives.
    fn received(&self, message: Message, receiver: u16, frame: u64) -> Option<Message> {
        let draws = DrawSeries::new(self.seed, Component::Corruption, usize::from(receiver)).at(frame);
        let sender = u32::from(message.sender);
        if f64::from(draws.at(sender)) >= self.radio.corruption * 4_294_967_296.0 {
            return Some(message);
        }
        corrupted(&message, draws, sender | 1 << 16)
    }
}

/// What can stand between a sender and a receiver.
#[derive(Clone, Copy, Debug)]
pub struct Obstruction<'a> {
    /// Walls.
    pub walls: &'a Walls,
    /// Every robot's place.
    pub positions: &'a [Point<f64>],
}

impl Obstruction<'_> {
    fn wall_between(&self, from: Point<f64>, to: Point<f64>) -> bool {
        let way = to - from;
        let Some(direction) = way.direction() else { return false };
        self.walls.ray(from, direction, way.length()).is_some()
    }

    /// Whether a robot other than the two at the ends stands in the way. These are told by their numbers: a receiver may have moved on
    /// since the frame began, and its own old place stands in nobody's way.
    fn body_between(&self, ends: [u16; 2], from: Point<f64>, to: Point<f64>) -> bool {
        let way = to - from;
        let squared = length_squared(way);
        self.positions.iter().enumerate().any(|(robot, &body)| {
            let offset = body - from;
            let along = offset.dot(way);
            let beside = along > 0.0 && along < squared;
            let aside = offset.cross(way);
            beside
                && aside * aside < BODY_RADIUS * BODY_RADIUS * squared
                && ends.iter().all(|&end| usize::from(end) != robot)
        })
    }
}

#[cfg(test)]
mod tests;

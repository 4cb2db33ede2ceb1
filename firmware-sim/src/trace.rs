//! A recorded run: poses, wheel commands, targets and contacts of every tick, or of every n-th, in integers.
//!
//! # Binary layout, version 2
//! Little-endian throughout, no padding, nothing after the last frame.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | magic `grntrace` |
//! | 2 | version, 2 |
//! | 2 + n | length n of the scenario's name, then the name in UTF-8 |
//! | 8, 8 | seed (u64), scale (f64) |
//! | 8, 8 | settle_s (f64), target_speed_m_per_s (f64) |
//! | 2, 2, 2, 2 | ticks per second, robots, mothers, targets (u16) |
//! | 4 | ticks per frame n (u32), at least 1 |
//! | 4 | frames (u32); frame 0 is the start, frame k the world after tick k · n |
//!
//! and per frame
//!
//! | bytes | content |
//! |---|---|
//! | 4 · 2 per target | x, y in micrometres (i32); -2^31 for both while it is not there |
//! | 16 per robot | x, y in micrometres (i32), heading (cos, sin) in 2^-14, left and right command in steps/s (i16) |
//! | 16 | peer events and wall events since the frame before, pairs in contact, robots at walls (u32) |
//!
//! Version 1, which is read too, has no ticks per frame (every tick is a frame), and contacts in u16, 8 bytes.

mod frame;
mod header;

use crate::contacts::ContactCounts;
use core::fmt;
pub use frame::{Frame, Observer, RobotState, metres};
pub use header::TraceHeader;

const MAGIC: &[u8; 8] = b"grntrace";
/// The layout's version.
pub const VERSION: u16 = 2;
/// What stands for the place of a target that is not there.
pub const NOT_THERE: [i32; 2] = [i32::MIN; 2];
/// By how much the contacts of a frame in version 1 are shorter.
const NARROWER: usize = 8;

/// A recorded run.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    header: TraceHeader,
    targets: Vec<Option<[i32; 2]>>,
    robots: Vec<RobotState>,
    contacts: Vec<ContactCounts>,
}

impl Trace {
    /// A trace without frames.
    pub fn new(header: TraceHeader) -> Self {
        Trace { header, targets: Vec::new(), robots: Vec::new(), contacts: Vec::new() }
    }

    fn push(&mut self, targets_um: &[Option<[i32; 2]>], robots: &[RobotState], contacts: ContactCounts) {
        debug_assert_eq!(targets_um.len(), usize::from(self.header.targets));
        debug_assert_eq!(robots.len(), usize::from(self.header.robots));
        self.targets.extend_from_slice(targets_um);
        self.robots.extend_from_slice(robots);
        self.contacts.push(contacts);
    }

    /// Forgets every second frame and returns the events that were seen after the last one that is left.
    fn halve(&mut self) -> ContactCounts {
        let (targets, robots) = (usize::from(self.header.targets), usize::from(self.header.robots));
        let left = self.len().div_ceil(2);
        for frame in 1..left {
            self.targets.copy_within(2 * frame * targets..(2 * frame + 1) * targets, frame * targets);
            self.robots.copy_within(2 * frame * robots..(2 * frame + 1) * robots, frame * robots);
            self.contacts[frame] = self.contacts[2 * frame].after(self.contacts[2 * frame - 1]);
        }
        let forgotten = if self.len() == 2 * left { self.contacts[2 * left - 1] } else { ContactCounts::default() };
        self.targets.truncate(left * targets);
        self.robots.truncate(left * robots);
        self.contacts.truncate(left);
        self.header.ticks_per_frame *= 2;
        forgotten
    }

    /// What it is of.
    pub fn header(&self) -> &TraceHeader {
        &self.header
    }

    /// Seconds from the start to this frame.
    pub fn seconds(&self, frame: usize) -> f64 {
        frame as f64 * f64::from(self.header.ticks_per_frame) / f64::from(self.header.ticks_per_second)
    }

    /// How many frames there are; of every tick, ticks + 1.
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// Is there no frame?
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// The frames, from the start on.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = Frame<'_>> {
        (0..self.contacts.len()).map(|index| {
            let (targets, robots) = (usize::from(self.header.targets), usize::from(self.header.robots));
            Frame {
                tick: index as u64 * u64::from(self.header.ticks_per_frame),
                targets_um: &self.targets[index * targets..(index + 1) * targets],
                robots: &self.robots[index * robots..(index + 1) * robots],
                contacts: self.contacts[index],
            }
        })
    }

    /// The trace in the layout of the module's page. Names longer than 65,535 bytes are cut.
    pub fn encode(&self) -> Vec<u8> {
        let TraceHeader { scenario, seed, scale, settle_s, target_speed_m_per_s, .. } = &self.header;
        let mut name = scenario.as_str();
        while name.len() > usize::from(u16::MAX) {
            name = &name[..name.char_indices().next_back().map_or(0, |(at, _)| at)];
        }
        let mut out = Vec::with_capacity(64 + name.len() + self.len() * self.header.bytes_per_frame());
        out.extend(MAGIC);
        out.extend(VERSION.to_le_bytes());
        out.extend((name.len() as u16).to_le_bytes());
        out.extend(name.as_bytes());
        out.extend(seed.to_le_bytes());
        for real in [scale, settle_s, target_speed_m_per_s] {
            out.extend(real.to_le_bytes());
        }
        let TraceHeader { ticks_per_second, robots, mothers, targets, ticks_per_frame, .. } = self.header;
        for count in [ticks_per_second, robots, mothers, targets] {
            out.extend(count.to_le_bytes());
        }
        out.extend(ticks_per_frame.to_le_bytes());
        out.extend((self.len() as u32).to_le_bytes());
        for frame in self.frames() {
            for coordinate in frame.targets_um.iter().flat_map(|target| target.unwrap_or(NOT_THERE)) {
                out.extend(coordinate.to_le_bytes());
            }
            for robot in frame.robots {
                robot.position_um.iter().for_each(|value| out.extend(value.to_le_bytes()));
                robot.heading_q14.iter().chain(&robot.wheels).for_each(|value| out.extend(value.to_le_bytes()));
            }
            let ContactCounts { peer_events, wall_events, peers, walls } = frame.contacts;
            for count in [peer_events, wall_events, peers, walls] {
                out.extend(count.to_le_bytes());
            }
        }
        out
    }

    /// The trace in these bytes.
    ///
    /// # Errors
    /// [`TraceError`] for bytes that [`encode`](Trace::encode) does not write.
    pub fn decode(bytes: &[u8]) -> Result<Trace, TraceError> {
        let mut reader = Reader { bytes };
        if &reader.take::<8>()? != MAGIC {
            return Err(TraceError::NotATrace);
        }
        let version = reader.u16()?;
        if !(1..=VERSION).contains(&version) {
            return Err(TraceError::Version(version));
        }
        let narrow = version == 1;
        let length = usize::from(reader.u16()?);
        let (name, rest) = reader.bytes.split_at_checked(length).ok_or(TraceError::Length)?;
        reader.bytes = rest;
        let scenario = str::from_utf8(name).map_err(|_| TraceError::Name)?.to_owned();
        let mut header = TraceHeader {
            scenario,
            seed: u64::from_le_bytes(reader.take()?),
            scale: f64::from_le_bytes(reader.take()?),
            settle_s: f64::from_le_bytes(reader.take()?),
            target_speed_m_per_s: f64::from_le_bytes(reader.take()?),
            ticks_per_second: reader.u16()?,
            robots: reader.u16()?,
            mothers: reader.u16()?,
            targets: reader.u16()?,
            ticks_per_frame: 1,
        };
        if !narrow {
            header.ticks_per_frame = reader.u32()?;
        }
        if header.ticks_per_second == 0 || header.ticks_per_frame == 0 {
            return Err(TraceError::Ticks);
        }
        let frames = reader.u32()? as usize;
        let (targets, robots) = (usize::from(header.targets), usize::from(header.robots));
        // The length is checked before anything is reserved: a header cannot ask for more memory than the file has.
        let narrower = if narrow { NARROWER } else { 0 };
        if Some(reader.bytes.len()) != frames.checked_mul(header.bytes_per_frame() - narrower) {
            return Err(TraceError::Length);
        }
        let mut trace = Trace::new(header);
        trace.targets.reserve_exact(frames * targets);
        trace.robots.reserve_exact(frames * robots);
        trace.contacts.reserve_exact(frames);
        for _ in 0..frames {
            for _ in 0..targets {
                let place = [reader.i32()?, reader.i32()?];
                trace.targets.push((place != NOT_THERE).then_some(place));
            }
            for _ in 0..robots {
                trace.robots.push(RobotState {
                    position_um: [reader.i32()?, reader.i32()?],
                    heading_q14: [reader.i16()?, reader.i16()?],
                    wheels: [reader.i16()?, reader.i16()?],
                });
            }
            let mut count = || if narrow { reader.u16().map(u32::from) } else { reader.u32() };
            let [peer_events, wall_events, peers, walls] = [count()?, count()?, count()?, count()?];
            trace.contacts.push(ContactCounts { peer_events, wall_events, peers, walls });
        }
        Ok(trace)
    }

    /// Writes one line per target and robot and frame: `tick,kind,index,x_um,y_um,cos_q14,sin_q14,left,right`; a
    /// target's last four columns are empty, and there is no line of a target while it is not there.
    pub fn to_csv(&self) -> Vec<u8> {
        const LINE: usize = 48;
        let mut out = Vec::with_capacity(LINE * (self.targets.len() + self.robots.len() + 2));
        out.extend(b"tick,kind,index,x_um,y_um,cos_q14,sin_q14,left,right\n");
        // Some hundred thousand lines: digits are written without the machinery of `format!`.
        let mut digits = itoa::Buffer::new();
        for frame in self.frames() {
            let tick = itoa::Buffer::new().format(frame.tick).to_owned();
            for (index, [x, y]) in
                frame.targets_um.iter().enumerate().filter_map(|(index, place)| Some((index, (*place)?)))
            {
                out.extend(tick.as_bytes());
                out.extend(b",target,");
                out.extend(digits.format(index).as_bytes());
                for number in [x, y] {
                    out.push(b',');
                    out.extend(digits.format(number).as_bytes());
                }
                out.extend(b",,,,\n");
            }
            for (index, robot) in frame.robots.iter().enumerate() {
                let RobotState { position_um: [x, y], heading_q14: [cos, sin], wheels: [left, right] } = *robot;
                out.extend(tick.as_bytes());
                out.extend(b",robot,");
                out.extend(digits.format(index).as_bytes());
                for number in [x, y, cos.into(), sin.into(), left.into(), right.into()] {
                    out.push(b',');
                    out.extend(digits.format(number).as_bytes());
                }
                out.push(b'\n');
            }
        }
        out
    }
}

/// Records a run in bounded memory: every tick until the memory is full, then every second, then every fourth, ….
#[derive(Debug)]
pub struct Recorder {
    trace: Trace,
    most_frames: usize,
    /// Of these only events count: those since the last frame.
    since: ContactCounts,
}

impl Recorder {
    /// A trace of what is observed, of at most `most_bytes` bytes and at least two frames; it begins with every
    /// `ticks_per_frame`-th tick.
    pub fn new(header: TraceHeader, most_bytes: usize) -> Self {
        let most_frames = (most_bytes / header.bytes_per_frame()).max(2);
        Recorder { trace: Trace::new(header), most_frames, since: ContactCounts::default() }
    }

    /// What is recorded so far.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// What was recorded.
    pub fn into_trace(self) -> Trace {
        self.trace
    }
}

impl Observer for Recorder {
    fn observe(&mut self, frame: &Frame<'_>) {
        self.since = frame.contacts.after(self.since);
        if !frame.tick.is_multiple_of(self.trace.header.ticks_per_frame.into()) {
            return;
        }
        if self.trace.len() == self.most_frames {
            self.since = self.since.after(self.trace.halve());
            if !frame.tick.is_multiple_of(self.trace.header.ticks_per_frame.into()) {
                return;
            }
        }
        self.trace.push(frame.targets_um, frame.robots, self.since);
        self.since = ContactCounts::default();
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], TraceError> {
        let (taken, rest) = self.bytes.split_first_chunk().ok_or(TraceError::Length)?;
        self.bytes = rest;
        Ok(*taken)
    }
    fn u16(&mut self) -> Result<u16, TraceError> {
        self.take().map(u16::from_le_bytes)
    }
    fn u32(&mut self) -> Result<u32, TraceError> {
        self.take().map(u32::from_le_bytes)
    }
    fn i16(&mut self) -> Result<i16, TraceError> {
        self.take().map(i16::from_le_bytes)
    }
    fn i32(&mut self) -> Result<i32, TraceError> {
        self.take().map(i32::from_le_bytes)
    }
}

/// Why bytes are no trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceError {
    /// They do not begin with the magic.
    NotATrace,
    /// They are of a layout this program does not know.
    Version(u16),
    /// The scenario's name is not UTF-8.
    Name,
    /// No ticks per second or per frame.
    Ticks,
    /// There are too few or too many bytes.
    Length,
}

impl fmt::Display for TraceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TraceError::NotATrace => write!(f, "not a trace: it does not begin with \"grntrace\""),
            TraceError::Version(version) => write!(f, "layout version {version}; this program reads 1 to {VERSION}"),
            TraceError::Name => write!(f, "the scenario's name is not UTF-8"),
            TraceError::Ticks => write!(f, "it has 0 ticks per second or per frame"),
            TraceError::Length => write!(f, "the length does not fit the header: cut off, or something follows"),
        }
    }
}

impl core::error::Error for TraceError {}

#[cfg(test)]
pub(crate) mod tests;

//! A recorded run: every tick's poses, wheel commands, targets and contacts, in integers.
//!
//! # Binary layout, version 1
//! Little-endian throughout, no padding, nothing after the last frame.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | magic `grntrace` |
//! | 2 | version, 1 |
//! | 2 + n | length n of the scenario's name, then the name in UTF-8 |
//! | 8, 8 | seed (u64), scale (f64) |
//! | 8, 8 | settle_s (f64), target_speed_m_per_s (f64) |
//! | 2, 2, 2, 2 | ticks per second, robots, mothers, targets (u16) |
//! | 4 | frames (u32); frame 0 is the start, frame t the world after tick t |
//!
//! and per frame
//!
//! | bytes | content |
//! |---|---|
//! | 4 · 2 per target | x, y in micrometres (i32) |
//! | 16 per robot | x, y in micrometres (i32), heading (cos, sin) in 2^-14, left and right command in steps/s (i16) |
//! | 8 | peer events, wall events, pairs in contact, robots at walls (u16) |

use crate::contacts::ContactCounts;
use core::fmt;
use grn_core::geometry::{Point, Vector};
use std::io;

const MAGIC: &[u8; 8] = b"grntrace";
/// The layout's version.
pub const VERSION: u16 = 1;
const ROBOT_BYTES: usize = 16;

/// What a trace is of.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceHeader {
    /// The scenario's name.
    pub scenario: String,
    /// The run's seed.
    pub seed: u64,
    /// Real metres per metre of the scenario.
    pub scale: f64,
    /// How long targets rest at first, seconds.
    pub settle_s: f64,
    /// Real speed of the target with the longest path, metres per second.
    pub target_speed_m_per_s: f64,
    /// Frames per second.
    pub ticks_per_second: u16,
    /// How many robots.
    pub robots: u16,
    /// How many of them, the first ones, are mothers.
    pub mothers: u16,
    /// How many targets.
    pub targets: u16,
}

/// A robot in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RobotState {
    /// True position, micrometres, (east, north).
    pub position_um: [i32; 2],
    /// True heading (cos, sin) in units of 2^-14.
    pub heading_q14: [i16; 2],
    /// The commands (left, right) that led here, steps per second; 0 in frame 0.
    pub wheels: [i16; 2],
}

/// One moment of a trace.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Targets' positions, micrometres.
    pub targets_um: &'a [[i32; 2]],
    /// The robots.
    pub robots: &'a [RobotState],
    /// Contacts in the tick that ended here.
    pub contacts: ContactCounts,
}

/// Micrometres → metres.
pub fn metres([x, y]: [i32; 2]) -> Point<f64> {
    Vector::new(f64::from(x) * 1e-6, f64::from(y) * 1e-6)
}

/// A recorded run.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    header: TraceHeader,
    targets: Vec<[i32; 2]>,
    robots: Vec<RobotState>,
    contacts: Vec<ContactCounts>,
}

impl Trace {
    /// A trace without frames.
    pub fn new(header: TraceHeader) -> Self {
        Trace { header, targets: Vec::new(), robots: Vec::new(), contacts: Vec::new() }
    }

    /// Makes room for this many more frames.
    pub fn reserve(&mut self, frames: usize) {
        self.targets.reserve(frames * usize::from(self.header.targets));
        self.robots.reserve(frames * usize::from(self.header.robots));
        self.contacts.reserve(frames);
    }

    /// Appends a frame; the iterators must give as many targets and robots as the header says.
    pub fn push(
        &mut self,
        targets_um: impl IntoIterator<Item = [i32; 2]>,
        robots: impl IntoIterator<Item = RobotState>,
        contacts: ContactCounts,
    ) {
        self.targets.extend(targets_um);
        self.robots.extend(robots);
        self.contacts.push(contacts);
        debug_assert_eq!(self.targets.len(), self.contacts.len() * usize::from(self.header.targets));
        debug_assert_eq!(self.robots.len(), self.contacts.len() * usize::from(self.header.robots));
    }

    /// What it is of.
    pub fn header(&self) -> &TraceHeader {
        &self.header
    }

    /// How many frames there are: ticks + 1.
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
        let size = 64 + name.len() + self.targets.len() * 8 + self.robots.len() * ROBOT_BYTES + self.contacts.len() * 8;
        let mut out = Vec::with_capacity(size);
        out.extend(MAGIC);
        out.extend(VERSION.to_le_bytes());
        out.extend((name.len() as u16).to_le_bytes());
        out.extend(name.as_bytes());
        out.extend(seed.to_le_bytes());
        for real in [scale, settle_s, target_speed_m_per_s] {
            out.extend(real.to_le_bytes());
        }
        let TraceHeader { ticks_per_second, robots, mothers, targets, .. } = self.header;
        for count in [ticks_per_second, robots, mothers, targets] {
            out.extend(count.to_le_bytes());
        }
        out.extend((self.contacts.len() as u32).to_le_bytes());
        for frame in self.frames() {
            for coordinate in frame.targets_um.iter().flatten() {
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
        if version != VERSION {
            return Err(TraceError::Version(version));
        }
        let length = usize::from(reader.u16()?);
        let (name, rest) = reader.bytes.split_at_checked(length).ok_or(TraceError::Length)?;
        reader.bytes = rest;
        let scenario = str::from_utf8(name).map_err(|_| TraceError::Name)?.to_owned();
        let header = TraceHeader {
            scenario,
            seed: u64::from_le_bytes(reader.take()?),
            scale: f64::from_le_bytes(reader.take()?),
            settle_s: f64::from_le_bytes(reader.take()?),
            target_speed_m_per_s: f64::from_le_bytes(reader.take()?),
            ticks_per_second: reader.u16()?,
            robots: reader.u16()?,
            mothers: reader.u16()?,
            targets: reader.u16()?,
        };
        let frames = u32::from_le_bytes(reader.take()?) as usize;
        let (targets, robots) = (usize::from(header.targets), usize::from(header.robots));
        // The length is checked before anything is reserved: a header cannot ask for more memory than the file has.
        if Some(reader.bytes.len()) != frames.checked_mul(targets * 8 + robots * ROBOT_BYTES + 8) {
            return Err(TraceError::Length);
        }
        let mut trace = Trace::new(header);
        trace.reserve(frames);
        for _ in 0..frames {
            for _ in 0..targets {
                trace.targets.push([reader.i32()?, reader.i32()?]);
            }
            for _ in 0..robots {
                trace.robots.push(RobotState {
                    position_um: [reader.i32()?, reader.i32()?],
                    heading_q14: [reader.i16()?, reader.i16()?],
                    wheels: [reader.i16()?, reader.i16()?],
                });
            }
            let [peer_events, wall_events, peers, walls] = [reader.u16()?, reader.u16()?, reader.u16()?, reader.u16()?];
            trace.contacts.push(ContactCounts { peer_events, wall_events, peers, walls });
        }
        Ok(trace)
    }

    /// Writes one line per target and robot and frame: `tick,kind,index,x_um,y_um,cos_q14,sin_q14,left,right`; a
    /// target's last four columns are empty.
    ///
    /// # Errors
    /// Whatever `out` fails with.
    pub fn to_csv(&self, out: &mut impl io::Write) -> io::Result<()> {
        writeln!(out, "tick,kind,index,x_um,y_um,cos_q14,sin_q14,left,right")?;
        for (tick, frame) in self.frames().enumerate() {
            for (index, [x, y]) in frame.targets_um.iter().enumerate() {
                writeln!(out, "{tick},target,{index},{x},{y},,,,")?;
            }
            for (index, robot) in frame.robots.iter().enumerate() {
                let RobotState { position_um: [x, y], heading_q14: [cos, sin], wheels: [left, right] } = robot;
                writeln!(out, "{tick},robot,{index},{x},{y},{cos},{sin},{left},{right}")?;
            }
        }
        Ok(())
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
    /// There are too few or too many bytes.
    Length,
}

impl fmt::Display for TraceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TraceError::NotATrace => write!(f, "not a trace: it does not begin with \"grntrace\""),
            TraceError::Version(version) => write!(f, "layout version {version}; this program reads version {VERSION}"),
            TraceError::Name => write!(f, "the scenario's name is not UTF-8"),
            TraceError::Length => write!(f, "the length does not fit the header: cut off, or something follows"),
        }
    }
}

impl core::error::Error for TraceError {}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// (east, north) in metres.
    pub(crate) type Places = Vec<(f64, f64)>;

    /// A trace of these targets and robots, frame by frame, with the same contacts and commands in each.
    pub(crate) fn trace_of(frames: &[(Places, Places)]) -> Trace {
        let um = |&(x, y): &(f64, f64)| [x, y].map(|v: f64| (v * 1e6).round() as i32);
        let mut trace = Trace::new(TraceHeader {
            scenario: "täst".to_owned(),
            seed: 9,
            scale: 0.25,
            settle_s: 10.0,
            target_speed_m_per_s: 0.02,
            ticks_per_second: 32,
            robots: frames[0].1.len() as u16,
            mothers: 1,
            targets: frames[0].0.len() as u16,
        });
        for (targets, robots) in frames {
            let robots =
                robots.iter().map(|p| RobotState { position_um: um(p), heading_q14: [16384, -1], wheels: [-7, 300] });
            trace.push(
                targets.iter().map(um),
                robots,
                ContactCounts { peer_events: 1, wall_events: 2, peers: 3, walls: 4 },
            );
        }
        trace
    }

    fn example() -> Trace {
        let frame = |t: f64| (vec![(t, 1.0)], vec![(0.5, t), (-2.0, 3.25)]);
        trace_of(&[frame(0.0), frame(0.001)])
    }

    #[test]
    fn bytes_are_as_documented_and_round_trip() {
        let bytes = example().encode();
        assert_eq!(bytes.len(), 8 + 2 + 2 + 5 + 8 + 24 + 8 + 4 + 2 * (8 + 32 + 8));
        assert_eq!(&bytes[..17], b"grntrace\x01\x00\x05\x00t\xc3\xa4st");
        assert_eq!(bytes[61..69], [0, 0, 0, 0, 0x40, 0x42, 0x0f, 0]);
        assert_eq!(Trace::decode(&bytes), Ok(example()));
    }

    #[test]
    fn other_bytes_are_rejected() {
        let bytes = example().encode();
        for length in 0..bytes.len() {
            assert!(Trace::decode(&bytes[..length]).is_err(), "{length}");
        }
        let with = |at: usize, value: u8| {
            let mut changed = bytes.clone();
            changed[at] = value;
            Trace::decode(&changed)
        };
        assert_eq!(with(0, 0), Err(TraceError::NotATrace));
        assert_eq!(with(8, 2), Err(TraceError::Version(2)));
        assert_eq!(with(13, 0xff), Err(TraceError::Name));
        assert_eq!(with(60, 0xff), Err(TraceError::Length));
        assert_eq!(Trace::decode(&[bytes.clone(), vec![0]].concat()), Err(TraceError::Length));
    }

    #[test]
    fn the_table_has_a_line_per_thing_and_frame() {
        let mut out = Vec::new();
        example().to_csv(&mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 7);
        assert_eq!((lines[4], lines[5]), ("1,target,0,1000,1000000,,,,", "1,robot,0,500000,1000,16384,-1,-7,300"));
    }
}

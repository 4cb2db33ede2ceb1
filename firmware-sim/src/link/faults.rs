//! A wire with faults, as ordinary middleware between a client and any other wire.

use crate::random::{Component, Stream};
use core::time::Duration;
use grn_link::Wire;
use std::io;

/// What goes wrong, each as a probability in [0, 1] for each byte in each direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Faults {
    /// One of its bits is flipped.
    pub flipped: f64,
    /// It is lost.
    pub dropped: f64,
    /// It arrives twice.
    pub doubled: f64,
    /// The connection breaks, for good.
    pub broken: f64,
}

/// A wire that suffers from [`Faults`].
pub struct FaultyWire<W> {
    wire: W,
    faults: Faults,
    chance: Stream,
    broken: bool,
}

impl<W> FaultyWire<W> {
    /// Puts faults on a wire; `seed` decides when they happen.
    pub fn new(wire: W, faults: Faults, seed: u64) -> Self {
        FaultyWire { wire, faults, chance: Stream::new(seed, Component::Wire, 0), broken: false }
    }

    /// The wire without faults.
    pub fn into_wire(self) -> W {
        self.wire
    }

    /// What becomes of these bytes.
    fn suffer(&mut self, bytes: &[u8]) -> io::Result<Vec<u8>> {
        let mut left = Vec::with_capacity(bytes.len());
        let Faults { flipped, dropped, doubled, broken } = self.faults;
        for &byte in bytes {
            self.broken |= self.chance.unit() < broken;
            if self.broken {
                return Err(io::Error::new(io::ErrorKind::ConnectionReset, "the connection broke"));
            }
            let event = self.chance.unit();
            if event < flipped {
                left.push(byte ^ 1 << (self.chance.unit() * 8.0) as u32);
            } else if event < flipped + doubled {
                left.extend([byte; 2]);
            } else if event >= flipped + doubled + dropped {
                left.push(byte);
            }
        }
        Ok(left)
    }
}

impl<W: Wire> Wire for FaultyWire<W> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let bytes = self.suffer(bytes)?;
        self.wire.send(&bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        // Half, so that even if all bytes come twice there is room for them.
        let half = buffer.len() / 2;
        let count = self.wire.receive(&mut buffer[..half], patience)?;
        let bytes = self.suffer(&buffer[..count])?;
        buffer[..bytes.len()].copy_from_slice(&bytes);
        Ok(bytes.len())
    }
}

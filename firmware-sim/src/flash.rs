//! A robot's NOR flash with everything that is awkward about it: it is erased in sectors, each unit is written once
//! between erasures, the power can fail after any step, and reads can fail.

use crate::random::{Component, Stream};
use core::fmt;
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};

/// Bytes of a sector.
pub const SECTOR: usize = 1024;
/// Bytes written at once.
pub const WORD: usize = 4;
/// Steps that the erasure of a sector takes.
const ERASE_STEPS: usize = 8;
const ERASED: u8 = 0xff;

/// Why the flash did not do what it was asked to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// Beyond its end.
    OutOfBounds,
    /// Not a multiple of the word or sector size.
    NotAligned,
    /// The word at this offset is not erased.
    WrittenTwice(u32),
    /// The power failed, now or before.
    PowerLost,
    /// What lies there cannot be read.
    Unreadable,
}

impl fmt::Display for FlashError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FlashError::OutOfBounds => f.write_str("beyond the end of the flash"),
            FlashError::NotAligned => f.write_str("not a multiple of the word or sector size"),
            FlashError::WrittenTwice(offset) => write!(f, "the word at {offset:#x} is written twice"),
            FlashError::PowerLost => f.write_str("the power failed"),
            FlashError::Unreadable => f.write_str("the flash cannot be read"),
        }
    }
}

impl core::error::Error for FlashError {}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            FlashError::OutOfBounds => NorFlashErrorKind::OutOfBounds,
            FlashError::NotAligned => NorFlashErrorKind::NotAligned,
            _ => NorFlashErrorKind::Other,
        }
    }
}

/// A simulated NOR flash of whole sectors.
///
/// A step is one byte written, or an eighth of a sector erased. The step in which the power fails leaves a byte in which
/// only some bits are written, or rubbish in the part that was being erased.
#[derive(Clone, Debug)]
pub struct SimulatedFlash {
    bytes: Vec<u8>,
    steps: u64,
    steps_left: Option<u64>,
    reads_left: Option<u64>,
    rubbish: Stream,
}

impl SimulatedFlash {
    /// An erased flash; `seed` decides what failing steps leave.
    pub fn erased(sectors: usize, seed: u64) -> Self {
        let rubbish = Stream::new(seed, Component::Flash, 0);
        SimulatedFlash { bytes: vec![ERASED; sectors * SECTOR], steps: 0, steps_left: None, reads_left: None, rubbish }
    }

    /// Steps done so far, those that failed included.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Power will fail in the step that follows this many further ones.
    #[must_use]
    pub fn failing_after(self, steps: u64) -> Self {
        SimulatedFlash { steps_left: Some(steps), ..self }
    }

    /// The flash as it is found when the power is back.
    #[must_use]
    pub fn powered(self) -> Self {
        SimulatedFlash { steps_left: None, ..self }
    }

    /// After this many more reads every read fails; with `None` no read fails.
    pub fn fail_reads_after(&mut self, reads: Option<u64>) {
        self.reads_left = reads;
    }

    /// Its content.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Its content, to damage it.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes
    }

    fn dead(&self) -> bool {
        self.steps_left == Some(u64::MAX)
    }

    /// Whether the next step is done; if not the power has failed in it.
    fn step(&mut self) -> bool {
        self.steps += 1;
        match self.steps_left {
            None => true,
            Some(0) => {
                self.steps_left = Some(u64::MAX);
                false
            }
            Some(left) => {
                self.steps_left = Some(left - 1);
                true
            }
        }
    }

    fn range(&self, offset: u32, length: usize, unit: usize) -> Result<core::ops::Range<usize>, FlashError> {
        let start = offset as usize;
        if self.dead() {
            Err(FlashError::PowerLost)
        } else if start + length > self.bytes.len() {
            Err(FlashError::OutOfBounds)
        } else if !start.is_multiple_of(unit) || !length.is_multiple_of(unit) {
            Err(FlashError::NotAligned)
        } else {
            Ok(start..start + length)
        }
    }
}

impl ErrorType for SimulatedFlash {
    type Error = FlashError;
}

impl ReadNorFlash for SimulatedFlash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let range = self.range(offset, bytes.len(), Self::READ_SIZE)?;
        if let Some(left) = &mut self.reads_left {
            *left = left.checked_sub(1).ok_or(FlashError::Unreadable)?;
        }
        bytes.copy_from_slice(&self.bytes[range]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for SimulatedFlash {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        let range = self.range(from, to.saturating_sub(from) as usize, SECTOR)?;
        for start in range.step_by(SECTOR / ERASE_STEPS) {
            let whole = self.step();
            for at in start..start + SECTOR / ERASE_STEPS {
                self.bytes[at] = if whole { ERASED } else { (self.rubbish.unit() * 256.0) as u8 };
            }
            if !whole {
                return Err(FlashError::PowerLost);
            }
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let range = self.range(offset, bytes.len(), WORD)?;
        if let Some(at) = range.clone().find(|&at| self.bytes[at] != ERASED) {
            return Err(FlashError::WrittenTwice(at as u32));
        }
        for (at, &byte) in range.zip(bytes) {
            if !self.step() {
                self.bytes[at] = byte | (self.rubbish.unit() * 256.0) as u8;
                return Err(FlashError::PowerLost);
            }
            self.bytes[at] = byte;
        }
        Ok(())
    }
}

//! Two slots for blobs in a robot's flash: a new one is tried beside the old one, which stays until the new one has
//! proved itself.
//!
//! ```text
//!            begin, chunk…        commit         activate        confirm
//!   Empty ────────────────▶ Partial ───▶ Verified ───▶ Trial ───────────▶ Confirmed
//!                                                        │ roll back, or reset │ roll back
//!                                                        ▼                     ▼
//!                                                          Rejected ◀──────────
//! ```
//!
//! - In charge is the newest slot on trial or confirmed whose blob is sound.
//! - Uploads go to the other slot. While a blob is on trial and there is one to fall back to, nothing can be uploaded.
//! - A blob that is still on trial when the robot starts is rejected, if there is one to fall back to.
//! - Each change of charge is one mark of 8 bytes. Power may fail at any moment: at the next start the old blob or the new
//!   one is in charge, and the upload can be repeated.

mod error;
mod journal;

pub use error::SlotError;
pub use journal::Stage;

use crate::blob::{Blob, BlobError, Identity, max_encoded_size};
use crate::network::DEFAULT_GENES;
use embedded_storage::nor_flash::NorFlash;
use heapless::Vec;
use journal::{CONTENT, HEADER, Header, Journal, MARKS, Mark, UNIT};

/// The most bytes of a blob in a slot.
pub const MAX_BLOB: usize = max_encoded_size(DEFAULT_GENES);
/// Bytes that a slot must have at least.
pub const MIN_SLOT: u32 = CONTENT + MAX_BLOB.next_multiple_of(UNIT) as u32;

/// Where the slots are, in bytes from the start of the flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Where each slot begins, a multiple of the flash's erase size.
    pub starts: [u32; 2],
    /// Bytes of each slot, a multiple of the flash's erase size, at least [`MIN_SLOT`].
    pub size: u32,
}

impl Layout {
    /// Both slots one behind the other from the start of the flash.
    pub const fn adjacent(size: u32) -> Self {
        Layout { starts: [0, size], size }
    }

    fn fits<F: NorFlash>(&self, flash: &F) -> bool {
        let erasable = |offset: u32| (offset as usize).is_multiple_of(F::ERASE_SIZE);
        let [first, second] = self.starts;
        let inside = |start: u32| {
            erasable(start) && start.checked_add(self.size).is_some_and(|end| end as usize <= flash.capacity())
        };
        let writable = UNIT.is_multiple_of(F::WRITE_SIZE) && UNIT.is_multiple_of(F::READ_SIZE);
        let apart = first.abs_diff(second) >= self.size;
        writable && apart && erasable(self.size) && self.size >= MIN_SLOT && inside(first) && inside(second)
    }
}

/// What is known of a slot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct SlotStatus {
    /// How far its blob has come.
    pub stage: Stage,
    /// The blob's identity, zeros if there is none.
    pub identity: Identity,
    /// The blob's length, bytes.
    pub length: u32,
    /// Of two slots the one with the higher number is newer; an upload gets the next number after that of the other slot.
    pub sequence: u32,
}

/// The bytes of a slot that holds this blob, confirmed: for flashing by a programmer instead of through the link.
///
/// Of two slots the robot takes the one with the higher `sequence`; [`u32::MAX`] would leave none for the next upload.
///
/// # Errors
/// [`SlotError::TooLong`], [`SlotError::Blob`], [`SlotError::SequenceUsedUp`] for [`u32::MAX`].
pub fn image(blob: &[u8], sequence: u32) -> Result<Vec<u8, { MIN_SLOT as usize }>, SlotError> {
    let identity = Blob::<DEFAULT_GENES>::decode(blob).map_err(SlotError::Blob)?.identity();
    if sequence == u32::MAX {
        return Err(SlotError::SequenceUsedUp);
    }
    let header = Header { length: blob.len() as u32, sequence, identity }.encode();
    let marks = [Mark::Verified, Mark::Activated, Mark::Confirmed].map(Mark::encode);
    let mut image: Vec<u8, { MIN_SLOT as usize }> = Vec::new();
    let mut append = |bytes: &[u8]| image.extend_from_slice(bytes).map_err(|_| SlotError::TooLong);
    append(&header)?;
    append(marks.as_flattened())?;
    append(&[0xff; UNIT * (MARKS - 3)])?;
    append(blob)?;
    Ok(image)
}

/// An upload under way.
#[derive(Clone, Copy, Debug)]
struct Upload {
    slot: usize,
    header: Header,
    written: u32,
}

/// The two slots.
#[derive(Debug)]
pub struct Slots<F> {
    flash: F,
    layout: Layout,
    active: Option<usize>,
    upload: Option<Upload>,
}

impl<F: NorFlash> Slots<F> {
    /// The slots as the robot finds them at its start; a blob still on trial is rejected if there is one to fall back to.
    /// `sound` says whether a blob can drive this robot.
    ///
    /// # Errors
    /// [`SlotError::Layout`], or what the flash says.
    pub fn start(flash: F, layout: Layout, sound: impl Fn(&Blob) -> bool) -> Result<Self, SlotError> {
        if !layout.fits(&flash) {
            return Err(SlotError::Layout);
        }
        let mut slots = Slots { flash, layout, active: None, upload: None };
        let mut in_charge = None;
        for slot in slots.newest_first()? {
            let status = slots.slot_status(slot)?;
            let candidate = matches!(status.stage, Stage::Trial | Stage::Confirmed);
            if !candidate || !slots.is_sound(slot, status.length, &sound)? {
                continue;
            }
            if let Some((on_trial, Stage::Trial)) = in_charge
                && status.stage == Stage::Confirmed
            {
                slots.mark(on_trial, Mark::Rejected)?;
                in_charge = None;
            }
            in_charge = in_charge.or(Some((slot, status.stage)));
        }
        slots.active = in_charge.map(|(slot, _)| slot);
        Ok(slots)
    }

    /// The flash, giving up the slots.
    pub fn into_flash(self) -> F {
        self.flash
    }

    /// Which slot is in charge, if one is.
    pub fn active(&self) -> Option<usize> {
        self.active
    }

    /// What is known of each slot.
    ///
    /// # Errors
    /// What the flash says.
    pub fn status(&mut self) -> Result<[SlotStatus; 2], SlotError> {
        Ok([self.slot_status(0)?, self.slot_status(1)?])
    }

    /// What is known of the slot in charge, if one is.
    ///
    /// # Errors
    /// What the flash says.
    pub fn active_status(&mut self) -> Result<Option<SlotStatus>, SlotError> {
        self.active.map(|slot| self.slot_status(slot)).transpose()
    }

    /// The blob in charge, if there is one.
    ///
    /// # Errors
    /// [`SlotError::Blob`] if it was sound when the robot started but is no longer, or what the flash says.
    pub fn blob_in_charge(&mut self) -> Result<Option<Blob>, SlotError> {
        let Some(slot) = self.active else { return Ok(None) };
        let length = self.slot_status(slot)?.length;
        self.blob(slot, length).map(Some)
    }

    /// Erases the slot that is not in charge for a blob of `length` bytes.
    ///
    /// # Errors
    /// [`SlotError::TooLong`], [`SlotError::OnTrial`], [`SlotError::SequenceUsedUp`], or what the flash says.
    pub fn begin(&mut self, length: u32, identity: Identity) -> Result<(), SlotError> {
        if length as usize > MAX_BLOB {
            return Err(SlotError::TooLong);
        }
        let slot = self.active.map_or(0, |active| 1 - active);
        let [first, second] = self.status()?;
        let (other, kept) = if slot == 0 { (first, second) } else { (second, first) };
        let on_trial = self.active_status()?.is_some_and(|status| status.stage == Stage::Trial);
        if on_trial && other.stage == Stage::Confirmed {
            return Err(SlotError::OnTrial);
        }
        // Newer than the slot that stays; the number of the slot that is erased does not matter.
        let sequence = kept.sequence.checked_add(1).ok_or(SlotError::SequenceUsedUp)?;
        let header = Header { length, sequence, identity };
        self.upload = None;
        let start = self.start_of(slot);
        self.flash.erase(start, start + self.layout.size)?;
        self.flash.write(start, &header.encode())?;
        self.upload = Some(Upload { slot, header, written: 0 });
        Ok(())
    }

    /// Writes the next bytes of the blob.
    ///
    /// # Errors
    /// [`SlotError::NoUpload`], [`SlotError::Chunk`], or what the flash says.
    pub fn chunk(&mut self, offset: u32, bytes: &[u8]) -> Result<(), SlotError> {
        let upload = self.upload.ok_or(SlotError::NoUpload)?;
        let end = offset.saturating_add(bytes.len() as u32);
        let last = end == upload.header.length;
        let fits = end <= upload.header.length && (last || bytes.len().is_multiple_of(UNIT));
        if offset != upload.written || bytes.is_empty() || !fits {
            return Err(SlotError::Chunk { expected: upload.written });
        }
        let mut place = self.start_of(upload.slot) + CONTENT + offset;
        for piece in bytes.chunks(UNIT) {
            let mut unit = [0xff; UNIT];
            for (byte, value) in unit.iter_mut().zip(piece) {
                *byte = *value;
            }
            self.flash.write(place, &unit)?;
            place += UNIT as u32;
        }
        self.upload = Some(Upload { written: end, ..upload });
        Ok(())
    }

    /// Reads the uploaded blob back and, if `check` finds it fit to drive this robot, marks it as verified; the upload is
    /// over, whatever comes out.
    ///
    /// # Errors
    /// [`SlotError::NoUpload`], [`SlotError::Chunk`] if bytes are lacking, [`SlotError::Blob`],
    /// [`SlotError::OtherBlob`], what the flash says, or what `check` says.
    pub fn commit<E: From<SlotError>>(&mut self, check: impl FnOnce(&Blob) -> Result<(), E>) -> Result<(), E> {
        let upload = self.upload.ok_or(SlotError::NoUpload)?;
        if upload.written < upload.header.length {
            return Err(SlotError::Chunk { expected: upload.written }.into());
        }
        self.upload = None;
        let blob = self.blob(upload.slot, upload.header.length);
        let blob = blob.as_ref().map_err(|&error| error)?;
        if blob.identity() != upload.header.identity {
            return Err(SlotError::OtherBlob.into());
        }
        check(blob)?;
        Ok(self.mark(upload.slot, Mark::Verified)?)
    }

    /// Puts the verified blob of this identity in charge, on trial. If it is in charge already nothing happens.
    ///
    /// # Errors
    /// [`SlotError::NotThere`], [`SlotError::Blob`], or what the flash says.
    pub fn activate(&mut self, identity: Identity) -> Result<(), SlotError> {
        if self.active_status()?.is_some_and(|status| status.identity == identity) {
            return Ok(());
        }
        let slot = self.active.map_or(0, |active| 1 - active);
        let status = self.slot_status(slot)?;
        if status.stage != Stage::Verified || status.identity != identity {
            return Err(SlotError::NotThere);
        }
        self.check(slot, status.length)?;
        self.mark(slot, Mark::Activated)?;
        self.active = Some(slot);
        Ok(())
    }

    /// Ends the trial of the blob in charge: it stays.
    ///
    /// # Errors
    /// [`SlotError::NotThere`] if another blob is in charge, or what the flash says.
    pub fn confirm(&mut self, identity: Identity) -> Result<(), SlotError> {
        let slot = self.active.ok_or(SlotError::NotThere)?;
        let status = self.slot_status(slot)?;
        match status.stage {
            _ if status.identity != identity => Err(SlotError::NotThere),
            Stage::Trial => self.mark(slot, Mark::Confirmed),
            _ => Ok(()),
        }
    }

    /// Takes the blob of this identity out of charge and puts the other back in. If it is out already nothing happens.
    ///
    /// # Errors
    /// [`SlotError::NotThere`] if no slot holds the blob, [`SlotError::NoFallback`], or what the flash says.
    pub fn roll_back(&mut self, identity: Identity) -> Result<(), SlotError> {
        let slot = self.active.ok_or(SlotError::NotThere)?;
        let other = 1 - slot;
        let (status, fallback) = (self.slot_status(slot)?, self.slot_status(other)?);
        if status.identity != identity {
            let done = fallback.identity == identity && fallback.stage == Stage::Rejected;
            return if done { Ok(()) } else { Err(SlotError::NotThere) };
        }
        if fallback.stage != Stage::Confirmed {
            return Err(SlotError::NoFallback);
        }
        match self.check(other, fallback.length) {
            Err(SlotError::Blob(_)) => return Err(SlotError::NoFallback),
            checked => checked?,
        }
        self.mark(slot, Mark::Rejected)?;
        self.active = Some(other);
        Ok(())
    }

    fn newest_first(&mut self) -> Result<[usize; 2], SlotError> {
        let [first, second] = self.status()?;
        Ok(if second.sequence > first.sequence { [1, 0] } else { [0, 1] })
    }

    fn start_of(&self, slot: usize) -> u32 {
        let [first, second] = self.layout.starts;
        if slot == 0 { first } else { second }
    }

    fn slot_status(&mut self, slot: usize) -> Result<SlotStatus, SlotError> {
        let mut header = [0; HEADER];
        self.flash.read(self.start_of(slot), &mut header)?;
        let Some(Header { length, sequence, identity }) = Header::decode(&header) else {
            return Ok(SlotStatus::default());
        };
        let stage = self.journal(slot)?.stage();
        Ok(SlotStatus { stage, identity, length, sequence })
    }

    fn journal(&mut self, slot: usize) -> Result<Journal, SlotError> {
        let mut journal = Journal::default();
        for place in 0..MARKS {
            let mut unit = [0; UNIT];
            self.flash.read(self.mark_offset(slot, place), &mut unit)?;
            journal.read(place, unit);
        }
        Ok(journal)
    }

    fn mark(&mut self, slot: usize, mark: Mark) -> Result<(), SlotError> {
        let place = self.journal(slot)?.free().ok_or(SlotError::MarksUsedUp)?;
        Ok(self.flash.write(self.mark_offset(slot, place), &mark.encode())?)
    }

    fn mark_offset(&self, slot: usize, place: usize) -> u32 {
        self.start_of(slot) + (HEADER + place * UNIT) as u32
    }

    /// Whether the blob in a slot can be read and `sound` agrees.
    #[inline(never)]
    fn is_sound(&mut self, slot: usize, length: u32, sound: impl Fn(&Blob) -> bool) -> Result<bool, SlotError> {
        match &self.blob(slot, length) {
            Ok(blob) => Ok(sound(blob)),
            Err(SlotError::Blob(_)) => Ok(false),
            Err(error) => Err(*error),
        }
    }

    /// Whether the blob in a slot can be read.
    #[inline(never)]
    fn check(&mut self, slot: usize, length: u32) -> Result<(), SlotError> {
        match &self.blob(slot, length) {
            Ok(_) => Ok(()),
            Err(error) => Err(*error),
        }
    }

    #[inline(never)]
    fn blob(&mut self, slot: usize, length: u32) -> Result<Blob, SlotError> {
        let mut bytes = [0; MAX_BLOB.next_multiple_of(UNIT)];
        let padded = (length as usize).checked_next_multiple_of(UNIT).and_then(|padded| bytes.get_mut(..padded));
        let padded = padded.ok_or(SlotError::Blob(BlobError::Truncated))?;
        self.flash.read(self.start_of(slot) + CONTENT, padded)?;
        let bytes = padded.get(..length as usize).ok_or(SlotError::Blob(BlobError::Truncated))?;
        Blob::decode(bytes).map_err(SlotError::Blob)
    }
}

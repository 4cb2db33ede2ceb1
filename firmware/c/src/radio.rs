//! Messages as radios carry them.

use crate::message::GrnMessage;
use crate::pointer::{bytes, copy, exclusive, shared, write};
use crate::status::GrnStatus;
use core::mem::MaybeUninit;
use grn_core::robot::Message;
use grn_core::robot::radio::Assembler;
use grn_core::robot::radio::fragments::{Fragments, MAX_FRAGMENT, PayloadError};
use grn_core::robot::radio::packed::{self, MAX_PACKED, PackedError};

/// The most bytes of a packed message.
pub const GRN_PACKED_MESSAGE_BYTES: usize = 37;
/// The smallest payload that a fragment fits.
pub const GRN_MIN_PAYLOAD_BYTES: usize = 2;
/// The most bytes of a fragment.
pub const GRN_MAX_FRAGMENT_BYTES: usize = 39;
/// The size of an assembler in units of 8 bytes, with some to spare for later versions.
pub const GRN_ASSEMBLER_WORDS: usize = 96;

const _: () = assert!(GRN_PACKED_MESSAGE_BYTES == MAX_PACKED);
const _: () = assert!(GRN_MIN_PAYLOAD_BYTES == grn_core::robot::radio::fragments::MIN_PAYLOAD);
const _: () = assert!(GRN_MAX_FRAGMENT_BYTES == MAX_FRAGMENT);
const _: () = assert!(size_of::<Assembler>() <= size_of::<GrnAssembler>(), "raise GRN_ASSEMBLER_WORDS");
const _: () = assert!(align_of::<Assembler>() <= align_of::<GrnAssembler>());

/// Puts the fragments of messages together that a radio with small payloads delivers: 768 bytes, 8-aligned, owned by the
/// caller.
///
/// Zeros are an assembler that has heard nothing: static storage, or "GrnAssembler assembler = {0};".
#[repr(C)]
pub struct GrnAssembler {
    /// Written by the library only.
    opaque: [MaybeUninit<u64>; GRN_ASSEMBLER_WORDS],
}

impl Default for GrnAssembler {
    fn default() -> Self {
        GrnAssembler { opaque: [MaybeUninit::zeroed(); GRN_ASSEMBLER_WORDS] }
    }
}

impl From<PackedError> for GrnStatus {
    fn from(error: PackedError) -> Self {
        match error {
            PackedError::Length { .. } => Self::MessageLength,
            PackedError::Damaged => Self::MessageDamaged,
            PackedError::Version { .. } => Self::MessageVersion,
        }
    }
}

impl From<PayloadError> for GrnStatus {
    fn from(_: PayloadError) -> Self {
        Self::PayloadTooSmall
    }
}

/// Packs a message for a radio: 9 to GRN_PACKED_MESSAGE_BYTES bytes with a checksum, the same on every machine.
///
/// `message`: for example the broadcast of a command.
/// `bytes`, `capacity`: receive the packed message; GRN_PACKED_MESSAGE_BYTES are always enough.
/// `length`: receives how many bytes there are; 0 if the message is refused.
///
/// docs/messages.md describes the bytes. Radios with smaller payloads use grn_message_fragment.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_message_write(
    message: *const GrnMessage,
    bytes: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> GrnStatus {
    GrnStatus::of(|| {
        // SAFETY: the caller gives null or a pointer to a number that nobody else uses now.
        unsafe { write(length, 0) }?;
        // SAFETY: the caller gives null or a pointer to a message that nobody writes now.
        let message: Message = unsafe { shared(message) }?.try_into()?;
        let packed = packed::write(&message);
        if capacity < packed.len() {
            return Err(GrnStatus::BufferTooSmall);
        }
        // SAFETY: the caller gives null or room for `capacity` bytes, which nobody else uses now.
        unsafe { copy(&packed, bytes) }?;
        // SAFETY: as above.
        unsafe { write(length, packed.len()) }
    })
}

/// Unpacks a message that grn_message_write packed.
///
/// `bytes`, `length`: exactly the bytes of one packed message.
/// `message`: receives it, for the percept's "heard"; all zero if it is refused.
///
/// Returns GRN_STATUS_OK, or why it is refused: damaged messages are to be dropped.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_message_read(bytes: *const u8, length: usize, message: *mut GrnMessage) -> GrnStatus {
    GrnStatus::of(|| {
        // SAFETY: the caller gives null or a pointer to a message that nobody else uses now.
        unsafe { write(message, GrnMessage::default()) }?;
        // SAFETY: the caller gives null or a pointer to `length` bytes that nobody writes now.
        let packed = unsafe { self::bytes(bytes, length) }?;
        let unpacked = packed::read(packed)?;
        // SAFETY: as above.
        unsafe { write(message, unpacked.into()) }
    })
}

/// Cuts a message for a radio with small payloads, down to GRN_MIN_PAYLOAD_BYTES: gives one of its fragments.
///
/// `message`: for example the broadcast of a command.
/// `number`: counts the messages that this robot sends; it may wrap around.
/// `payload`: how many bytes the radio carries at a time. The longest message takes 50 fragments of 2 bytes, 37 of 3,
/// 7 of 8, or 2 of 21 to 38.
/// `index`: which fragment, from 0.
/// `fragment`: receives it; room for `payload` bytes, of which no more than GRN_MAX_FRAGMENT_BYTES are used.
/// `length`: receives how many bytes it has; 0 if the message has fewer fragments.
///
/// Fragments may be sent in any order and more than once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_message_fragment(
    message: *const GrnMessage,
    number: u8,
    payload: usize,
    index: usize,
    fragment: *mut u8,
    length: *mut usize,
) -> GrnStatus {
    GrnStatus::of(|| {
        // SAFETY: the caller gives null or a pointer to a number that nobody else uses now.
        unsafe { write(length, 0) }?;
        // SAFETY: the caller gives null or a pointer to a message that nobody writes now.
        let message: Message = unsafe { shared(message) }?.try_into()?;
        let piece = Fragments::new(&message, payload, number)?.nth(index).unwrap_or_default();
        // SAFETY: the caller gives null or room for `payload` bytes, and a fragment has no more.
        unsafe { copy(&piece, fragment) }?;
        // SAFETY: as above.
        unsafe { write(length, piece.len()) }
    })
}

/// Takes in a fragment that was heard; gives a message if that completes it.
///
/// `assembler`: what was heard so far.
/// `assembler_size`: sizeof(GrnAssembler), which tells whether this header fits the library.
/// `tick`: counts the control ticks, from anywhere; fragments that belong together and are long apart are told by it.
/// `fragment`, `length`: exactly the bytes that the radio delivered.
/// `message`: receives the message, for the percept's "heard"; all zero if none is complete.
///
/// Returns GRN_STATUS_OK if a message is complete and undamaged, else GRN_STATUS_MESSAGE_INCOMPLETE or what is wrong.
/// Fragments may be lost, come twice, and overtake each other. Messages of eight robots are put together at a time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_assembler_receive(
    assembler: *mut GrnAssembler,
    assembler_size: usize,
    tick: u32,
    fragment: *const u8,
    length: usize,
    message: *mut GrnMessage,
) -> GrnStatus {
    GrnStatus::of(|| {
        // SAFETY: the caller gives null or a pointer to a message that nobody else uses now.
        unsafe { write(message, GrnMessage::default()) }?;
        if assembler_size < size_of::<GrnAssembler>() {
            return Err(GrnStatus::StorageTooSmall);
        }
        // SAFETY: the caller gives null or a pointer to an assembler that nobody else uses now, and whatever integers it
        // holds are an assembler: it is large enough, as asserted above, and made of integers only.
        let assembler = unsafe { exclusive(assembler.cast::<Assembler>()) }?;
        // SAFETY: the caller gives null or a pointer to `length` bytes that nobody writes now.
        let fragment = unsafe { bytes(fragment, length) }?;
        let complete = assembler.receive(tick, fragment).ok_or(GrnStatus::MessageIncomplete)?;
        // SAFETY: as above.
        unsafe { write(message, complete.into()) }
    })
}

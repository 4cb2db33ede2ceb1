//! Messages as radios carry them: packed into at most 37 bytes with a checksum, whole or in fragments.
//!
//! [`packed`] turns a [`Message`](super::Message) into bytes and back. [`fragments`] cuts these bytes for radios whose
//! payload is smaller, down to 2 bytes, and [`Assembler`] puts fragments together that were lost, doubled or have
//! overtaken each other. `docs/messages.md` is normative for the bytes.

mod assembler;
pub mod fragments;
pub mod packed;

pub use assembler::Assembler;
pub use fragments::{Fragment, Fragments, PayloadError};
pub use packed::{MAX_PACKED, Packed, PackedError};

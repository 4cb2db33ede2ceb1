//! What host and robot say to each other; `docs/link.md` is normative for the bytes.

use super::frame::{self, MAX_WIRE, TooLong};
use crate::blob::Identity;
use crate::robot::percept::{Command, Percept};
use crate::robot::position::Millimetres;
use crate::robot::slots::SlotStatus;
use crate::scalar::NumberType;
use heapless::{String, Vec};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The protocol version this build speaks.
pub const VERSION: u8 = 2;
/// The most bytes of a blob in one [`Chunk`]; a multiple of 8.
pub const MAX_CHUNK: usize = 64;
/// Added to a request's operation in its response.
pub const RESPONSE: u8 = 0x80;
/// Operation of a response that says why there is none; its payload is a [`Refusal`](super::Refusal).
pub const REFUSED: u8 = 0xff;

/// Operations up to this one, their responses and refusals have the same bytes in every version of the protocol.
pub const LAST_FROZEN: u8 = 8;

/// A request with its response.
pub trait Request: Serialize + DeserializeOwned {
    /// Its number on the wire.
    const OPERATION: u8;
    /// What a robot answers.
    type Response: Serialize + DeserializeOwned;
}

macro_rules! requests {
    ($($request:ty = $operation:literal -> $response:ty),* $(,)?) => {
        $(impl Request for $request {
            const OPERATION: u8 = $operation;
            type Response = $response;
        })*
    };
}

requests! {
    Identify = 1 -> About,
    Status = 2 -> RobotStatus,
    Begin = 3 -> (),
    Chunk = 4 -> (),
    Commit = 5 -> (),
    Activate = 6 -> (),
    Confirm = 7 -> (),
    RollBack = 8 -> (),
    Reset = 9 -> (),
    Percept = 10 -> Command,
    Homeward = 11 -> Command,
}

/// Asks what the robot is. Begins a conversation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identify;

/// Asks what the robot has in its slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Status;

/// Announces a blob: the robot erases a slot for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Begin {
    /// The blob's length, bytes.
    pub length: u32,
    /// The blob's identity.
    pub identity: Identity,
}

/// The next bytes of the blob.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Chunk {
    /// Where in the blob these bytes begin.
    pub offset: u32,
    /// A multiple of 8 bytes, unless they are the last.
    pub bytes: Vec<u8, MAX_CHUNK>,
}

/// Ends an upload: the robot reads the blob back and checks it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Commit;

/// Puts a blob in charge, on trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Activate {
    /// The blob's identity.
    pub identity: Identity,
}

/// Ends the trial of a blob: it stays in charge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Confirm {
    /// The blob's identity.
    pub identity: Identity,
}

/// Takes a blob out of charge and puts the other one back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RollBack {
    /// The identity of the blob that goes.
    pub identity: Identity,
}

/// Begin anew as robot `robot`: all genes silent, nothing known, wheels at rest.
///
/// From then on percepts come by the link: processor in the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reset {
    /// Number of the robot in its swarm.
    pub robot: u16,
}

/// A percept of a robot that its base station calls home.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Homeward {
    /// Where it is to go.
    pub home: Millimetres,
    /// What it perceives.
    pub percept: Percept,
}

/// What a robot is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct About {
    /// Protocol version it speaks.
    pub protocol: u8,
    /// Blob format version it reads.
    pub blob_format: u8,
    /// The most genes it holds.
    pub genes: u8,
    /// The most bytes of a blob it stores.
    pub blob_bytes: u16,
    /// The number type it computes in.
    pub number_type: NumberType,
    /// Its name.
    pub name: String<24>,
}

/// What a robot has and does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RobotStatus {
    /// The slot in charge, if one is.
    pub active: Option<u8>,
    /// Its two slots.
    pub slots: [SlotStatus; 2],
    /// Ticks that the blob in charge has run since it was put there or the robot started, at most 65535.
    pub ticks: u16,
}

/// The bytes of a request on the wire.
///
/// # Errors
/// [`TooLong`] for a request that fits no frame.
pub fn encode_request<R: Request>(sequence: u8, request: &R) -> Result<Vec<u8, MAX_WIRE>, TooLong> {
    encode_message([VERSION, sequence, R::OPERATION], request)
}

/// The bytes of a message on the wire.
///
/// # Errors
/// [`TooLong`] for a message that fits no frame.
pub fn encode_message(header: [u8; 3], message: &impl Serialize) -> Result<Vec<u8, MAX_WIRE>, TooLong> {
    use postcard::ser_flavors::Slice;
    frame::encode(header, |room| {
        postcard::serialize_with_flavor(message, Slice::new(room)).ok().map(|written| written.len())
    })
}

/// The message in a payload, with nothing behind it.
pub fn decode_message<M: DeserializeOwned>(payload: &[u8]) -> Option<M> {
    let (message, rest) = postcard::take_from_bytes(payload).ok()?;
    rest.is_empty().then_some(message)
}

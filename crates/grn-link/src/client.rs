//! Requests to a robot. A request is sent again until its answer comes, up to a number of times.

use crate::wire::Wire;
use core::fmt;
use core::time::Duration;
use grn_core::robot::link::Refusal;
use grn_core::robot::link::frame::Receiver;
use grn_core::robot::link::message::{
    About, Begin, Identify, REFUSED, RESPONSE, Request, decode_message, encode_request,
};
use std::io;
use std::time::Instant;

/// How long a client waits for a robot, and how often it asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// How long it waits for a response before it sends the request again.
    pub response: Duration,
    /// How long it waits while a robot erases a slot.
    pub erasure: Duration,
    /// How often it sends a request before it gives up.
    pub tries: u32,
}

impl Default for Patience {
    /// For a serial line: an answer takes milliseconds, the erasure of a 128 KiB sector up to two seconds.
    fn default() -> Self {
        Patience { response: Duration::from_millis(250), erasure: Duration::from_secs(4), tries: 8 }
    }
}

/// Why a request has no answer.
#[derive(Debug)]
pub enum LinkError {
    /// The wire failed.
    Wire(io::Error),
    /// The robot did not answer.
    Silent {
        /// How often the request was sent.
        tries: u32,
    },
    /// The robot refused.
    Refused(Refusal),
    /// The robot answered this request, but with bytes that are no such answer.
    Unreadable,
    /// The request is longer than a frame.
    TooLong,
}

impl fmt::Display for LinkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LinkError::Wire(_) => f.write_str("the connection failed"),
            LinkError::Silent { tries } => write!(f, "the robot does not answer; the request was sent {tries} times"),
            LinkError::Refused(_) => f.write_str("the robot refuses"),
            LinkError::Unreadable => f.write_str("the robot's answer cannot be read"),
            LinkError::TooLong => f.write_str("the request is longer than a frame of the link"),
        }
    }
}

impl core::error::Error for LinkError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            LinkError::Wire(error) => Some(error),
            LinkError::Refused(refusal) => Some(refusal),
            LinkError::Silent { .. } | LinkError::Unreadable | LinkError::TooLong => None,
        }
    }
}

impl From<io::Error> for LinkError {
    fn from(error: io::Error) -> Self {
        LinkError::Wire(error)
    }
}

/// A conversation with one robot.
pub struct Client<W> {
    wire: W,
    patience: Patience,
    sequence: u8,
    receiver: Receiver,
}

impl<W: Wire> Client<W> {
    /// Begins a conversation: asks the robot what it is.
    ///
    /// # Errors
    /// [`LinkError`].
    pub fn connect(wire: W, patience: Patience) -> Result<(Self, About), LinkError> {
        let mut client = Client { wire, patience, sequence: 0, receiver: Receiver::new() };
        let about = client.ask(&Identify)?;
        Ok((client, about))
    }

    /// The wire, giving up the conversation.
    pub fn into_wire(self) -> W {
        self.wire
    }

    /// Sends a request, up to [`Patience::tries`] times, and waits for its answer.
    ///
    /// # Errors
    /// [`LinkError`].
    pub fn ask<R: Request>(&mut self, request: &R) -> Result<R::Response, LinkError> {
        self.ask_up_to(self.patience.tries, request)
    }

    /// Sends a request, up to `tries` times, and waits for its answer.
    ///
    /// # Errors
    /// [`LinkError`].
    pub fn ask_up_to<R: Request>(&mut self, tries: u32, request: &R) -> Result<R::Response, LinkError> {
        self.sequence = self.sequence.wrapping_add(1);
        let bytes = encode_request(self.sequence, request).map_err(|_| LinkError::TooLong)?;
        for _ in 0..tries {
            self.wire.send(&bytes)?;
            if let Some(answer) = self.await_answer::<R>()? {
                return answer;
            }
        }
        Err(LinkError::Silent { tries })
    }

    /// The answer to the request sent last; `None` if it does not come in time. Answers to earlier ones are skipped.
    fn await_answer<R: Request>(&mut self) -> Result<Option<Result<R::Response, LinkError>>, LinkError> {
        let patience = if R::OPERATION == Begin::OPERATION { self.patience.erasure } else { self.patience.response };
        let deadline = Instant::now() + patience;
        let mut buffer = [0; 256];
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Ok(None);
            }
            let count = self.wire.receive(&mut buffer, left)?;
            if count == 0 {
                return Ok(None);
            }
            for &byte in &buffer[..count] {
                let Some(frame) = self.receiver.receive(byte) else { continue };
                if frame.sequence != self.sequence {
                    continue;
                }
                if frame.operation == R::OPERATION | RESPONSE {
                    return Ok(Some(decode_message(frame.payload).ok_or(LinkError::Unreadable)));
                }
                if frame.operation == REFUSED {
                    let refusal = decode_message(frame.payload).map_or(LinkError::Unreadable, LinkError::Refused);
                    return Ok(Some(Err(refusal)));
                }
            }
        }
    }
}

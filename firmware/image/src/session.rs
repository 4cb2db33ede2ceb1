//! A robot and the host that flashes and drives it in one image: how much stack does a robot take that does all it can?
//!
//! The robot is served as in `robot-*`, by the same function; only the port is not a serial line but [`Host`]. It is given
//! one of the largest printed models, keeps it, is given the other, ticks in the costliest scene, keeps that, too, and goes
//! back to the first. Then it starts once more, with a blob in charge. Lines are `what has been done, highest stack so far`:
//! what the host itself takes counts, too, so that a robot takes a little less.

use crate::board::slots::SlotMemory;
use crate::board::{print, stack_used};
use crate::port::Port;
use crate::robot::serve;
use crate::text::decimal;
use core::ops::ControlFlow;
use grn_core::blob::Identity;
use grn_core::robot::link::frame::{MAX_WIRE, Receiver, TooLong};
use grn_core::robot::link::message::{
    Activate, Begin, Chunk, Commit, Confirm, Identify, MAX_CHUNK, RESPONSE, Request, Reset, RollBack, Status,
    encode_request,
};
use grn_core::robot::link::server::TRIAL_TICKS;
use grn_core::scalar::{NumberType, Scalar};
use grn_trials::models::{EH_GRN_1, EH_GRN_2};
use grn_trials::scene;
use heapless::Vec;

type Wire = Vec<u8, MAX_WIRE>;

/// What a host has a robot do, with the bytes of the blob it is about.
#[derive(Clone, Copy)]
enum Act {
    Identify,
    Upload(&'static [u8]),
    Activate(&'static [u8]),
    Confirm(&'static [u8]),
    RollBack(&'static [u8]),
    Reset,
    Tick,
    Status,
}

const FLASHING: [Act; 11] = [
    Act::Identify,
    Act::Upload(EH_GRN_2),
    Act::Activate(EH_GRN_2),
    Act::Confirm(EH_GRN_2),
    Act::Upload(EH_GRN_1),
    Act::Activate(EH_GRN_1),
    Act::Reset,
    Act::Tick,
    Act::Confirm(EH_GRN_1),
    Act::RollBack(EH_GRN_1),
    Act::Status,
];
const AFTER_A_RESTART: [Act; 4] = [Act::Identify, Act::Reset, Act::Tick, Act::Status];

/// Runs both parts of the session, shows the stack; an exit code.
pub fn run<S: Scalar>(number_type: NumberType) -> u8 {
    let all_done = [&FLASHING[..], &AFTER_A_RESTART].into_iter().all(|acts| {
        let mut host = Host { acts, request: 0, sequence: 0, wire: Wire::new(), sent: 0, asked: 0, answered: true };
        // SAFETY: the one of the part before is gone.
        #[allow(unsafe_code, reason = "the board's slots are taken")]
        let slots = unsafe { SlotMemory::take() };
        serve::<S>(number_type, slots, &mut host) && host.is_content()
    });
    show("stack");
    u8::from(!all_done)
}

fn show(what: &str) {
    print(what);
    print(" ");
    decimal(stack_used());
    print(" bytes\n");
}

/// A host that asks for one act after another and wants every request done at once.
struct Host {
    acts: &'static [Act],
    /// Number of the next request of the first act.
    request: u32,
    sequence: u8,
    /// The present request and how much of it the robot has read.
    wire: Wire,
    sent: usize,
    asked: u8,
    /// Whether the robot has done what was asked last.
    answered: bool,
}

impl Host {
    fn is_content(&self) -> bool {
        self.acts.is_empty() && self.answered
    }

    // Not inlined, nor is `write`: a robot is not to be charged with what they take while it does not compute.

    /// Makes the next request; breaks at the end of all acts, or if the robot did not do what it was asked to.
    #[inline(never)]
    fn ask(&mut self) -> ControlFlow<()> {
        while let Some((act, later)) = self.acts.split_first() {
            if !self.answered {
                break;
            }
            self.sequence = self.sequence.wrapping_add(1);
            match act.request(self.request, self.sequence) {
                Some((asked, Ok(wire))) => {
                    (self.asked, self.wire, self.sent, self.answered) = (asked, wire, 0, false);
                    self.request += 1;
                    return ControlFlow::Continue(());
                }
                Some((_, Err(TooLong))) => break,
                None => {
                    show(act.name());
                    (self.acts, self.request) = (later, 0);
                }
            }
        }
        ControlFlow::Break(())
    }
}

impl Port for Host {
    fn start(&mut self) {
        show("start");
    }

    fn read(&mut self) -> Option<u8> {
        if self.sent == self.wire.len() {
            self.ask().continue_value()?;
        }
        self.sent += 1;
        self.wire.get(self.sent - 1).copied()
    }

    #[inline(never)]
    fn write(&mut self, bytes: &[u8]) {
        let mut receiver = Receiver::new();
        for &byte in bytes {
            if let Some(frame) = receiver.receive(byte) {
                self.answered |= (frame.sequence, frame.operation) == (self.sequence, self.asked | RESPONSE);
            }
        }
    }
}

impl Act {
    fn name(self) -> &'static str {
        match self {
            Act::Identify => "identify",
            Act::Upload(_) => "upload",
            Act::Activate(_) => "activate",
            Act::Confirm(_) => "confirm",
            Act::RollBack(_) => "roll-back",
            Act::Reset => "reset",
            Act::Tick => "tick",
            Act::Status => "status",
        }
    }

    /// Operation and frame of its request number `index`; `None` if it has fewer.
    fn request(self, index: u32, sequence: u8) -> Option<(u8, Result<Wire, TooLong>)> {
        fn framed<R: Request>(sequence: u8, request: &R) -> Option<(u8, Result<Wire, TooLong>)> {
            Some((R::OPERATION, encode_request(sequence, request)))
        }
        match (self, index) {
            (Act::Upload(blob), 0) => framed(sequence, &Begin { length: blob.len() as u32, identity: identity(blob) }),
            (Act::Upload(blob), _) => {
                let offset = (index - 1) as usize * MAX_CHUNK;
                match blob.get(offset..).filter(|rest| !rest.is_empty()) {
                    Some(rest) => {
                        let bytes = rest.iter().take(MAX_CHUNK).copied().collect();
                        framed(sequence, &Chunk { offset: offset as u32, bytes })
                    }
                    None if offset < blob.len() + MAX_CHUNK => framed(sequence, &Commit),
                    None => None,
                }
            }
            (Act::Tick, _) => {
                (index < u32::from(TRIAL_TICKS)).then(scene::everything).and_then(|percept| framed(sequence, &percept))
            }
            (_, 1..) => None,
            (Act::Identify, _) => framed(sequence, &Identify),
            (Act::Activate(blob), _) => framed(sequence, &Activate { identity: identity(blob) }),
            (Act::Confirm(blob), _) => framed(sequence, &Confirm { identity: identity(blob) }),
            (Act::RollBack(blob), _) => framed(sequence, &RollBack { identity: identity(blob) }),
            (Act::Reset, _) => framed(sequence, &Reset { robot: 1 }),
            (Act::Status, _) => framed(sequence, &Status),
        }
    }
}

/// Of a blob's bytes: it stands behind magic, version and length.
fn identity(blob: &[u8]) -> Identity {
    blob.get(7..).and_then(|rest| rest.first_chunk()).copied().unwrap_or_default()
}

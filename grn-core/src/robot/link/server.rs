//! The robot's side of the link.
//!
//! The functions that carry out requests are not inlined. Inlined into one function their stack frames would add up, and a
//! robot's stack is small.

use super::frame::{Frame, MAX_WIRE, Receiver, TooLong};
use super::message::{
    About, Activate, Begin, Chunk, Commit, Confirm, Homeward, Identify, LAST_FROZEN, REFUSED, RESPONSE, Request, Reset,
    RobotStatus, RollBack, Status, VERSION, decode_message, encode_message,
};
use super::refusal::Refusal;
use crate::blob::{Blob, FORMAT_VERSION, Identity};
use crate::network::DEFAULT_GENES;
use crate::robot::controller::Controller;
use crate::robot::percept::{Command, Percept};
use crate::robot::position::Millimetres;
use crate::robot::slots::{Layout, MAX_BLOB, SlotError, Slots};
use crate::scalar::{NumberType, Scalar};
use embedded_storage::nor_flash::{NorFlash, NorFlashErrorKind};
use heapless::{String, Vec};

/// How many ticks a blob on trial drives before the robot confirms it by itself.
pub const TRIAL_TICKS: u16 = 64;

/// Serves one link: takes the bytes of requests, carries them out, gives the bytes of responses.
///
/// Each request is carried out once. When it comes again because its response was lost, the response is repeated.
#[derive(Debug)]
pub struct Server<F, S> {
    receiver: Receiver,
    last: Option<Done>,
    response: Vec<u8, MAX_WIRE>,
    robot: Robot<F, S>,
}

/// The last request that was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Done {
    sequence: u8,
    crc: u32,
}

impl<F: NorFlash, S: Scalar> Server<F, S> {
    /// A robot at its start, with the blob in charge loaded if there is one.
    ///
    /// # Errors
    /// [`SlotError::Layout`], or what the flash says.
    #[inline(never)]
    pub fn start(flash: F, layout: Layout, name: &str, number_type: NumberType) -> Result<Self, SlotError> {
        let slots = Slots::start(flash, layout, |blob| loads::<S>(blob).is_ok())?;
        let name = String::try_from(name).unwrap_or_default();
        let robot = Robot { slots, controller: None, ticks: 0, number: 0, name, number_type };
        let mut server = Server { receiver: Receiver::new(), last: None, response: Vec::new(), robot };
        match server.robot.reset(0) {
            // Without a blob in charge the robot waits for one.
            Ok(()) | Err(Refusal::NoController) => Ok(server),
            // What was sound a moment ago cannot be read now.
            Err(_) => Err(SlotError::Flash(NorFlashErrorKind::Other)),
        }
    }

    /// Takes the next byte from the link. Bytes to send, if it ended a request.
    pub fn receive(&mut self, byte: u8) -> Option<&[u8]> {
        let frame = self.receiver.receive(byte)?;
        if frame.operation >= RESPONSE {
            return None;
        }
        let done = Done { sequence: frame.sequence, crc: frame.crc };
        if self.last != Some(done) {
            self.response = self.robot.respond(&frame).unwrap_or_default();
            self.last = Some(done);
        }
        Some(&self.response)
    }

    /// One control tick with the robot's own percept.
    ///
    /// # Errors
    /// [`Refusal::NoController`] while no blob is in charge, [`Refusal::Percept`] for a percept that no robot can have.
    /// After a refusal the robot is to stop its wheels.
    pub fn tick(&mut self, percept: &Percept) -> Result<Command, Refusal> {
        self.robot.tick(percept)
    }

    /// The same for a robot whose base station calls it home.
    ///
    /// # Errors
    /// As of [`tick`](Self::tick).
    pub fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, Refusal> {
        self.robot.tick_home(percept, home)
    }

    /// The flash as it is, giving up the robot.
    pub fn into_flash(self) -> F {
        self.robot.slots.into_flash()
    }
}

#[derive(Debug)]
struct Robot<F, S> {
    slots: Slots<F>,
    controller: Option<Controller<S>>,
    ticks: u16,
    number: u16,
    name: String<24>,
    number_type: NumberType,
}

impl<F: NorFlash, S: Scalar> Robot<F, S> {
    #[inline(never)]
    fn respond(&mut self, frame: &Frame<'_>) -> Result<Vec<u8, MAX_WIRE>, TooLong> {
        match frame.operation {
            Identify::OPERATION => answer(frame, |Identify| Ok(self.about())),
            Status::OPERATION => answer(frame, |Status| self.status()),
            Begin::OPERATION => answer(frame, |Begin { length, identity }| Ok(self.slots.begin(length, identity)?)),
            Chunk::OPERATION => answer(frame, |Chunk { offset, bytes }| Ok(self.slots.chunk(offset, &bytes)?)),
            Commit::OPERATION => answer(frame, |Commit| self.commit()),
            Activate::OPERATION => answer(frame, |Activate { identity }| self.activate(identity)),
            Confirm::OPERATION => answer(frame, |Confirm { identity }| Ok(self.slots.confirm(identity)?)),
            RollBack::OPERATION => answer(frame, |RollBack { identity }| self.roll_back(identity)),
            Reset::OPERATION => answer(frame, |Reset { robot }| self.reset(robot)),
            Percept::OPERATION => answer(frame, |percept: Percept| self.tick(&percept)),
            Homeward::OPERATION => answer(frame, |Homeward { home, percept }| self.tick_home(&percept, home)),
            _ => refuse(frame, Refusal::Unknown),
        }
    }

    fn about(&self) -> About {
        About {
            protocol: VERSION,
            blob_format: FORMAT_VERSION,
            genes: DEFAULT_GENES as u8,
            blob_bytes: MAX_BLOB as u16,
            number_type: self.number_type,
            name: self.name.clone(),
        }
    }

    fn status(&mut self) -> Result<RobotStatus, Refusal> {
        let active = self.slots.active().map(|slot| slot as u8);
        Ok(RobotStatus { active, slots: self.slots.status()?, ticks: self.ticks })
    }

    /// A blob that cannot drive this robot is not marked as verified.
    #[inline(never)]
    fn commit(&mut self) -> Result<(), Refusal> {
        self.slots.commit(loads::<S>)
    }

    #[inline(never)]
    fn activate(&mut self, identity: Identity) -> Result<(), Refusal> {
        self.slots.activate(identity)?;
        self.change()
    }

    #[inline(never)]
    fn roll_back(&mut self, identity: Identity) -> Result<(), Refusal> {
        self.slots.roll_back(identity)?;
        self.change()
    }

    /// Another blob is in charge: the old one drives no longer, even if the flash fails now.
    fn change(&mut self) -> Result<(), Refusal> {
        self.controller = None;
        self.ticks = 0;
        self.reset(self.number)
    }

    #[inline(never)]
    fn reset(&mut self, number: u16) -> Result<(), Refusal> {
        let blob = self.slots.blob_in_charge();
        let blob = blob.as_ref().map_err(|&error| error)?.as_ref().ok_or(Refusal::NoController)?;
        self.load(blob, number)
    }

    #[inline(never)]
    fn load(&mut self, blob: &Blob, number: u16) -> Result<(), Refusal> {
        match Controller::new(blob, number) {
            Ok(controller) => self.controller = Some(controller),
            Err(error) => return Err(error.into()),
        }
        self.number = number;
        Ok(())
    }

    #[inline(never)]
    fn tick(&mut self, percept: &Percept) -> Result<Command, Refusal> {
        let controller = self.controller.as_mut().ok_or(Refusal::NoController)?;
        let command = controller.tick(percept)?;
        self.count_tick()?;
        Ok(command)
    }

    #[inline(never)]
    fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, Refusal> {
        let controller = self.controller.as_mut().ok_or(Refusal::NoController)?;
        let command = controller.tick_home(percept, home)?;
        self.count_tick()?;
        Ok(command)
    }

    /// After enough ticks a blob on trial has proved itself.
    fn count_tick(&mut self) -> Result<(), Refusal> {
        self.ticks = self.ticks.saturating_add(1);
        if self.ticks == TRIAL_TICKS
            && let Some(controller) = &self.controller
        {
            self.slots.confirm(controller.identity())?;
        }
        Ok(())
    }
}

#[inline(never)]
fn loads<S: Scalar>(blob: &Blob) -> Result<(), Refusal> {
    match Controller::<S>::new(blob, 0) {
        Ok(_) => Ok(()),
        Err(error) => Err(error.into()),
    }
}

fn answer<R: Request>(
    frame: &Frame<'_>,
    respond: impl FnOnce(R) -> Result<R::Response, Refusal>,
) -> Result<Vec<u8, MAX_WIRE>, TooLong> {
    if frame.version != VERSION && R::OPERATION > LAST_FROZEN {
        return refuse(frame, Refusal::Version { spoken: VERSION });
    }
    let response = decode_message(frame.payload).ok_or(Refusal::Malformed).and_then(respond);
    match response {
        Ok(response) => encode_message([VERSION, frame.sequence, R::OPERATION | RESPONSE], &response),
        Err(refusal) => refuse(frame, refusal),
    }
}

fn refuse(frame: &Frame<'_>, refusal: Refusal) -> Result<Vec<u8, MAX_WIRE>, TooLong> {
    encode_message([VERSION, frame.sequence, REFUSED], &refusal)
}

//! A controller in storage that its user owns.

use crate::status::GrnStatus;
use grn_core::blob::{Blob, Identity};
use grn_core::robot::{Command, Controller, Percept};
use grn_core::scalar::{Q8_24, Scalar};

/// The size of a GrnController in units of 8 bytes.
pub const GRN_CONTROLLER_WORDS: usize = 256;

/// What a controller computes with. Both follow the same law; each gives the same bits on every machine.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrnNumber {
    /// Single-precision floating point.
    F32 = 1,
    /// Fixed point with 24 fractional bits, for processors without a floating-point unit.
    Q8_24 = 2,
}

/// Storage for one controller, owned by the caller: 2048 bytes, 8-aligned.
///
/// To be zero before the first grn_load, as static storage is and as "GrnController controller = {0};" makes it: so a
/// controller that nobody loaded is told from one that was. Loaded, it holds no pointers and may be copied.
#[repr(C)]
pub struct GrnController {
    opaque: [u64; GRN_CONTROLLER_WORDS],
}

/// What is in the storage of a loaded controller.
#[repr(C)]
struct Slot {
    magic: u64,
    brain: Brain,
}

/// The first word of a loaded controller.
const MAGIC: u64 = u64::from_le_bytes(*b"grn ctrl");

const _: () = assert!(size_of::<Slot>() <= size_of::<GrnController>(), "raise GRN_CONTROLLER_WORDS");
const _: () = assert!(align_of::<Slot>() <= align_of::<GrnController>(), "GrnController needs more alignment");

impl GrnController {
    /// From now on no controller is loaded.
    pub fn vacate(&mut self) {
        let [magic, ..] = &mut self.opaque;
        *magic = 0;
    }

    /// From now on this one is.
    pub fn fill(&mut self, brain: Brain) {
        let slot = (&raw mut self.opaque).cast::<Slot>();
        // SAFETY: a slot fits in size and alignment (asserted above), and `self` is borrowed exclusively.
        unsafe { slot.write(Slot { magic: MAGIC, brain }) };
    }

    /// The controller that is loaded.
    pub fn brain(&self) -> Result<&Brain, GrnStatus> {
        self.check()?;
        let slot = (&raw const self.opaque).cast::<Slot>();
        // SAFETY: the magic is there, so `fill` has written a slot.
        Ok(unsafe { &(*slot).brain })
    }

    /// The controller that is loaded, to be ticked.
    pub fn brain_mut(&mut self) -> Result<&mut Brain, GrnStatus> {
        self.check()?;
        let slot = (&raw mut self.opaque).cast::<Slot>();
        // SAFETY: the magic is there, so `fill` has written a slot, and `self` is borrowed exclusively.
        Ok(unsafe { &mut (*slot).brain })
    }

    fn check(&self) -> Result<(), GrnStatus> {
        let [magic, ..] = self.opaque;
        if magic == MAGIC { Ok(()) } else { Err(GrnStatus::NotLoaded) }
    }
}

/// A controller in either number type.
pub enum Brain {
    F32(Controller<f32>),
    Q8_24(Controller<Q8_24>),
}

impl Brain {
    pub fn load(bytes: &[u8], number: i32, robot: u8) -> Result<Self, GrnStatus> {
        const F32: i32 = GrnNumber::F32 as i32;
        const Q: i32 = GrnNumber::Q8_24 as i32;
        match number {
            F32 => controller(bytes, robot).map(Brain::F32),
            Q => controller(bytes, robot).map(Brain::Q8_24),
            _ => Err(GrnStatus::UnknownNumber),
        }
    }

    pub fn tick(&mut self, percept: &Percept) -> Command {
        match self {
            Brain::F32(controller) => controller.tick(percept),
            Brain::Q8_24(controller) => controller.tick(percept),
        }
    }

    pub fn morphogen(&self) -> f32 {
        match self {
            Brain::F32(controller) => controller.morphogen(),
            Brain::Q8_24(controller) => controller.morphogen().to_f32(),
        }
    }

    pub fn identity(&self) -> Identity {
        match self {
            Brain::F32(controller) => controller.identity(),
            Brain::Q8_24(controller) => controller.identity(),
        }
    }
}

fn controller<S: Scalar>(bytes: &[u8], robot: u8) -> Result<Controller<S>, GrnStatus> {
    Ok(Controller::new(&Blob::decode(bytes)?, robot)?)
}

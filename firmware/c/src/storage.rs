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
struct Slot<S> {
    magic: u64,
    controller: Controller<S>,
}

/// A number type that controllers are loaded in.
pub trait Number: Scalar {
    /// The first word of a controller that was loaded in it.
    const MAGIC: u64;
}

impl Number for f32 {
    const MAGIC: u64 = u64::from_le_bytes(*b"grn f32 ");
}

impl Number for Q8_24 {
    const MAGIC: u64 = u64::from_le_bytes(*b"grn 8.24");
}

impl<S> Slot<S> {
    /// A slot fits into the storage.
    const FITS: () = {
        assert!(size_of::<Self>() <= size_of::<GrnController>(), "raise GRN_CONTROLLER_WORDS");
        assert!(align_of::<Self>() <= align_of::<GrnController>(), "GrnController needs more alignment");
    };
}

impl Default for GrnController {
    fn default() -> Self {
        GrnController { opaque: [0; GRN_CONTROLLER_WORDS] }
    }
}

impl GrnController {
    /// From now on no controller is loaded.
    pub(crate) fn vacate(&mut self) {
        let [magic, ..] = &mut self.opaque;
        *magic = 0;
    }

    /// From now on this one is.
    pub(crate) fn fill<S: Number>(&mut self, controller: Controller<S>) {
        const { Slot::<S>::FITS };
        let slot = (&raw mut self.opaque).cast::<Slot<S>>();
        // SAFETY: a slot fits in size and alignment, and `self` is borrowed exclusively. The fields one by one, so that
        // the controller, large on the chip's stack, is copied once.
        unsafe {
            (&raw mut (*slot).controller).write(controller);
            (&raw mut (*slot).magic).write(S::MAGIC);
        }
    }

    /// The controller that is loaded, if it is in this number type.
    pub(crate) fn get<S: Number>(&self) -> Option<&Controller<S>> {
        let [magic, ..] = self.opaque;
        let slot = (&raw const self.opaque).cast::<Slot<S>>();
        // SAFETY: where this magic is, `fill` has written such a slot.
        (magic == S::MAGIC).then(|| unsafe { &(*slot).controller })
    }

    /// The same, to be ticked.
    pub(crate) fn get_mut<S: Number>(&mut self) -> Option<&mut Controller<S>> {
        let [magic, ..] = self.opaque;
        let slot = (&raw mut self.opaque).cast::<Slot<S>>();
        // SAFETY: where this magic is, `fill` has written such a slot, and `self` is borrowed exclusively.
        (magic == S::MAGIC).then(|| unsafe { &mut (*slot).controller })
    }

    pub(crate) fn tick(&mut self, percept: &Percept) -> Result<Command, GrnStatus> {
        if let Some(controller) = self.get_mut::<f32>() {
            Ok(tick(controller, percept))
        } else if let Some(controller) = self.get_mut::<Q8_24>() {
            Ok(tick(controller, percept))
        } else {
            Err(GrnStatus::NotLoaded)
        }
    }

    pub(crate) fn morphogen(&self) -> Result<f32, GrnStatus> {
        let float = || self.get::<f32>().map(Controller::morphogen);
        let fixed = || self.get::<Q8_24>().map(|controller| controller.morphogen().to_f32());
        float().or_else(fixed).ok_or(GrnStatus::NotLoaded)
    }

    pub(crate) fn identity(&self) -> Result<Identity, GrnStatus> {
        let float = || self.get::<f32>().map(Controller::identity);
        let fixed = || self.get::<Q8_24>().map(Controller::identity);
        float().or_else(fixed).ok_or(GrnStatus::NotLoaded)
    }
}

/// Makes a controller from a blob and, if there is storage for it, keeps it there.
pub fn load(bytes: &[u8], number: i32, robot: u8, storage: Option<&mut GrnController>) -> Result<(), GrnStatus> {
    const F32: i32 = GrnNumber::F32 as i32;
    const Q: i32 = GrnNumber::Q8_24 as i32;
    let blob = Blob::decode(bytes)?;
    match number {
        F32 => build::<f32>(&blob, robot, storage),
        Q => build::<Q8_24>(&blob, robot, storage),
        _ => Err(GrnStatus::UnknownNumber),
    }
}

// Not inlined, one function a number type: so the stack holds what one of them needs, not both at once.

#[inline(never)]
fn build<S: Number>(blob: &Blob, robot: u8, storage: Option<&mut GrnController>) -> Result<(), GrnStatus> {
    let controller = Controller::<S>::new(blob, robot)?;
    if let Some(storage) = storage {
        storage.fill(controller);
    }
    Ok(())
}

#[inline(never)]
fn tick<S: Number>(controller: &mut Controller<S>, percept: &Percept) -> Command {
    controller.tick(percept)
}

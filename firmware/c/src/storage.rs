//! A controller in storage that its user owns.

use crate::status::GrnStatus;
use core::mem::MaybeUninit;
use grn_core::blob::{Blob, Identity};
use grn_core::robot::{Command, Controller, Millimetres, Percept};
use grn_core::scalar::{Q8_24, Scalar};

/// The size of a loaded controller in units of 8 bytes, with some to spare for later versions.
pub const GRN_CONTROLLER_WORDS: usize = 319;

/// What a controller computes with. Both follow the same law; each gives the same bits on every machine.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrnNumber {
    /// Single-precision floating point.
    F32 = 1,
    /// Fixed point with 24 fractional bits, for processors without a floating-point unit.
    Q8_24 = 2,
}

/// Storage for one controller, owned by the caller: 2560 bytes, 8-aligned.
///
/// To be zero before the first grn_load, as static storage is and as "GrnController controller = {0};" makes it: so a
/// controller that nobody loaded is told from one that was. Loaded, it holds no pointers and may be copied.
#[repr(C)]
pub struct GrnController {
    /// What is loaded; 0 for nothing. Written by the library only, as all of the storage.
    magic: u64,
    /// The controller, if one is loaded.
    opaque: [MaybeUninit<u64>; GRN_CONTROLLER_WORDS],
}

/// A number type that controllers are loaded in.
pub trait Number: Scalar {
    /// What tells that the controller that is loaded computes with it.
    const MAGIC: u64;
}

impl Number for f32 {
    const MAGIC: u64 = u64::from_le_bytes(*b"grn f32 ");
}

impl Number for Q8_24 {
    const MAGIC: u64 = u64::from_le_bytes(*b"grn 8.24");
}

impl Default for GrnController {
    fn default() -> Self {
        GrnController { magic: 0, opaque: [MaybeUninit::zeroed(); GRN_CONTROLLER_WORDS] }
    }
}

impl GrnController {
    /// From now on no controller is loaded.
    pub(crate) fn vacate(&mut self) {
        self.magic = 0;
    }

    /// From now on this one is.
    pub(crate) fn fill<S: Number>(&mut self, controller: Controller<S>) {
        const {
            assert!(
                size_of::<Controller<S>>() <= GRN_CONTROLLER_WORDS * size_of::<u64>(),
                "raise GRN_CONTROLLER_WORDS"
            );
            assert!(align_of::<Controller<S>>() <= align_of::<u64>(), "a controller needs more alignment");
        }
        // SAFETY: a controller fits in size and alignment, and `self` is borrowed exclusively.
        unsafe { (&raw mut self.opaque).cast::<Controller<S>>().write(controller) };
        self.magic = S::MAGIC;
    }

    /// The controller that is loaded, if it computes with this number type.
    pub(crate) fn get<S: Number>(&self) -> Option<&Controller<S>> {
        let controller = (&raw const self.opaque).cast::<Controller<S>>();
        // SAFETY: with this magic `fill` has written such a controller.
        (self.magic == S::MAGIC).then(|| unsafe { &*controller })
    }

    /// The same, to be ticked.
    pub(crate) fn get_mut<S: Number>(&mut self) -> Option<&mut Controller<S>> {
        let controller = (&raw mut self.opaque).cast::<Controller<S>>();
        // SAFETY: with this magic `fill` has written such a controller, and `self` is borrowed exclusively.
        (self.magic == S::MAGIC).then(|| unsafe { &mut *controller })
    }

    pub(crate) fn tick(&mut self, percept: &Percept) -> Result<Command, GrnStatus> {
        if let Some(controller) = self.get_mut::<f32>() {
            tick(controller, percept)
        } else if let Some(controller) = self.get_mut::<Q8_24>() {
            tick(controller, percept)
        } else {
            Err(GrnStatus::NotLoaded)
        }
    }

    pub(crate) fn tick_home(&mut self, percept: &Percept, home: Millimetres) -> Result<Command, GrnStatus> {
        if let Some(controller) = self.get_mut::<f32>() {
            tick_home(controller, percept, home)
        } else if let Some(controller) = self.get_mut::<Q8_24>() {
            tick_home(controller, percept, home)
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
pub fn load(bytes: &[u8], number: i32, robot: u16, storage: Option<&mut GrnController>) -> Result<(), GrnStatus> {
    const F32: i32 = GrnNumber::F32 as i32;
    const Q: i32 = GrnNumber::Q8_24 as i32;
    let blob = Blob::decode(bytes);
    let blob = blob.as_ref().map_err(|&error| error)?;
    match number {
        F32 => build::<f32>(blob, robot, storage),
        Q => build::<Q8_24>(blob, robot, storage),
        _ => Err(GrnStatus::UnknownNumber),
    }
}

// Not inlined, one function a number type: so the stack holds what one of them needs, not both at once. And what is large
// is not moved out of its `Result`, which would put it there twice.

#[inline(never)]
fn build<S: Number>(blob: &Blob, robot: u16, storage: Option<&mut GrnController>) -> Result<(), GrnStatus> {
    match (Controller::<S>::new(blob, robot), storage) {
        (Ok(controller), Some(storage)) => storage.fill(controller),
        (Ok(_), None) => {}
        (Err(error), _) => return Err(error.into()),
    }
    Ok(())
}

#[inline(never)]
fn tick<S: Number>(controller: &mut Controller<S>, percept: &Percept) -> Result<Command, GrnStatus> {
    Ok(controller.tick(percept)?)
}

#[inline(never)]
fn tick_home<S: Number>(
    controller: &mut Controller<S>,
    percept: &Percept,
    home: Millimetres,
) -> Result<Command, GrnStatus> {
    Ok(controller.tick_home(percept, home)?)
}

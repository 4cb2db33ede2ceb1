//! The controller as a C library: for the e-puck2's C firmware, and for C and C++ controllers in Webots and ARGoS.
//!
//! No allocation, no global state, no panic: the caller owns the storage ([`GrnController`]), every call returns a
//! [`GrnStatus`], and whatever can be checked about a pointer, a count or a blob is checked. `include/grn.h` is made from
//! this crate's sources by cbindgen, so the documentation here is also the header's.
//!
//! The results are those of [`grn_core::robot::Controller`], bit for bit, on every machine.
#![no_std]
#![deny(clippy::expect_used, clippy::panic, clippy::indexing_slicing)]
#![deny(unsafe_op_in_unsafe_fn, clippy::undocumented_unsafe_blocks)]
// What holds for the pointers of all functions is said once, at the top of the header.
#![allow(clippy::missing_safety_doc)]

// A static library for a host takes its panic handler from std; nothing else of std is used.
#[cfg(not(target_os = "none"))]
extern crate std;

#[doc(hidden)]
pub mod layout;
mod message;
mod pointer;
mod radio;
mod status;
mod storage;

pub use message::*;
pub use radio::*;
pub use status::GrnStatus;
pub use storage::{GRN_CONTROLLER_WORDS, GrnController, GrnNumber};

use core::ffi::{CStr, c_char};
use grn_core::blob::FORMAT_VERSION;
use grn_core::robot::{Command, Millimetres, Percept};
use pointer::{bytes, exclusive, shared, write};

const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
    Ok(version) => version,
    Err(_) => c"",
};

/// Loads a blob into a controller, all genes silent and nothing known.
///
/// `controller`: the storage; whatever it holds is overwritten.
/// `controller_size`: sizeof(GrnController), which tells whether this header fits the library.
/// `blob`, `length`: the bytes of the blob, for example a file or a place in flash; they are not needed any more after
/// the call.
/// `number`: what to compute with, a GrnNumber.
/// `robot`: this robot's number, unique in the swarm.
///
/// Returns GRN_STATUS_OK, or why the blob is refused; the storage then holds no controller and grn_tick refuses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_load(
    controller: *mut GrnController,
    controller_size: usize,
    blob: *const u8,
    length: usize,
    number: i32,
    robot: u16,
) -> GrnStatus {
    GrnStatus::of(|| {
        if controller_size < size_of::<GrnController>() {
            return Err(GrnStatus::StorageTooSmall);
        }
        // SAFETY: the caller gives null or a pointer to storage, large enough, that nobody else uses now.
        let controller = unsafe { exclusive(controller) }?;
        controller.vacate();
        // SAFETY: the caller gives null or a pointer to `length` bytes that nobody writes now.
        let blob = unsafe { bytes(blob, length) }?;
        storage::load(blob, number, robot, Some(controller))
    })
}

/// Says what grn_load would say about a blob, without storage: for example before it is kept in flash.
///
/// `blob`, `length`, `number`: as for grn_load.
///
/// Takes about as much stack as grn_load.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_check(blob: *const u8, length: usize, number: i32) -> GrnStatus {
    GrnStatus::of(|| {
        // SAFETY: the caller gives null or a pointer to `length` bytes that nobody writes now.
        let blob = unsafe { bytes(blob, length) }?;
        storage::load(blob, number, 0, None)
    })
}

/// The percept of a robot that perceives nothing, not even where it is: what GRN_PERCEPT_NOTHING is.
///
/// `percept`: receives it; then put in what is perceived.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_percept_nothing(percept: *mut GrnPercept) -> GrnStatus {
    // SAFETY: the caller gives null or a pointer to a percept that nobody else uses now.
    GrnStatus::of(|| unsafe { write(percept, GrnPercept::nothing()) })
}

/// One control tick: perceive, express genes, move. To be called GRN_TICKS_PER_SECOND times a second,
/// or as often as "elapsed_us" of the percepts says.
///
/// `percept`: what the robot perceives; entries beyond a count are not read. Before the first fix the robot stands still.
/// `command`: receives what the robot does until the next tick.
///
/// Returns GRN_STATUS_OK, or what is wrong; the controller is then as before, and `command`, if it is a pointer to one,
/// stops the wheels and sends nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_tick(
    controller: *mut GrnController,
    percept: *const GrnPercept,
    command: *mut GrnCommand,
) -> GrnStatus {
    // SAFETY: what holds for the caller's pointers holds there.
    unsafe { answered(controller, percept, command, GrnController::tick) }
}

/// The same for a robot whose base station calls it home: it drives there, straight on and around what its proximity sensors
/// feel, instead of to the pattern. In any later tick it may go back to the pattern with grn_tick.
///
/// `percept`, `command`: as for grn_tick.
/// `home`: where it is to go.
///
/// Returns what grn_tick returns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_tick_home(
    controller: *mut GrnController,
    percept: *const GrnPercept,
    home: GrnMillimetres,
    command: *mut GrnCommand,
) -> GrnStatus {
    let home = Millimetres { x: home.x, y: home.y };
    // SAFETY: what holds for the caller's pointers holds there.
    unsafe { answered(controller, percept, command, |controller, percept| controller.tick_home(percept, home)) }
}

/// Reads a percept, lets the controller answer, writes its command.
unsafe fn answered(
    controller: *mut GrnController,
    percept: *const GrnPercept,
    command: *mut GrnCommand,
    answer: impl FnOnce(&mut GrnController, &Percept) -> Result<Command, GrnStatus>,
) -> GrnStatus {
    GrnStatus::of(|| {
        // SAFETY: the caller gives null or a pointer to a command that nobody else uses now.
        unsafe { write(command, GrnCommand::default()) }?;
        // SAFETY: the caller gives null or a pointer to storage that nobody else uses now.
        let controller = unsafe { exclusive(controller) }?;
        // SAFETY: the caller gives null or a pointer to a percept that nobody writes now.
        let percept = unsafe { shared(percept) }?;
        let mut perceived = Percept::nothing();
        percept.tell(&mut perceived)?;
        let answer = answer(controller, &perceived)?.into();
        // SAFETY: as above.
        unsafe { write(command, answer) }
    })
}

/// The level of the pattern morphogen M at the robot, as its genes express it now: 0 before the first target is known, then
/// about 0 to 1. A last gene XNOR may take it a little below 0, a last gene XOR a little above 1.
///
/// `morphogen`: receives it, without loss for both number types.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_morphogen(controller: *const GrnController, morphogen: *mut f32) -> GrnStatus {
    GrnStatus::of(|| {
        // SAFETY: the caller gives null or a pointer to storage that nobody writes now.
        let controller = unsafe { shared(controller) }?;
        // SAFETY: the caller gives null or a pointer to a number that nobody else uses now.
        unsafe { write(morphogen, controller.morphogen()?) }
    })
}

/// The identity of the blob that runs: the first 8 bytes of the SHA-256 of its payload, which `grn show` prints.
///
/// `identity`: receives GRN_IDENTITY_BYTES bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn grn_identity(controller: *const GrnController, identity: *mut u8) -> GrnStatus {
    GrnStatus::of(|| {
        // SAFETY: the caller gives null or a pointer to storage that nobody writes now.
        let controller = unsafe { shared(controller) }?;
        // SAFETY: the caller gives null or a pointer to as many bytes that nobody else uses now.
        unsafe { write(identity.cast::<[u8; GRN_IDENTITY_BYTES]>(), controller.identity()?) }
    })
}

/// What a status means and what to do about it: one line in English, ASCII, without a line end; never null.
///
/// `status`: a GrnStatus; another number has a text that says so.
#[unsafe(no_mangle)]
pub extern "C" fn grn_status_text(status: i32) -> *const c_char {
    GrnStatus::text(status).as_ptr()
}

/// The version of this library, like "0.1.0"; never null.
#[unsafe(no_mangle)]
pub extern "C" fn grn_version() -> *const c_char {
    VERSION.as_ptr()
}

/// The format version of the blobs this library reads.
#[unsafe(no_mangle)]
pub extern "C" fn grn_blob_format_version() -> u8 {
    FORMAT_VERSION
}

/// Nothing in this library can panic: if anything could, linking would fail for want of this symbol.
///
/// That is so with optimisation; an unoptimised library does not link.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        safe fn grn_panic_is_reachable() -> !;
    }
    grn_panic_is_reachable()
}

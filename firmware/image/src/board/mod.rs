//! The board: text and an exit code to the emulator's host, and what else the board at hand has.

#[cfg(target_arch = "arm")]
mod cortex_m;
#[cfg(target_arch = "riscv32")]
mod riscv;
#[cfg(target_arch = "arm")]
pub use cortex_m::stack_used;

#[cfg(target_abi = "eabihf")]
mod netduinoplus2;
#[cfg(target_abi = "eabihf")]
pub use netduinoplus2::{counter, uart};
#[cfg(target_abi = "eabihf")]
pub mod slots;

mod semihosting;
pub use semihosting::{exit, print};

//! What the images in `src/bin` share: the board they run on, and the proof that they cannot panic.
//!
//! The target says which board: `thumbv7em-none-eabihf` is QEMU's `netduinoplus2` (an STM32F405, of the e-puck2's family),
//! `thumbv7m-none-eabi` `mps2-an385`, `thumbv6m-none-eabi` `microbit` and `riscv32imc-unknown-none-elf` `virt`.
//! `cargo xtask target` builds and runs them all.
#![no_std]
#![deny(unsafe_code)]

#[allow(unsafe_code, reason = "registers, semihosting and start-up")]
pub mod board;
#[allow(unsafe_code, reason = "a function that does not exist is declared and called")]
mod panic;
#[cfg(target_abi = "eabihf")]
pub mod port;
#[cfg(target_abi = "eabihf")]
pub mod robot;
#[cfg(target_abi = "eabihf")]
pub mod session;
pub mod text;

/// Makes a function the image's entry: `fn() -> u8` ends the emulation with its exit code, `fn() -> !` never ends.
#[macro_export]
macro_rules! entry {
    ($main:path) => {
        #[unsafe(export_name = "main")]
        #[allow(unreachable_code, reason = "where the function never ends")]
        extern "C" fn entry() -> ! {
            $crate::board::exit($main())
        }
    };
}

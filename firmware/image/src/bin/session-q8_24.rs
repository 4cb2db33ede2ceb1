//! Measures the stack of a robot that computes in Q8.24.
#![no_std]
#![no_main]

use grn_core::scalar::{NumberType, Q8_24};
use grn_firmware::session;

grn_firmware::entry!(main);

fn main() -> u8 {
    session::run::<Q8_24>(NumberType::Q8_24)
}

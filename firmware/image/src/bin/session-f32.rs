//! Measures the stack of a robot that computes in f32.
#![no_std]
#![no_main]

use grn_core::scalar::NumberType;
use grn_firmware::session;

grn_firmware::entry!(main);

fn main() -> u8 {
    session::run::<f32>(NumberType::F32)
}

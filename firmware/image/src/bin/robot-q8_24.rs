//! A robot that computes in Q8.24.
#![no_std]
#![no_main]

use grn_core::scalar::{NumberType, Q8_24};
use grn_firmware::board::slots::SlotMemory;
use grn_firmware::board::uart::Uart;
use grn_firmware::robot;

grn_firmware::entry!(main);

fn main() -> u8 {
    // SAFETY: this is the only one.
    let slots = unsafe { SlotMemory::take() };
    u8::from(!robot::serve::<Q8_24>(NumberType::Q8_24, slots, &mut Uart))
}

//! A robot that computes in f32.
#![no_std]
#![no_main]

use grn_core::scalar::NumberType;
use grn_firmware::board::slots::SlotMemory;
use grn_firmware::board::uart::Uart;
use grn_firmware::robot;

grn_firmware::entry!(main);

fn main() -> u8 {
    // SAFETY: this is the only one.
    let slots = unsafe { SlotMemory::take() };
    u8::from(!robot::serve::<f32>(NumberType::F32, slots, &mut Uart))
}

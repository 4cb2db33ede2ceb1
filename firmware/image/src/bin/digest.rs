//! Placeholder.
#![no_std]
#![no_main]
use grn_firmware::board;

grn_firmware::entry!(main);

fn main() -> u8 {
    board::print("hello\n");
    7
}

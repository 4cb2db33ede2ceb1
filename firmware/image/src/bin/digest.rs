//! Runs the trials in every number type that the core has instructions for and prints their digests.
#![no_std]
#![no_main]

use grn_core::scalar::Q8_24;
use grn_firmware::board::print;
use grn_trials::digest::{Bits, Digest};
use grn_trials::digests;

grn_firmware::entry!(main);

fn main() -> u8 {
    #[cfg(target_abi = "eabihf")]
    show::<f32>();
    show::<Q8_24>();
    0
}

fn show<S: Bits>() {
    let digests = digests::<S>();
    for (part, digest) in digests.parts() {
        line(S::NAME, part, &digest);
    }
    line(S::NAME, "all", &digests.all());
}

fn line(number: &str, part: &str, digest: &Digest) {
    for word in [number, " ", part, " "] {
        print(word);
    }
    for digit in digest.digits() {
        print(digit.encode_utf8(&mut [0; 4]));
    }
    print("\n");
}

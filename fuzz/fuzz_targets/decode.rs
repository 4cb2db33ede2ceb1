//! The blob decoder under libFuzzer: `cargo xtask fuzz`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    grn_tests::decoder::exercise(data);
});

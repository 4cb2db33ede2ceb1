//! Hands the linker the memory map of the board that the target stands for.

use std::path::PathBuf;
use std::{env, fs};

fn main() {
    let of_cargo = |name: &str| env::var(name).unwrap_or_else(|_| panic!("cargo sets {name}"));
    let target = of_cargo("TARGET");
    let (board, script) = match target.as_str() {
        "thumbv7em-none-eabihf" => ("netduinoplus2", "link.x"),
        "thumbv7m-none-eabi" => ("mps2-an385", "link.x"),
        "thumbv6m-none-eabi" => ("microbit", "link.x"),
        "riscv32imc-unknown-none-elf" => ("virt", "memory.x"),
        other => panic!("no board for {other}: firmware/image is built with --target, see `cargo xtask target`"),
    };
    let source = PathBuf::from(of_cargo("CARGO_MANIFEST_DIR")).join("boards").join(board).with_extension("x");
    let out = PathBuf::from(of_cargo("OUT_DIR"));
    fs::copy(&source, out.join("memory.x")).unwrap_or_else(|error| panic!("{}: {error}", source.display()));
    println!("cargo:rerun-if-changed={}", source.display());
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=-T{script}");
}

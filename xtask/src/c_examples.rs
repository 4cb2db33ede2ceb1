//! The C library's examples, compiled and run: on this machine, and on a bare Cortex-M4F in QEMU.

use crate::tally::Tally;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};

const TARGET: &str = "thumbv7em-none-eabihf";
/// What has to be installed, and the Debian packages that have it.
const TOOLS: [(&str, &str); 5] = [
    ("make", "make"),
    ("cc", "gcc libc6-dev"),
    ("c++", "g++"),
    ("arm-none-eabi-gcc", "gcc-arm-none-eabi"),
    ("qemu-system-arm", "qemu-system-arm"),
];

/// Tests the header and the examples, and counts: both examples must print what `expected.txt` says, byte for byte.
///
/// What is missing on this machine is a failure, and how to get it is printed.
pub fn check() -> Tally {
    type Test = fn() -> Result<(), String>;
    let tests: [(&str, Test); 5] = [
        ("compilers and emulator are installed", tools),
        ("the header is C++ too", header),
        ("the example prints what it should on this machine", || example("run-host")),
        ("the example prints what it should on the chip", || example("run-chip")),
        ("size of the library on the chip", size),
    ];
    let mut tally = Tally::default();
    for (name, test) in tests {
        let outcome = test();
        println!("test C: {name} ... {}", if outcome.is_ok() { "ok" } else { "FAILED" });
        match outcome {
            Ok(()) => tally.passed += 1,
            Err(why) => {
                eprintln!("{why}");
                tally.failed += 1;
            }
        }
    }
    tally
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn examples() -> PathBuf {
    repository().join("firmware/examples/c")
}

/// Standard output of a command that succeeds; its standard error is shown.
fn output(command: &mut Command) -> Result<String, String> {
    let described = format!("{command:?}");
    let output = command.stderr(Stdio::inherit()).output().map_err(|error| format!("{described}: {error}"))?;
    if output.status.success() {
        String::from_utf8(output.stdout).map_err(|error| format!("{described}: {error}"))
    } else {
        Err(format!("{described}: {}", output.status))
    }
}

fn make(goal: &str) -> Result<String, String> {
    output(Command::new("make").args(["--silent", "--no-print-directory", goal]).current_dir(examples()))
}

fn tools() -> Result<(), String> {
    let installed = |tool: &str| {
        let asked = Command::new(tool).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        asked.is_ok_and(|status| status.success())
    };
    let missing: Vec<&str> = TOOLS.iter().filter(|(tool, _)| !installed(tool)).map(|&(_, package)| package).collect();
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let library = output(Command::new(rustc).args(["--print", "target-libdir", "--target", TARGET]))?;
    let mut wanted = Vec::new();
    if !missing.is_empty() {
        wanted.push(format!("missing; get it with: apt-get install --no-install-recommends {}", missing.join(" ")));
    }
    if !Path::new(library.trim()).exists() {
        wanted.push(format!("Rust's library for the chip is missing; get it with: rustup target add {TARGET}"));
    }
    if wanted.is_empty() { Ok(()) } else { Err(wanted.join("\n")) }
}

fn header() -> Result<(), String> {
    let flags = ["-x", "c++", "-std=c++11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"];
    output(Command::new("c++").args(flags).arg(repository().join("firmware/c/include/grn.h"))).map(drop)
}

fn example(goal: &str) -> Result<(), String> {
    let expected = examples().join("expected.txt");
    let expected = fs::read_to_string(&expected).map_err(|error| format!("{}: {error}", expected.display()))?;
    let printed = make(goal)?;
    if printed == expected {
        return Ok(());
    }
    let differs = (1..).zip(printed.lines().zip(expected.lines())).find(|(_, (printed, expected))| printed != expected);
    Err(match differs {
        Some((line, (printed, expected))) => format!("line {line} is\n{printed}\nand should be\n{expected}"),
        None => format!("{} bytes instead of {}", printed.len(), expected.len()),
    })
}

fn size() -> Result<(), String> {
    make("size").map(|sizes| print!("{sizes}"))
}

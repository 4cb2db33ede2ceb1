//! The C library's examples, compiled and run: on this machine, and on a bare Cortex-M4F in QEMU.

use crate::tally::Tally;
use crate::target::tools::{self, Compiler};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const TARGET: &str = "thumbv7em-none-eabihf";
/// What has to be installed besides the emulator, and the Debian packages that have it.
const TOOLS: [(&str, &[&str]); 4] = [
    ("make", &["make"]),
    ("cc", &["gcc", "libc6-dev"]),
    ("c++", &["g++"]),
    ("arm-none-eabi-gcc", &["gcc-arm-none-eabi"]),
];

/// Tests the header and the examples, and counts: both examples must print what `expected.txt` says, byte for byte.
///
/// What is missing on this machine is installed if that can be done, else a failure, and how to get it is printed.
pub fn check(tally: &mut Tally) {
    let ready = tools::emulators(&["qemu-system-arm"])
        .and_then(|()| tools::programs(&TOOLS))
        .and_then(|()| Compiler::find(&[TARGET]));
    let chip = ready.as_ref().map(|compiler| compiler.environment(TARGET)).unwrap_or_default();
    let checks: Vec<(&str, Result<(), String>)> = match ready {
        Err(error) => vec![("compilers and emulator are there", Err(error))],
        Ok(_) => vec![
            ("the header is C++ too", header()),
            ("the example prints what it should on this machine", example("run-host", &[])),
            ("the example prints what it should on the chip", example("run-chip", &chip)),
            ("size of the library on the chip", make("size", &chip).map(|sizes| print!("{sizes}"))),
        ],
    };
    for (name, outcome) in checks {
        println!("test C: {name} ... {}", if outcome.is_ok() { "ok" } else { "FAILED" });
        match outcome {
            Ok(()) => tally.passed += 1,
            Err(why) => {
                eprintln!("{why}");
                tally.failed += 1;
            }
        }
    }
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

fn make(goal: &str, environment: &[(String, String)]) -> Result<String, String> {
    let mut command = Command::new("make");
    command.args(["--silent", "--no-print-directory", goal]).envs(environment.iter().cloned());
    output(command.current_dir(examples()))
}

fn header() -> Result<(), String> {
    let flags = ["-x", "c++", "-std=c++11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"];
    output(Command::new("c++").args(flags).arg(repository().join("firmware/c/include/grn.h"))).map(drop)
}

fn example(goal: &str, environment: &[(String, String)]) -> Result<(), String> {
    let expected = examples().join("expected.txt");
    let expected = fs::read_to_string(&expected).map_err(|error| format!("{}: {error}", expected.display()))?;
    let printed = make(goal, environment)?;
    if printed == expected {
        return Ok(());
    }
    let differs = (1..).zip(printed.lines().zip(expected.lines())).find(|(_, (printed, expected))| printed != expected);
    Err(match differs {
        Some((line, (printed, expected))) => format!("line {line} is\n{printed}\nand should be\n{expected}"),
        None => format!("{} bytes instead of {}", printed.len(), expected.len()),
    })
}

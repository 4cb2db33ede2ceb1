//! The C library's examples, compiled and run: on this machine, and on a bare Cortex-M4F in QEMU.

use crate::c_package;
use crate::tally::Tally;
use crate::target::golden::Golden;
use crate::target::tools::{self, Compiler};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "thumbv7em-none-eabihf";
/// What has to be installed besides the emulator, and the Debian packages that have it.
const TOOLS: [(&str, &[&str]); 4] = [
    ("make", &["make"]),
    ("cc", &["gcc", "libc6-dev"]),
    ("c++", &["g++"]),
    ("arm-none-eabi-gcc", &["gcc-arm-none-eabi"]),
];

/// Tests the header and the examples, and counts: both examples must print what `expected.txt` says, byte for byte, and the
/// library must weigh what `firmware/golden/c-library.run` says; with `bless` that file is written anew.
///
/// What is missing on this machine is installed if that can be done, else a failure, and how to get it is printed.
pub fn check(bless: bool, tally: &mut Tally) {
    let ready = tools::emulators(&["qemu-system-arm"])
        .and_then(|()| tools::programs(&TOOLS))
        .and_then(|()| Compiler::find(&[TARGET]));
    let mut checks: Vec<(&str, Result<(), String>)> = match ready {
        Err(error) => vec![("compilers and emulator are there", Err(error))],
        Ok(compiler) => {
            let chip = compiler.environment(TARGET);
            let on_the_chip = make("run-chip", &chip);
            let folder = repository().join("firmware/golden");
            let golden = Golden { folder, bless, task: "c", tolerance: compiler.tolerance() };
            let costs = costs(&on_the_chip, make("size", &chip));
            vec![
                ("the header is C++ too", header()),
                ("the example prints what it should on this machine", expected(&make("run-host", &[]))),
                ("the example prints what it should on the chip", expected(&on_the_chip)),
                (
                    "a program that fills the RAM links with the controller beside the core",
                    in_ccm(make("chip-ccm", &chip)),
                ),
                ("the library has the golden costs", costs.and_then(|costs| golden.near("c-library.run", &costs))),
            ]
        }
    };
    checks.extend(c_package::checks());
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

/// What a command printed.
struct Printed {
    output: String,
    /// To standard error, which is shown, too.
    errors: String,
}

/// Runs a command that must succeed.
fn run(command: &mut Command) -> Result<Printed, String> {
    let described = format!("{command:?}");
    let ran = command.output().map_err(|error| format!("{described}: {error}"))?;
    let errors = String::from_utf8_lossy(&ran.stderr).into_owned();
    eprint!("{errors}");
    if !ran.status.success() {
        return Err(format!("{described}: {}", ran.status));
    }
    let output = String::from_utf8(ran.stdout).map_err(|error| format!("{described}: {error}"))?;
    Ok(Printed { output, errors })
}

fn make(goal: &str, environment: &[(String, String)]) -> Result<Printed, String> {
    let mut command = Command::new("make");
    command.args(["--silent", "--no-print-directory", goal]).envs(environment.iter().cloned());
    run(command.current_dir(examples()))
}

/// A golden file's lines: bytes of the library, from what `size` printed, and of stack, from what the chip did.
fn costs(on_the_chip: &Result<Printed, String>, size: Result<Printed, String>) -> Result<String, String> {
    let size = size?.output;
    let text = size.lines().nth(1).and_then(|line| line.split_whitespace().next());
    let text = text.ok_or_else(|| format!("no size in {size:?}"))?;
    let errors = &on_the_chip.as_ref().map_err(Clone::clone)?.errors;
    let stack = errors.lines().filter(|line| line.contains("bytes of stack"));
    let stack = stack.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    let lines = [format!("code and constants, bytes: {text}")].into_iter().chain(stack);
    Ok(lines.map(|line| line + "\n").collect())
}

/// Whether symbols that `nm` listed have a controller in the memory beside the core, from 0x10000000 on.
fn in_ccm(symbols: Result<Printed, String>) -> Result<(), String> {
    let symbols = symbols?.output;
    let there = symbols.lines().any(|line| line.starts_with("1000") && line.contains(" controller"));
    if there { Ok(()) } else { Err(format!("no controller from 0x10000000 on:\n{symbols}")) }
}

fn header() -> Result<(), String> {
    let flags = ["-x", "c++", "-std=c++11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"];
    run(Command::new("c++").args(flags).arg(repository().join("firmware/c/include/grn.h"))).map(drop)
}

fn expected(ran: &Result<Printed, String>) -> Result<(), String> {
    let printed = &ran.as_ref().map_err(Clone::clone)?.output;
    let expected = examples().join("expected.txt");
    let expected = fs::read_to_string(&expected).map_err(|error| format!("{}: {error}", expected.display()))?;
    if *printed == expected {
        return Ok(());
    }
    let differs = (1..).zip(printed.lines().zip(expected.lines())).find(|(_, (printed, expected))| printed != expected);
    Err(match differs {
        Some((line, (printed, expected))) => format!("line {line} is\n{printed}\nand should be\n{expected}"),
        None => format!("{} bytes instead of {}", printed.len(), expected.len()),
    })
}

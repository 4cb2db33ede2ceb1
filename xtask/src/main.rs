//! What a person would otherwise type by hand. `cargo xtask` without arguments says what there is.

mod c_examples;
mod c_install;
mod c_package;
mod mpi;
mod python;
mod slurm;
mod tally;
mod target;

use std::env;
use std::path::Path;
use std::process::{Command, ExitCode};
use tally::Tally;

const HELP: &str = "cargo xtask TASK

  test   build everything and run all tests; ends with a line that counts them
  target [--bless]
         build the images for the emulated boards, check that they cannot panic and what they weigh, run them in QEMU
         and compare what they print with firmware/golden; a part of test. --bless writes these files anew
  c [--bless]
         test the C library and its examples, on this machine and on an emulated chip; a part of test. --bless writes its
         header, the examples' expected output and the library's golden costs anew
  c-install PREFIX
         build the C library and install it under PREFIX: header, static and shared library, pkg-config file, CMake package
  mpi    build the command with MPI and try campaigns of up to 4 ranks on this machine
  python build the Python package and run its tests and examples, in an environment of its own in target/python; a part of
         test
  crosscheck [--seeds N] [--labs NAME…] [--models NAME…]
         drive the same robots in MuJoCo and in our simulator and write docs/crosscheck.md; goes on where it was stopped. A
         short form is a part of python
  slurm  try the scripts of examples/slurm under a Slurm of our own, one node on this machine; needs root, and is no part of test
  bench  run the benchmarks (criterion); figures on standard output
  bless  write the golden files anew: models/*.grn, tests/golden/digest.txt (look at the difference before you commit)
  reproduce
         run the paper's experiments (campaigns/*.toml, about ten minutes on two cores; goes on where it was stopped)
         and write docs/reproduction.md with its figures and tables
  reproduce adaptive
         the same for controllers that adapt, with docs/adaptive.md: takes a night on two cores; `grn campaign --shard`, MPI
         and Slurm share out the campaigns' runs between machines
  fuzz   feed the blob decoder 10 million mutated inputs, a robot 10 million random frames, and the radio's assembler
         200 thousand random conversations, then the decoder 10 million
         inputs of libFuzzer's (this part needs a nightly toolchain and cargo-fuzz, and says so if they are missing)
";

fn main() -> ExitCode {
    let task = env::args().nth(1).unwrap_or_default();
    let done = match task.as_str() {
        "test" => test(),
        "target" => target(bless()),
        "c" => {
            let mut tally = Tally::default();
            let succeeded = c_library(bless(), &mut tally);
            tally.close(succeeded)
        }
        "c-install" => c_install(),
        "mpi" => {
            let mut tally = Tally::default();
            let succeeded = mpi::check(&mut tally);
            tally.close(succeeded)
        }
        "slurm" => {
            let mut tally = Tally::default();
            let succeeded = slurm::check(&mut tally);
            tally.close(succeeded)
        }
        "python" => {
            let mut tally = Tally::default();
            let succeeded = python::check(&mut tally);
            tally.close(succeeded)
        }
        "crosscheck" => python::crosscheck(env::args().skip(2)),
        "bench" => cargo(&["bench", "--workspace", "--benches"], &[]),
        "bless" => ["models", "digest"].iter().all(|what| {
            cargo(&["run", "--quiet", "--release", "--package", "grn-tests", "--bin", "bless", "--", what], &[])
        }),
        "reproduce" => match env::args().nth(2).as_deref() {
            None => reproduce(&["paper", "sensitivity", "de-generations"], "reproduce"),
            Some("adaptive") => reproduce(&["generalise", "adaptive", "adaptive-tracked"], "adaptive"),
            Some(other) => {
                eprintln!(
                    "cargo xtask reproduce {other}: there is nothing of that name; leave it out, or say adaptive"
                );
                false
            }
        },
        "fuzz" => fuzz(),
        "" | "help" | "--help" | "-h" => {
            print!("{HELP}");
            true
        }
        other => {
            eprintln!("no task {other:?}\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    if done { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn this_cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// Runs cargo with its output shown; whether it succeeded.
fn cargo(arguments: &[&str], variables: &[(&str, &str)]) -> bool {
    println!("cargo {}", arguments.join(" "));
    let status = this_cargo().args(arguments).envs(variables.iter().copied()).status();
    status.inspect_err(|error| eprintln!("cargo cannot be run: {error}")).is_ok_and(|status| status.success())
}

/// Whether the task is to write its golden files anew.
fn bless() -> bool {
    env::args().nth(2).as_deref() == Some("--bless")
}

/// Runs cargo with its output shown and counts tests; whether it succeeded.
fn cargo_test(arguments: &[&str], tally: &mut Tally) -> bool {
    println!("cargo {}", arguments.join(" "));
    tally.follow(this_cargo().args(arguments))
}

/// All tests there are; none is left out but those marked ignored, which are counted as skipped.
fn test() -> bool {
    let mut tally = Tally::default();
    let succeeded = [
        cargo_test(&["test", "--workspace", "--no-fail-fast"], &mut tally),
        // The same core with the other sigmoid, which only the core's own tests are about.
        cargo_test(&["test", "--package", "grn-core", "--features", "micromath", "--no-fail-fast"], &mut tally),
        images(false, &mut tally),
        c_library(false, &mut tally),
        python::check(&mut tally),
        cargo(&["doc", "--workspace", "--no-deps", "--quiet"], &[("RUSTDOCFLAGS", "-D warnings")]),
    ];
    tally.close(succeeded.into_iter().all(|success| success))
}

/// What runs on the robot: built, weighed and run in QEMU.
fn target(bless: bool) -> bool {
    let mut tally = Tally::default();
    let succeeded = images(bless, &mut tally);
    tally.close(succeeded)
}

/// The images, then robots that run them in a simulated swarm.
fn images(bless: bool, tally: &mut Tally) -> bool {
    target::check(bless, tally);
    // Of the workspace, not of the package alone: that would build all it depends on again, with fewer features.
    let loops = ["--features", "grn-tests/qemu", "--test", "processor_in_the_loop", "--no-fail-fast"];
    cargo_test(&[&["test", "--workspace"], &loops[..]].concat(), tally)
}

/// The C library's own tests, then its examples.
fn c_library(bless: bool, tally: &mut Tally) -> bool {
    let mut tests = this_cargo();
    tests.args(["test", "--manifest-path", "firmware/Cargo.toml", "--package", "grn-c", "--no-fail-fast"]);
    if bless {
        tests.env("GRN_BLESS", "1");
    }
    let succeeded = tally.follow(&mut tests);
    c_examples::check(bless, tally);
    succeeded
}

/// Installs the C library and lists what was written.
fn c_install() -> bool {
    let Some(prefix) = env::args_os().nth(2) else {
        eprintln!("cargo xtask c-install PREFIX: say where to, for example /usr/local or a folder of your own");
        return false;
    };
    match c_install::install(Path::new(&prefix)) {
        Ok(written) => {
            written.iter().for_each(|path| println!("{}", path.display()));
            true
        }
        Err(error) => {
            eprintln!("{error}");
            false
        }
    }
}

/// Runs campaigns, or what is left of them, and then `writer`, which makes a page of docs/ from their folders.
fn reproduce(campaigns: &[&str], writer: &str) -> bool {
    let done = campaigns.iter().all(|name| {
        let (file, out) = (format!("campaigns/{name}.toml"), format!("runs/{name}"));
        cargo(&["run", "--release", "--package", "host-evolver", "--", "campaign", &file, "--out", &out], &[])
    });
    let folders: Vec<String> = campaigns.iter().map(|name| format!("runs/{name}")).collect();
    let mut write = vec!["run", "--release", "--package", "grn-tests", "--bin", writer, "--"];
    write.extend(folders.iter().map(String::as_str));
    done && cargo(&write, &[])
}

fn fuzz() -> bool {
    const INPUTS: &str = "10000000";
    let variables = [("GRN_FUZZ_INPUTS", INPUTS)];
    let decoder = ["test", "--release", "--package", "grn-tests", "--test", "decoder", "--", "--nocapture"];
    // With the checks of the test profile: a robot must not even come near an overflow.
    let link = [
        "test",
        "--package",
        "grn-tests",
        "--test",
        "link_frames",
        "no_frame_makes_a_robot_panic",
        "--",
        "--nocapture",
    ];
    let radio = ["test", "--package", "grn-core", "--lib", "robot::radio"];
    let radio = cargo(&radio, &[("PROPTEST_CASES", "200000")]);
    let random = [cargo(&decoder, &variables), cargo(&link, &variables), radio] == [true; 3];
    let ready = Command::new("cargo").args(["+nightly", "fuzz", "--version"]).output();
    if !ready.is_ok_and(|output| output.status.success()) {
        eprintln!(
            "libFuzzer's part is missing: it needs a nightly toolchain (rustup toolchain install nightly) and cargo-fuzz \
             (cargo install cargo-fuzz)"
        );
        return false;
    }
    let runs = format!("-runs={INPUTS}");
    let guided =
        Command::new("cargo").args(["+nightly", "fuzz", "run", "decode", "--", &runs, "-max_len=512"]).status();
    random && guided.is_ok_and(|status| status.success())
}

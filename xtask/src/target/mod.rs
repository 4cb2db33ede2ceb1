//! `cargo xtask target`: builds the images, checks what they are made of, runs them in QEMU and compares what they say
//! with golden files.

mod elf;
pub mod golden;
pub mod tools;

use crate::tally::Tally;
use elf::Elf;
use golden::Golden;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use tools::Compiler;

/// A board: a compiler's target and the QEMU machine that runs it.
#[derive(Clone, Copy)]
struct Board {
    name: &'static str,
    target: &'static str,
    emulator: &'static str,
    machine: &'static [&'static str],
    /// The number types that its `digest` shows.
    numbers: &'static [&'static str],
}

const CORTEX_M4F: Board = Board {
    name: "netduinoplus2",
    target: "thumbv7em-none-eabihf",
    emulator: "qemu-system-arm",
    machine: &["-M", "netduinoplus2"],
    numbers: &["f32", "q8.24"],
};
const CORTEX_M3: Board = Board {
    name: "mps2-an385",
    target: "thumbv7m-none-eabi",
    emulator: "qemu-system-arm",
    machine: &["-M", "mps2-an385"],
    numbers: &["q8.24"],
};
const CORTEX_M0: Board = Board {
    name: "microbit",
    target: "thumbv6m-none-eabi",
    emulator: "qemu-system-arm",
    machine: &["-M", "microbit"],
    numbers: &["q8.24"],
};
const RV32IMC: Board = Board {
    name: "virt",
    target: "riscv32imc-unknown-none-elf",
    emulator: "qemu-system-riscv32",
    machine: &["-M", "virt", "-bios", "none"],
    numbers: &["q8.24"],
};
const BOARDS: [Board; 4] = [CORTEX_M4F, CORTEX_M3, CORTEX_M0, RV32IMC];

/// Of all builds, relative to the repository.
const TARGET_FOLDER: &str = "firmware/target";

/// What is asked of an image besides that it links, and so cannot panic.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Check {
    /// Runs, and prints lines of `tests/golden/digest.txt`.
    Digest,
    /// Runs, counting instructions, and prints costs near the golden ones and below [`COST_BARS`].
    Cost,
    /// Code below [`CODE_BAR`]; it serves a serial port and so is not run here.
    Robot,
    /// Runs, flashing and driving a robot, and prints stack near the golden one and, with static memory, below
    /// [`MEMORY_BAR`].
    Session,
}

/// One image: a binary of `firmware/image`, built for a board with features.
struct Image {
    board: Board,
    binary: &'static str,
    features: &'static str,
    check: Check,
}

/// Images that are built by one run of cargo are neighbours here.
const IMAGES: [Image; 10] = [
    Image { board: CORTEX_M4F, binary: "digest", features: "", check: Check::Digest },
    Image { board: CORTEX_M4F, binary: "cost", features: "", check: Check::Cost },
    Image { board: CORTEX_M4F, binary: "robot-f32", features: "", check: Check::Robot },
    Image { board: CORTEX_M4F, binary: "robot-q8_24", features: "", check: Check::Robot },
    Image { board: CORTEX_M4F, binary: "session-f32", features: "", check: Check::Session },
    Image { board: CORTEX_M4F, binary: "session-q8_24", features: "", check: Check::Session },
    Image { board: CORTEX_M4F, binary: "cost", features: "micromath", check: Check::Cost },
    Image { board: CORTEX_M3, binary: "digest", features: "", check: Check::Digest },
    Image { board: CORTEX_M0, binary: "digest", features: "", check: Check::Digest },
    Image { board: RV32IMC, binary: "digest", features: "", check: Check::Digest },
];

/// `.text` of a robot's image, bytes.
const CODE_BAR: usize = 48 * 1024;
/// Static memory and stack together, bytes.
const MEMORY_BAR: usize = 16 * 1024;
/// Ends of costs' names, for the printed two- and three-gene models, and the instructions they must stay below.
const COST_BARS: [(&str, usize); 5] = [
    (" nand-xnor rk4-step", 1_500),
    ("-xnor tick", 10_000),
    ("-xnor tick-largest", 10_000),
    ("-xnor tick-all-heard-at-once", 10_700),
    ("-xnor tick-all-new-at-once", 10_700),
];

impl Image {
    fn name(&self) -> String {
        let features = if self.features.is_empty() { String::new() } else { format!("-{}", self.features) };
        format!("{}-{}{features}", self.board.name, self.binary)
    }

    /// Where cargo leaves it, until it builds the same binary with other features.
    fn built(&self, root: &Path) -> PathBuf {
        root.join(TARGET_FOLDER).join(self.board.target).join("release").join(self.binary)
    }

    /// Where it stays.
    fn path(&self, root: &Path) -> PathBuf {
        root.join(TARGET_FOLDER).join("images").join(self.name()).with_extension("elf")
    }

    fn built_with(&self, other: &Image) -> bool {
        (self.board.target, self.features) == (other.board.target, other.features)
    }

    /// What it prints when run, and its exit code, from QEMU.
    fn run(&self, root: &Path) -> Result<String, String> {
        let mut command = Command::new(self.board.emulator);
        command.args(self.board.machine).args(["-display", "none", "-monitor", "none", "-serial", "none"]);
        command.args(["-semihosting-config", "enable=on,target=native"]);
        if self.check == Check::Cost {
            // One nanosecond an instruction.
            command.args(["-icount", "shift=0"]);
        }
        command.arg("-kernel").arg(self.path(root));
        tools::output_within(&mut command, Duration::from_secs(180))
    }
}

/// Builds, checks and runs all images, counting each check as a test; with `bless`, writes the golden files instead of
/// comparing with them.
pub fn check(bless: bool, tally: &mut Tally) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let ready = tools::emulators(&BOARDS.map(|board| board.emulator))
        .and_then(|()| Compiler::find(&BOARDS.map(|board| board.target)));
    let compiler = match ready {
        Ok(compiler) => compiler,
        Err(error) => return report(tally, "tools", Err(error)),
    };
    println!("\nfirmware: {compiler}");
    host_checks(&root, tally);
    let golden =
        Golden { folder: root.join("firmware/golden"), bless, task: "target", tolerance: compiler.tolerance() };
    for images in IMAGES.chunk_by(Image::built_with) {
        let built = build(&compiler, &root, images);
        for image in images {
            let name = image.name();
            let checks: Vec<(&str, Result<(), String>)> = match &built {
                Err(error) => vec![("builds", Err(error.clone()))],
                Ok(()) => image_checks(image, &root, &golden),
            };
            for (what, result) in checks {
                report(tally, &format!("{name} {what}"), result);
            }
        }
    }
}

/// The same trials on this machine, in a build of each sort.
fn host_checks(root: &Path, tally: &mut Tally) {
    // Optimised differently from the images, and quick to link.
    let release = ["--release", "--config", "profile.release.opt-level=3", "--config", "profile.release.lto=false"];
    // With a target, cargo does not build compiler plug-ins once more with these flags.
    let host = tools::host();
    let native = ["--target", &host, "--config", "build.rustflags=['-Ctarget-cpu=native']"];
    let builds = [("debug", vec![]), ("release", release.to_vec()), ("native", [&release[..], &native[..]].concat())];
    for (name, options) in builds {
        let mut command = crate::this_cargo();
        command.current_dir(root.join("firmware")).args(["run", "--quiet", "--locked", "--package", "grn-trials"]);
        command.args(["--bin", "digest", "--target-dir"]).arg(root.join(TARGET_FOLDER)).args(options);
        let output = tools::output_within(&mut command, Duration::from_secs(600));
        let result = output.and_then(|output| golden::digests(root, &output, &["f32", "q8.24"]));
        report(tally, &format!("host-{name} gives the golden digests"), result);
    }
}

fn report(tally: &mut Tally, name: &str, result: Result<(), String>) {
    match result {
        Ok(()) => {
            tally.passed += 1;
            println!("test target {name} ... ok");
        }
        Err(error) => {
            tally.failed += 1;
            println!("test target {name} ... FAILED\n{error}");
        }
    }
}

fn build(compiler: &Compiler, root: &Path, images: &[Image]) -> Result<(), String> {
    let Some(first) = images.first() else { return Ok(()) };
    let mut command = compiler.cargo_build(first.board.target);
    command.current_dir(root.join("firmware")).args(["--release", "--locked", "--package", "grn-firmware"]);
    command.args(["--features", first.features]).arg("--target-dir").arg(root.join(TARGET_FOLDER));
    for image in images {
        command.args(["--bin", image.binary]);
    }
    let status = command.status().map_err(|error| format!("cargo cannot be run: {error}"))?;
    if !status.success() {
        return Err("does not build; an undefined symbol a_panic_is_reachable means that it could panic".into());
    }
    images.iter().try_for_each(|image| {
        let (built, path) = (image.built(root), image.path(root));
        let folder = path.parent().unwrap_or(root);
        let kept = fs::create_dir_all(folder).and_then(|()| fs::copy(&built, &path));
        kept.map(|_| ()).map_err(|error| format!("{}: {error}", path.display()))
    })
}

fn image_checks(image: &Image, root: &Path, golden: &Golden) -> Vec<(&'static str, Result<(), String>)> {
    let name = image.name();
    let elf = match Elf::read(&image.path(root)) {
        Ok(elf) => elf,
        Err(error) => return vec![("is an image", Err(error))],
    };
    let sizes = elf.sizes;
    println!("{name}: {sizes}");
    let panics = match elf.symbols.iter().find(|symbol| symbol.contains("panicking") || symbol.contains("begin_unwind"))
    {
        None => Ok(()),
        Some(symbol) => Err(format!("it holds {symbol}: something can panic")),
    };
    let mut checks = vec![
        ("holds no panic machinery", panics),
        ("has the golden sizes", golden.near(&format!("{name}.size"), &sizes.lines())),
    ];
    match image.check {
        Check::Robot => checks.push(("code is below 48 KiB", below(".text", sizes.code, CODE_BAR))),
        Check::Digest => {
            let digests = image.run(root).and_then(|output| golden::digests(root, &output, image.board.numbers));
            checks.push(("gives the golden digests", digests));
        }
        Check::Cost | Check::Session => match image.run(root) {
            Err(error) => checks.push(("runs", Err(error))),
            Ok(output) => {
                print!("{output}");
                checks.push(("has the golden costs", golden.near(&format!("{name}.run"), &output)));
                checks.push(("is below the bars of cost", costs_below_bars(&output)));
                let used = golden::value(&output, "stack").unwrap_or(usize::MAX);
                let memory = used.saturating_add(sizes.memory());
                checks
                    .push(("stack and static memory are below 16 KiB", below("stack, data, bss", memory, MEMORY_BAR)));
            }
        },
    }
    checks
}

fn below(what: &str, size: usize, bar: usize) -> Result<(), String> {
    println!("{what}: {size}, must be below {bar}");
    if size < bar { Ok(()) } else { Err(format!("{what}: {size}, which must be below {bar}")) }
}

fn costs_below_bars(output: &str) -> Result<(), String> {
    let costly = output.lines().filter_map(|line| {
        let (name, count) = line.rsplit_once(' ')?;
        let &(_, bar) = COST_BARS.iter().find(|(end, _)| name.ends_with(end))?;
        below(name, count.parse().ok()?, bar).err()
    });
    let costly: Vec<String> = costly.collect();
    if costly.is_empty() { Ok(()) } else { Err(costly.join("\n")) }
}

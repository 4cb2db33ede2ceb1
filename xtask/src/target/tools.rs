//! The compiler and the emulators: found, or fetched where that is possible, or asked for by the command that gets them.

use std::fmt;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// What builds images.
pub enum Compiler {
    /// The compiler in use, with the targets' own `core`.
    Installed(String),
    /// Debian's compiler, which builds `core` from its packaged source.
    Debian(String),
}

const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_SOURCE: &str = "/usr/lib/rustlib/src/rust";
const DEBIAN_PACKAGES: [&str; 4] = ["rustc-web", "cargo-web", "rust-web-src", "lld"];

impl Compiler {
    /// A compiler for all `targets`: the one in use, after rustup has added what is missing, else Debian's.
    pub fn find(targets: &[&str]) -> Result<Compiler, String> {
        let missing: Vec<&str> = targets.iter().copied().filter(|target| !has_core(target)).collect();
        if missing.is_empty() || succeeds(Command::new("rustup").args(["target", "add"]).args(&missing)) {
            return Ok(Compiler::Installed(version("rustc")));
        }
        println!("rustup cannot add {}: Debian's compiler instead", missing.join(", "));
        if !Path::new(DEBIAN_SOURCE).exists() || !Path::new(DEBIAN_RUSTC).exists() || !present("ld.lld") {
            install(&DEBIAN_PACKAGES)?;
        }
        Ok(Compiler::Debian(version(DEBIAN_RUSTC)))
    }

    /// The beginning of a build for a target.
    pub fn cargo_build(&self, target: &str) -> Command {
        let mut command = crate::this_cargo();
        command.args(["build", "--target", target]).envs(self.environment(target));
        command
    }

    /// How far what it builds may be from the golden sizes and costs, per cent. They are those of the first sort; Debian's
    /// version of the compiler is up to 4 off.
    pub fn tolerance(&self) -> usize {
        match self {
            Compiler::Installed(_) => 2,
            Compiler::Debian(_) => 5,
        }
    }

    /// What makes cargo use it for a target.
    pub fn environment(&self, target: &str) -> Vec<(String, String)> {
        let Compiler::Debian(_) = self else { return Vec::new() };
        let linker = format!("CARGO_TARGET_{}_LINKER", target.to_uppercase().replace('-', "_"));
        let variables = [
            ("RUSTC_BOOTSTRAP", "1"),
            ("RUSTC", DEBIAN_RUSTC),
            ("CARGO_UNSTABLE_BUILD_STD", "core"),
            (linker.as_str(), "ld.lld"),
        ];
        variables.map(|(name, value)| (name.into(), value.into())).to_vec()
    }
}

impl fmt::Display for Compiler {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Compiler::Installed(version) => write!(f, "{version}, with rustup's targets"),
            Compiler::Debian(version) => write!(f, "Debian's {version}, with core built from its source"),
        }
    }
}

/// The target that this machine is.
pub fn host() -> String {
    let output = Command::new("rustc").arg("-vV").output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().find_map(|line| line.strip_prefix("host: ")).unwrap_or_default().to_owned()
}

/// Whether the compiler in use has `core` for a target.
fn has_core(target: &str) -> bool {
    let folder = Command::new("rustc").args(["--print", "target-libdir", "--target", target]).output();
    folder.is_ok_and(|output| Path::new(String::from_utf8_lossy(&output.stdout).trim()).exists())
}

/// Makes sure of the emulators.
pub fn emulators(programs: &[&str]) -> Result<(), String> {
    if programs.iter().all(|program| present(program)) {
        return Ok(());
    }
    // Without the pin, apt removes what an image of another origin has installed.
    let pinned = std::fs::read_to_string("/etc/os-release").is_ok_and(|text| text.contains("bookworm"));
    install(&["qemu-system-arm", "qemu-system-misc", if pinned { "qemu-utils/bookworm" } else { "qemu-utils" }])
}

/// Makes sure of programs, each with the Debian packages that have it.
pub fn programs(wanted: &[(&str, &[&'static str])]) -> Result<(), String> {
    let missing = wanted.iter().filter(|(program, _)| !present(program)).flat_map(|(_, packages)| packages.iter());
    let missing: Vec<&str> = missing.copied().collect();
    if missing.is_empty() { Ok(()) } else { install(&missing) }
}

/// Installs Debian packages if that can be done, else says how to get them.
pub fn install(packages: &[&str]) -> Result<(), String> {
    let arguments = ["install", "-y", "--no-install-recommends", "--allow-downgrades"];
    println!("apt-get {} {}", arguments.join(" "), packages.join(" "));
    // Though it fails where any source cannot be reached, what is needed may come from the others.
    succeeds(Command::new("apt-get").arg("update"));
    if succeeds(Command::new("apt-get").args(arguments).args(packages).env("DEBIAN_FRONTEND", "noninteractive")) {
        return Ok(());
    }
    Err(format!(
        "missing on this machine: {0}. On Debian:\n  sudo apt-get {1} {0}",
        packages.join(" "),
        arguments.join(" ")
    ))
}

fn present(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

fn version(program: &str) -> String {
    let output = Command::new(program).arg("--version").output();
    output.map_or_else(|_| program.into(), |output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

fn succeeds(command: &mut Command) -> bool {
    command.status().is_ok_and(|status| status.success())
}

/// Runs a command that ends by itself within `limit`; what it printed.
pub fn output_within(command: &mut Command, limit: Duration) -> Result<String, String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let failed = |error: std::io::Error| format!("{program}: {error}");
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().map_err(failed)?;
    let stdout = child.stdout.take();
    let reader = thread::spawn(move || {
        let mut text = String::new();
        stdout.map(|mut stdout| stdout.read_to_string(&mut text)).transpose().map(|_| text)
    });
    let start = Instant::now();
    let status = loop {
        match child.try_wait().map_err(failed)? {
            Some(status) => break Some(status),
            None if start.elapsed() > limit => {
                child.kill().map_err(failed)?;
                child.wait().map_err(failed)?;
                break None;
            }
            None => thread::sleep(Duration::from_millis(20)),
        }
    };
    let text = reader.join().map_err(|_| format!("{program}: its output cannot be read"))?.map_err(failed)?;
    match status {
        Some(status) if status.success() => Ok(text),
        Some(status) => Err(format!("{text}{program} ended with {status}")),
        None => Err(format!("{text}{program} did not end within {} s", limit.as_secs())),
    }
}

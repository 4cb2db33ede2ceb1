//! The Python package: built, installed into an environment of its own in `target/python`, and tried there.

use crate::tally::Tally;
use crate::target::tools;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the package's tests and examples need, from the Python package index.
const NEEDED: &str = "python/tests/requirements.txt";

/// An environment in which the package is installed.
pub struct Environment {
    root: PathBuf,
    folder: PathBuf,
}

/// How the package is compiled.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Build {
    /// As tests are: with every assertion.
    Checked,
    /// As users get it.
    Release,
}

impl Environment {
    /// Makes the environment if it is not there yet, builds the package and installs it.
    ///
    /// What is missing on this machine is installed if that can be done, else the error says how to get it.
    pub fn make(build: Build) -> Result<Self, String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let root = root.canonicalize().map_err(|error| format!("{}: {error}", root.display()))?;
        let environment = Environment { folder: root.join("target/python"), root };
        environment.provide()?;
        environment.install(build)?;
        Ok(environment)
    }

    /// The environment's interpreter, in the repository's root.
    pub fn python(&self) -> Command {
        let mut python = Command::new(self.folder.join("environment/bin/python"));
        python.current_dir(&self.root);
        python
    }

    /// The environment with everything that is needed from the package index.
    fn provide(&self) -> Result<(), String> {
        let can_make = Command::new("python3").args(["-c", "import ensurepip, venv"]).output();
        if !can_make.is_ok_and(|output| output.status.success()) {
            tools::install(&["python3", "python3-venv"])?;
        }
        let place = self.folder.join("environment");
        if !self.python().arg("--version").output().is_ok_and(|output| output.status.success()) {
            told(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&place))?;
        }
        let needed = fs::read_to_string(self.root.join(NEEDED)).map_err(|error| format!("{NEEDED}: {error}"))?;
        let provided = place.join("provided.txt");
        if fs::read_to_string(&provided).is_ok_and(|text| text == needed) {
            return Ok(());
        }
        let installed = told(self.pip().args(["--requirement", NEEDED]));
        installed.map_err(|error| {
            format!("{error}: what {NEEDED} names has to be installed for the Python package's tests")
        })?;
        fs::write(&provided, needed).map_err(|error| format!("{}: {error}", provided.display()))
    }

    fn pip(&self) -> Command {
        let mut pip = self.python();
        pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
        pip
    }

    fn install(&self, build: Build) -> Result<(), String> {
        let wheels = self.folder.join("wheels");
        // Of an older build.
        let _ = fs::remove_dir_all(&wheels);
        let mut maturin = self.python();
        maturin
            .args(["-m", "maturin", "build", "--quiet", "--manifest-path", "python/Cargo.toml", "--out"])
            .arg(&wheels);
        if build == Build::Release {
            maturin.arg("--release");
        }
        told(&mut maturin)?;
        let built = fs::read_dir(&wheels).map_err(|error| format!("{}: {error}", wheels.display()))?;
        let wheel = built.filter_map(Result::ok).map(|entry| entry.path());
        let wheel = wheel.into_iter().find(|path| path.extension().is_some_and(|extension| extension == "whl"));
        let wheel = wheel.ok_or("maturin left no wheel")?;
        told(self.pip().args(["--force-reinstall", "--no-deps"]).arg(wheel))
    }
}

/// Builds the package and runs its tests, the short form of the comparison with MuJoCo among them.
pub fn check(tally: &mut Tally) -> bool {
    let environment = match Environment::make(Build::Checked).and_then(|environment| {
        // With the features that the whole workspace has, as the tests have built it before.
        told(crate::this_cargo().args(["build", "--quiet", "--workspace", "--bin", "grn"]))?;
        Ok(environment)
    }) {
        Ok(environment) => environment,
        Err(error) => {
            println!("test Python: the package can be built and installed ... FAILED");
            eprintln!("{error}");
            tally.failed += 1;
            return false;
        }
    };
    println!("test Python: the package can be built and installed ... ok");
    tally.passed += 1;
    tally.follow(environment.python().args(["-m", "pytest", "-p", "no:cacheprovider", "python/tests"]))
}

/// Runs the whole comparison with MuJoCo; `arguments` go to `examples/mujoco/crosscheck.py`.
pub fn crosscheck(arguments: impl Iterator<Item = String>) -> bool {
    let compared = Environment::make(Build::Release)
        .and_then(|environment| told(environment.python().arg("examples/mujoco/crosscheck.py").args(arguments)));
    compared.inspect_err(|error| eprintln!("{error}")).is_ok()
}

/// Runs a command with its output shown.
fn told(command: &mut Command) -> Result<(), String> {
    let words: Vec<_> = std::iter::once(command.get_program()).chain(command.get_args()).collect();
    let line = words.iter().map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ");
    println!("{line}");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{line}: {status}")),
        Err(error) => Err(format!("{line}: {error}")),
    }
}

//! Campaigns over several ranks: the command built with MPI and tried under mpirun on this machine.

use crate::tally::Tally;
use crate::target::tools;
use std::fs;
use std::path::Path;

/// Debian's packages with an MPI library, its launcher, and what reads its headers.
const PACKAGES: [&str; 3] = ["libopenmpi-dev", "openmpi-bin", "libclang-dev"];

/// Makes sure of what it takes to build with MPI and to start several ranks.
pub fn provide() -> Result<(), String> {
    if has_libclang() {
        tools::programs(&[("mpicc", &PACKAGES), ("mpirun", &PACKAGES)])
    } else {
        tools::install(&PACKAGES)
    }
}

/// Whether the build finds libclang, which has no program of its own: by its variable, or where systems keep it.
fn has_libclang() -> bool {
    let is_it = |path: &Path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.starts_with("libclang.") || name.starts_with("libclang-1") || name.starts_with("libclang-2")
    };
    let entries =
        |folder: &Path| fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path());
    let usual = ["/usr/lib", "/usr/lib64", "/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu"].map(Into::into);
    let versions = entries(Path::new("/usr/lib")).filter(|path| path.to_string_lossy().contains("/llvm-"));
    let mut folders = usual.into_iter().chain(versions.map(|path| path.join("lib")));
    std::env::var_os("LIBCLANG_PATH").is_some() || folders.any(|folder| entries(&folder).any(|path| is_it(&path)))
}

/// Builds the command with MPI and runs its tests under mpirun.
pub fn check(tally: &mut Tally) -> bool {
    if let Err(error) = provide() {
        println!("test MPI: the command can be built with it ... FAILED");
        eprintln!("{error}");
        tally.failed += 1;
        return false;
    }
    // Of the workspace, not of the package alone: that would build all it depends on again, with fewer features.
    let ranks = ["test", "--workspace", "--features", "host-evolver/mpi", "--test", "ranks", "--no-fail-fast"];
    crate::cargo_test(&ranks, tally)
}

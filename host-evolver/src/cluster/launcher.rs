//! Whether this process was started as one of several: launchers tell it in variables of the environment. A program that none of
//! them has started never touches MPI.

use std::env;

/// Where launchers write how many ranks there are: Open MPI's `mpirun`; MPICH's and, with `--mpi=pmi2`, Slurm's.
const SIZES: [&str; 2] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"];
/// Where those that speak PMIx write the rank alone: Slurm with `--mpi=pmix`, Open MPI 5.
const RANK: &str = "PMIX_RANK";

/// Whether a launcher of MPI has started this process, maybe as the only one.
pub fn is_rank() -> bool {
    env::var_os(RANK).is_some() || SIZES.iter().any(|name| env::var_os(name).is_some())
}

/// How many ranks there are, where that is told.
#[cfg_attr(feature = "mpi", allow(dead_code, reason = "MPI itself tells"))]
pub fn ranks() -> Option<usize> {
    SIZES.iter().find_map(|name| env::var(name).ok()?.parse().ok())
}

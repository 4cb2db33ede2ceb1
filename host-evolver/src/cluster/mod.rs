//! Work on several processes, which may be on several machines: one leads and knows what there is to do, the others ask it for
//! jobs and send back what came of them. What jobs mean is their owner's; here they are bytes.
//!
//! How an exchange works:
//! 1. A follower that has results, or a thread that is free, sends a report to the leader.
//! 2. The leader takes the results and answers at once: with the next job if a thread is free and one is left, and with whether
//!    to go on.
//! 3. The follower sends nothing more before it has the answer, and the leader sends nothing but answers. So no two of them ever
//!    wait for each other.
//! 4. The leader performs jobs, too, as many at a time as it has threads.
//!
//! What a job leaves must not depend on who performs it, nor on when. Nobody but the leader needs to write.
//!
//! Whoever waits sleeps: MPI's own waiting takes a whole core.

mod follower;
mod launcher;
mod leader;
mod message;
#[cfg(feature = "mpi")]
mod mpi;
mod transport;

pub use follower::Follower;
pub use leader::{Jobs, Leader};
pub use transport::{Perform, Transport};

use std::fmt;

/// What this process is to the others that were started with it.
pub enum Role {
    /// It has no others.
    Alone,
    /// It has the work, and followers that help.
    Leader(Leader),
    /// It does what the leader wants.
    Follower(Follower),
}

/// Finds out whether this process is one of several, and joins them.
///
/// # Errors
/// It is, and was built without MPI, or MPI does not start.
pub fn join() -> Result<Role, ClusterError> {
    if !launcher::is_rank() {
        return Ok(Role::Alone);
    }
    #[cfg(feature = "mpi")]
    {
        let transport = mpi::start().ok_or(ClusterError::NoStart)?;
        Ok(match (transport.size(), transport.rank()) {
            (1, _) => Role::Alone,
            (_, 0) => Role::Leader(Leader::new(Box::new(transport))),
            _ => Role::Follower(Follower::new(Box::new(transport))),
        })
    }
    #[cfg(not(feature = "mpi"))]
    match launcher::ranks() {
        Some(ranks) if ranks > 1 => Err(ClusterError::NotBuilt { ranks }),
        _ => Ok(Role::Alone),
    }
}

/// Why processes cannot work together.
#[derive(Debug)]
pub enum ClusterError {
    /// Started as one of several by a program that was built without MPI.
    NotBuilt {
        /// How many there are.
        ranks: usize,
    },
    /// MPI is running in this process already, or does not start.
    NoStart,
    /// A follower that cannot take part.
    Unfit {
        /// Its rank.
        rank: usize,
        /// Its machine.
        machine: String,
        /// Why.
        reason: String,
    },
    /// A message that nobody of this version sends.
    Garbled {
        /// The rank of who sent it.
        rank: usize,
    },
}

impl fmt::Display for ClusterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ClusterError::NotBuilt { ranks } => write!(
                f,
                "started as one of {ranks} ranks, and this grn was built without MPI; build it with --features mpi \
                 (docs/cluster.md), or start single processes with --shard"
            ),
            ClusterError::NoStart => write!(f, "MPI does not start in this process"),
            ClusterError::Unfit { rank, machine, reason } => write!(f, "rank {rank} on {machine}: {reason}"),
            ClusterError::Garbled { rank } => write!(f, "rank {rank} sends what cannot be read"),
        }
    }
}

impl std::error::Error for ClusterError {}

#[cfg(test)]
mod tests;

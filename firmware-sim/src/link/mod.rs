//! Robots behind a link: emulated ones, ones on a bad wire, and how a simulated swarm asks them.
//!
//! | module | what it holds |
//! |---|---|
//! | [`faults`] | a wire that flips, drops and doubles bytes and breaks |
//! | `qemu` (Unix) | a robot's image in QEMU |
//! | [`remote`] | a robot's controller behind a link as a [`Brain`](crate::Brain) |

pub mod faults;
#[cfg(unix)]
pub mod qemu;
pub mod remote;

pub use remote::RemoteBrain;

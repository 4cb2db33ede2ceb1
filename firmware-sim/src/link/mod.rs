//! The host's side of the link to a robot (the robot's is [`grn_core::robot::link`]).
//!
//! | module | what it holds |
//! |---|---|
//! | [`wire`] | what carries bytes: sockets, a robot in the same process |
//! | [`faults`] | a wire that flips, drops and doubles bytes and breaks |
//! | [`client`] | requests with repetition, and their errors |
//! | [`flashing`] | a blob onto a robot: upload, verify, activate, confirm |
//! | `qemu` (Unix) | a robot's image in QEMU |
//! | [`remote`] | a robot's controller behind a link as a [`Brain`](crate::Brain) |

pub mod client;
pub mod faults;
pub mod flashing;
#[cfg(unix)]
pub mod qemu;
pub mod remote;
pub mod wire;

pub use client::{Client, LinkError, Patience};
pub use remote::RemoteBrain;
pub use wire::Wire;

//! The host's end of the link to a robot, real, emulated or simulated (the robot's is [`grn_core::robot::link`]).
//!
//! | module | what it holds |
//! |---|---|
//! | [`wire`] | what carries bytes: sockets, a robot in the same process |
//! | `port` (feature `serial`) | where robots answer: serial ports and sockets, by their names |
//! | [`client`] | requests with repetition, and their errors |
//! | [`flashing`] | a blob onto a robot: upload, verify, activate, confirm |

pub mod client;
pub mod flashing;
#[cfg(feature = "serial")]
pub mod port;
pub mod wire;

pub use client::{Client, LinkError, Patience};
#[cfg(feature = "serial")]
pub use port::Port;
pub use wire::Wire;

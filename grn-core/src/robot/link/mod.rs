//! The link between a host and a robot: requests and responses in frames over a serial line.
//!
//! | layer | module | what it does |
//! |---|---|---|
//! | 1 | [`frame`] | COBS and CRC: bytes ↔ frames; garbage in between is skipped |
//! | 2 | [`message`], [`refusal`] | frames ↔ requests, responses and refusals |
//! | 3 | [`server`] | the robot: carries out each request once |
//!
//! The host sends a request and waits; when no response comes it sends the same frame again. Requests about blobs are the same
//! bytes in every version of the protocol, so that a robot with old or new firmware can always be given another blob.

pub mod frame;
pub mod message;
pub mod refusal;
pub mod server;

pub use refusal::Refusal;
pub use server::Server;

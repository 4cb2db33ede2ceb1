//! The figure of a network.

pub(crate) mod data;
mod draw;
pub(crate) mod figure;
mod layout;

//! The figure of a front.

pub(crate) mod data;
pub(crate) mod figure;
mod front;
pub(crate) mod pairs;

//! The figure of a run.

pub(crate) mod data;
pub(crate) mod figure;
mod map;
mod strips;

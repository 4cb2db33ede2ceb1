//! What several figures share: axes, legends, maps, panels, and places for labels.

pub(crate) mod axes;
#[cfg(test)]
pub(crate) mod check;
pub(crate) mod legend;
pub(crate) mod map;
pub(crate) mod panels;
pub(crate) mod place;

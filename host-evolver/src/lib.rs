//! Skeleton.

pub mod search;

//! Skeleton.
pub mod report;

//! What the cross-crate tests share: the blobs that ship, and the decoder's exercise.

pub mod decoder;
pub mod golden;
pub mod reproduction;
pub mod robots;

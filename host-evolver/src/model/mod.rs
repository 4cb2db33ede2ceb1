//! Models: trees and how they vary, the published networks, how a model is described, and the blob it becomes.

pub mod deploy;
pub mod describe;
pub mod notation;
pub mod published;
pub mod tree;
pub mod variation;

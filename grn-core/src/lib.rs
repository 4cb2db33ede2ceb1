//! Gene-regulatory-network (GRN) controllers, from the flashed blob to wheel steps.
//!
//! This crate is everything that runs on the robot: `no_std`, no allocation, no `unsafe`, no panic. The host runs the
//! same code, so what was evolved and simulated is what robots run. From the bottom up:
//!
//! | module | what it holds |
//! |---|---|
//! | [`scalar`] | the number types `f32`, Q8.24 and (on hosts) `f64`, behind one trait; dual numbers for gradients |
//! | [`motif`] | the ten network motifs and their regulation functions |
//! | [`network`] | a validated feed-forward network of genes |
//! | [`dynamics`] | RK4 integration; the exact steady state and its gradient |
//! | [`field`](mod@field) | targets and obstacles → morphogens (x1, x2) and their gradients |
//! | [`pattern`] | level, inside test, nearest candidate point |
//! | [`blob`] | the flashed file: checked, canonical, self-describing |
//! | [`robot`] | percept → controller → wheel command; radio messages; the link to a host; slots for blobs |
//!
//! Results are the same bits on every machine: only IEEE-754 basic operations, integer arithmetic and the `libm` crate are
//! used, never a platform's transcendental functions or fused operations.
#![no_std]
#![deny(clippy::expect_used, clippy::panic, clippy::indexing_slicing)]
#![cfg_attr(test, allow(clippy::expect_used, clippy::panic, clippy::indexing_slicing))]

#[cfg(test)]
extern crate std;

pub mod blob;
pub mod bounded;
mod coded;
pub mod dynamics;
pub mod field;
pub mod geometry;
pub mod motif;
pub mod network;
pub mod pattern;
pub mod robot;
pub mod scalar;

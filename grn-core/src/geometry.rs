//! Plane vectors in any scalar.

use crate::scalar::Scalar;
use core::ops::{Add, Mul, Neg, Sub};

/// A vector or a point in the world's plane: x east, y north; metres unless stated otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<S> {
    /// East.
    pub x: S,
    /// North.
    pub y: S,
}

/// A position; the same type as [`Vector`], named for the reader.
pub type Point<S> = Vector<S>;

impl<S: Scalar> Vector<S> {
    /// The zero vector.
    pub const ZERO: Self = Vector { x: S::ZERO, y: S::ZERO };

    /// (x, y).
    pub const fn new(x: S, y: S) -> Self {
        Vector { x, y }
    }

    /// Euclidean length.
    pub fn length(self) -> S {
        self.x.hypot(self.y)
    }

    /// self · other.
    pub fn dot(self, other: Self) -> S {
        self.x * other.x + self.y * other.y
    }

    /// The z component of self × other: positive when `other` points to the left of `self`.
    pub fn cross(self, other: Self) -> S {
        self.x * other.y - self.y * other.x
    }

    /// The vector turned a quarter turn to the left.
    #[must_use]
    pub fn turned_left(self) -> Self {
        Vector { x: -self.y, y: self.x }
    }

    /// Length squared, for comparisons.
    pub fn square(self) -> S::Square {
        self.x.square_sum(self.y)
    }

    /// Length, and the same direction with length 1; `None` for a zero vector.
    pub fn polar(self) -> Option<(S, Self)> {
        let length = self.length();
        (length > S::ZERO).then(|| (length, Vector { x: self.x / length, y: self.y / length }))
    }

    /// The same direction with length 1, or `None` for a zero vector.
    pub fn direction(self) -> Option<Self> {
        self.polar().map(|(_, direction)| direction)
    }

    /// The vector, shortened to `limit` if it is longer.
    #[must_use]
    pub fn limited(self, limit: S) -> Self {
        if self.square() > limit.square_sum(S::ZERO) { self * (limit / self.length()) } else { self }
    }
}

impl<S: Scalar> Add for Vector<S> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Vector { x: self.x + other.x, y: self.y + other.y }
    }
}

impl<S: Scalar> Sub for Vector<S> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Vector { x: self.x - other.x, y: self.y - other.y }
    }
}

impl<S: Scalar> Neg for Vector<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Vector { x: -self.x, y: -self.y }
    }
}

impl<S: Scalar> Mul<S> for Vector<S> {
    type Output = Self;
    fn mul(self, factor: S) -> Self {
        Vector { x: self.x * factor, y: self.y * factor }
    }
}

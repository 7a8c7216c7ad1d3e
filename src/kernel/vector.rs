//! The affine spaces that curves live in: the uv plane (`DVec2`) and model space (`DVec3`).

use std::fmt::Debug;
use std::ops::{Add, Mul, Sub};

use glam::{DVec2, DVec3};

/// A point or vector of the uv plane or of model space.
pub trait Vector:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<f64, Output = Self>
{
    /// The origin.
    const ZERO: Self;
    /// Number of coordinates.
    const DIMENSION: usize;
    /// The `axis`-th coordinate.
    fn coordinate(self, axis: usize) -> f64;
    /// The unit vector along the `axis`-th coordinate.
    fn unit(axis: usize) -> Self;
    /// Scalar product.
    fn dot(self, other: Self) -> f64;
    /// Smaller coordinates of the two, one by one.
    fn min(self, other: Self) -> Self;
    /// Larger coordinates of the two, one by one.
    fn max(self, other: Self) -> Self;
    /// Whether every coordinate is finite.
    fn is_finite(self) -> bool;
    /// Euclidean length.
    fn length(self) -> f64 {
        self.dot(self).sqrt()
    }
}

macro_rules! vector {
    ($type:ty, $dimension:literal) => {
        impl Vector for $type {
            const ZERO: Self = <$type>::ZERO;
            const DIMENSION: usize = $dimension;
            fn coordinate(self, axis: usize) -> f64 {
                self[axis]
            }
            fn unit(axis: usize) -> Self {
                <$type>::AXES[axis]
            }
            fn dot(self, other: Self) -> f64 {
                <$type>::dot(self, other)
            }
            fn min(self, other: Self) -> Self {
                <$type>::min(self, other)
            }
            fn max(self, other: Self) -> Self {
                <$type>::max(self, other)
            }
            fn is_finite(self) -> bool {
                <$type>::is_finite(self)
            }
        }
    };
}
vector!(DVec2, 2);
vector!(DVec3, 3);

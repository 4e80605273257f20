//! Left and right.

use core::ops::Add;

use serde::{Deserialize, Serialize};

/// Two of a kind, one on each side of the plane of symmetry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pair<T> {
    /// On the pilot's left.
    pub left: T,
    /// On the pilot's right.
    pub right: T,
}

impl<T> Pair<T> {
    /// The same on both sides.
    pub fn both(value: T) -> Self
    where
        T: Clone,
    {
        Self { left: value.clone(), right: value }
    }

    /// `f` of each side.
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Pair<U> {
        Pair { left: f(self.left), right: f(self.right) }
    }

    /// Each side together with the same side of another pair.
    pub fn zip<U>(self, other: Pair<U>) -> Pair<(T, U)> {
        Pair { left: (self.left, other.left), right: (self.right, other.right) }
    }

    /// Sides exchanged.
    pub fn swapped(self) -> Self {
        Self { left: self.right, right: self.left }
    }

    /// Left and right by reference.
    pub fn as_ref(&self) -> Pair<&T> {
        Pair { left: &self.left, right: &self.right }
    }

    /// Left plus right. Sums over the aircraft add the sides first, so that a mirrored aircraft
    /// rounds the same way.
    pub fn sum(self) -> T
    where
        T: Add<Output = T>,
    {
        self.left + self.right
    }
}

impl Pair<f64> {
    /// Half of left plus right.
    pub fn mean(self) -> f64 {
        0.5 * self.sum()
    }
}

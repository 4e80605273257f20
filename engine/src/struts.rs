//! Nose and main struts.

use serde::{Deserialize, Serialize};

use crate::pair::Pair;

/// One of each strut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Struts<T> {
    /// Nose.
    pub nose: T,
    /// Mains.
    pub main: Pair<T>,
}

impl<T: Clone> Struts<T> {
    /// The same for every strut.
    pub fn all(value: T) -> Self {
        Self { nose: value.clone(), main: Pair::both(value) }
    }
}

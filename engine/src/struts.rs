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

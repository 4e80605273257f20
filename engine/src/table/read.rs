//! Reading a table's parts: its axes by their keys, in the order of its type, and its values behind them.
//!
//! What is written is `{ alpha_rad = [...], mach = [...], value = [[...], ...] }`. The keys that the file has
//! are held against those of the type, so a table over another axis, or over the same in another order, is
//! refused.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;
use core::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};

/// The name that every table has for a deserializer, as an array of components is called `Vec3`.
pub const NAME: &str = "Table";

/// The key of a table's values, behind those of its axes.
pub const VALUE: &str = "value";

/// The points of N axes, and the values over them; `keys` are those of the axes and [`VALUE`].
pub(super) fn parts<'de, D: Deserializer<'de>, V: Deserialize<'de>, const N: usize>(
    deserializer: D,
    keys: &'static [&'static str],
) -> Result<([Vec<f64>; N], V), D::Error> {
    deserializer.deserialize_struct(NAME, keys, Parts { keys, values: PhantomData })
}

struct Parts<V, const N: usize> {
    keys: &'static [&'static str],
    values: PhantomData<V>,
}

impl<V, const N: usize> Parts<V, N> {
    /// The next entry's value, if its key is the `i`th.
    fn next<'de, M: MapAccess<'de>, T: Deserialize<'de>>(
        &self,
        map: &mut M,
        i: usize,
    ) -> Result<T, M::Error> {
        let key = self.keys[i];
        match map.next_key::<String>()? {
            Some(found) if found == key => map.next_value(),
            Some(found) => Err(M::Error::unknown_field(&found, self.keys)),
            None => Err(M::Error::missing_field(key)),
        }
    }
}

impl<'de, V: Deserialize<'de>, const N: usize> Visitor<'de> for Parts<V, N> {
    type Value = ([Vec<f64>; N], V);

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a table over {}", self.keys[..N].join(", "))
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Self::Value, M::Error> {
        let mut axes = [const { Vec::new() }; N];
        for (i, axis) in axes.iter_mut().enumerate() {
            *axis = self.next(&mut map, i)?;
        }
        let values = self.next(&mut map, N)?;
        match map.next_key::<String>()? {
            Some(beyond) => Err(M::Error::unknown_field(&beyond, self.keys)),
            None => Ok((axes, values)),
        }
    }
}

//! Reading a table: its axes by their keys, in the order of its type, and its values behind them.
//!
//! What is written is `{ alpha_rad = [...], mach = [...], value = [[...], ...] }`. The keys that the file has
//! are held against those of the type, so a table over another axis, or over the same in another order, is
//! refused.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;
use core::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};

use super::{Axis, Table1, Table2, Table3};

/// The name that every table has for a deserializer, as an array of components is called `Vec3`.
pub const NAME: &str = "Table";

/// The key of a table's values, behind those of its axes.
pub const VALUE: &str = "value";

impl<'de, X: Axis> Deserialize<'de> for Table1<X> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ([x], y) = parts(deserializer, const { &[X::KEY, VALUE] })?;
        Ok(Self::new(x, y))
    }
}

impl<'de, X: Axis, Y: Axis> Deserialize<'de> for Table2<X, Y> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ([x, y], z) = parts(deserializer, const { &[X::KEY, Y::KEY, VALUE] })?;
        Ok(Self::new(x, y, z))
    }
}

impl<'de, X: Axis, Y: Axis, Z: Axis> Deserialize<'de> for Table3<X, Y, Z> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ([x, y, z], w) = parts(deserializer, const { &[X::KEY, Y::KEY, Z::KEY, VALUE] })?;
        Ok(Self::new(x, y, z, w))
    }
}

/// The points of N axes, and the values over them; `keys` are those of the axes and [`VALUE`].
fn parts<'de, D: Deserializer<'de>, V: Deserialize<'de>, const N: usize>(
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

#[cfg(test)]
mod tests {
    use alloc::format;
    use alloc::vec;

    use serde::de::value::{Error as ValueError, MapDeserializer};

    use super::*;
    use crate::table::axis::{Alpha, Beta};

    fn read<X: Axis>(parts: &[(&'static str, Vec<f64>)]) -> Result<Table1<X>, ValueError> {
        Table1::deserialize(MapDeserializer::new(parts.iter().cloned()))
    }

    #[test]
    fn a_table_is_read_over_the_axis_of_its_type_alone() {
        let printed = [("alpha_rad", vec![0.0, 1.0]), ("value", vec![2.0, 4.0])];
        assert_eq!(read::<Alpha>(&printed), Ok(Table1::new(vec![0.0, 1.0], vec![2.0, 4.0])));
        let told = read::<Beta>(&printed).map_err(|error| format!("{error}"));
        assert_eq!(told, Err("unknown field `alpha_rad`, expected `beta_rad` or `value`".into()));
    }

    #[test]
    fn a_table_has_its_axes_first_and_nothing_behind_its_values() {
        let (x, y) = (("alpha_rad", vec![0.0, 1.0]), ("value", vec![2.0, 4.0]));
        assert!(read::<Alpha>(&[y.clone(), x.clone()]).is_err());
        assert!(read::<Alpha>(&[x.clone()]).is_err());
        assert!(read::<Alpha>(&[x, y.clone(), y]).is_err());
    }
}

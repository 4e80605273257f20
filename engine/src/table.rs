//! Tables as printed: linear between the points, held beyond them.
//!
//! A table's type names what it is over, `Table2<Alpha, ElevatorAngle>`: it is read from a file that names the
//! same axes in the same order, and looked up with values of these quantities.

use alloc::vec::Vec;
use core::marker::PhantomData;

use serde::{Deserialize, Deserializer};

pub mod axis;
mod read;

pub use axis::Axis;
use read::parts;
pub use read::{NAME, VALUE};

/// y over one argument.
#[derive(Clone, Debug, PartialEq)]
pub struct Table1<X: Axis> {
    /// Arguments, ascending.
    pub x: Vec<f64>,
    /// Values, one per argument.
    pub y: Vec<f64>,
    axis: PhantomData<X>,
}

/// z over two arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct Table2<X: Axis, Y: Axis> {
    /// First arguments, ascending: one per row.
    pub x: Vec<f64>,
    /// Second arguments, ascending: one per column.
    pub y: Vec<f64>,
    /// Values by row and column.
    pub z: Vec<Vec<f64>>,
    axes: PhantomData<(X, Y)>,
}

/// w over three arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct Table3<X: Axis, Y: Axis, Z: Axis> {
    /// First arguments, ascending: one per block.
    pub x: Vec<f64>,
    /// Second arguments, ascending: one per row.
    pub y: Vec<f64>,
    /// Third arguments, ascending: one per column.
    pub z: Vec<f64>,
    /// Values by block, row and column.
    pub w: Vec<Vec<Vec<f64>>>,
    axes: PhantomData<(X, Y, Z)>,
}

/// The interval of `x` that holds `at`, and how far into it `at` lies, 0..1.
///
/// Counting the inner points that lie below takes every table of a dozen points less time than halving
/// it does: there is nothing for the CPU to guess. Every kind of table has its own copy of the lookup, and
/// each is shorter with this in it.
#[inline]
fn locate(x: &[f64], at: f64) -> (usize, f64) {
    let inner = &x[1..x.len() - 1];
    let i = inner.iter().map(|&point| usize::from(point <= at)).sum();
    (i, crate::math::ramp(at, x[i], x[i + 1]))
}

/// What in an aircraft file cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Invalid {
    /// Its key in the file.
    pub key: &'static str,
    /// What is expected there.
    pub expected: &'static str,
}

/// Whether all of these can be used, by their keys.
///
/// # Errors
/// The first that cannot.
pub fn all_valid(
    parts: impl IntoIterator<Item = (&'static str, Result<(), &'static str>)>,
) -> Result<(), Invalid> {
    parts
        .into_iter()
        .try_for_each(|(key, found)| found.map_err(|expected| Invalid { key, expected }))
}

impl<X: Axis> Table1<X> {
    /// The table of these arguments and values, in SI.
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { x, y, axis: PhantomData }
    }

    /// The value at `x`.
    pub fn at(&self, x: X) -> f64 {
        let (i, t) = locate(&self.x, x.si());
        self.y[i] + t * (self.y[i + 1] - self.y[i])
    }

    /// The value at `x`; beyond the print it goes over to `outer` within `fade`.
    pub fn at_or(&self, x: X, outer: f64, fade: f64) -> f64 {
        let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
        let beyond = crate::math::max(first - x.si(), x.si() - last);
        let held = self.at(x);
        if beyond <= 0.0 {
            held
        } else {
            held + crate::math::min(beyond / fade, 1.0) * (outer - held)
        }
    }

    /// # Errors
    /// What is expected of a table that can be used, if it is not one.
    pub fn validate(&self) -> Result<(), &'static str> {
        if self.x.len() != self.y.len() {
            Err("as many values as arguments")
        } else {
            ascending(&self.x)
        }
    }
}

impl<X: Axis, Y: Axis> Table2<X, Y> {
    /// The table of these arguments and values, in SI.
    pub fn new(x: Vec<f64>, y: Vec<f64>, z: Vec<Vec<f64>>) -> Self {
        Self { x, y, z, axes: PhantomData }
    }

    /// The value at `(x, y)`.
    pub fn at(&self, x: X, y: Y) -> f64 {
        let (i, s) = locate(&self.x, x.si());
        let (j, t) = locate(&self.y, y.si());
        let along = |row: &[f64]| row[j] + t * (row[j + 1] - row[j]);
        let low = along(&self.z[i]);
        low + s * (along(&self.z[i + 1]) - low)
    }

    /// # Errors
    /// What is expected of a table that can be used, if it is not one.
    pub fn validate(&self) -> Result<(), &'static str> {
        if self.x.len() != self.z.len() || self.z.iter().any(|row| row.len() != self.y.len()) {
            Err("one row per first argument, one column per second")
        } else {
            ascending(&self.x).and_then(|()| ascending(&self.y))
        }
    }
}

impl<X: Axis, Y: Axis, Z: Axis> Table3<X, Y, Z> {
    /// The table of these arguments and values, in SI.
    pub fn new(x: Vec<f64>, y: Vec<f64>, z: Vec<f64>, w: Vec<Vec<Vec<f64>>>) -> Self {
        Self { x, y, z, w, axes: PhantomData }
    }

    /// The value at `(x, y, z)`.
    pub fn at(&self, x: X, y: Y, z: Z) -> f64 {
        let (i, r) = locate(&self.x, x.si());
        let (j, s) = locate(&self.y, y.si());
        let (k, t) = locate(&self.z, z.si());
        let along = |row: &[f64]| row[k] + t * (row[k + 1] - row[k]);
        let block = |rows: &[Vec<f64>]| {
            let low = along(&rows[j]);
            low + s * (along(&rows[j + 1]) - low)
        };
        let low = block(&self.w[i]);
        if r > 0.0 { low + r * (block(&self.w[i + 1]) - low) } else { low }
    }

    /// # Errors
    /// What is expected of a table that can be used, if it is not one.
    pub fn validate(&self) -> Result<(), &'static str> {
        let block_fits = |rows: &Vec<Vec<f64>>| {
            rows.len() == self.y.len() && rows.iter().all(|row| row.len() == self.z.len())
        };
        if self.x.len() != self.w.len() || !self.w.iter().all(block_fits) {
            Err("one block per first argument, one row per second, one column per third")
        } else {
            ascending(&self.x).and_then(|()| ascending(&self.y)).and_then(|()| ascending(&self.z))
        }
    }
}

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

fn ascending(axis: &[f64]) -> Result<(), &'static str> {
    if axis.len() < 2 {
        Err("two points at least")
    } else if axis.windows(2).any(|w| w[0] >= w[1]) {
        Err("ascending arguments")
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use alloc::format;
    use alloc::vec;

    use serde::de::value::{Error as ValueError, MapDeserializer};

    use super::axis::{Alpha, Beta, Mach};
    use super::*;

    #[test]
    fn a_table_holds_its_ends_and_is_linear_between() {
        let table = Table1::new(vec![0.0, 1.0, 3.0], vec![2.0, 4.0, 0.0]);
        for (x, y) in [(-9.0, 2.0), (0.0, 2.0), (0.5, 3.0), (1.0, 4.0), (2.0, 2.0), (9.0, 0.0)] {
            assert!((table.at(Alpha(x)) - y).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn two_arguments_are_linear_in_each() {
        let table =
            Table2::new(vec![0.0, 1.0], vec![0.0, 10.0], vec![vec![0.0, 1.0], vec![2.0, 5.0]]);
        assert!((table.at(Alpha(0.5), Mach(5.0)) - 2.0).abs() < 1e-15);
        assert!((table.at(Alpha(7.0), Mach(-3.0)) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn three_arguments_are_linear_in_each() {
        let ends = || vec![0.0, 1.0];
        let flat = |value: f64| vec![vec![value, value + 1.0], vec![value + 2.0, value + 3.0]];
        let table = Table3::new(ends(), ends(), ends(), vec![flat(0.0), flat(4.0)]);
        assert!((table.at(Alpha(0.5), Beta(0.5), Mach(0.5)) - 3.5).abs() < 1e-15);
        assert!((table.at(Alpha(9.0), Beta(-1.0), Mach(9.0)) - 5.0).abs() < 1e-15);
        assert_eq!(table.validate(), Ok(()));
    }

    #[test]
    fn beyond_its_print_a_table_goes_over_to_another() {
        let table = Table1::new(vec![0.0, 1.0], vec![2.0, 4.0]);
        for (x, y) in [(0.5, 3.0), (1.0, 4.0), (1.5, 5.0), (2.0, 6.0), (9.0, 6.0), (-0.5, 4.0)] {
            assert!((table.at_or(Alpha(x), 6.0, 1.0) - y).abs() < 1e-15, "{x}");
        }
    }

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
        assert!(read::<Alpha>(core::slice::from_ref(&x)).is_err());
        assert!(read::<Alpha>(&[x, y.clone(), y]).is_err());
    }
}

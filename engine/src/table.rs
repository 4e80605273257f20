//! Tables as printed: linear between the points, held beyond them.

use alloc::vec::Vec;

use serde::Deserialize;

/// y over one argument.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table1 {
    /// Arguments, ascending.
    pub x: Vec<f64>,
    /// Values, one per argument.
    pub y: Vec<f64>,
}

/// y over two arguments.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table2 {
    /// First arguments, ascending: one per row.
    pub x: Vec<f64>,
    /// Second arguments, ascending: one per column.
    pub y: Vec<f64>,
    /// Values by row and column.
    pub z: Vec<Vec<f64>>,
}

/// The interval of `x` that holds `at`, and how far into it `at` lies, 0..1.
fn locate(x: &[f64], at: f64) -> (usize, f64) {
    let last = x.len().saturating_sub(2);
    let i = x.partition_point(|&point| point <= at).saturating_sub(1);
    let i = if i < last { i } else { last };
    (i, crate::math::ramp(at, x[i], x[i + 1]))
}

impl Table1 {
    /// The value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        let (i, t) = locate(&self.x, x);
        self.y[i] + t * (self.y[i + 1] - self.y[i])
    }

    /// Why the table cannot be used, if so.
    pub fn fault(&self) -> Option<&'static str> {
        if self.x.len() != self.y.len() {
            Some("as many values as arguments")
        } else {
            axis_fault(&self.x)
        }
    }
}

impl Table2 {
    /// The value at `(x, y)`.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let (i, s) = locate(&self.x, x);
        let (j, t) = locate(&self.y, y);
        let along = |row: &[f64]| row[j] + t * (row[j + 1] - row[j]);
        let low = along(&self.z[i]);
        low + s * (along(&self.z[i + 1]) - low)
    }

    /// Why the table cannot be used, if so.
    pub fn fault(&self) -> Option<&'static str> {
        if self.x.len() != self.z.len() || self.z.iter().any(|row| row.len() != self.y.len()) {
            Some("one row per first argument, one column per second")
        } else {
            axis_fault(&self.x).or_else(|| axis_fault(&self.y))
        }
    }
}

fn axis_fault(axis: &[f64]) -> Option<&'static str> {
    if axis.len() < 2 {
        Some("two points at least")
    } else if axis.windows(2).any(|w| w[0] >= w[1]) {
        Some("ascending arguments")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    #[test]
    fn a_table_holds_its_ends_and_is_linear_between() {
        let table = Table1 { x: vec![0.0, 1.0, 3.0], y: vec![2.0, 4.0, 0.0] };
        for (x, y) in [(-9.0, 2.0), (0.0, 2.0), (0.5, 3.0), (1.0, 4.0), (2.0, 2.0), (9.0, 0.0)] {
            assert!((table.at(x) - y).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn two_arguments_are_linear_in_each() {
        let table = Table2 {
            x: vec![0.0, 1.0],
            y: vec![0.0, 10.0],
            z: vec![vec![0.0, 1.0], vec![2.0, 5.0]],
        };
        assert!((table.at(0.5, 5.0) - 2.0).abs() < 1e-15);
        assert!((table.at(7.0, -3.0) - 2.0).abs() < 1e-15);
    }
}

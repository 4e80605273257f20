//! Linear systems, also those that do not determine every unknown.

use alloc::vec;
use alloc::vec::Vec;

use engine::math::max;

use crate::matrix::Matrix;

/// A pivot that is smaller than this part of the largest coefficient counts as zero.
const PIVOT_NORM_MIN: f64 = 1e-14;

/// x of A·x = b for a square A (n × n, and n values), by Gaussian elimination with row pivoting.
///
/// Where A is singular, the unknown that it says nothing of is 0: the power of engines that have failed
/// is such an unknown of a trim. nalgebra's decompositions give no answer there, or a different one.
pub(crate) fn solve(a: &Matrix, b: &[f64]) -> Vec<f64> {
    let n = a.nrows();
    let nothing = PIVOT_NORM_MIN * a.iter().fold(0.0, |most, value| max(most, value.abs()));
    let (mut a, mut b) = (a.clone(), b.to_vec());
    // The column of each row's pivot; a column without one leaves its rows to the next.
    let mut pivots = Vec::with_capacity(n);
    for k in 0..n {
        let top = pivots.len();
        let mut pivot = top;
        for row in top..n {
            if a[(row, k)].abs() > a[(pivot, k)].abs() {
                pivot = row;
            }
        }
        if top == n || a[(pivot, k)].abs() <= nothing {
            continue;
        }
        a.swap_rows(top, pivot);
        b.swap(top, pivot);
        for row in top + 1..n {
            let factor = a[(row, k)] / a[(top, k)];
            if factor != 0.0 {
                for column in k..n {
                    a[(row, column)] -= factor * a[(top, column)];
                }
                b[row] -= factor * b[top];
            }
        }
        pivots.push(k);
    }
    let mut x = vec![0.0; n];
    for (row, &k) in pivots.iter().enumerate().rev() {
        let known: f64 = (k + 1..n).map(|column| a[(row, column)] * x[column]).sum();
        x[k] = (b[row] - known) / a[(row, k)];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_solved() {
        let a = Matrix::from_row_slice(3, 3, &[0.0, 2.0, 1.0, 1.0, -1.0, 0.5, 3.0, 0.0, -2.0]);
        let x = solve(&a, &[7.0, 0.5, -3.0]);
        for (found, expected) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-14, "{x:?}");
        }
    }

    #[test]
    fn what_a_singular_system_does_not_say_is_zero() {
        let a = Matrix::from_row_slice(3, 3, &[1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0]);
        let x = solve(&a, &[5.0, 0.0, -1.0]);
        assert!((x[0] - 1.0).abs() < 1e-15 && x[1] == 0.0 && (x[2] - 2.0).abs() < 1e-15);
    }
}

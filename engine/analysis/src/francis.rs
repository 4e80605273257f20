//! Eigenvalues of a real Hessenberg matrix by Francis' implicit double-shift QR iteration.
//!
//! # Equations
//! ```text
//! v ∝ (H − σ₁)·(H − σ₂)·e₁       H' = QᵀHQ, Q a product of reflections of three rows, the first along v
//! |h(k,k−1)| ≤ ε·(|h(k−1,k−1)| + |h(k,k)|)                     deflation, with Ahues and Tisseur's test
//! ```
//! # Assumptions
//! No Schur vectors: only the block that is being worked on is updated.
//!
//! Not nalgebra's `Schur`: it forms v from the shifts' sum and product, in which the differences h − σ
//! cancel, and has no exceptional shifts. On matrices with repeated eigenvalues, ten actuators with one
//! lag, it stands still: within 100 sweeps a row it converged in 5 of 34 systems of the XV-15 with its
//! SCAS on. Here differences are taken first, as LAPACK does.
//! # Source
//! LAPACK 3.12, `dlahqr`, `dlanv2`; EISPACK `hqr`. Golub and Van Loan, Matrix Computations, 7.5.

use alloc::vec;
use alloc::vec::Vec;

use engine::math::{max, min, sqrt, square};

use crate::matrix::{Complex, Matrix};

/// Sweeps without a deflation that are allowed; two or three are usual.
pub(crate) const SWEEPS_MAX: usize = 300;

/// After so many sweeps without a deflation the shifts are exceptional ones.
const EXCEPTIONAL: usize = 10;

/// All eigenvalues of an upper Hessenberg matrix, n × n, in the order of the diagonal in which they end.
/// Nothing when the iteration does not converge.
pub(crate) fn eigenvalues(mut h: Matrix) -> Option<Vec<Complex>> {
    let mut found = vec![Complex::new(0.0, 0.0); h.nrows()];
    let mut rows = h.nrows();
    let mut sweeps = 0;
    while rows > 0 {
        let last = rows - 1;
        let first = block_start(&mut h, last);
        match last - first {
            0 => found[last] = Complex::new(h[(last, last)], 0.0),
            1 => found[first..=last].copy_from_slice(&of_two(&block_of_two(&h, first))),
            _ if sweeps == SWEEPS_MAX => return None,
            _ => {
                sweeps += 1;
                let shifts = shifts(&h, first, last, sweeps);
                sweep(&mut h, first, last, shifts);
                continue;
            }
        }
        sweeps = 0;
        rows = first;
    }
    Some(found)
}

/// The block of two rows that begins at a row: a, b, c, d.
fn block_of_two(h: &Matrix, i: usize) -> [f64; 4] {
    [h[(i, i)], h[(i, i + 1)], h[(i + 1, i)], h[(i + 1, i + 1)]]
}

/// Both eigenvalues of a block of two.
fn of_two([a, b, c, d]: &[f64; 4]) -> [Complex; 2] {
    let half = 0.5 * (a - d);
    let discriminant = square(half) + b * c;
    let root = sqrt(discriminant.abs());
    if discriminant < 0.0 {
        let mean = d + half;
        return [Complex::new(mean, root), Complex::new(mean, -root)];
    }
    // The one further from d by the sum, the other by the product, which loses no digits.
    let far = if half < 0.0 { half - root } else { half + root };
    let near = if far == 0.0 { 0.0 } else { -b * c / far };
    [Complex::new(d + far, 0.0), Complex::new(d + near, 0.0)]
}

/// The first row of the last block that does not fall apart, of the rows up to `last`.
fn block_start(h: &mut Matrix, last: usize) -> usize {
    for k in (1..=last).rev() {
        if is_negligible(h, k) {
            h[(k, k - 1)] = 0.0;
            return k;
        }
    }
    0
}

/// Whether what is left of the diagonal in a row is rounding.
fn is_negligible(h: &Matrix, k: usize) -> bool {
    let [a, b, c, d] = block_of_two(h, k - 1);
    if c.abs() <= f64::MIN_POSITIVE {
        return true;
    }
    let mut size = a.abs() + d.abs();
    if size == 0.0 {
        size = h.column(k - 1).amax();
    }
    if c.abs() > f64::EPSILON * size {
        return false;
    }
    // Ahues and Tisseur: what is neglected moves the eigenvalues by rounding only.
    let (most, least) = (max(c.abs(), b.abs()), min(c.abs(), b.abs()));
    let (wide, narrow) = (max(d.abs(), (a - d).abs()), min(d.abs(), (a - d).abs()));
    let sum = wide + most;
    least * (most / sum) <= max(f64::MIN_POSITIVE, f64::EPSILON * (narrow * (wide / sum)))
}

/// The two shifts of a sweep: eigenvalues of the last two rows, of real ones twice the nearer. They are
/// real, or a pair: σ = re ± j·im.
fn shifts(h: &Matrix, first: usize, last: usize, sweeps: usize) -> Complex {
    let exceptional = |at: usize, size: f64| {
        let diagonal = 0.75 * size + h[(at, at)];
        [diagonal, -0.4375 * size, size, diagonal]
    };
    let block = if sweeps.is_multiple_of(2 * EXCEPTIONAL) {
        exceptional(last, h[(last, last - 1)].abs() + h[(last - 1, last - 2)].abs())
    } else if sweeps.is_multiple_of(EXCEPTIONAL) {
        exceptional(first, h[(first + 1, first)].abs() + h[(first + 2, first + 1)].abs())
    } else {
        block_of_two(h, last - 1)
    };
    let [one, other] = of_two(&block);
    let d = block[3];
    if one.im != 0.0 || (one.re - d).abs() <= (other.re - d).abs() { one } else { other }
}

/// One double-shift sweep over the block of rows `first..=last`, which are three at least.
fn sweep(h: &mut Matrix, first: usize, last: usize, shift: Complex) {
    let (start, mut v) = bulge(h, first, last, shift);
    for k in start..last {
        let size = min_usize(3, last - k + 1);
        if k > start {
            v = [h[(k, k - 1)], h[(k + 1, k - 1)], 0.0];
            if size == 3 {
                v[2] = h[(k + 2, k - 1)];
            }
        }
        let (alpha, tau) = reflection(&mut v);
        if k > start {
            h[(k, k - 1)] = alpha;
            for row in k + 1..k + size {
                h[(row, k - 1)] = 0.0;
            }
        } else if start > first {
            h[(k, k - 1)] *= 1.0 - tau;
        }
        for column in k..=last {
            let sum: f64 = (0..size).map(|i| v[i] * h[(k + i, column)]).sum();
            for i in 0..size {
                h[(k + i, column)] -= sum * tau * v[i];
            }
        }
        for row in first..=min_usize(k + 3, last) {
            let sum: f64 = (0..size).map(|i| v[i] * h[(row, k + i)]).sum();
            for i in 0..size {
                h[(row, k + i)] -= sum * tau * v[i];
            }
        }
    }
}

fn min_usize(a: usize, b: usize) -> usize {
    if a < b { a } else { b }
}

/// Where a sweep may begin, below two small elements in a row, and its first vector v.
fn bulge(h: &Matrix, first: usize, last: usize, shift: Complex) -> (usize, [f64; 3]) {
    let mut m = last - 2;
    loop {
        let (a, d) = (h[(m, m)] - shift.re, h[(m + 1, m + 1)] - shift.re);
        let below = h[(m + 1, m)];
        let size = a.abs() + shift.im.abs() + below.abs();
        let c = below / size;
        let v = [
            c * h[(m, m + 1)] + a * (a / size) + shift.im * (shift.im / size),
            c * (a + d),
            c * h[(m + 2, m + 1)],
        ];
        let length = v[0].abs() + v[1].abs() + v[2].abs();
        let v = v.map(|v| v / length);
        if m == first {
            return (m, v);
        }
        let around = h[(m - 1, m - 1)].abs() + h[(m, m)].abs() + h[(m + 1, m + 1)].abs();
        if h[(m, m - 1)].abs() * (v[1].abs() + v[2].abs()) <= f64::EPSILON * v[0].abs() * around {
            return (m, v);
        }
        m -= 1;
    }
}

/// The reflection I − τ·v·vᵀ that turns a vector onto the first axis: v, whose first number is 1, in its
/// place, and the vector's length with its sign, and τ.
fn reflection(v: &mut [f64; 3]) -> (f64, f64) {
    let [alpha, y, z] = *v;
    let rest = square(y) + square(z);
    if rest == 0.0 {
        *v = [1.0, 0.0, 0.0];
        return (alpha, 0.0);
    }
    let length = sqrt(square(alpha) + rest);
    let beta = if alpha < 0.0 { length } else { -length };
    *v = [1.0, y / (alpha - beta), z / (alpha - beta)];
    (beta, (beta - alpha) / beta)
}

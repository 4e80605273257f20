//! Dense matrices of any size, for trim and linearisation: linear systems and eigenvalues.
//!
//! Nothing that flies uses them. They are our own because the usual products of large matrices round
//! differently on different CPUs, and because the flight's own matrices need no sizes at run time.
//!
//! # Equations
//! Gaussian elimination with row pivoting; eigenvalues by balancing, reduction to Hessenberg form and
//! the implicit double-shift QR iteration of Francis (EISPACK `balanc`, `elmhes`, `hqr`).

use alloc::vec;
use alloc::vec::Vec;
use core::ops::{Index, IndexMut};

use crate::math::{max, sqrt, square};

/// A real matrix, by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

/// A complex number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// Distance from zero.
    pub fn abs(self) -> f64 {
        sqrt(square(self.re) + square(self.im))
    }

    /// Angle, −π..π.
    pub fn arg_rad(self) -> f64 {
        crate::math::atan2(self.im, self.re)
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;
    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self.values[row * self.columns + column]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut f64 {
        &mut self.values[row * self.columns + column]
    }
}

impl Matrix {
    /// All zeros.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![0.0; rows * columns] }
    }

    /// From its rows.
    pub fn from_rows(rows: &[&[f64]]) -> Self {
        let columns = rows.first().map_or(0, |row| row.len());
        Self { rows: rows.len(), columns, values: rows.concat() }
    }

    /// How many rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// How many columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// One row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.columns..(row + 1) * self.columns]
    }

    /// Rows as columns.
    #[must_use]
    pub fn transposed(&self) -> Self {
        let mut turned = Self::zeros(self.columns, self.rows);
        for row in 0..self.rows {
            for column in 0..self.columns {
                turned[(column, row)] = self[(row, column)];
            }
        }
        turned
    }

    /// The rows and columns of a square matrix that are named.
    #[must_use]
    pub fn part(&self, kept: &[usize]) -> Self {
        let mut part = Self::zeros(kept.len(), kept.len());
        for (i, &row) in kept.iter().enumerate() {
            for (j, &column) in kept.iter().enumerate() {
                part[(i, j)] = self[(row, column)];
            }
        }
        part
    }

    fn swap_rows(&mut self, a: usize, b: usize) {
        for column in 0..self.columns {
            self.values.swap(a * self.columns + column, b * self.columns + column);
        }
    }

    /// x of A·x = b for a square A. Where A is singular, the unknown that it says nothing of is 0.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let largest = self.values.iter().fold(0.0, |most, value| max(most, value.abs()));
        self.eliminate(b, largest * 1e-14)
    }

    /// The same, where a pivot counts as zero that is not larger than `nothing`.
    fn eliminate(&self, b: &[f64], nothing: f64) -> Vec<f64> {
        let n = self.rows;
        let mut a = self.clone();
        let mut b = b.to_vec();
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

    /// x of (s·I − A)·x = b for a complex s.
    pub fn solve_shifted(&self, s: Complex, b: &[Complex]) -> Vec<Complex> {
        let n = self.rows;
        let mut both = Self::zeros(2 * n, 2 * n);
        for i in 0..n {
            for j in 0..n {
                both[(i, j)] = -self[(i, j)];
                both[(n + i, n + j)] = -self[(i, j)];
            }
            both[(i, i)] += s.re;
            both[(n + i, n + i)] += s.re;
            both[(i, n + i)] = -s.im;
            both[(n + i, i)] = s.im;
        }
        let parts: Vec<f64> = b.iter().map(|b| b.re).chain(b.iter().map(|b| b.im)).collect();
        let x = both.eliminate(&parts, 0.0);
        (0..n).map(|i| Complex { re: x[i], im: x[n + i] }).collect()
    }

    /// The eigenvalue's right eigenvector, by inverse iteration.
    pub fn eigenvector(&self, eigenvalue: Complex) -> Vec<Complex> {
        // A little beside the eigenvalue, where the system still has an answer.
        let beside = 1e-9 * max(1.0, eigenvalue.abs());
        let s = Complex { re: eigenvalue.re + beside, im: eigenvalue.im };
        let n = self.rows;
        let mut balanced = self.clone();
        let scales = balanced.balance();
        // Not along a symmetry of the matrix, or half of the vectors would not be found.
        let mut v: Vec<Complex> =
            (0..n).map(|i| Complex { re: 1.0 + 0.37 * ((i * 7 % 11) as f64), im: 0.0 }).collect();
        for _ in 0..3 {
            v = balanced.solve_shifted(s, &v);
            let norm = sqrt(v.iter().map(|v| square(v.abs())).sum());
            for v in &mut v {
                *v = Complex { re: v.re / norm, im: v.im / norm };
            }
        }
        let scaled = v.iter().zip(&scales);
        scaled.map(|(v, scale)| Complex { re: v.re * scale, im: v.im * scale }).collect()
    }

    /// All eigenvalues of a square matrix, the slowest first, a pair with its positive imaginary part
    /// first.
    pub fn eigenvalues(&self) -> Vec<Complex> {
        let mut work = self.clone();
        work.balance();
        work.reduce_to_hessenberg();
        let mut found = work.francis();
        found.sort_by(|a, b| {
            a.abs().total_cmp(&b.abs()).then(a.re.total_cmp(&b.re)).then(b.im.total_cmp(&a.im))
        });
        found
    }

    /// D⁻¹·A·D with D of powers of two, so that rows and columns are alike in size; gives D.
    fn balance(&mut self) -> Vec<f64> {
        let n = self.rows;
        let mut scales = vec![1.0; n];
        let mut done = false;
        while !done {
            done = true;
            for i in 0..n {
                let (mut row, mut column) = (0.0, 0.0);
                for j in (0..n).filter(|&j| j != i) {
                    column += self[(j, i)].abs();
                    row += self[(i, j)].abs();
                }
                if row == 0.0 || column == 0.0 {
                    continue;
                }
                let (mut factor, sum) = (1.0, column + row);
                while column < row / 2.0 {
                    factor *= 2.0;
                    column *= 4.0;
                }
                while column > row * 2.0 {
                    factor /= 2.0;
                    column /= 4.0;
                }
                if (column + row) / factor < 0.95 * sum {
                    done = false;
                    scales[i] *= factor;
                    for j in 0..n {
                        self[(i, j)] /= factor;
                    }
                    for j in 0..n {
                        self[(j, i)] *= factor;
                    }
                }
            }
        }
        scales
    }

    fn reduce_to_hessenberg(&mut self) {
        let n = self.rows;
        for m in 1..n.saturating_sub(1) {
            let mut pivot = m;
            for j in m..n {
                if self[(j, m - 1)].abs() > self[(pivot, m - 1)].abs() {
                    pivot = j;
                }
            }
            if self[(pivot, m - 1)] == 0.0 {
                continue;
            }
            if pivot != m {
                self.swap_rows(pivot, m);
                for row in 0..n {
                    self.values.swap(row * n + pivot, row * n + m);
                }
            }
            for i in m + 1..n {
                let factor = self[(i, m - 1)] / self[(m, m - 1)];
                if factor != 0.0 {
                    for j in m - 1..n {
                        self[(i, j)] -= factor * self[(m, j)];
                    }
                    for j in 0..n {
                        self[(j, m)] += factor * self[(j, i)];
                    }
                    self[(i, m - 1)] = 0.0;
                }
            }
        }
    }

    /// Eigenvalues of a Hessenberg matrix, by deflation from its end.
    fn francis(&mut self) -> Vec<Complex> {
        let mut found = Vec::with_capacity(self.rows);
        let mut end = self.rows;
        let mut iterations = 0;
        while end > 0 {
            let start = self.block_start(end);
            match end - start {
                1 => found.push(Complex { re: self[(end - 1, end - 1)], im: 0.0 }),
                2 => found.extend(self.pair(end)),
                _ => {
                    iterations += 1;
                    // Never seen to be needed; it ends what would not converge.
                    if iterations < 300 {
                        self.sweep(start, end, iterations % 10 == 0);
                        continue;
                    }
                    found.push(Complex { re: f64::NAN, im: f64::NAN });
                    end -= 1;
                    iterations = 0;
                    continue;
                }
            }
            end = start;
            iterations = 0;
        }
        found
    }

    /// Where the last block that does not fall apart begins.
    fn block_start(&mut self, end: usize) -> usize {
        for k in (1..end).rev() {
            let size = self[(k - 1, k - 1)].abs() + self[(k, k)].abs();
            if self[(k, k - 1)].abs() <= f64::EPSILON * max(size, f64::MIN_POSITIVE) {
                self[(k, k - 1)] = 0.0;
                return k;
            }
        }
        0
    }

    /// Both eigenvalues of the block of two that ends at `end`.
    fn pair(&self, end: usize) -> [Complex; 2] {
        let (i, j) = (end - 2, end - 1);
        let mean = 0.5 * (self[(i, i)] + self[(j, j)]);
        let half = 0.5 * (self[(i, i)] - self[(j, j)]);
        let discriminant = square(half) + self[(i, j)] * self[(j, i)];
        let root = sqrt(discriminant.abs());
        if discriminant < 0.0 {
            return [Complex { re: mean, im: root }, Complex { re: mean, im: -root }];
        }
        // The larger one first: the other by the product, which loses no digits.
        let first = if mean < 0.0 { mean - root } else { mean + root };
        let product = self[(i, i)] * self[(j, j)] - self[(i, j)] * self[(j, i)];
        let second = if first == 0.0 { 0.0 } else { product / first };
        [Complex { re: first, im: 0.0 }, Complex { re: second, im: 0.0 }]
    }

    /// One double-shift QR sweep over the block `start..end`.
    fn sweep(&mut self, start: usize, end: usize, exceptional: bool) {
        let (last, n) = (end - 1, self.rows);
        let (mut sum, mut product) = (
            self[(last, last)] + self[(last - 1, last - 1)],
            self[(last, last)] * self[(last - 1, last - 1)]
                - self[(last, last - 1)] * self[(last - 1, last)],
        );
        if exceptional {
            let size = self[(last, last - 1)].abs() + self[(last - 1, last - 2)].abs();
            (sum, product) = (1.5 * size, square(size));
        }
        let h = |i: usize, j: usize| self[(start + i, start + j)];
        let mut p = h(0, 0) * (h(0, 0) - sum) + product + h(0, 1) * h(1, 0);
        let mut q = h(1, 0) * (h(0, 0) + h(1, 1) - sum);
        let mut r = h(1, 0) * h(2, 1);
        for k in start..last {
            let three = k + 2 <= last;
            if k > start {
                p = self[(k, k - 1)];
                q = self[(k + 1, k - 1)];
                r = if three { self[(k + 2, k - 1)] } else { 0.0 };
            } else if !three {
                r = 0.0;
            }
            let norm = sqrt(square(p) + square(q) + square(r));
            if norm == 0.0 {
                continue;
            }
            // The reflection that turns (p, q, r) onto the first axis.
            let alpha = if p < 0.0 { norm } else { -norm };
            let v = [p - alpha, q, r];
            let scale = 2.0 / (square(v[0]) + square(q) + square(r));
            let size = if three { 3 } else { 2 };
            for j in k.saturating_sub(1).max(start)..n {
                let dot: f64 = (0..size).map(|i| v[i] * self[(k + i, j)]).sum();
                for (i, v) in v.iter().enumerate().take(size) {
                    self[(k + i, j)] -= scale * dot * v;
                }
            }
            for i in 0..=(k + 3).min(last) {
                let dot: f64 = (0..size).map(|j| v[j] * self[(i, k + j)]).sum();
                for (j, v) in v.iter().enumerate().take(size) {
                    self[(i, k + j)] -= scale * dot * v;
                }
            }
            if k > start {
                self[(k, k - 1)] = alpha;
                for i in k + 1..k + size {
                    self[(i, k - 1)] = 0.0;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_solved() {
        let a = Matrix::from_rows(&[&[0.0, 2.0, 1.0], &[1.0, -1.0, 0.5], &[3.0, 0.0, -2.0]]);
        let x = a.solve(&[7.0, 0.5, -3.0]);
        for (found, expected) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-14, "{x:?}");
        }
    }

    #[test]
    fn what_a_singular_system_does_not_say_is_zero() {
        let a = Matrix::from_rows(&[&[1.0, 0.0, 2.0], &[0.0, 0.0, 0.0], &[1.0, 0.0, -1.0]]);
        let x = a.solve(&[5.0, 0.0, -1.0]);
        assert!((x[0] - 1.0).abs() < 1e-15 && x[1] == 0.0 && (x[2] - 2.0).abs() < 1e-15);
    }

    /// Of a companion matrix they are the polynomial's roots: −1, −2, 3 ± 4i, 0.5 ± 0.1i.
    #[test]
    fn eigenvalues_are_the_roots_of_the_characteristic_polynomial() {
        let mut polynomial = vec![1.0];
        let factors: [&[f64]; 4] =
            [&[1.0, 1.0], &[1.0, 2.0], &[1.0, -6.0, 25.0], &[1.0, -1.0, 0.26]];
        for factor in factors {
            let mut product = vec![0.0; polynomial.len() + factor.len() - 1];
            for (i, a) in polynomial.iter().enumerate() {
                for (j, b) in factor.iter().enumerate() {
                    product[i + j] += a * b;
                }
            }
            polynomial = product;
        }
        let n = polynomial.len() - 1;
        let mut a = Matrix::zeros(n, n);
        for i in 0..n {
            a[(0, i)] = -polynomial[i + 1];
            if i > 0 {
                a[(i, i - 1)] = 1.0;
            }
        }
        let found = a.eigenvalues();
        let expected = [(0.5, 0.1), (0.5, -0.1), (-1.0, 0.0), (-2.0, 0.0), (3.0, 4.0), (3.0, -4.0)];
        for (found, (re, im)) in found.iter().zip(expected) {
            assert!((found.re - re).abs() < 1e-9 && (found.im - im).abs() < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn an_eigenvector_is_only_stretched() {
        let a = Matrix::from_rows(&[&[0.0, 1.0, 0.2], &[-4.0, -0.4, 0.1], &[0.3, 0.0, -7.0]]);
        for eigenvalue in a.eigenvalues() {
            let v = a.eigenvector(eigenvalue);
            for i in 0..3 {
                let re: f64 = (0..3).map(|j| a[(i, j)] * v[j].re).sum();
                let im: f64 = (0..3).map(|j| a[(i, j)] * v[j].im).sum();
                let stretched_re = eigenvalue.re * v[i].re - eigenvalue.im * v[i].im;
                let stretched_im = eigenvalue.re * v[i].im + eigenvalue.im * v[i].re;
                assert!((re - stretched_re).abs() < 1e-7 && (im - stretched_im).abs() < 1e-7);
            }
        }
    }
}

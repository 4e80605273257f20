//! Eigenvalues, eigenvectors and shifted systems of a real square matrix.
//!
//! # Equations
//! ```text
//! A = D·B·D⁻¹                balanced: rows and columns of B alike in size, D of powers of two
//! B = Q·H·Qᵀ                 H upper Hessenberg; its eigenvalues by the QR iteration
//! (A − s·I)·vₙ₊₁ = vₙ         inverse iteration, s beside the eigenvalue
//! ```
//! # Source
//! Golub and Van Loan, Matrix Computations, 7.4 to 7.6; balancing by James, Langou and Lowery,
//! arXiv:1401.5766. Balancing, Hessenberg form and the complex systems' LU are nalgebra's.

use alloc::vec::Vec;
use core::fmt;

use engine::math::{max, sqrt, square};
use nalgebra::linalg::{Hessenberg, balancing::balance_parlett_reinsch};
use nalgebra::{DMatrix, DVector};

use crate::francis;
use crate::matrix::{Complex, Matrix, Polar};

/// A matrix that has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsolved {
    /// A number of the matrix is not finite.
    NotFinite,
    /// The eigenvalues have not converged.
    Eigenvalues,
    /// The system is singular: a pole of the response.
    Singular,
}

impl fmt::Display for Unsolved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("a number of the matrix is not finite"),
            Self::Eigenvalues => write!(
                f,
                "the eigenvalues have not converged: {} QR sweeps without one more",
                francis::SWEEPS_MAX
            ),
            Self::Singular => f.write_str("the system is singular: a pole of the response"),
        }
    }
}

impl core::error::Error for Unsolved {}

/// All eigenvalues of a square matrix, the slowest first, of a pair the one with positive imaginary part
/// first. There are as many as the matrix has rows.
///
/// # Errors
/// When the iteration does not converge, or a number of the matrix is not finite.
pub(crate) fn eigenvalues(a: &Matrix) -> Result<Vec<Complex>, Unsolved> {
    if !a.iter().all(|number| number.is_finite()) {
        return Err(Unsolved::NotFinite);
    }
    if a.is_empty() {
        return Ok(Vec::new());
    }
    let mut balanced = a.clone();
    balance_parlett_reinsch(&mut balanced);
    let mut found = francis::eigenvalues(hessenberg(balanced)).ok_or(Unsolved::Eigenvalues)?;
    if !found.iter().all(|value| value.re.is_finite() && value.im.is_finite()) {
        return Err(Unsolved::Eigenvalues);
    }
    found.sort_by(|a, b| {
        a.magnitude()
            .total_cmp(&b.magnitude())
            .then(a.re.total_cmp(&b.re))
            .then(b.im.total_cmp(&a.im))
    });
    Ok(found)
}

/// QᵀBQ, without anything below the first subdiagonal.
fn hessenberg(b: Matrix) -> Matrix {
    if b.nrows() < 2 { b } else { Hessenberg::new(b).unpack_h() }
}

/// x of (s·I − A)·x = b for a complex s; A is n × n, b has n values.
///
/// # Errors
/// [`Unsolved::Singular`] when s is an eigenvalue of A.
pub(crate) fn solve_shifted(
    a: &Matrix,
    s: Complex,
    b: &[Complex],
) -> Result<Vec<Complex>, Unsolved> {
    let mut shifted: DMatrix<Complex> = a.map(|number| Complex::new(-number, 0.0));
    for i in 0..a.nrows() {
        shifted[(i, i)] += s;
    }
    let x = shifted.lu().solve(&DVector::from_column_slice(b)).ok_or(Unsolved::Singular)?;
    if x.iter().all(|x| x.re.is_finite() && x.im.is_finite()) {
        Ok(x.iter().copied().collect())
    } else {
        Err(Unsolved::Singular)
    }
}

/// The right eigenvector of an eigenvalue, of length 1 as balanced, by inverse iteration.
///
/// # Errors
/// When the system beside the eigenvalue is singular.
pub(crate) fn eigenvector(a: &Matrix, eigenvalue: Complex) -> Result<Vec<Complex>, Unsolved> {
    // A little beside the eigenvalue, where the system still has an answer.
    let beside = 1e-9 * max(1.0, eigenvalue.magnitude());
    let s = Complex::new(eigenvalue.re + beside, eigenvalue.im);
    let mut balanced = a.clone();
    let scales = balance_parlett_reinsch(&mut balanced);
    // Not along a symmetry of the matrix, or half of the vectors would not be found.
    let mut v: Vec<Complex> =
        (0..a.nrows()).map(|i| Complex::new(1.0 + 0.37 * ((i * 7 % 11) as f64), 0.0)).collect();
    for _ in 0..3 {
        v = solve_shifted(&balanced, s, &v)?;
        let norm = sqrt(v.iter().map(|v| square(v.magnitude())).sum());
        for v in &mut v {
            *v /= norm;
        }
    }
    Ok(v.iter().zip(scales.iter()).map(|(v, &scale)| v * scale).collect())
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

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
        let found = eigenvalues(&a).unwrap();
        let expected = [(0.5, 0.1), (0.5, -0.1), (-1.0, 0.0), (-2.0, 0.0), (3.0, 4.0), (3.0, -4.0)];
        for (found, (re, im)) in found.iter().zip(expected) {
            assert!((found.re - re).abs() < 1e-9 && (found.im - im).abs() < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn an_eigenvector_is_only_stretched() {
        let a = Matrix::from_row_slice(3, 3, &[0.0, 1.0, 0.2, -4.0, -0.4, 0.1, 0.3, 0.0, -7.0]);
        for eigenvalue in eigenvalues(&a).unwrap() {
            let v = eigenvector(&a, eigenvalue).unwrap();
            for i in 0..3 {
                let turned: Complex = (0..3).map(|j| v[j] * a[(i, j)]).sum();
                assert!((turned - eigenvalue * v[i]).magnitude() < 1e-7);
            }
        }
    }

    /// Rows and columns of a state-space matrix differ by powers of ten: watts beside radians.
    #[test]
    fn eigenvalues_do_not_depend_on_the_units_of_the_states() {
        let a = Matrix::from_row_slice(3, 3, &[-1.0, 2.0, 0.5, -3.0, -0.2, 1.0, 0.1, 0.4, -5.0]);
        let units = [1.0, 1e-6, 3e5];
        let scaled = Matrix::from_fn(3, 3, |i, j| a[(i, j)] * units[i] / units[j]);
        let pairs = eigenvalues(&a).unwrap().into_iter().zip(eigenvalues(&scaled).unwrap());
        for (one, other) in pairs {
            assert!((one - other).magnitude() < 1e-12, "{one} {other}");
        }
    }

    #[test]
    fn what_is_not_finite_or_singular_is_told() {
        let a = Matrix::from_row_slice(2, 2, &[f64::NAN, 0.0, 0.0, 1.0]);
        assert_eq!(eigenvalues(&a), Err(Unsolved::NotFinite));
        let one = Complex::new(1.0, 0.0);
        let identity = Matrix::identity(2, 2);
        assert_eq!(solve_shifted(&identity, one, &[one, one]), Err(Unsolved::Singular));
    }

    /// The cyclic permutation, on which sweeps without exceptional shifts stand still.
    #[test]
    fn eigenvalues_of_a_cyclic_matrix_are_the_roots_of_one() {
        for n in 3..12 {
            let a = Matrix::from_fn(n, n, |i, j| if (i + 1) % n == j { 1.0 } else { 0.0 });
            let found = eigenvalues(&a).unwrap();
            for k in 0..n {
                let angle = engine::math::TAU * k as f64 / n as f64;
                let root = Complex::new(engine::math::cos(angle), engine::math::sin(angle));
                assert!(found.iter().any(|value| (value - root).magnitude() < 1e-12), "{found:?}");
            }
        }
    }

    /// Actuators with one lag that are driven by the same few motions: what made other iterations
    /// stall, since all but as many eigenvalues as there are motions are alike.
    #[test]
    fn repeated_eigenvalues_converge() {
        let (motions, actuators) = (3, 9);
        let n = motions + actuators;
        let a = Matrix::from_fn(n, n, |i, j| match (i < motions, j < motions) {
            (true, true) => [-0.5, 0.3, -0.2][(i + 2 * j) % 3] - if i == j { 1.0 } else { 0.0 },
            (true, false) => [0.7, -0.4, 0.9, 0.1][(3 * i + j) % 4],
            (false, true) => [0.2, 0.05, -0.1, 0.3, 0.15][(i + 3 * j) % 5],
            (false, false) => {
                if i == j {
                    -20.0
                } else {
                    0.0
                }
            }
        });
        let found = eigenvalues(&a).unwrap();
        let alike =
            found.iter().filter(|value| (*value - Complex::new(-20.0, 0.0)).magnitude() < 1e-6);
        assert_eq!(alike.count(), actuators - motions, "{found:?}");
        let sum: Complex = found.iter().sum();
        assert!((sum - a.trace()).magnitude() < 1e-10);
    }
}

//! Bending: the shape in which a blade bends by itself, and its inertias in that shape.
//!
//! # Equations
//! ```text
//! w(r) = r·γ + R·φ(x)·q        x = r/R, φ = Σ a_k·x^k / Σ a_k, k = 2, 3, 4: 1 at the tip     [JOHNSON]
//! M_γq = ∫m·r·Rφ   M_qq = ∫m·(Rφ)²   C_qq = ∫m·r·∫₀ʳ(dRφ/dr)²   S_q = ∫m·Rφ
//! K_q = M_qq·ω_q² − Ω_q²·C_qq                                first elastic frequency ω_q at Ω_q
//! ```
//! γ is the gimbal's part of the flapping, a straight line from the hub; q what the blade bends beyond it: its
//! tip's displacement over the radius.
//! # Signs
//! Flap up.
//! # Assumptions
//! One shape, the first elastic flapping; mass spread evenly over the blade, m = 3·I_b/R³, so that a straight line has
//! the flapping inertia of the file. Pitch does not turn the shape out of the flapping's plane: a proprotor's blade at
//! the pitch of an aeroplane bends in the plane of rotation as well, which is left out with all motion in lag.

use serde::Deserialize;

use crate::math::square;

/// How a blade bends.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// ω_q: first elastic frequency of flapping, the root held.
    pub frequency_radps: f64,
    /// Ω_q: at this rotor speed.
    pub reference_radps: f64,
    /// a2, a3, a4: displacement by the second, third and fourth power of the radius, in any scale.
    pub shape_norm: [f64; 3],
}

/// Powers of the radius in the shape.
const POWERS: [f64; 3] = [2.0, 3.0, 4.0];

impl Params {
    /// # Errors
    /// What is expected, if it is not so.
    pub fn validate(&self) -> Result<(), &'static str> {
        let tip = self.shape_norm.iter().sum::<f64>();
        if tip.is_nan() || tip <= 0.0 {
            return Err("a shape that is up at the tip");
        }
        let stiff = self.inertias(1.0, 0.0, 1.0).spring_n_m_per_rad > 0.0;
        stiff.then_some(()).ok_or("a frequency above that of a blade without stiffness")
    }

    fn coefficients(&self) -> [f64; 3] {
        let tip = self.shape_norm.iter().sum::<f64>();
        self.shape_norm.map(|a| a / tip)
    }

    /// φ at a part of the radius.
    pub fn displacement(&self, x: f64) -> f64 {
        let [a, b, c] = self.coefficients();
        square(x) * (a + x * (b + x * c))
    }

    /// dφ/dx there.
    pub fn slope(&self, x: f64) -> f64 {
        let [a, b, c] = self.coefficients();
        x * (2.0 * a + x * (3.0 * b + x * 4.0 * c))
    }

    /// What one blade of this flapping inertia has, with its share of the hub.
    pub fn inertias(
        &self,
        blade_inertia_kg_m2: f64,
        hub_share_kg_m2: f64,
        radius_m: f64,
    ) -> Inertias {
        let a = self.coefficients();
        let single = |f: fn(f64) -> f64| -> f64 { (0..3).map(|k| a[k] * f(POWERS[k])).sum() };
        let double = |f: fn(f64, f64) -> f64| -> f64 {
            (0..3).map(|j| (0..3).map(|k| a[j] * a[k] * f(POWERS[j], POWERS[k])).sum::<f64>()).sum()
        };
        // Of m·R³ = 3·I_b; each is an integral of powers of x.
        let mass = 3.0 * blade_inertia_kg_m2;
        let elastic_kg_m2 = mass * double(|j, k| 1.0 / (j + k + 1.0));
        let stiffened_kg_m2 = mass * double(|j, k| j * k / ((j + k - 1.0) * (j + k + 1.0)));
        Inertias {
            gimbal_kg_m2: blade_inertia_kg_m2 + hub_share_kg_m2,
            coupled_kg_m2: mass * single(|k| 1.0 / (k + 2.0)),
            elastic_kg_m2,
            stiffened_kg_m2,
            spring_n_m_per_rad: elastic_kg_m2 * square(self.frequency_radps)
                - stiffened_kg_m2 * square(self.reference_radps),
            moment_kg_m: mass / radius_m * single(|k| 1.0 / (k + 1.0)),
        }
    }
}

/// A blade's inertias as it flaps, and what holds it in its own shape.
#[derive(Clone, Copy, Debug)]
pub struct Inertias {
    /// M_γγ: of the blade as a straight line, with its share of the hub.
    pub gimbal_kg_m2: f64,
    /// M_γq.
    pub coupled_kg_m2: f64,
    /// M_qq.
    pub elastic_kg_m2: f64,
    /// C_qq: what the rotation stiffens.
    pub stiffened_kg_m2: f64,
    /// K_q.
    pub spring_n_m_per_rad: f64,
    /// S_q.
    pub moment_kg_m: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cantilever() -> Params {
        Params { frequency_radps: 90.0, reference_radps: 48.0, shape_norm: [6.0, -4.0, 1.0] }
    }

    /// The sums of powers against the integrals, added up point by point.
    #[test]
    fn inertias_are_the_integrals_of_their_shape() {
        let (params, inertia, radius) = (cantilever(), 140.0, 3.8);
        let found = params.inertias(inertia, 3.0, radius);
        let steps = 4000;
        let (mut coupled, mut elastic, mut stiffened, mut moment) = (0.0, 0.0, 0.0, 0.0);
        let mut slope2 = 0.0;
        for i in 0..steps {
            let each = 1.0 / f64::from(steps);
            let x = (f64::from(i) + 0.5) * each;
            let (mass, phi) = (3.0 * inertia * each, params.displacement(x));
            let half = 0.5 * each * square(params.slope(x));
            slope2 += half;
            coupled += mass * x * phi;
            elastic += mass * square(phi);
            stiffened += mass * x * slope2;
            moment += mass * phi / radius;
            slope2 += half;
        }
        for (ours, integral) in [
            (found.coupled_kg_m2, coupled),
            (found.elastic_kg_m2, elastic),
            (found.stiffened_kg_m2, stiffened),
            (found.moment_kg_m, moment),
        ] {
            assert!((ours / integral - 1.0).abs() < 1e-6, "{ours} {integral}");
        }
        assert!((found.gimbal_kg_m2 - 143.0).abs() < 1e-12);
    }

    #[test]
    fn the_shape_is_one_at_the_tip_and_has_its_own_slope() {
        let params = cantilever();
        assert!((params.displacement(1.0) - 1.0).abs() < 1e-15);
        assert!((params.slope(1.0) - 4.0 / 3.0).abs() < 1e-15);
        let by_difference = (params.displacement(0.601) - params.displacement(0.599)) / 0.002;
        assert!((params.slope(0.6) - by_difference).abs() < 1e-6);
    }

    #[test]
    fn a_blade_softer_than_a_string_is_refused() {
        assert_eq!(cantilever().validate(), Ok(()));
        assert!(Params { frequency_radps: 50.0, ..cantilever() }.validate().is_err());
        assert!(Params { shape_norm: [1.0, -1.0, 0.0], ..cantilever() }.validate().is_err());
    }
}

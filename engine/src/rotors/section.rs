//! Blade sections: lift and drag at any angle and subsonic Mach number.
//!
//! # Equations
//! ```text
//! cl, cd = tables(α'),   α' = α0 + (α − α0)·√(1 − M_t²)/√(1 − M²)     −6° < α < 12°     [TP04]
//! cl = 2·sin α·cos α,  cd = 0.01 + 1.9·sin²α                          flat plate
//! cl(α) = cl(α' − Δ) + a·Δ                            rotation holds off the stall  [CORRIGAN]
//! Δ = (K − 1)·(Ωr/U)²·(α' − α0), at most at αs,  K = (1.291·(c/r)^.0775)^n
//! cd += d(M) − d(M_t),  d = 20·(M − M_cr)⁴ above M_cr,  M_cr = κ_A − t/c − cl/10 − .108   [KORN]
//! ```
//! Between −6° and −20°, and between 12° and 30°, the table fades into the plate; what rotation adds
//! fades out between 30° and 60°.
//! # Signs
//! α from zero at the chord, leading edge up positive; lift and drag across and along the flow.
//! # Assumptions
//! The tables hold at one Mach number M_t a region: Prandtl–Glauert carries their slope, not their
//! greatest lift, to others. No unsteady stall, no Reynolds number. The drag goes on in a straight line
//! where its table ends and that of the lift does not (8° to 12°). The delay is one of lift alone, as its
//! source has it: the drag is that of the section without rotation. The thickness, and
//! with it where the drag rises, follows the radius within a region, too.

use serde::Deserialize;

use crate::lanes::{self, Lanes, clamp, max, min, square, whole};
use crate::math::{self, pow_positive, sqrt};
use crate::table::axis::{Alpha, RadialStation};
use crate::table::{Table1, Table2};

/// Angles of a table, at most.
const ANGLES_MAX: usize = 16;
/// Regions of the blade with a section of their own.
pub const REGIONS: usize = 4;

/// From the drag divergence of Korn's rule down to where the drag begins to rise: (0.1/80)^(1/3).
const DIVERGENCE: f64 = 0.107_7;
/// Beyond it Prandtl–Glauert would grow without bound.
const MACH2_MAX: f64 = 0.64;

/// What the sections are.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// cl by the region's outer end and α in equal steps.
    pub lift_coefficient: Table2<RadialStation, Alpha>,
    /// cd, alike.
    pub drag_coefficient: Table2<RadialStation, Alpha>,
    /// t/c over the part of the radius.
    pub thickness_norm: Table1<RadialStation>,
    /// M at the tip when the tables hold: M_t is that of the region's middle.
    pub table_tip_mach: f64,
    /// n.
    pub delay_exponent: f64,
    /// κ_A.
    pub korn_factor: f64,
}

impl Params {
    /// # Errors
    /// What is expected, if it is not so.
    pub fn validate(&self) -> Result<(), &'static str> {
        let (lift, drag) = (&self.lift_coefficient, &self.drag_coefficient);
        let thickness = self.thickness_norm.validate();
        lift.validate().and(drag.validate()).and(thickness).and_then(|()| {
            let step = lift.y[1] - lift.y[0];
            let even = lift.y.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() < 1e-6 * step);
            let known = lift.y.iter().skip(self.drag_offset());
            let same = drag.y.len() <= known.len()
                && drag.y.iter().zip(known).all(|(a, b)| (a - b).abs() < 1e-9);
            if lift.x.len() != REGIONS || drag.x != lift.x {
                Err("the same four regions in lift and drag")
            } else if !even || lift.y.len() > ANGLES_MAX {
                Err("sixteen angles at most, in equal steps")
            } else if !same {
                Err("angles of the drag among those of the lift")
            } else {
                Ok(())
            }
        })
    }

    /// The sections, ready to be asked.
    pub fn regions(&self, root_norm: f64) -> [Region; REGIONS] {
        let (lift, drag) = (&self.lift_coefficient, &self.drag_coefficient);
        let step = lift.y[1] - lift.y[0];
        let last = lift.y.len() - 1;
        // The drag's angles are some of the lift's: the row below or beyond them goes on in its line.
        let first = self.drag_offset();
        core::array::from_fn(|i| {
            let row = &drag.z[i];
            let drag_at = |j: usize| {
                let k = j.saturating_sub(first).min(row.len() - 2);
                row[k] + (j as f64 - (first + k) as f64) * (row[k + 1] - row[k])
            };
            let cells = |value: &dyn Fn(usize) -> f64| {
                let mut cells = [[0.0; 2]; ANGLES_MAX];
                for (j, cell) in cells.iter_mut().enumerate().take(last) {
                    *cell = [value(j), value(j + 1) - value(j)];
                }
                cells
            };
            let inner = if i > 0 { lift.x[i - 1] } else { root_norm };
            let mach = self.table_tip_mach * 0.5 * (inner + lift.x[i]);
            let zero_lift_rad = lift.y[0] + step * root(&lift.z[i]);
            Region {
                lift: cells(&|j| lift.z[i][j]),
                drag: cells(&drag_at),
                per_step: 1.0 / step,
                cell_max: last as f64 - 1.0,
                zero_lift_rad,
                zero_lift_steps: root(&lift.z[i]),
                lift_slope_per_rad: slope(&lift.z[i]) / step,
                to_stall_rad: lift.y[greatest(&lift.z[i])] - zero_lift_rad,
                table_mach: mach,
                table_beta: sqrt(1.0 - math::square(mach)),
            }
        })
    }

    /// M_cr without lift, at this part of the radius.
    pub fn rise_mach(&self, radius_norm: f64) -> f64 {
        self.korn_factor - self.thickness_norm.at(RadialStation(radius_norm)) - DIVERGENCE
    }

    /// K − 1 at a chord over radius; the correlation knows none beyond a half.
    pub fn delay(&self, chord_over_radius: f64) -> f64 {
        let k = 1.291 * pow_positive(math::clamp(chord_over_radius, 1e-3, 0.5), 0.0775);
        math::max(pow_positive(k, self.delay_exponent) - 1.0, 0.0)
    }

    /// Where among the lift's angles the drag's begin.
    fn drag_offset(&self) -> usize {
        let (lift, drag) = (&self.lift_coefficient.y, &self.drag_coefficient.y);
        lift.iter().position(|angle| (angle - drag[0]).abs() < 1e-9).unwrap_or(0)
    }
}

/// Where a rising row passes through zero, in steps.
fn root(row: &[f64]) -> f64 {
    let i = row.windows(2).position(|pair| pair[1] > 0.0).unwrap_or(0);
    i as f64 - row[i] / (row[i + 1] - row[i])
}

/// Slope of a row between a fifth and a half of its length, per step: where lift is straight.
fn slope(row: &[f64]) -> f64 {
    let (from, to) = (row.len() / 5, row.len() / 2);
    (row[to] - row[from]) / (to - from) as f64
}

/// Where a row is greatest.
fn greatest(row: &[f64]) -> usize {
    (1..row.len()).fold(0, |best, j| if row[j] > row[best] { j } else { best })
}

/// The section of one region of the blade.
#[derive(Clone, Copy, Debug)]
pub struct Region {
    /// cl where each step of α begins, and how much it grows over it.
    lift: Cells,
    /// cd, alike.
    drag: Cells,
    per_step: f64,
    cell_max: f64,
    /// α0.
    pub zero_lift_rad: f64,
    /// The same in steps from where the table begins.
    zero_lift_steps: f64,
    /// a.
    lift_slope_per_rad: f64,
    /// αs − α0, to the greatest lift.
    to_stall_rad: f64,
    /// M_t.
    table_mach: f64,
    /// √(1 − M_t²).
    table_beta: f64,
}

/// Where each step of α begins, and how much the value grows over it.
type Cells = [[f64; 2]; ANGLES_MAX];

/// What a section does, by lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficients {
    /// cl.
    pub lift: Lanes,
    /// cd.
    pub drag: Lanes,
    /// 0 on the table, 1 on the flat plate.
    pub stalled: Lanes,
}

// sin 12°, sin 30°, sin 6°, sin 20°: where the table ends and where the plate begins.
const STALL: f64 = 0.207_911_690_817_759_3;
const PLATE: f64 = 0.5;
const STALL_BELOW: f64 = 0.104_528_463_267_653_5;
const PLATE_BELOW: f64 = 0.342_020_143_325_668_7;
/// sin 60°: where rotation has lost its hold.
const DELAY_END: f64 = 0.866_025_403_784_438_6;
/// a: lift slope that stands for all sections where the tables do not say, per rad.
pub const LIFT_SLOPE: f64 = 5.7;

impl Region {
    /// Coefficients at the angle of attack with this sine and cosine; `delay` is (K − 1)·(Ωr/U)²,
    /// `rise_mach` M_cr without lift.
    ///
    /// What most blades meet nowhere most of the time is left out where no lane needs it: there it
    /// would add zeros.
    #[inline(always)]
    pub(crate) fn coefficients(
        &self,
        (s, cos_alpha): (Lanes, Lanes),
        mach: Lanes,
        delay: Lanes,
        rise_mach: f64,
    ) -> Coefficients {
        // What is not known is the plate's: NaN, too.
        let known = cos_alpha.above(0.0) & s.below(DELAY_END) & s.above(-PLATE_BELOW);
        // The arc sine by its series: to 1e-6 rad where the table ends, 5e-4 where the plate begins.
        let s2 = square(s);
        let alpha = s * (1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0)));
        let slope = self.table_beta / lanes::sqrt(1.0 - min(square(mach), MACH2_MAX));
        let lifting = (alpha - self.zero_lift_rad) * slope;
        let delayed = delay * clamp(lifting, 0.0, self.to_stall_rad);
        let steps = lifting * self.per_step + self.zero_lift_steps;
        let table_lift = self.table(&self.lift, steps - delayed * self.per_step);
        let table_drag = max(self.table(&self.drag, steps), 0.0);
        let above = s.above(0.0);
        let past = (s - STALL) * (1.0 / (PLATE - STALL));
        let below = (-s - STALL_BELOW) * (1.0 / (PLATE_BELOW - STALL_BELOW));
        let dragging = above.select(past, below);
        let fade = min((DELAY_END - s) * (1.0 / (DELAY_END - PLATE)), 1.0);
        let held = fade * self.lift_slope_per_rad * delayed;

        let mut found =
            Coefficients { lift: table_lift + held, drag: table_drag, stalled: 0.0.into() };
        if (!known | dragging.above(0.0)).any() {
            let (plate_lift, plate_drag) = (2.0 * s * cos_alpha, 0.01 + 1.9 * s * s);
            let held_off = delayed * cos_alpha * (1.0 / (PLATE - STALL));
            let stalled = clamp(above.select(past - held_off, below), 0.0, 1.0);
            let lift = table_lift + stalled * (plate_lift - table_lift) + held;
            let drag = table_drag + clamp(dragging, 0.0, 1.0) * (plate_drag - table_drag);
            found.lift = known.select(lift, plate_lift);
            found.drag = known.select(drag, plate_drag);
            found.stalled = known.select(stalled, 1.0);
        }
        let rise_mach = rise_mach - 0.1 * found.lift.abs();
        let rises = mach.above(rise_mach);
        if rises.any() {
            let more = rise(mach - rise_mach) - rise(self.table_mach - rise_mach);
            found.drag = rises.select(found.drag + max(more, 0.0), found.drag);
        }
        found
    }

    /// A value so many steps into its table: linear between the points and below them, held above.
    #[inline(always)]
    fn table(&self, cells: &Cells, steps: Lanes) -> Lanes {
        let steps = min(steps, self.cell_max + 1.0);
        let (cell, index) = whole(clamp(steps, 0.0, self.cell_max));
        let cells = index.map(|index| cells[index as usize % ANGLES_MAX]);
        let [from, more] = core::array::from_fn(|part| Lanes::from_fn(|lane| cells[lane][part]));
        from + (steps - cell) * more
    }
}

/// d; held where the fourth power has no meaning any more.
#[inline(always)]
fn rise(beyond: Lanes) -> Lanes {
    20.0 * square(square(clamp(beyond, 0.0, 0.3)))
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::math::{cos, sin};
    use crate::units::DEGREE_RAD as DEG;

    fn params() -> Params {
        let ends = vec![0.55, 0.80, 0.95, 1.0];
        let angles: vec::Vec<f64> = (-3..=6).map(|i| f64::from(2 * i) * DEG).collect();
        let lift = vec![-0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95];
        let drag = vec![0.012, 0.01, 0.008, 0.007, 0.008, 0.01, 0.014, 0.02, 0.03, 0.045];
        let table =
            |row: vec::Vec<f64>| Table2::new(ends.clone(), angles.clone(), vec![row; REGIONS]);
        Params {
            lift_coefficient: table(lift),
            drag_coefficient: table(drag),
            thickness_norm: Table1::new(vec![0.25, 1.0], vec![0.25, 0.08]),
            table_tip_mach: 0.0,
            delay_exponent: 1.0,
            korn_factor: 0.87,
        }
    }

    /// cl and cd of the innermost region at an angle, a Mach number, a delay and a part of the radius.
    fn at(alpha_deg: f64, mach: f64, delay: f64, radius_norm: f64) -> (f64, f64) {
        let params = params();
        let sine = (sin(alpha_deg * DEG).into(), cos(alpha_deg * DEG).into());
        let rise_mach = params.rise_mach(radius_norm);
        let region = &params.regions(0.0875)[0];
        let found = region.coefficients(sine, mach.into(), delay.into(), rise_mach);
        (found.lift.to_array()[0], found.drag.to_array()[0])
    }

    #[test]
    fn rotation_holds_lift_and_leaves_drag() {
        for alpha_deg in [4.0, 10.0, 16.0, 25.0] {
            let (lift, drag) = at(alpha_deg, 0.1, 0.0, 0.3);
            let (held, same) = at(alpha_deg, 0.1, 0.2, 0.3);
            assert!(held > lift - 1e-12, "{alpha_deg} deg: {held} {lift}");
            assert!((same - drag).abs() < 1e-15, "{alpha_deg} deg: {same} {drag}");
        }
        assert!(at(16.0, 0.1, 0.2, 0.3).0 > 1.1 * at(16.0, 0.1, 0.0, 0.3).0);
    }

    /// Upside down beyond its stall a blade is a plate: 2·sin α·cos α of lift, .01 + 1.9·sin² α of drag.
    #[test]
    fn at_negative_stall_it_is_a_plate() {
        for alpha_deg in [-25.0, -45.0, -80.0, -135.0, 170.0] {
            let (s, c) = (sin(alpha_deg * DEG), cos(alpha_deg * DEG));
            let (lift, drag) = at(alpha_deg, 0.1, 0.0, 0.5);
            assert!((lift - 2.0 * s * c).abs() < 1e-12, "{alpha_deg} deg: lift {lift}");
            assert!((drag - 0.01 - 1.9 * s * s).abs() < 1e-12, "{alpha_deg} deg: drag {drag}");
        }
        let (attached, _) = at(-5.0, 0.0, 0.0, 0.5);
        assert!((attached + 0.5).abs() < 0.01, "its table's -.5 at -5 deg, not {attached}");
    }

    /// At Mach .6 a section of 25 % is beyond its rise, .87 - .25 - .108 = .51, one of 8 % is not.
    #[test]
    fn the_thicker_root_drags_first() {
        let slow = at(0.0, 0.1, 0.0, 0.3).1;
        assert!((at(0.0, 0.6, 0.0, 1.0).1 - slow).abs() < 1e-12);
        let expected = 20.0 * math::square(math::square(0.6 - (0.87 - 0.25 - DIVERGENCE)));
        assert!((at(0.0, 0.6, 0.0, 0.2).1 - slow - expected).abs() < 1e-12);
    }
}

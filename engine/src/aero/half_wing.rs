//! A half wing with its pylon: its numbers, and what acts on it.

use serde::Deserialize;

use super::LocalFlow;
use super::polar::Polar;
use crate::frames::{Body, Structural, Vec3};
use crate::mast::TiltedMast;
use crate::motion::Motion;
use crate::table::axis::{CrossflowAngle, FlapAngle, MastTilt};
use crate::table::{Invalid, Table1, Table2, all_valid};

/// What a half wing is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// S of both halves.
    pub area_m2: f64,
    /// c.
    pub chord_m: f64,
    /// b.
    pub span_m: f64,
    /// Aerodynamic centre of the right half.
    pub centre_m: Vec3<Structural>,
    /// CL.
    pub lift: Polar,
    /// CD.
    pub drag: Polar,
    /// Cm over mast tilt and flap.
    pub pitching_moment: Table2<MastTilt, FlapAngle>,
    /// CD0, at no lift, over mast tilt and flap.
    pub drag_at_no_lift: Table2<MastTilt, FlapAngle>,
    /// Clβ at no lift, over mast tilt and flap.
    pub rolling_by_sideslip_per_rad: Table2<MastTilt, FlapAngle>,
    /// What Clβ grows by with CL.
    pub rolling_by_sideslip_and_lift_per_rad: Table2<MastTilt, FlapAngle>,
    /// Clp.
    pub rolling_by_roll_rate: f64,
    /// Clr/CL.
    pub rolling_by_yaw_rate_and_lift: f64,
    /// Cnβ at no lift.
    pub yawing_by_sideslip_per_rad: f64,
    /// Cnβ/CL².
    pub yawing_by_sideslip_and_lift2_per_rad: f64,
    /// Cnp/CL.
    pub yawing_by_roll_rate_and_lift: f64,
    /// Cnr/CL².
    pub yawing_by_yaw_rate_and_lift2: f64,
    /// Cnr/CD0.
    pub yawing_by_yaw_rate_and_drag: f64,
    /// Clδa.
    pub rolling_by_flaperon_per_rad: f64,
    /// K over mast tilt and flap.
    pub flaperon_factor: Table2<MastTilt, FlapAngle>,
    /// CLδa over flap.
    pub lift_loss_by_flaperon_per_rad: Table1<FlapAngle>,
    /// K_n0 over mast tilt and flap.
    pub yawing_by_flaperon_per_rad: Table2<MastTilt, FlapAngle>,
    /// K_n over mast tilt and flap.
    pub yawing_by_flaperon_and_lift: Table2<MastTilt, FlapAngle>,
    /// SL_WTE: fuselage station of the trailing edge.
    pub trailing_edge_station_m: f64,
    /// D_PYINT of both pylons over mast tilt.
    pub interference_m2: Table1<MastTilt>,
    /// S_PLAT of one pylon.
    pub platform_m2: f64,
    /// K_PLAT over the angle of the flow from the side.
    pub platform_factor: Table1<CrossflowAngle>,
    /// Drag area of a spinner along its mast.
    pub spinner_m2: f64,
    /// Added when the flow comes across.
    pub spinner_across_m2: f64,
}

/// What the right half reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// The flow that the whole aircraft meets.
    pub flow: LocalFlow,
    /// Mach number.
    pub mach: f64,
    /// α_WFS.
    pub alpha_rad: f64,
    /// K0·v·n: velocity of the half wing through its wake.
    pub wake_mps: Vec3<Body>,
    /// This side's mast, with βm and n of its thrust.
    pub mast: TiltedMast,
    /// v of this side's rotor.
    pub induced_mps: f64,
    /// R.
    pub rotor_radius_m: f64,
    /// Conversion pivot, where the pylon's drag acts.
    pub pivot_m: Vec3<Structural>,
    /// Hub.
    pub hub_from_cg_m: Vec3<Body>,
    /// Flap.
    pub flap_rad: f64,
    /// This side's flaperon beyond the flap's setting.
    pub flaperon_rad: f64,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        all_valid([
            ("wing_pylon.lift", self.lift.validate()),
            ("wing_pylon.drag", self.drag.validate()),
            ("wing_pylon.pitching_moment", self.pitching_moment.validate()),
            ("wing_pylon.drag_at_no_lift", self.drag_at_no_lift.validate()),
            ("wing_pylon.rolling_by_sideslip", self.rolling_by_sideslip_per_rad.validate()),
            (
                "wing_pylon.rolling_by_sideslip_and_lift",
                self.rolling_by_sideslip_and_lift_per_rad.validate(),
            ),
            ("wing_pylon.flaperon_factor", self.flaperon_factor.validate()),
            ("wing_pylon.lift_loss_by_flaperon", self.lift_loss_by_flaperon_per_rad.validate()),
            ("wing_pylon.yawing_by_flaperon", self.yawing_by_flaperon_per_rad.validate()),
            ("wing_pylon.yawing_by_flaperon_and_lift", self.yawing_by_flaperon_and_lift.validate()),
            ("wing_pylon.interference", self.interference_m2.validate()),
            ("wing_pylon.platform_factor", self.platform_factor.validate()),
        ])
    }
}

//! Vertical stabilisers: one fin with its rudder.
//!
//! # Equations
//! ```text
//! β_V = atan2(V, U_W) + .1·p·b/2U      U_W = √(U² + W²), U at least 35 ft/s          [CR536 subsystem 6]
//! β_F = atan2(v, u_w)                  of the centre of gravity: what does not turn
//! K_V = K_βR(V, |β|)·(1 − ∂σ/∂β)(βm, δF, α, |β|)        rotors' and fuselage's sidewash
//! CY = CY(β_V) − (1 − K_V)·CY(β_F) + ΔCY(δr) up to Mach .2; above it the tables by Mach number and
//!   a·X_Kr·τr·δr
//! CD = CD(β_V + K_r·τr·δr) − (1 − K_V)·CD(β_F + K_r·τr·δr)          q = ½ρ·η_V·(U_W² + V²)
//! ```
//! # Signs
//! β from the right positive; CY pushes to the left, across the flow. Rudder: trailing edge right
//! positive, which pushes the tail left and the nose right. Written for the right fin; the left is its
//! mirror image.
//! # Assumptions
//! U_W changes sign over ±30° about the vertical, so that the tables' whole circle is flown: the source
//! says how from ahead only. The source's η_V, over βm, α and V, is not at hand by itself: it is taken
//! to be the horizontal stabiliser's. Its trim printouts say so: with it the fins' drag there is within
//! 3 % of theirs, without it between .57 and 1.04 of it. β of the sidewash factors is the aircraft's.
//! The source multiplies CY(β_V) by K_V. In steady straight flight that is the same; but its factor, −.5
//! to 1.5, is what rotors and fuselage do to the air that comes from the side. The fin that swings into
//! that air with yaw and roll meets it undiminished: with K_V on the whole of β_V a yaw rate at 40 kt
//! pushed the fin the way it went.
//! The rotors' wake turns the flow at the fin in its own plane; U and W in β_V have it, q does not:
//! η_V was measured in that wake. What of the wake comes from the side is K_βR's.

use serde::Deserialize;

use super::polar::{ByMach, Flap};
use super::{LocalFlow, ahead, load_at};
use crate::frames::{Body, Load, Structural, Vec3};
use crate::math::{atan2, max, ramp, sin_cos, sqrt, square};
use crate::motion::Motion;
use crate::pair::Pair;
use crate::table::axis::{Airspeed, Alpha, Beta, Mach, MastTilt, RudderAngle};
use crate::table::{Invalid, Table1, Table2, Table3, all_valid};
use crate::units::DEGREE_RAD as DEG;

/// Rudder angle from which it loses effect.
const RUDDER_FULL_RAD: f64 = 15.0 * DEG;

/// 1 − ∂σ/∂β over mast tilt, α and |β| for each flap setting.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sidewash {
    /// Flaps up.
    pub flap_0: Table3<MastTilt, Alpha, Beta>,
    /// 20/12.5.
    pub flap_20: Table3<MastTilt, Alpha, Beta>,
    /// 40/25.
    pub flap_40: Table3<MastTilt, Alpha, Beta>,
    /// 75/47.
    pub flap_75: Table3<MastTilt, Alpha, Beta>,
}

impl Sidewash {
    /// By setting, in order.
    pub fn columns(&self) -> [&Table3<MastTilt, Alpha, Beta>; 4] {
        [&self.flap_0, &self.flap_20, &self.flap_40, &self.flap_75]
    }

    /// The factor.
    pub fn at(&self, flap: Flap, tilt: MastTilt, alpha: Alpha, beta: Beta) -> f64 {
        flap.blend(|i| self.columns()[i].at(tilt, alpha, beta))
    }

    fn validate(&self) -> Result<(), &'static str> {
        self.columns().into_iter().try_for_each(Table3::validate)
    }
}

/// What a fin is.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// S of one fin.
    pub area_m2: f64,
    /// Reference point of the right fin.
    pub centre_m: Vec3<Structural>,
    /// Of one fin, from its foot to its tip.
    pub span_m: f64,
    /// CY over β and δr at Mach number .2 and below; odd, printed for negative β.
    pub side_force: Table2<Beta, RudderAngle>,
    /// CY above, rudder at 0; odd.
    pub side_force_by_mach: ByMach<Beta>,
    /// CD over |β| at Mach number .2 and below.
    pub drag: Table1<Beta>,
    /// CD above.
    pub drag_by_mach: ByMach<Beta>,
    /// a, above Mach .2.
    pub lift_slope_per_rad: f64,
    /// τr.
    pub rudder_effect: f64,
    /// D_Kr.
    pub rudder_loss: f64,
    /// X_Kr over Mach number.
    pub rudder_by_mach: Table1<Mach>,
    /// K_βR over airspeed and |β|.
    pub rotor_sidewash: Table2<Airspeed, Beta>,
    /// 1 − ∂σ/∂β.
    pub fuselage_sidewash: Sidewash,
    /// ∂σ/∂p̂.
    pub sidewash_by_roll_rate: f64,
    /// b of the wing, to which p̂ refers.
    pub wing_span_m: f64,
    /// Least speed of p̂.
    pub sidewash_speed_mps_min: f64,
}

/// What the right fin reads.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// How the aircraft moves through the air.
    pub motion: Motion,
    /// The flow that the whole aircraft meets.
    pub flow: LocalFlow,
    /// Velocity through the rotor's wake.
    pub wake_mps: Vec3<Body>,
    /// Mach number.
    pub mach: f64,
    /// Mean βm.
    pub mast_tilt_rad: f64,
    /// Flap.
    pub flap_rad: f64,
    /// η_V.
    pub pressure_ratio: f64,
    /// δr, outboard positive (to the right for the right fin).
    pub rudder_rad: f64,
}

impl Params {
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        all_valid([
            ("vertical_stabilizers.side_force", self.side_force.validate()),
            ("vertical_stabilizers.side_force_by_mach", self.side_force_by_mach.validate()),
            ("vertical_stabilizers.drag", self.drag.validate()),
            ("vertical_stabilizers.drag_by_mach", self.drag_by_mach.validate()),
            ("vertical_stabilizers.rudder_by_mach", self.rudder_by_mach.validate()),
            ("vertical_stabilizers.rotor_sidewash", self.rotor_sidewash.validate()),
            ("vertical_stabilizers.fuselage_sidewash", self.fuselage_sidewash.validate()),
        ])
    }

    /// CY at Mach number .2 and below.
    pub fn slow_side_force(&self, beta_rad: f64, rudder_rad: f64) -> f64 {
        if beta_rad > 0.0 {
            -self.side_force.at(Beta(-beta_rad), RudderAngle(-rudder_rad))
        } else {
            self.side_force.at(Beta(beta_rad), RudderAngle(rudder_rad))
        }
    }
}

/// What both fins look up alike.
#[derive(Clone, Copy)]
struct Common {
    /// K_V.
    factor: f64,
    /// X_Kr.
    effect: f64,
}

impl Common {
    fn new(params: &Params, inputs: &Inputs) -> Self {
        let sideslip = Beta(inputs.flow.beta_rad.abs());
        let fuselage = params.fuselage_sidewash.at(
            Flap::new(inputs.flap_rad),
            MastTilt(inputs.mast_tilt_rad),
            Alpha(inputs.flow.alpha_rad),
            sideslip,
        );
        Self {
            factor: params.rotor_sidewash.at(Airspeed(inputs.flow.speed_mps), sideslip) * fuselage,
            effect: params.rudder_by_mach.at(Mach(inputs.mach)),
        }
    }

    /// The arguments that lead to it, as bits.
    fn arguments(inputs: &Inputs) -> [u64; 6] {
        let LocalFlow { alpha_rad, beta_rad, speed_mps, .. } = inputs.flow;
        [inputs.mast_tilt_rad, inputs.flap_rad, inputs.mach, alpha_rad, beta_rad.abs(), speed_mps]
            .map(f64::to_bits)
    }
}

/// Loads of both fins, each as of a right one. What is equal for both is looked up once.
pub fn evaluate_both(params: &Params, inputs: Pair<Inputs>) -> Pair<Load> {
    let left = Common::new(params, &inputs.left);
    let alike = Common::arguments(&inputs.left) == Common::arguments(&inputs.right);
    let right = if alike { left } else { Common::new(params, &inputs.right) };
    Pair { left: load(params, &inputs.left, left), right: load(params, &inputs.right, right) }
}

/// Load of the right fin.
pub fn evaluate(params: &Params, inputs: &Inputs) -> Load {
    load(params, inputs, Common::new(params, inputs))
}

/// How the air passes a fin.
struct Passing {
    /// atan2(V, U_W).
    flow_rad: f64,
    /// U_W, below zero from astern.
    along_mps: f64,
    /// Of x and z to the flow in the plane of symmetry: ahead, or astern.
    chord_s_per_m: f64,
}

impl Passing {
    fn new(velocity: Vec3<Body>) -> Self {
        let in_plane_mps = sqrt(square(velocity.x) + square(velocity.z));
        // Up to 60° it is 1: so much is known without the angle.
        let straight = velocity.x > 0.0 && velocity.z.abs() < 1.66 * velocity.x;
        let forward = if straight { 1.0 } else { ahead(atan2(velocity.z, velocity.x)) };
        let along_mps = forward * in_plane_mps;
        let way = if forward < 0.0 { -1.0 } else { 1.0 };
        Self {
            flow_rad: atan2(velocity.y, along_mps),
            along_mps,
            chord_s_per_m: way / max(in_plane_mps, 1e-3),
        }
    }
}

fn load(params: &Params, inputs: &Inputs, Common { factor, effect }: Common) -> Load {
    let arm = params.centre_m.from_cg(inputs.motion.cg_m);
    let own = inputs.motion.velocity_at(arm);
    let velocity = own + inputs.wake_mps;
    let Passing { flow_rad, chord_s_per_m, .. } = Passing::new(velocity);
    let along_mps = Passing::new(own).along_mps;
    let free_rad = Passing::new(inputs.motion.airspeed_mps).flow_rad;

    let speed_mps = max(own.x.abs(), params.sidewash_speed_mps_min);
    let direction = if own.x < 0.0 { -1.0 } else { 1.0 };
    let roll = inputs.motion.angular_rate_radps.x * params.wing_span_m / (2.0 * speed_mps);
    let beta = flow_rad - direction * params.sidewash_by_roll_rate * roll;

    let loss = max(0.0, inputs.rudder_rad.abs() / RUDDER_FULL_RAD - 1.0);
    let slow_fin = params.slow_side_force(beta, 0.0);
    let slow_rudder = params.slow_side_force(beta, inputs.rudder_rad) - slow_fin;
    let fin = params.side_force_by_mach.odd_at(inputs.mach, Beta(beta), slow_fin);
    let slow_free = params.slow_side_force(free_rad, 0.0);
    let free_fin = params.side_force_by_mach.odd_at(inputs.mach, Beta(free_rad), slow_free);
    let fast_rudder = params.lift_slope_per_rad * effect * params.rudder_effect * inputs.rudder_rad;
    let (s, c) = sin_cos(flow_rad);
    let fast = ramp(inputs.mach, 0.2, 0.4) * max(0.0, c);
    let rudder = slow_rudder + fast * (fast_rudder - slow_rudder);
    let kept_off = 1.0 - factor;
    let side = fin - kept_off * free_fin + rudder;
    let rudder_turn_rad =
        (effect - params.rudder_loss * loss) * params.rudder_effect * inputs.rudder_rad;
    let drag_at = |beta_rad: f64| {
        let angle = Beta((beta_rad + rudder_turn_rad).abs());
        params.drag_by_mach.at(inputs.mach, angle, params.drag.at(angle))
    };
    let drag = drag_at(beta) - kept_off * drag_at(free_rad);

    let pressure_area = 0.5
        * inputs.motion.density_kg_per_m3
        * inputs.pressure_ratio
        * (square(along_mps) + square(own.y))
        * params.area_m2;
    let chordwise_n = pressure_area * (side * s - drag * c);
    let force = Vec3::new(
        chordwise_n * velocity.x * chord_s_per_m,
        -pressure_area * (side * c + drag * s),
        chordwise_n * velocity.z * chord_s_per_m,
    );
    load_at(force, arm, 0.0)
}

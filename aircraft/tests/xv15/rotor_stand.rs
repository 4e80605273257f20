//! A test stand: one right rotor alone, settled.

use engine::frames::Vec3;
use engine::math::{PI, square};
use engine::motion::Motion;
use engine::rotors::{self, Inputs, Outputs, Params, State};
use engine::units::DEGREE_RAD as DEG;

pub const DENSITY: f64 = engine::isa::DENSITY_SL_KG_PER_M3;

/// Ticks until nothing changes any more: twelve seconds.
const SETTLING: usize = 3_000;

/// A rotor that has settled.
pub struct Run {
    pub inputs: Inputs,
    pub state: State,
    pub out: Outputs,
    pub c_t: f64,
    pub c_p: f64,
}

/// Far from the ground, at sea level.
pub fn hovering(rpm: f64, collective_rad: f64) -> Inputs {
    Inputs {
        motion: Motion {
            cg_m: Vec3::new(7.65, 0.0, 2.074),
            airspeed_mps: Vec3::zero(),
            angular_rate_radps: Vec3::zero(),
            density_kg_per_m3: DENSITY,
        },
        sound_speed_mps: engine::isa::SOUND_SPEED_SL_MPS,
        mast_tilt_rad: 0.0,
        mast_tilt_rate_radps: 0.0,
        rotor_speed_radps: rpm * PI / 30.0,
        collective_rad,
        cyclic_forward_rad: 0.0,
        cyclic_outboard_rad: 0.0,
        hub_height_m: 1e9,
        other_induced_mps: 0.0,
    }
}

/// The rotor under these inputs, moved every tick by `trim` to where it is wanted.
pub fn trimmed(
    params: &Params,
    inputs: Inputs,
    mut trim: impl FnMut(&mut Inputs, &Outputs),
) -> Run {
    let (blade, mut inputs) = (params.blade(), inputs);
    let (mut state, mut out) = (State::default(), Outputs::default());
    for _ in 0..SETTLING {
        (state, out) = rotors::evaluate(params, &blade, &state, &inputs);
        trim(&mut inputs, &out);
    }
    let c_t = out.thrust_coefficient;
    let tip_mps = inputs.rotor_speed_radps * params.radius_m;
    let disc_n = inputs.motion.density_kg_per_m3 * params.disc_area_m2() * square(tip_mps);
    Run { inputs, state, out, c_t, c_p: out.power_w / (disc_n * tip_mps) }
}

/// The rotor under these inputs.
pub fn settled(params: &Params, inputs: Inputs) -> Run {
    trimmed(params, inputs, |_, _| ())
}

/// The hover with this thrust coefficient, below the stall.
pub fn hover_at(params: &Params, rpm: f64, c_t: f64) -> Run {
    let (mut low, mut high) = (-5.0 * DEG, 17.0 * DEG);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if settled(params, hovering(rpm, middle)).c_t < c_t {
            low = middle;
        } else {
            high = middle;
        }
    }
    settled(params, hovering(rpm, low))
}

//! One rotor in steady flight, in two forms written here once more: their equations, where they stand still, and how they
//! answer. [`equations`] has the forms, [`answers`] where they stand still and how they answer; [`engine_rotor`] has the answer of the rotor that flies.

mod answers;
mod engine_rotor;
mod equations;
pub use answers::Steady;
pub use engine_rotor::Ticks;

use analysis::trim::Trim;
use engine::Aircraft;
use engine::frames::{Body, Vec3};
use engine::math::{sqrt, square};
use engine::motion::Motion;
use engine::rotors::blade::Blade;
use engine::rotors::elements::Flow;
use engine::rotors::{self, Params, flapping, other_rotor};

/// Which equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The cheaper one: gimbal and blades as springs in series, the blade a straight line.
    InSeries,
    /// The one that flies: gimbal with the hub's inertia, elastic blades with states of their own.
    Elastic,
}

/// What goes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    CyclicForward,
    Collective,
    PitchRate,
}

/// What comes out. `Shear` is the thrust that the mast feels: without what accelerates the blades.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    Thrust,
    Torque,
    Forward,
    TiltAft,
    TiltOutboard,
    Coning,
    Pitching,
    Shear,
}

const OUTPUTS: usize = Output::Shear as usize + 1;
const INPUTS: usize = Input::PitchRate as usize + 1;

/// First elastic frequency, per rev, at this rotor speed, rad/s.
const ELASTIC: (f64, f64) = (1.85, 458.0 * std::f64::consts::PI / 30.0);

/// φ/R and its slope by x = r/R: a cantilever under an even load, 1 at the tip.
fn shape(x: f64) -> (f64, f64) {
    (
        (6.0 * x * x - 4.0 * x * x * x + x * x * x * x) / 3.0,
        4.0 * x - 4.0 * x * x + 4.0 / 3.0 * x * x * x,
    )
}

/// M_γq, M_qq and C_qq in parts of I_b, ∫m·φ in parts of I_b/R; mass spread evenly.
struct Modal {
    gimbal: f64,
    own: f64,
    stiffened: f64,
    shear: f64,
}

impl Modal {
    fn new() -> Self {
        let steps = 2000;
        let (mut modal, mut slope2) =
            (Self { gimbal: 0.0, own: 0.0, stiffened: 0.0, shear: 0.0 }, 0.0);
        for i in 0..steps {
            let x = (f64::from(i) + 0.5) / f64::from(steps);
            let mass = 3.0 / f64::from(steps);
            let (phi, slope) = shape(x);
            let half = 0.5 * slope * slope / f64::from(steps);
            slope2 += half;
            modal.gimbal += mass * x * phi;
            modal.own += mass * phi * phi;
            modal.stiffened += mass * x * slope2;
            modal.shear += mass * phi;
            slope2 += half;
        }
        modal
    }
}

/// A right rotor in steady flight.
pub struct Rotor {
    params: Params,
    blade: Blade,
    modal: Modal,
    pub omega_radps: f64,
    flow: Flow,
    collective_rad: f64,
    cyclic_rad: [f64; 2],
    start: rotors::State,
    /// As the engine's rotor is asked.
    inputs: rotors::Inputs,
    /// What the engine says of it.
    pub engine: rotors::Outputs,
}

impl Rotor {
    /// The right one of a trim.
    pub fn of(aircraft: &Aircraft, found: &Trim) -> Self {
        let (params, plant) = (&aircraft.rotors, &found.state.plant);
        let surfaces = &found.state.actuators;
        let mast = params.mast(surfaces.mast_tilt_rad.right);
        let axis = mast.thrust_axis;
        let forward = Vec3::<Body>::new(mast.cos_tilt, 0.0, mast.sin_tilt);
        let right = (-axis).cross(forward);
        let velocity = plant.attitude.ned_from_body().inverse() * plant.velocity_mps;
        let hub = params.hub_from_cg(found.outputs.balance.cg_m, &mast);
        let mut flow = Flow {
            omega_radps: plant.rotor_speed_radps,
            forward_mps: velocity.dot(forward),
            right_mps: velocity.dot(right),
            along_mps: velocity.dot(axis),
            density_kg_per_m3: found.outputs.air.density_kg_per_m3,
            sound_speed_mps: found.outputs.air.sound_speed_mps,
        };
        let of_other =
            other_rotor::factor(&params.other_rotor, &flow, 2.0 * hub.y, params.radius_m);
        let other_induced_mps = plant.rotors.left.inflow.mean_mps;
        flow.along_mps += of_other * other_induced_mps;
        let inputs = rotors::Inputs {
            motion: Motion {
                cg_m: found.outputs.balance.cg_m,
                airspeed_mps: velocity,
                angular_rate_radps: Vec3::zero(),
                density_kg_per_m3: flow.density_kg_per_m3,
            },
            sound_speed_mps: flow.sound_speed_mps,
            mast_tilt_rad: surfaces.mast_tilt_rad.right,
            mast_tilt_rate_radps: 0.0,
            rotor_speed_radps: plant.rotor_speed_radps,
            collective_rad: surfaces.collective_rad.right,
            cyclic_forward_rad: surfaces.cyclic_forward_rad.right,
            cyclic_outboard_rad: surfaces.cyclic_outboard_rad.right,
            hub_height_m: 1e9,
            other_induced_mps,
        };
        Self {
            inputs,
            params: params.clone(),
            blade: params.blade(),
            modal: Modal::new(),
            omega_radps: plant.rotor_speed_radps,
            flow,
            collective_rad: surfaces.collective_rad.right,
            cyclic_rad: [surfaces.cyclic_forward_rad.right, surfaces.cyclic_outboard_rad.right],
            start: plant.rotors.right,
            engine: found.outputs.rotors.right,
        }
    }

    /// K_q/I_b.
    fn bending_per_s2(&self) -> f64 {
        let (per_rev, radps) = ELASTIC;
        square(radps) * (square(per_rev) * self.modal.own - self.modal.stiffened)
    }

    /// The blade's elastic frequency.
    pub fn coning_radps(&self) -> f64 {
        let stiffness = self.bending_per_s2() + square(self.omega_radps) * self.modal.stiffened;
        sqrt(stiffness / self.modal.own)
    }

    /// λ of S·v = λ·M·v for the tilt, rad²/s².
    pub fn cyclic_per_s2(&self) -> [f64; 2] {
        let params = &self.params.flapping;
        let (m, omega2) = (&self.modal, square(self.omega_radps));
        let hub = self.params.hub_inertia_kg_m2() / 1.5 / params.blade_inertia_kg_m2;
        let spring = params.hub_spring_n_m_per_rad / 1.5 / params.blade_inertia_kg_m2;
        let elastic = self.bending_per_s2() + omega2 * (m.stiffened - m.own);
        // (S_γ − λ·M_γγ)·(S_q − λ·M_qq) = λ²·M_γq²
        let a = (1.0 + hub) * m.own - square(m.gimbal);
        let b = spring * m.own + elastic * (1.0 + hub);
        let root = sqrt(square(b) - 4.0 * a * spring * elastic);
        [(b - root) / (2.0 * a), (b + root) / (2.0 * a)]
    }

    /// Begins with blades that are straight lines from a gimbal at rest.
    pub fn straighten(&mut self) {
        let coning_rad = self.params.flapping.precone_rad;
        self.start.flapping = flapping::State { coning_rad, ..flapping::State::default() };
    }

    /// Takes the air away, at another rotor speed.
    pub fn in_vacuum(&mut self, omega_radps: f64) {
        (self.omega_radps, self.flow.omega_radps) = (omega_radps, omega_radps);
        self.inputs.rotor_speed_radps = omega_radps;
        self.flow.density_kg_per_m3 = 1e-9;
        self.inputs.motion.density_kg_per_m3 = 1e-9;
    }

    fn size(form: Form) -> usize {
        match form {
            Form::InSeries => 9,
            Form::Elastic => 13,
        }
    }

    /// Where it begins: the engine's state. x: inflow, coning, then tilts a and b with their rates.
    fn guess(&self, form: Form) -> Vec<f64> {
        let (v, f) = (&self.start.inflow, &self.start.flapping);
        let mut x = vec![v.mean_mps, v.aft_mps, v.right_mps];
        if form == Form::InSeries {
            x.extend([f.coning_rad, f.coning_radps]);
            x.extend([f.aft_rad, f.aft_radps, f.right_rad, f.right_radps]);
        } else {
            x.extend([f.coning_rad - self.params.flapping.precone_rad, 0.0]);
            let (aft_rad, right_rad) = (f.elastic_aft_rad, f.elastic_right_rad);
            x.extend([f.aft_rad - aft_rad, 0.0, f.right_rad - right_rad, 0.0]);
            x.extend([aft_rad, 0.0, right_rad, 0.0]);
        }
        x
    }
}

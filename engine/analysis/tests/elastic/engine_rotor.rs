//! The rotor that flies, tick by tick, beside the full form taken in ticks of the same rule.

use engine::STEP_S;
use engine::frames::{Body, Vec3};
use engine::rotors::elements::BladeLoads;
use engine::rotors::flapping::{Damping, Moment};
use engine::rotors::{self, flapping, inflow};
use nalgebra::DMatrix;

use super::answers::{Steady, respond};
use super::{INPUTS, Input, OUTPUTS, Output, Rotor};

/// Numbers of a rotor's state.
const SIZE: usize = 13;

fn numbers(state: &rotors::State) -> [f64; SIZE] {
    let (v, f) = (&state.inflow, &state.flapping);
    [
        v.mean_mps,
        v.aft_mps,
        v.right_mps,
        f.coning_rad,
        f.coning_radps,
        f.aft_rad,
        f.aft_radps,
        f.right_rad,
        f.right_radps,
        f.elastic_aft_rad,
        f.elastic_aft_radps,
        f.elastic_right_rad,
        f.elastic_right_radps,
    ]
}

fn state(x: &[f64; SIZE]) -> rotors::State {
    rotors::State {
        inflow: inflow::State { mean_mps: x[0], aft_mps: x[1], right_mps: x[2] },
        flapping: flapping::State {
            coning_rad: x[3],
            coning_radps: x[4],
            aft_rad: x[5],
            aft_radps: x[6],
            right_rad: x[7],
            right_radps: x[8],
            elastic_aft_rad: x[9],
            elastic_aft_radps: x[10],
            elastic_right_rad: x[11],
            elastic_right_radps: x[12],
        },
    }
}

impl Rotor {
    /// The engine's rotor a tick later, and what it gives.
    fn tick(&self, x: &[f64; SIZE], u: &[f64; INPUTS]) -> ([f64; SIZE], [f64; OUTPUTS]) {
        let mut inputs = self.inputs;
        inputs.collective_rad += u[Input::Collective as usize];
        inputs.cyclic_forward_rad += u[Input::CyclicForward as usize];
        let mast = self.params.mast(inputs.mast_tilt_rad);
        let axis = mast.thrust_axis;
        let forward = Vec3::<Body>::new(mast.cos_tilt, 0.0, mast.sin_tilt);
        let right = (-axis).cross(forward);
        let arm_m = self.params.hub_from_cg(inputs.motion.cg_m, &mast);
        // The hub turns and goes nowhere.
        inputs.motion.angular_rate_radps = right * u[Input::PitchRate as usize];
        inputs.motion.airspeed_mps =
            inputs.motion.airspeed_mps - inputs.motion.angular_rate_radps.cross(arm_m);
        let (next, out) = rotors::evaluate(&self.params, &self.blade, &state(x), &inputs);
        let force = out.load.force_n;
        let moment = out.load.moment_n_m - arm_m.cross(force);
        let mut y = [0.0; OUTPUTS];
        y[Output::Thrust as usize] = out.thrust_n;
        y[Output::Torque as usize] = out.torque_n_m;
        y[Output::Forward as usize] = force.dot(forward);
        y[Output::TiltAft as usize] = out.tilt_aft_rad;
        y[Output::TiltOutboard as usize] = out.tilt_outboard_rad;
        y[Output::Coning as usize] = out.coning_rad;
        y[Output::Pitching as usize] = moment.dot(right);
        y[Output::Shear as usize] = force.dot(axis);
        (numbers(&next), y)
    }

    /// The engine's rotor once it stands still, after 20 s.
    pub fn flown(&self) -> Ticks {
        let mut x = numbers(&self.start);
        for _ in 0..5000 {
            x = self.tick(&x, &[0.0; INPUTS]).0;
        }
        let (map, c) = self.tick_slopes(&x, false);
        let (by_input, d) = self.tick_slopes(&x, true);
        Ticks { y: self.tick(&x, &[0.0; INPUTS]).1, map, by_input, c, d }
    }

    fn tick_slopes(&self, x: &[f64; SIZE], by_input: bool) -> (DMatrix<f64>, DMatrix<f64>) {
        let count = if by_input { INPUTS } else { SIZE };
        let (mut map, mut outputs) = (DMatrix::zeros(SIZE, count), DMatrix::zeros(OUTPUTS, count));
        for column in 0..count {
            let moved = |by: f64| {
                let (mut x, mut u) = (*x, [0.0; INPUTS]);
                if by_input {
                    u[column] += by;
                } else {
                    x[column] += by;
                }
                self.tick(&x, &u)
            };
            let step = 1e-5;
            let (above, below) = (moved(step), moved(-step));
            for row in 0..SIZE {
                map[(row, column)] = (above.0[row] - below.0[row]) / (2.0 * step);
            }
            for row in 0..OUTPUTS {
                outputs[(row, column)] = (above.1[row] - below.1[row]) / (2.0 * step);
            }
        }
        (map, outputs)
    }

    /// The full form in ticks: ẋ of the inflow as it is, flapping by the midpoint rule, in which the air's part is D alone.
    pub fn in_ticks(&self, steady: &Steady) -> Ticks {
        let (n, flapping) = (SIZE, SIZE - 3);
        let mut implicit = DMatrix::identity(n, n);
        let air = &steady.damping;
        let zero = self.implied(&[0.0; SIZE], air);
        for column in 3..n {
            let mut x = [0.0; SIZE];
            x[column] = 1.0;
            let rates = self.implied(&x, air);
            for row in 0..flapping {
                implicit[(3 + row, column)] -= 0.5 * STEP_S * (rates[row] - zero[row]);
            }
        }
        let inverse = implicit.try_inverse().unwrap_or_else(|| panic!("a tick without an end"));
        let rates = (&inverse * &steady.a, &inverse * &steady.b);
        let (mut c, mut d) = (steady.c.clone(), steady.d.clone());
        // Of the thrust, what accelerates the blades over the tick.
        let params = &self.params;
        let mass_kg = params.blade.count * params.flapping.blade_inertia_kg_m2 / params.radius_m
            * self.modal.shear;
        let (thrust, shear) = (Output::Thrust as usize, Output::Shear as usize);
        for (output, rates) in [(&mut c, &rates.0), (&mut d, &rates.1)] {
            let row = output.row(thrust) - rates.row(4) * mass_kg;
            output.set_row(shear, &row);
        }
        Ticks {
            y: steady.y,
            map: DMatrix::identity(n, n) + rates.0 * STEP_S,
            by_input: rates.1 * STEP_S,
            c,
            d,
        }
    }

    /// Rates of the flapping when all that the air does is D.
    fn implied(&self, x: &[f64; SIZE], air: &Damping) -> Vec<f64> {
        let omega = self.omega_radps;
        // Around the turn, with cos ψ and with sin ψ, in a shape that begins there.
        let rates = |aft: usize| (x[aft + 1] + omega * x[aft + 2], x[aft + 3] - omega * x[aft]);
        let (tilting, bending) = (rates(5), rates(9));
        let moment = |of_tilting: f64, of_bending: f64, of_coning: f64| Moment {
            mean_n_m: -of_coning * x[4],
            cos_n_m: of_tilting * tilting.0 + of_bending * bending.0,
            sin_n_m: of_tilting * tilting.1 + of_bending * bending.1,
        };
        let sums = BladeLoads {
            straight: moment(air.straight_n_m_s, air.coupled_n_m_s, 0.0),
            elastic: moment(air.coupled_n_m_s, air.elastic_n_m_s, air.elastic_n_m_s),
            ..BladeLoads::default()
        };
        let mut rate = Vec::new();
        self.elastic(x, 0.0, &sums, &mut rate, &mut [0.0; OUTPUTS]);
        rate
    }
}

/// A rotor in ticks and its answers to small inputs.
pub struct Ticks {
    y: [f64; OUTPUTS],
    map: DMatrix<f64>,
    by_input: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

impl Ticks {
    /// What it gives.
    pub fn output(&self, output: Output) -> f64 {
        self.y[output as usize]
    }

    /// C·(z − J)⁻¹·B + D at z = e^{iωh}.
    pub fn response(&self, input: Input, output: Output, omega_radps: f64) -> (f64, f64) {
        let (s, c) = engine::math::sin_cos(omega_radps * STEP_S);
        let z = (c, s);
        respond(&self.map, &self.by_input, (&self.c, &self.d), (input, output), z)
    }

    /// Roots of the motion that this map takes a tick of by the midpoint rule, rad/s: 2/h·(z − 1)/(z + 1).
    pub fn roots(&self) -> Vec<(f64, f64)> {
        let one = DMatrix::identity(SIZE, SIZE);
        let after = (&self.map + &one).try_inverse().unwrap_or_else(|| panic!("a root at -1"));
        let motion = (&self.map - &one) * after * (2.0 / STEP_S);
        motion.complex_eigenvalues().iter().map(|root| (root.re, root.im)).collect()
    }
}

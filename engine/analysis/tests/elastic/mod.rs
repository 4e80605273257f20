//! One rotor in steady flight, in two forms written here once more: their equations, where they stand still, and how they
//! answer. [`engine_rotor`] has the answer of the rotor that flies.

mod engine_rotor;
pub use engine_rotor::Ticks;

use analysis::trim::Trim;
use engine::Aircraft;
use engine::STEP_S;
use engine::frames::{Body, Vec3};
use engine::math::{max, sqrt, square};
use engine::motion::Motion;
use engine::rotors::blade::{Blade, STATIONS};
use engine::rotors::elements::{BladeLoads, Flow, Induced, Pitch, elements};
use engine::rotors::flapping::{Curve, Damping, Harmonics};
use engine::rotors::{self, Params, flapping, inflow, other_rotor};
use nalgebra::{DMatrix, DVector};

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

/// K_b of the form in series, N m/rad: that frequency with the blade as a straight line.
const BLADE_SPRING: f64 = 773e3;

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

    /// What the air does to the blades: all sums, and F_q as mean, cosine and sine.
    fn air(&self, form: Form, x: &[f64], u: &[f64; INPUTS]) -> (BladeLoads, Induced) {
        let precone_rad = self.params.flapping.precone_rad;
        let tan_delta3 = self.blade.tan_delta3;
        let state = inflow::State { mean_mps: x[0], aft_mps: x[1], right_mps: x[2] };
        let passage = inflow::disc_flow(&state, &self.flow);
        let collective_rad = self.collective_rad + u[Input::Collective as usize];
        let turn = engine::math::sin_cos(collective_rad);
        let induced = inflow::induced(
            &self.params.inflow,
            &state,
            &passage,
            &self.flow,
            &self.blade,
            (turn, self.params.blade.count),
            (1.0, self.params.radius_m),
        );
        let gimbal = match form {
            Form::InSeries => {
                let share = self.in_series_share();
                [share * x[5], share * x[7]]
            }
            Form::Elastic => [x[5], x[7]],
        };
        let pitch = Pitch {
            collective_rad,
            forward_rad: self.cyclic_rad[0] + u[Input::CyclicForward as usize]
                - tan_delta3 * gimbal[1],
            right_rad: self.cyclic_rad[1] - tan_delta3 * gimbal[0],
        };
        if form == Form::InSeries {
            let sums =
                elements(&self.blade, &self.flow, &pitch, &straight(flapping_of(x)), &induced);
            return (sums, induced);
        }
        let mut all = BladeLoads::default();
        for i in 0..STATIONS {
            let norm = self.blade.stations[i].radius_m / self.params.radius_m;
            let (phi, slope) = shape(norm);
            let part = phi / norm;
            let omega = self.flow.omega_radps;
            let place = |tilt: usize, bent: usize| x[tilt] + part * x[bent];
            let leans = |tilt: usize, bent: usize| x[tilt] + slope * x[bent];
            let (aft, right) = (place(5, 9), place(7, 11));
            let (aft_slope, right_slope) = (leans(5, 9), leans(7, 11));
            // Slopes tilt the forces; what the air meets are the velocities of the place itself.
            let flap = Harmonics {
                mean_rad: precone_rad + slope * x[3],
                mean_radps: part * x[4],
                aft_rad: aft_slope,
                aft_radps: place(6, 10) + omega * (right - right_slope),
                right_rad: right_slope,
                right_radps: place(8, 12) - omega * (aft - aft_slope),
            };
            let mut alone = self.blade;
            for (j, station) in alone.stations.iter_mut().enumerate() {
                if j != i {
                    station.area_m2 = 0.0;
                }
            }
            let sums = elements(&alone, &self.flow, &pitch, &straight(flap), &induced);
            add(&mut all, &sums, part);
        }
        (all, induced)
    }

    /// What of the tilt is the gimbal's when blades and gimbal are springs in series.
    fn in_series_share(&self) -> f64 {
        let blades = 1.5 * BLADE_SPRING;
        blades / (blades + self.params.flapping.hub_spring_n_m_per_rad)
    }

    /// ẋ and y.
    fn equations(&self, form: Form, x: &[f64], u: &[f64; INPUTS]) -> (Vec<f64>, [f64; OUTPUTS]) {
        let (sums, _) = self.air(form, x, u);
        let blades = self.params.blade.count;
        let state = inflow::State { mean_mps: x[0], aft_mps: x[1], right_mps: x[2] };
        let forcing = inflow::DiscLoads {
            thrust_n: blades * sums.up_n,
            aft_n_m: 0.5 * blades * sums.straight.cos_n_m,
            right_n_m: 0.5 * blades * sums.straight.sin_n_m,
        };
        let passage = inflow::disc_flow(&state, &self.flow);
        let radius_m = self.params.radius_m;
        let next = inflow::advance(&state, &passage, &self.flow, &forcing, radius_m);
        let mut rate = vec![
            (next.mean_mps - state.mean_mps) / STEP_S,
            (next.aft_mps - state.aft_mps) / STEP_S,
            (next.right_mps - state.right_mps) / STEP_S,
        ];
        let mut y = [0.0; OUTPUTS];
        y[Output::Thrust as usize] = blades * sums.up_n;
        y[Output::Torque as usize] = blades * sums.torque_n_m;
        y[Output::Forward as usize] = blades * sums.forward_n;
        let hub_pitch_radps = u[Input::PitchRate as usize];
        if form == Form::InSeries {
            self.in_series(x, hub_pitch_radps, &sums, &mut rate, &mut y);
        } else {
            self.elastic(x, hub_pitch_radps, &sums, &mut rate, &mut y);
        }
        (rate, y)
    }

    fn in_series(
        &self,
        x: &[f64],
        pitch_radps: f64,
        sums: &BladeLoads,
        rate: &mut Vec<f64>,
        y: &mut [f64; OUTPUTS],
    ) {
        let params = &self.params.flapping;
        let (blade, omega) = (params.blade_inertia_kg_m2, self.omega_radps);
        let per = 1.0 / blade;
        let moment_n_m_per_rad = self.in_series_share() * params.hub_spring_n_m_per_rad;
        let (pitching_n_m, rolling_n_m) = (moment_n_m_per_rad * x[5], moment_n_m_per_rad * x[7]);
        let bending = per * BLADE_SPRING;
        let coning = bending * (params.precone_rad - x[3]) - square(omega) * x[3]
            + per * sums.straight.mean_n_m;
        rate.extend([x[4], coning]);
        let per = 1.0 / (blade + self.params.hub_inertia_kg_m2() / 1.5);
        let spring = per / 1.5;
        rate.extend([
            x[6] - pitch_radps,
            -2.0 * omega * x[8] - spring * pitching_n_m - per * sums.straight.cos_n_m,
            x[8],
            2.0 * omega * x[6] - spring * rolling_n_m - per * sums.straight.sin_n_m,
        ]);
        y[Output::TiltAft as usize] = x[5];
        y[Output::TiltOutboard as usize] = x[7];
        y[Output::Coning as usize] = x[3];
        y[Output::Pitching as usize] = pitching_n_m;
        let swung_n = self.params.blade.count * 1.5 * blade / self.params.radius_m * coning;
        y[Output::Shear as usize] = y[Output::Thrust as usize] - swung_n;
    }

    fn elastic(
        &self,
        x: &[f64],
        pitch_radps: f64,
        sums: &BladeLoads,
        rate: &mut Vec<f64>,
        y: &mut [f64; OUTPUTS],
    ) {
        let params = &self.params.flapping;
        let (inertia, omega) = (params.blade_inertia_kg_m2, self.omega_radps);
        let of = &self.modal;
        let m_gg = inertia + self.params.hub_inertia_kg_m2() / 1.5;
        let (m_gq, m_qq) = (inertia * of.gimbal, inertia * of.own);
        let bending = inertia * self.bending_per_s2();
        let stiffened = inertia * of.stiffened * square(omega);

        let coning = (sums.elastic.mean_n_m
            - (bending + stiffened) * x[3]
            - square(omega) * m_gq * params.precone_rad)
            / m_qq;
        rate.extend([x[4], coning]);
        // M·(ẇ − 2iΩw) = −S·z − F, in a and in b.
        let spring = params.hub_spring_n_m_per_rad / 1.5;
        let elastic = bending + stiffened - square(omega) * m_qq;
        let solve = |gimbal: f64, bent: f64| {
            let determinant = m_gg * m_qq - m_gq * m_gq;
            (
                (m_qq * gimbal - m_gq * bent) / determinant,
                (m_gg * bent - m_gq * gimbal) / determinant,
            )
        };
        let (aft, aft_bent) =
            solve(-spring * x[5] - sums.straight.cos_n_m, -elastic * x[9] - sums.elastic.cos_n_m);
        let (right, right_bent) =
            solve(-spring * x[7] - sums.straight.sin_n_m, -elastic * x[11] - sums.elastic.sin_n_m);
        rate.extend([x[6] - pitch_radps, aft - 2.0 * omega * x[8]]);
        rate.extend([x[8], right + 2.0 * omega * x[6]]);
        rate.extend([x[10], aft_bent - 2.0 * omega * x[12]]);
        rate.extend([x[12], right_bent + 2.0 * omega * x[10]]);
        y[Output::TiltAft as usize] = x[5] + x[9];
        y[Output::TiltOutboard as usize] = x[7] + x[11];
        y[Output::Coning as usize] = params.precone_rad + x[3];
        y[Output::Pitching as usize] = params.hub_spring_n_m_per_rad * x[5];
        let blades = self.params.blade.count;
        let swung_n = blades * inertia / self.params.radius_m * of.shear * coning;
        y[Output::Shear as usize] = y[Output::Thrust as usize] - swung_n;
    }

    /// Slopes of ẋ and y by x and u.
    fn slopes(&self, form: Form, x: &[f64], by_input: bool) -> (DMatrix<f64>, DMatrix<f64>) {
        let (n, count) = (x.len(), if by_input { INPUTS } else { x.len() });
        let (mut rates, mut outputs) = (DMatrix::zeros(n, count), DMatrix::zeros(OUTPUTS, count));
        for column in 0..count {
            let moved = |by: f64| {
                let (mut x, mut u) = (x.to_vec(), [0.0; INPUTS]);
                if by_input {
                    u[column] += by;
                } else {
                    x[column] += by;
                }
                self.equations(form, &x, &u)
            };
            let step = 1e-6;
            let (above, below) = (moved(step), moved(-step));
            for row in 0..n {
                rates[(row, column)] = (above.0[row] - below.0[row]) / (2.0 * step);
            }
            for row in 0..OUTPUTS {
                outputs[(row, column)] = (above.1[row] - below.1[row]) / (2.0 * step);
            }
        }
        (rates, outputs)
    }

    /// Where the form stands still under the trim's controls, by Newton's method.
    pub fn steady(&self, form: Form) -> Steady {
        let mut x = self.guess(form);
        assert_eq!(x.len(), Self::size(form));
        for _ in 0..50 {
            let (rates, _) = self.slopes(form, &x, false);
            let still = DVector::from_vec(self.equations(form, &x, &[0.0; INPUTS]).0);
            let step = rates.lu().solve(&still).unwrap_or_else(|| panic!("no steady rotor"));
            for (x, step) in x.iter_mut().zip(step.iter()) {
                *x -= step;
            }
            if step.amax() < 1e-11 {
                break;
            }
        }
        let (rate, y) = self.equations(form, &x, &[0.0; INPUTS]);
        let off = rate.iter().fold(0.0_f64, |most, rate| max(most, rate.abs()));
        assert!(off < 1e-6, "the rotor does not stand still: {off}");
        let ((a, c), (b, d)) = (self.slopes(form, &x, false), self.slopes(form, &x, true));
        let damping = self.air(form, &x, &[0.0; INPUTS]).0.damping;
        Steady { y, damping, a, b, c, d }
    }
}

fn flapping_of(x: &[f64]) -> Harmonics {
    Harmonics {
        mean_rad: x[3],
        mean_radps: x[4],
        aft_rad: x[5],
        aft_radps: x[6],
        right_rad: x[7],
        right_radps: x[8],
    }
}

/// Adds what the air does at one station, where the elastic shape has moved by that part of a straight line.
fn add(all: &mut BladeLoads, sums: &BladeLoads, part: f64) {
    all.up_n += sums.up_n;
    all.forward_n += sums.forward_n;
    all.right_n += sums.right_n;
    all.torque_n_m += sums.torque_n_m;
    for (whole, weight) in [(&mut all.straight, 1.0), (&mut all.elastic, part)] {
        whole.mean_n_m += weight * sums.straight.mean_n_m;
        whole.cos_n_m += weight * sums.straight.cos_n_m;
        whole.sin_n_m += weight * sums.straight.sin_n_m;
    }
    let lost = sums.damping.straight_n_m_s;
    all.damping.straight_n_m_s += lost;
    all.damping.coupled_n_m_s += part * lost;
    all.damping.elastic_n_m_s += part * part * lost;
}

/// A blade that is a straight line.
fn straight(flap: Harmonics) -> Curve {
    Curve { straight: flap, elastic: Harmonics::default() }
}

/// A steady rotor and its answers to small inputs.
pub struct Steady {
    y: [f64; OUTPUTS],
    /// D, of the full form.
    damping: Damping,
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    d: DMatrix<f64>,
}

impl Steady {
    /// What it gives.
    pub fn output(&self, output: Output) -> f64 {
        self.y[output as usize]
    }

    /// C·(iω − A)⁻¹·B + D, real and imaginary part.
    pub fn response(&self, input: Input, output: Output, omega_radps: f64) -> (f64, f64) {
        let at = (0.0, omega_radps);
        respond(&self.a, &self.b, (&self.c, &self.d), (input, output), at)
    }
}

/// C·(z − A)⁻¹·B + D, real and imaginary part.
fn respond(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    (c, d): (&DMatrix<f64>, &DMatrix<f64>),
    (input, output): (Input, Output),
    z: (f64, f64),
) -> (f64, f64) {
    let n = a.nrows();
    // (z − A)·(x + iy) = b in real numbers.
    let mut system = DMatrix::zeros(2 * n, 2 * n);
    system.view_mut((0, 0), (n, n)).copy_from(&-a);
    system.view_mut((n, n), (n, n)).copy_from(&-a);
    for i in 0..n {
        system[(i, i)] += z.0;
        system[(n + i, n + i)] += z.0;
        system[(i, n + i)] = -z.1;
        system[(n + i, i)] = z.1;
    }
    let (input, output) = (input as usize, output as usize);
    let mut right = DVector::zeros(2 * n);
    right.rows_mut(0, n).copy_from(&b.column(input));
    let x = system.lu().solve(&right).unwrap_or_else(|| panic!("a root on the axis"));
    let row = c.row(output);
    let part = |from: usize| (0..n).map(|i| row[i] * x[from + i]).sum::<f64>();
    (part(0) + d[(output, input)], part(n))
}

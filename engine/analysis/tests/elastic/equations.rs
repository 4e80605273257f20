//! The equations of both forms.

use engine::STEP_S;
use engine::math::square;
use engine::rotors::blade::STATIONS;
use engine::rotors::elements::{BladeLoads, Induced, Pitch, elements};
use engine::rotors::flapping::{Curve, Harmonics};
use engine::rotors::inflow;

use super::{Form, INPUTS, Input, OUTPUTS, Output, Rotor, shape};

/// K_b of the form in series, N m/rad: that frequency with the blade as a straight line.
const BLADE_SPRING: f64 = 773e3;

impl Rotor {
    /// What the air does to the blades: all sums, and F_q as mean, cosine and sine.
    pub(super) fn air(&self, form: Form, x: &[f64], u: &[f64; INPUTS]) -> (BladeLoads, Induced) {
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
    pub(super) fn equations(
        &self,
        form: Form,
        x: &[f64],
        u: &[f64; INPUTS],
    ) -> (Vec<f64>, [f64; OUTPUTS]) {
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

    pub(super) fn elastic(
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

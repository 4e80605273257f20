//! The airframe's tables: as printed, without jumps, the same on both sides, finite everywhere.

use engine::aero::polar::{ByFlap, ByMach, Flap, Polar};
use engine::aero::{local_flow, vertical_stabilizers};
use engine::frames::{Attitude, Euler, Load, Vec3};
use engine::inputs::World;
use engine::math::PI;
use engine::pair::Pair;
use engine::state::Plant;
use engine::symmetry::Mirror;
use engine::table::axis::{Airspeed, Alpha, Beta, ElevatorAngle, FlapAngle, MastTilt};
use engine::table::{Axis, Table1, Table2, Table3};
use engine::units::{DEGREE_RAD as DEG, KNOT_MPS as KT};
use engine::{Aircraft, Inputs, Outputs, State, actuators};

/// What the conversion to SI and back may lose.
const ROUNDING: f64 = 1e-9;

fn xv15() -> Aircraft {
    aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn reads(ours: f64, printed: f64) {
    assert!((ours - printed).abs() < ROUNDING, "{ours} is not {printed}");
}

/// Flaps up and full down the wing across the flow has the drag of the tunnel (CR176970 Table 4), not
/// that of the print: full down at the mean of flap and flaperon, 57 degrees, between its 50 and 60.
#[test]
fn val_drag_across_the_flow_is_the_tunnels_where_the_print_is_not_used() {
    let xv15 = xv15();
    let across = |flap: f64, alpha: f64| {
        xv15.wing_pylon.drag.drag_at(0.0, Flap::new(flap * DEG), 0.1, alpha * DEG)
    };
    for alpha in [-85.0, -90.0] {
        reads(across(0.0, alpha), 1.69);
        let full = across(75.0, alpha);
        assert!((1.09..1.21).contains(&full), "{full}");
    }
}

fn tilted(deg: f64) -> MastTilt {
    MastTilt(deg * DEG)
}

fn from_below(deg: f64) -> Alpha {
    Alpha(deg * DEG)
}

fn flying(kt: f64) -> Airspeed {
    Airspeed(kt * KT)
}

/// Points of the print, typed again by hand: corners, odd breakpoints, and columns easily confused.
#[test]
fn val_coefficients_at_tabulated_points_are_the_printed_ones() {
    let xv15 = xv15();
    let (lift, drag) = (&xv15.wing_pylon.lift, &xv15.wing_pylon.drag);
    type At = fn(&Polar, f64, Flap, f64, f64) -> f64;
    let at = |at: At, polar: &Polar, tilt: f64, flap: f64, mach: f64, alpha: f64| {
        at(polar, tilt * DEG, Flap::new(flap * DEG), mach, alpha * DEG)
    };
    for (tilt, flap, mach, alpha, printed) in [
        (0.0, 0.0, 0.1, -19.5, -0.88),
        (0.0, 20.0, 0.1, 13.6, 1.54),
        (0.0, 40.0, 0.1, -12.0, 0.0628),
        (0.0, 75.0, 0.1, 130.0, -0.829),
        (90.0, 0.0, 0.2, -15.5, -0.91),
        (90.0, 0.0, 0.4, -15.5, -0.945),
        (90.0, 0.0, 0.5, 12.0, 1.27),
        (90.0, 0.0, 0.6, 8.0, 1.09),
        (90.0, 20.0, 0.1, -21.5, -0.84),
        (90.0, 40.0, 0.6, 18.4, 1.62),
        (90.0, 75.0, 0.1, 0.0, 1.44),
    ] {
        reads(at(Polar::lift_at, lift, tilt, flap, mach, alpha), printed);
    }
    for (tilt, flap, mach, alpha, printed) in [
        (0.0, 0.0, 0.1, -120.0, 0.86),
        (0.0, 75.0, 0.1, -120.0, 0.83),
        (0.0, 20.0, 0.1, -90.0, 1.57),
        (0.0, 40.0, 0.1, -90.0, 1.44),
        (0.0, 40.0, 0.1, 150.0, 0.87),
        (90.0, 0.0, 0.1, 0.0, 0.0204),
        (90.0, 0.0, 0.4, -24.0, 0.312),
        (90.0, 0.0, 0.6, 12.0, 0.268),
        (90.0, 20.0, 0.1, -8.0, 0.033),
        (90.0, 75.0, 0.1, 40.0, 1.025),
    ] {
        reads(at(Polar::drag_at, drag, tilt, flap, mach, alpha), printed);
    }
    let tail = &xv15.horizontal_stabilizer;
    for (alpha, elevator, printed) in
        [(-15.6, -15.0, -1.38), (12.2, 20.0, 1.48), (4.0, 0.0, 0.284), (-170.0, 10.0, 1.1)]
    {
        reads(tail.lift.at(Alpha(alpha * DEG), ElevatorAngle(elevator * DEG)), printed);
    }
    reads(tail.lift_by_mach.odd_at(0.4, Alpha(-24.0 * DEG), -0.935), -0.90);
    let downwash_rad = tail.downwash_rad.at(tilted(60.0), from_below(8.0), FlapAngle(40.0 * DEG));
    reads(downwash_rad / DEG, 8.18);
    reads(tail.pressure_ratio.at(tilted(15.0), from_below(-4.0), flying(20.0)), 2.44);
    let wake = &xv15.rotor_wake;
    reads(wake.tail_ratio.at(tilted(0.0), from_below(-12.0), flying(80.0)), -1.13);
    reads(wake.tail_ratio.at(tilted(30.0), from_below(4.0), flying(80.0)), -0.60);
    reads(wake.sideslip_factor.at(Beta(24.0 * DEG), tilted(30.0)), 0.225);
    let fins = &xv15.vertical_stabilizers;
    for (beta, rudder, printed) in
        [(-18.0, -20.0, -1.3584), (18.0, 20.0, 1.3584), (-4.0, 0.0, -0.2125), (-170.0, 15.0, 0.73)]
    {
        reads(fins.slow_side_force(beta * DEG, rudder * DEG), printed);
    }
    reads(fins.rotor_sidewash.at(flying(40.0), Beta(0.0)), -0.5);
    for (flap, tilt, alpha, beta, printed) in [
        (0.0, 90.0, 13.0, 12.0, 0.622),
        (0.0, 30.0, 0.0, 2.0, 1.248),
        (20.0, 30.0, 13.0, 16.0, 0.50),
        (40.0, 0.0, -3.0, 8.0, 1.26),
        (40.0, 60.0, 7.0, 35.0, 0.908),
        (75.0, 0.0, -3.0, 0.0, 1.8),
        (75.0, 90.0, 28.0, 90.0, 1.0),
    ] {
        let flap = Flap::new(flap * DEG);
        let sidewash = &fins.fuselage_sidewash;
        reads(sidewash.at(flap, tilted(tilt), from_below(alpha), Beta(beta * DEG)), printed);
    }
}

/// Of what pylons across the flow add, the cube of the sine of their angle to it is left: at 60° of
/// mast tilt sin³30°, an eighth; nothing as an aeroplane, all of it upright.
#[test]
fn the_pylons_drag_goes_with_how_far_they_stand_across_the_flow() {
    let drag = xv15().wing_pylon.drag.clone();
    let cd = |tilt: f64| drag.drag_at(tilt * DEG, Flap::new(20.0 * DEG), 0.1, 0.0);
    let (upright, level) = (0.30, 0.072);
    reads(cd(0.0), upright);
    reads(cd(90.0), level);
    reads(cd(60.0), level + 0.125 * (upright - level));
    assert!((0..90).all(|tilt| cd(f64::from(tilt)) > cd(f64::from(tilt) + 1.0)));
}

/// The steepest straight line of a table.
fn steepest<X: Axis>(table: &Table1<X>) -> f64 {
    let lines = table.x.windows(2).zip(table.y.windows(2));
    lines.map(|(x, y)| ((y[1] - y[0]) / (x[1] - x[0])).abs()).fold(0.0, engine::math::max)
}

fn steepest_of<'a, X: Axis + 'a>(tables: impl IntoIterator<Item = &'a Table1<X>>) -> f64 {
    tables.into_iter().map(steepest).fold(0.0, engine::math::max)
}

/// The columns of a table over two arguments, each over the first.
fn columns<X: Axis, Y: Axis>(table: &Table2<X, Y>) -> Vec<Table1<X>> {
    let column = |j: usize| table.z.iter().map(|row| row[j]).collect();
    (0..table.y.len()).map(|j| Table1::new(table.x.clone(), column(j))).collect()
}

/// The steepest line of tables by Mach number, which go over to others.
fn by_mach<A: Axis>(by: &ByMach<A>) -> f64 {
    steepest_of(by.columns()) + FADE
}

/// No step over ±180°, once round, is larger than the steepest printed line allows.
#[track_caller]
fn has_no_jumps(name: &str, slope: f64, f: impl Fn(f64) -> f64) {
    const STEPS: i32 = 36_000;
    let angle = |i: i32| f64::from(i) * 2.0 * PI / f64::from(STEPS) - PI;
    for i in 0..STEPS {
        let jump = f(angle(i + 1)) - f(angle(i));
        assert!(
            jump.abs() <= slope * 2.0 * PI / f64::from(STEPS) * 1.001 + 1e-12,
            "{name} jumps by {jump} at {} deg",
            angle(i) / DEG
        );
    }
    let round = f(PI) - f(-PI);
    assert!(round.abs() < ROUNDING, "{name} jumps by {round} at 180 deg");
}

/// A column goes over to another within 10°, where their difference is some coefficient at most.
const FADE: f64 = 1.0 / (10.0 * DEG);

/// The pylons, some .3 of CD, turn into the flow: by 2 at most for each radian.
const PYLONS: f64 = 0.3 * 2.0;

#[test]
fn no_coefficient_jumps_more_than_its_print() {
    let xv15 = xv15();
    type At = fn(&Polar, f64, Flap, f64, f64) -> f64;
    for (name, polar, at) in [
        ("CL", &xv15.wing_pylon.lift, Polar::lift_at as At),
        ("CD", &xv15.wing_pylon.drag, Polar::drag_at as At),
    ] {
        let all = |by: &ByFlap| steepest_of(by.columns());
        let slope = all(&polar.upright)
            + all(&polar.aeroplane)
            + steepest_of(polar.aeroplane_by_mach.columns())
            + FADE;
        for (tilt, flap, mach) in [
            (0.0, 0.0, 0.1),
            (0.0, 30.0, 0.1),
            (90.0, 0.0, 0.55),
            (90.0, 60.0, 0.1),
            (40.0, 10.0, 0.3),
        ] {
            has_no_jumps(name, slope + PYLONS, |alpha| {
                at(polar, tilt * DEG, Flap::new(flap * DEG), mach, alpha)
            });
        }
    }
    let tail = &xv15.horizontal_stabilizer;
    let fins = &xv15.vertical_stabilizers;
    for (mach, control) in [(0.1, 0.0), (0.1, 18.0), (0.3, -7.0), (0.55, 20.0)] {
        let control = control * DEG;
        has_no_jumps(
            "tail CL",
            steepest_of(&columns(&tail.lift)) + by_mach(&tail.lift_by_mach),
            |a| {
                let slow = tail.lift.at(Alpha(a), ElevatorAngle(control));
                tail.lift_by_mach.odd_at(mach, Alpha(a), slow)
            },
        );
        has_no_jumps("tail CD", steepest(&tail.drag) + by_mach(&tail.drag_by_mach), |a| {
            tail.drag_by_mach.at(mach, Alpha(a), tail.drag.at(Alpha(a)))
        });
        has_no_jumps("fin CY", steepest_of(&columns(&fins.side_force)), |b| {
            fins.slow_side_force(b, control)
        });
        has_no_jumps("fin CD", steepest(&fins.drag) + by_mach(&fins.drag_by_mach), |b| {
            let angle = Beta(b.abs());
            fins.drag_by_mach.at(mach, angle, fins.drag.at(angle))
        });
    }
}

#[test]
fn every_table_gives_back_every_number_it_holds() {
    fn one<X: Axis>(table: &Table1<X>) {
        for (x, &y) in table.x.iter().zip(&table.y) {
            reads(table.at(X::new(*x)), y);
        }
    }
    fn two<X: Axis, Y: Axis>(table: &Table2<X, Y>) {
        for (x, row) in table.x.iter().zip(&table.z) {
            for (y, &z) in table.y.iter().zip(row) {
                reads(table.at(X::new(*x), Y::new(*y)), z);
            }
        }
    }
    fn three<X: Axis, Y: Axis, Z: Axis>(table: &Table3<X, Y, Z>) {
        for (x, rows) in table.x.iter().zip(&table.w) {
            for (y, row) in table.y.iter().zip(rows) {
                for (z, &w) in table.z.iter().zip(row) {
                    reads(table.at(X::new(*x), Y::new(*y), Z::new(*z)), w);
                }
            }
        }
    }
    let xv15 = xv15();
    three(&xv15.rotor_wake.tail_ratio);
    three(&xv15.horizontal_stabilizer.downwash_rad);
    three(&xv15.horizontal_stabilizer.pressure_ratio);
    xv15.vertical_stabilizers.fuselage_sidewash.columns().into_iter().for_each(three);
    let (wing, tail, fins) =
        (&xv15.wing_pylon, &xv15.horizontal_stabilizer, &xv15.vertical_stabilizers);
    two(&xv15.rotor_wake.sideslip_factor);
    two(&wing.pitching_moment);
    two(&wing.rolling_by_sideslip_per_rad);
    two(&tail.lift);
    two(&fins.side_force);
    two(&fins.rotor_sidewash);
    let polars = [&wing.lift, &wing.drag].into_iter();
    let by_mach = polars.clone().flat_map(|polar| polar.aeroplane_by_mach.columns());
    polars
        .flat_map(|polar| [&polar.upright, &polar.aeroplane])
        .flat_map(ByFlap::columns)
        .chain(by_mach)
        .chain([&xv15.fuselage.lift_m2, &tail.drag])
        .for_each(one);
    one(&xv15.fuselage.pitching_by_sideslip_m3);
}

// ----------------------------------------------------------------- everywhere, and on both sides

/// The same numbers in the same order on every machine (splitmix64).
struct Dice(u64);

impl Dice {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector<F>(&mut self, size: f64) -> Vec3<F> {
        Vec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }

    fn pair(&mut self, low: f64, high: f64) -> Pair<f64> {
        Pair { left: self.between(low, high), right: self.between(low, high) }
    }

    /// Any attitude, speed, setting and rate; one in eight at rest, one in eight along an axis.
    fn state(&mut self) -> State {
        let speed_mps = [0.0, 1e-3, 5.0, 40.0, 90.0, 180.0][self.between(0.0, 6.0) as usize];
        let mut velocity_mps = self.vector(speed_mps);
        match self.between(0.0, 8.0) as u64 {
            0 => velocity_mps = Vec3::zero(),
            1 => velocity_mps = Vec3::new(0.0, velocity_mps.y, 0.0),
            _ => {}
        }
        let euler = Euler {
            roll_rad: self.between(-PI, PI),
            pitch_rad: self.between(-1.5, 1.5),
            heading_rad: 0.0,
        };
        let mut state = State {
            plant: Plant {
                position_m: Vec3::new(0.0, 0.0, -self.between(100.0, 8_000.0)),
                velocity_mps,
                attitude: Attitude::from_euler(euler),
                angular_rate_radps: self.vector(2.0),
                rotor_speed_radps: self.between(0.0, 70.0),
                fuel_kg: 600.0,
                ..Plant::default()
            },
            actuators: actuators::State {
                collective_rad: self.pair(0.0, 0.8),
                elevator_rad: self.between(-0.35, 0.35),
                flaperon_rad: self.pair(-0.4, 0.24),
                rudder_right_rad: self.between(-0.35, 0.35),
                flap_rad: self.between(0.0, 1.31),
                mast_tilt_rad: self.pair(-0.087, 1.571),
                gear_extension_norm: self.between(0.0, 1.0),
                ..actuators::State::default()
            },
            ..State::default()
        };
        state.plant.rotors.left.inflow.mean_mps = self.between(-5.0, 25.0);
        state.plant.rotors.right.inflow.mean_mps = self.between(-5.0, 25.0);
        state.plant.horizontal_stabilizer.downwash_rad = self.between(0.0, 0.15);
        state
    }
}

fn stepped(xv15: &Aircraft, state: &State, world: World) -> (State, Outputs) {
    engine::step(xv15, state, &Inputs { events: &[], world })
}

fn airframe(out: &Outputs) -> [Load; 6] {
    let loads = &out.loads;
    [
        loads.fuselage,
        loads.horizontal_stabilizer,
        loads.wing_pylon.left,
        loads.wing_pylon.right,
        loads.vertical_stabilizers.left,
        loads.vertical_stabilizers.right,
    ]
}

/// Ten times what the largest component makes at 310 m/s, beyond which something divides by nothing.
const FORCE_N_MAX: f64 = 1e8;

#[test]
fn the_airframe_is_finite_at_any_attitude_and_speed() {
    let xv15 = xv15();
    let mut dice = Dice(15);
    for sample in 0..20_000 {
        let state = dice.state();
        let (next, out) = stepped(&xv15, &state, World::default());
        assert!(next.is_finite() && next.frozen == 0, "sample {sample}: {state:?}");
        for load in airframe(&out) {
            let size = load.force_n.norm() + load.moment_n_m.norm();
            assert!(size < FORCE_N_MAX, "sample {sample}: {load:?} of {state:?}");
        }
    }
}

#[test]
fn the_mirrored_aircraft_has_the_mirrored_loads_to_the_bit() {
    let xv15 = xv15();
    let mut dice = Dice(16);
    let plus = |load: Load| {
        [load.force_n.x, load.force_n.y, load.force_n.z].map(|number| (number + 0.0).to_bits())
    };
    for sample in 0..5_000 {
        let state = dice.state().without_negative_zeros();
        let (next, out) = stepped(&xv15, &state, World::default());
        let (mirror_next, mirror_out) = stepped(&xv15, &state.mirrored(), World::default());
        let mut exchanged = airframe(&mirror_out).map(Load::mirrored);
        exchanged.swap(2, 3);
        exchanged.swap(4, 5);
        for (load, mirrored) in airframe(&out).into_iter().zip(exchanged) {
            assert_eq!(plus(load), plus(mirrored), "sample {sample}: {state:?}");
        }
        assert_eq!(next.mirrored(), mirror_next, "sample {sample}");
    }
}

/// Both fins together are the airframe's weathercock: about 380,000 ft·lb/rad at 180 kt and 8,000 ft
/// (validation.md §5.2, by hand from the same tables; sanity, not acceptance).
#[test]
fn the_fins_turn_the_nose_into_the_wind() {
    let xv15 = xv15();
    let fins = |beta_rad: f64| {
        let motion = engine::motion::Motion {
            cg_m: Vec3::new(7.57, 0.0, 2.0),
            airspeed_mps: Vec3::new(104.0, 104.0 * beta_rad, 0.0),
            angular_rate_radps: Vec3::zero(),
            density_kg_per_m3: 0.963,
        };
        let inputs = vertical_stabilizers::Inputs {
            motion,
            flow: local_flow(motion.airspeed_mps, motion.density_kg_per_m3),
            wake_mps: Vec3::zero(),
            mach: 0.31,
            mast_tilt_rad: 0.5 * PI,
            flap_rad: 0.0,
            pressure_ratio: 1.0,
            rudder_rad: 0.0,
        };
        vertical_stabilizers::evaluate(&xv15.vertical_stabilizers, &inputs).moment_n_m.z
    };
    let per_rad = (fins(0.02) - fins(-0.02)) / 0.02 / 1.355_818;
    println!("fins: {per_rad:.0} ft lb/rad");
    assert!((300e3..450e3).contains(&per_rad));
}

//! Flight to the side and yaw: modes and derivatives, sideward and rearward flight, sideslip, a stopped
//! engine.

use analysis::linearize::{Linear, linearize};
use analysis::modes::{Mode, modes};
use analysis::trim::{Target, Trim, trim, trim_near};
use analysis::variable::Part;
use engine::inputs::Failures;
use engine::math::{max, square};
use engine::{Aircraft, Inputs, step};

use crate::book::{Band, Book, Case, Class, DEG, FOOT_M, INCH_M, KNOT_MPS};
use crate::trims::why;

/// Places among the states and inputs of a linear system.
const ROLL_RATE: usize = 3;
const YAW_RATE: usize = 5;
const RIGHT: usize = 1;
const STICK_RIGHT: usize = 1;
const PEDAL: usize = 2;

/// A flight, and its system as the textbooks have it: rotors and actuators follow at once.
struct Flight {
    trim: Trim,
    linear: Linear,
    slow: Linear,
}

/// Nacelle angle, speed and flap detent: 458 rpm as an aeroplane.
fn target(nacelle_deg: f64, speed_kt: f64, flap_detent: u64) -> Target {
    Target {
        mast_tilt_rad: (90.0 - nacelle_deg) / DEG,
        airspeed_mps: speed_kt * KNOT_MPS,
        flap_detent,
        rpm_select: if nacelle_deg < 1.0 { 2 } else { 0 },
        ..Target::default()
    }
}

fn flight(aircraft: &Aircraft, target: &Target) -> Result<Flight, String> {
    let trim = trim(aircraft, target).map_err(|failure| why(&failure))?;
    let linear = linearize(aircraft, &trim, &target.world);
    let slow = linear.quasi_steady(|state| matches!(state.part(), Part::Rotors | Part::Actuators));
    Ok(Flight { trim, linear, slow })
}

impl Flight {
    fn mode(&self, name: &str) -> Result<Mode, String> {
        modes(&self.linear, self.trim.outputs.airspeed_mps)
            .map_err(|why| why.to_string())?
            .into_iter()
            .find(|mode| mode.name == name)
            .ok_or_else(|| format!("no mode of ours is called {name}"))
    }

    /// The fastest growth of any mode in which the lateral states lead, 1/s.
    fn lateral_growth(&self) -> Result<f64, String> {
        let found = modes(&self.linear, self.trim.outputs.airspeed_mps);
        let lateral = found.map_err(|why| why.to_string())?.into_iter();
        let growth = lateral
            .filter(|mode| mode.state.part() == Part::Lateral)
            .map(|mode| mode.eigenvalue.re);
        Ok(growth.fold(f64::NEG_INFINITY, max))
    }

    fn derivative(&self, of: usize, by: usize) -> f64 {
        self.slow.a[(of, by)]
    }
}

fn of<T, N>(found: &Result<T, String>, number: impl Fn(&T) -> N) -> Result<N, String> {
    found.as_ref().map(number).map_err(Clone::clone)
}

/// Case 21.
pub fn qualities(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        21,
        Class::A,
        "hover and cruise as flight describes their modes, SCAS off",
        "NASA TM-89428 and TM-86009, in words: pitch and roll of hover are unstable oscillations of low \
         frequency; cruise is level 2 or better for category A.",
    )
    .tolerance(
        "Only that a mode grows is the words' own. What is low (below 1 rad/s) and what level 2 \
         is are taken from elsewhere, and count as our own: level 2 of category A is that of \
         MIL-F-8785C for a class II aircraft: Dutch roll ζ ≥ .02, ζω ≥ .05 1/s, ω ≥ .4 rad/s; \
         roll time constant ≤ 3.0 s; spiral, if it grows, doubling in no less than 8 s; short \
         period ζ .25 to 2.",
    )
    .set_up(
        "Cruise is that of case 9: 180 KCAS at 8,000 ft, 458 rpm. Whether the SCAS was on is not \
         said; off is the harder. The oscillation in roll comes with table 1-II: the rotor \
         downwind stands in the other's wake, loses thrust, and rolls the aircraft away from \
         where it goes; without it the mode is neutral (−.005 ± .27j).",
    );
    let hover = flight(aircraft, &Target::default());
    for (label, name) in
        [("pitch", "hover oscillation in pitch"), ("roll", "hover oscillation in roll")]
    {
        let mode = hover.as_ref().map_err(Clone::clone).and_then(|hover| hover.mode(name));
        let growth = of(&mode, |mode| mode.eigenvalue.re);
        let what = format!("hover, {label}: σ, 1/s (more than)");
        let row = case.row(what, 0.0, growth, Band::AtLeast(0.0), 3);
        if label == "pitch" {
            row.twice("case 9");
        }
        let omega = of(&mode, Mode::frequency_radps);
        let what = format!("hover, {label}: ω, rad/s (less than)");
        case.row(what, 1.0, omega, Band::AtMost(1.0), 3).class(Class::Own);
    }
    let airspeed_mps = 180.0 * KNOT_MPS / engine::math::sqrt(0.786);
    let cruise = Target { airspeed_mps, altitude_m: 8000.0 * FOOT_M, ..target(0.0, 180.0, 0) };
    let cruise = flight(aircraft, &cruise);
    let mode = |name: &str| cruise.as_ref().map_err(Clone::clone).and_then(|c| c.mode(name));
    let dutch = mode("Dutch roll");
    let zeta = of(&dutch, Mode::damping);
    case.row("cruise, Dutch roll: ζ (more than)", 0.02, zeta, Band::AtLeast(0.02), 3)
        .class(Class::Own);
    let damping = of(&dutch, |mode| -mode.eigenvalue.re);
    case.row("cruise, Dutch roll: ζω, 1/s (more than)", 0.05, damping, Band::AtLeast(0.05), 3)
        .class(Class::Own);
    let omega = of(&dutch, Mode::frequency_radps);
    case.row("cruise, Dutch roll: ω, rad/s (more than)", 0.4, omega, Band::AtLeast(0.4), 2)
        .class(Class::Own);
    let roll = of(&mode("roll subsidence"), Mode::time_s);
    case.row("cruise, roll: time constant, s (less than)", 3.0, roll, Band::AtMost(3.0), 2)
        .class(Class::Own);
    let spiral = cruise
        .as_ref()
        .map_err(Clone::clone)
        .and_then(|cruise| cruise.mode("spiral").or_else(|_| cruise.mode("spiral divergence")));
    let spiral = of(&spiral, |mode| mode.eigenvalue.re);
    let double = core::f64::consts::LN_2 / 8.0;
    case.row("cruise, spiral: growth, 1/s (less than)", double, spiral, Band::AtMost(double), 3)
        .class(Class::Own);
    let short = of(&mode("short period"), Mode::damping);
    case.row("cruise, short period: ζ", 0.5, short, Band::Between(0.25, 2.0), 2)
        .twice("case 9")
        .class(Class::Own);
    book.add(case);
}

/// The part of a derivative that a change of the aircraft takes away.
fn part_of(
    whole: &Result<Flight, String>,
    without: &Result<Flight, String>,
    (of, by): (usize, usize),
) -> Result<f64, String> {
    let (whole, without) =
        (whole.as_ref().map_err(Clone::clone)?, without.as_ref().map_err(Clone::clone)?);
    Ok(whole.derivative(of, by) - without.derivative(of, by))
}

/// Case 22.
pub fn derivatives(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        22,
        Class::Theory,
        "lateral and directional derivatives and modes, SCAS off",
        "Closed form, worked out from published geometry and tables; no flight number is at hand for any \
         of these conditions (p/δa and β/δr of TM-86009 and TM-89428 are not in what could be read).",
    )
    .tolerance(
        "Fins: N_r = −ρ·V·S·a·l²·η/2I_zz with a = 3.044/rad (table 6-I), l = 268.8 in, S = 50.5 \
         ft² and η of table 5-V; ±15 %, for the wake in their flow and their distance aside. \
         Rotor on rotor: L_v = −y/I_xx·∂T/∂w·dX_SF/dμ·v/(ΩR), ∂T/∂w = ρAΩR·2λ·(aσ/4)/(aσ/4 + 4λ) \
         with a = 5.73/rad; ±30 %, for a blade that is no line. Growth: no lateral mode doubles \
         in less than 4 s (.173 1/s), our own requirement for flight with the SCAS off as a \
         helicopter; 8 s and level 2 beyond. Estimates by hand ±50 %.",
    )
    .set_up(
        "N_r of the fins is the aircraft's less that of the same aircraft without fins. As an \
         aeroplane at 180 KCAS and 8,000 ft the numbers estimated by hand from the reference's \
         tables leave the rotors out, which here add to N_r and to roll damping and take from \
         N_β.",
    )
    .misses(
        "At 40 kt the growth is missed, and was worse: +.50 1/s while the −.5 of table 6-VIII \
         also reversed the fins' yaw damping. What is left is the table's own: at 40 kt and small \
         sideslip the fins push the nose away from the wind (N_v below zero), and the table is \
         printed so. At 60 kt the Dutch roll grows because the rotors roll the aircraft away from \
         the wind (L_v) and the fins, at .2 of their effect, hardly turn it (N_v).",
    )
    .settled_by(
        "A yaw response at 40 kt, identified in flight.",
    );
    fins(&mut case, aircraft);
    rotors(&mut case, aircraft);
    growth(&mut case, aircraft);
    cruise(&mut case, aircraft);
    book.add(case);
}

/// Yaw damping of the fins.
fn fins(case: &mut Case, aircraft: &Aircraft) {
    let no_fins = aircraft.clone().with(|a| a.vertical_stabilizers.area_m2 = 1e-9);
    let izz = aircraft.weight_balance.inertia.zz_kg_m2;
    for (speed_kt, eta) in [(40.0, 1.78), (60.0, 1.54)] {
        let target = target(90.0, speed_kt, 2);
        let (whole, without) = (flight(aircraft, &target), flight(&no_fins, &target));
        let fins = &aircraft.vertical_stabilizers;
        let arm_m = 268.8 * INCH_M;
        let closed =
            -0.5 * 1.225 * target.airspeed_mps * 2.0 * fins.area_m2 * 3.044 * square(arm_m) * eta
                / izz;
        let ours = part_of(&whole, &without, (YAW_RATE, YAW_RATE));
        case.row(
            format!("helicopter, {speed_kt:.0} kt: N_r of the fins, 1/s"),
            closed,
            ours,
            Band::Part(0.15),
            3,
        );
        let n_r = of(&whole, |flight| flight.derivative(YAW_RATE, YAW_RATE));
        case.row(
            format!("helicopter, {speed_kt:.0} kt: N_r, 1/s (less than)"),
            0.0,
            n_r,
            Band::AtMost(0.0),
            3,
        )
        .class(Class::Own);
    }
}

/// What one rotor's wake does to the other.
fn rotors(case: &mut Case, aircraft: &Aircraft) {
    let alone = aircraft.clone().with(|a| {
        a.rotors.other_rotor.downwind.y.iter_mut().for_each(|x| *x = 0.0);
    });
    let (whole, without) =
        (flight(aircraft, &Target::default()), flight(&alone, &Target::default()));
    let ours = part_of(&whole, &without, (ROLL_RATE, RIGHT));
    let (closed, ours) = match of(&whole, |flight| rotor_on_rotor(aircraft, &flight.trim)) {
        Ok(closed) => (closed, ours),
        Err(why) => (0.0, Err(why)),
    };
    case.row("hover: L_v of rotor on rotor, rad/s² per m/s", closed, ours, Band::Part(0.3), 4);
}

/// How fast lateral modes grow.
fn growth(case: &mut Case, aircraft: &Aircraft) {
    for (label, nacelle_deg, speed_kt, flap, most) in [
        ("hover", 90.0, 0.0, 2, 0.173),
        ("helicopter, 40 kt", 90.0, 40.0, 2, 0.173),
        ("helicopter, 60 kt", 90.0, 60.0, 2, 0.173),
        ("60 deg, 100 kt", 60.0, 100.0, 1, 0.087),
        ("aeroplane, 180 kt", 0.0, 180.0, 0, 0.087),
    ] {
        for (scas, scas_on) in [("off", 0), ("on", 1)] {
            let target = Target { scas_on, ..target(nacelle_deg, speed_kt, flap) };
            let growth = flight(aircraft, &target).and_then(|flight| flight.lateral_growth());
            case.row(
                format!("{label}, SCAS {scas}: fastest lateral growth, 1/s (less than)"),
                most,
                growth,
                Band::AtMost(most),
                3,
            )
            .class(Class::Own);
        }
    }
}

/// As an aeroplane.
fn cruise(case: &mut Case, aircraft: &Aircraft) {
    let airspeed_mps = 180.0 * KNOT_MPS / engine::math::sqrt(0.786);
    let cruise = Target { airspeed_mps, altitude_m: 8000.0 * FOOT_M, ..target(0.0, 180.0, 0) };
    let cruise = flight(aircraft, &cruise);
    let n_beta = of(&cruise, |c| c.derivative(YAW_RATE, RIGHT) * c.trim.outputs.airspeed_mps);
    case.row("cruise: N_β, 1/s²", 3.5, n_beta, Band::Part(0.5), 2);
    let n_r = of(&cruise, |c| c.derivative(YAW_RATE, YAW_RATE));
    case.row("cruise: N_r, 1/s", -0.38, n_r, Band::Part(0.5), 2);
    let y_v = of(&cruise, |c| c.derivative(RIGHT, RIGHT));
    case.row("cruise: Y_v, 1/s", -0.19, y_v, Band::Part(0.5), 2);
    let dutch = cruise.as_ref().map_err(Clone::clone).and_then(|c| c.mode("Dutch roll"));
    case.row(
        "cruise: Dutch roll ω, rad/s",
        1.9,
        of(&dutch, Mode::frequency_radps),
        Band::Part(0.5),
        2,
    );
    case.row("cruise: Dutch roll ζ", 0.15, of(&dutch, Mode::damping), Band::Part(0.5), 2);
    let roll = cruise.as_ref().map_err(Clone::clone).and_then(|c| c.mode("roll subsidence"));
    case.row("cruise: roll time constant, s", 2.3, of(&roll, Mode::time_s), Band::Part(0.5), 2);
}

/// L_v by which the rotor downwind loses thrust in hover.
fn rotor_on_rotor(aircraft: &Aircraft, hover: &Trim) -> f64 {
    let rotors = &aircraft.rotors;
    let density = hover.outputs.air.density_kg_per_m3;
    let tip_mps = hover.outputs.rotor_speed_radps * rotors.radius_m;
    let inflow_mps = hover.state.plant.rotors.right.inflow.mean_mps;
    let lambda = inflow_mps / tip_mps;
    let blade = 5.73 * rotors.solidity / 4.0;
    let thrust_by_sink =
        density * rotors.disc_area_m2() * tip_mps * 2.0 * lambda * blade / (blade + 4.0 * lambda);
    let table = &rotors.other_rotor.downwind;
    let wake_by_speed =
        (table.y[1] - table.y[0]) / (table.x[1] - table.x[0]) * inflow_mps / tip_mps;
    let arm_m = rotors.pivot_m.y;
    -arm_m * thrust_by_sink * wake_by_speed / aircraft.weight_balance.inertia.xx_kg_m2
}

/// The least part of its travel that stick and pedals have left, %.
fn travel_left(trim: &Trim) -> f64 {
    let cockpit = &trim.state.cockpit;
    let used = [cockpit.stick_aft_norm, cockpit.stick_right_norm, cockpit.pedal_right_norm];
    100.0 * (1.0 - used.into_iter().map(f64::abs).fold(0.0, max))
}

/// Trims from hover to a speed, each from the one before: the last of them.
fn sweep(aircraft: &Aircraft, sideslip_deg: f64, speeds_kt: &[f64]) -> Result<Vec<Trim>, String> {
    let mut found: Vec<Trim> = Vec::new();
    for &speed_kt in speeds_kt {
        let target = Target { sideslip_rad: sideslip_deg / DEG, ..target(90.0, speed_kt, 2) };
        let next = match found.last() {
            Some(near) => trim_near(aircraft, &target, near),
            None => trim(aircraft, &target),
        };
        found.push(next.map_err(|failure| format!("{speed_kt} kt: {}", why(&failure)))?);
    }
    Ok(found)
}

/// Case 23.
pub fn sideward(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        23,
        Class::Own,
        "sideward flight to 35 kt and rearward flight to 20 kt, hover attitude, flaps 40/25",
        "No published trim. That both can be flown, and with a tenth of every control left, is what a \
         helicopter is asked for.",
    )
    .tolerance(
        "Can be flown, with a tenth of every control left. Rolled to the side it goes to.",
    )
    .set_up(
        "Steady, out of ground effect; and flown by the pilot model `sideways` at 10 m, nose \
         where it was. In sideward flight the rotor downwind stands in the other's wake (table \
         1-II): lateral stick and power say how much.",
    );
    let speeds_kt = [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0];
    for (label, sideslip_deg, speeds_kt) in [
        ("to the right, 35 kt", 90.0, &speeds_kt[..]),
        ("rearward, 20 kt", 180.0, &speeds_kt[1..5]),
    ] {
        let found = sweep(aircraft, sideslip_deg, speeds_kt);
        let left = of(&found, |trims| {
            trims.iter().map(travel_left).fold(f64::INFINITY, engine::math::min)
        });
        case.row(
            format!("{label}: control left, % of travel (more than)"),
            10.0,
            left,
            Band::AtLeast(10.0),
            0,
        );
        let roll =
            of(&found, |trims| trims.last().map_or(f64::NAN, |t| t.report.roll_rad.abs() * DEG));
        case.row(format!("{label}: bank, deg (less than)"), 15.0, roll, Band::AtMost(15.0), 1);
    }
    crate::sidling::rows(aircraft, &mut case);
    book.add(case);
}

/// Case 24.
pub fn sideslips(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        24,
        Class::Own,
        "steady sideslip to the right, SCAS off",
        "No published number. That right sideslip takes left pedal and right stick, more of them with more \
         sideslip, and bank to the right, is what level 2 asks for (MIL-F-8785C 3.3.6).",
    )
    .tolerance(
        "Signs, and more control with more sideslip.",
    )
    .set_up(
        "Pedal and stick of 2 and 10 deg.",
    )
    .misses(
        "As a helicopter at 40 kt the fins' factor of table 6-VIII is −.5 at no sideslip and .8 \
         at 10 deg: at first the pedal goes the wrong way, as the table is printed.",
    );
    for (label, nacelle_deg, speed_kt, flap) in [
        ("helicopter, 40 kt", 90.0, 40.0, 2),
        ("helicopter, 60 kt", 90.0, 60.0, 2),
        ("helicopter, 80 kt", 90.0, 80.0, 2),
        ("60 deg, 100 kt", 60.0, 100.0, 1),
        ("aeroplane, 180 kt", 0.0, 180.0, 0),
    ] {
        let at = |sideslip_deg: f64| {
            let flown =
                Target { sideslip_rad: sideslip_deg / DEG, ..target(nacelle_deg, speed_kt, flap) };
            trim(aircraft, &flown).map_err(|failure| why(&failure))
        };
        let (little, more) = (at(2.0), at(10.0));
        let pedal = of(&little, |t| t.report.pedal_right_m / INCH_M);
        case.row(
            format!("{label}: pedal at 2 deg, in (left, less than)"),
            0.0,
            pedal,
            Band::AtMost(0.0),
            2,
        );
        let pedal = of(&more, |t| t.report.pedal_right_m / INCH_M);
        case.row(
            format!("{label}: pedal at 10 deg, in (left, less than)"),
            0.0,
            pedal,
            Band::AtMost(0.0),
            2,
        );
        let stick = of(&more, |t| t.report.stick_right_m / INCH_M);
        case.row(
            format!("{label}: stick at 10 deg, in (right, more than)"),
            0.0,
            stick,
            Band::AtLeast(0.0),
            2,
        );
        let bank = of(&more, |t| t.report.roll_rad * DEG);
        case.row(
            format!("{label}: bank at 10 deg, deg (right, more than)"),
            0.0,
            bank,
            Band::AtLeast(0.0),
            1,
        );
    }
    book.add(case);
}

/// Heading change in five seconds after the right engine stopped, hands off, deg.
fn turned_hands_off(aircraft: &Aircraft, both: &Trim, target: &Target) -> f64 {
    let mut state = both.state;
    let mut world = target.world;
    world.failures = Failures::ENGINE_RIGHT;
    for _ in 0..1250 {
        state = step(aircraft, &state, &Inputs { events: &[], world }).0;
    }
    let turned =
        state.plant.attitude.euler().heading_rad - both.state.plant.attitude.euler().heading_rad;
    DEG * engine::math::wrap_angle(turned).abs()
}

/// Case 25.
pub fn engine_out(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        25,
        Class::Theory,
        "one engine stopped: roll and yaw",
        "Closed form: the shafts are joined, so that both rotors go on alike; what is left is the jet of one \
         engine on one side, some 85 lbf in hover (CR-176970).",
    )
    .tolerance(
        "±25 %, since either control does a little of the other. Controller off: less than 5 deg \
         in 5 s, our own requirement, with the SCAS on.",
    )
    .set_up(
        "The jet acts along the mast at the nacelle: upright it rolls, at 0 deg it yaws. Stick or \
         pedal = F·y/(I·sensitivity).",
    );
    for (label, nacelle_deg, speed_kt, flap) in
        [("helicopter, 80 kt", 90.0, 80.0, 2), ("aeroplane, 180 kt", 0.0, 180.0, 0)]
    {
        let both = target(nacelle_deg, speed_kt, flap);
        let mut one = both;
        one.world.failures = Failures::ENGINE_RIGHT;
        let (whole, stopped) = (flight(aircraft, &both), flight(aircraft, &one));
        let inertia = of(&whole, |f| f.trim.outputs.balance.inertia);
        let closed = whole.as_ref().map_err(Clone::clone).and_then(|whole| {
            let stopped = stopped.as_ref().map_err(Clone::clone)?;
            let inertia = inertia.clone()?;
            let arm_m = aircraft.rotors.pivot_m.y;
            let jet_n = stopped.trim.outputs.engines.jet_thrust_n.left
                - stopped.trim.outputs.engines.jet_thrust_n.right;
            Ok(if nacelle_deg > 45.0 {
                -jet_n * arm_m
                    / (inertia.xx_kg_m2 * whole.slow.b[(ROLL_RATE, STICK_RIGHT)])
                    / INCH_M
            } else {
                -jet_n * arm_m / (inertia.zz_kg_m2 * whole.slow.b[(YAW_RATE, PEDAL)]) / INCH_M
            })
        });
        let ours = of(&stopped, |f| {
            if nacelle_deg > 45.0 {
                f.trim.report.stick_right_m / INCH_M
            } else {
                f.trim.report.pedal_right_m / INCH_M
            }
        });
        let what = if nacelle_deg > 45.0 { "lateral stick" } else { "pedal" };
        case.row(
            format!("{label}: {what}, in"),
            closed.clone().unwrap_or(0.0),
            closed.and(ours),
            Band::Part(0.25),
            3,
        );
        let augmented = Target { scas_on: 1, ..both };
        let turned = trim(aircraft, &augmented)
            .map(|trim| turned_hands_off(aircraft, &trim, &augmented))
            .map_err(|failure| why(&failure));
        case.row(
            format!("{label}: turned in 5 s, hands off, deg (less than)"),
            5.0,
            turned,
            Band::AtMost(5.0),
            1,
        )
        .class(Class::Own);
    }
    book.add(case);
}

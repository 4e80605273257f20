//! Frequency responses, modes, control response, symmetry.

use analysis::linearize::{Linear, decibels, linearize};
use analysis::modes::{Mode, modes};
use analysis::trim::{Target, Trim, trim};
use analysis::variable::Part;
use analysis::{Complex, Polar, Unsolved};
use engine::math::{PI, cos, sin, sqrt};
use engine::symmetry::Mirror;
use engine::{Aircraft, Inputs, State};

use crate::book::{
    Band, Book, Case, Class, DEG, FOOT_M, INCH_M, KNOT_MPS, RPM_RADPS, SLUG_FT2_KG_M2,
};
use crate::fits::Fit;
use crate::trims::why;

/// A published transfer function: polynomials of s, highest power first, and a delay in s.
pub struct Transfer {
    numerator: &'static [f64],
    denominator: &'static [f64],
    delay_s: f64,
}

/// NASA TM-89428, hover, SCAS off: pitch rate over elevator, both in degrees.
pub const HOVER_PITCH: Transfer = Transfer {
    numerator: &[-2.66, -0.630_42, 0.366_197, 0.0],
    denominator: &[1.0, 0.888_846, -0.290_178, 0.403_407, 0.046_464_4],
    delay_s: 0.0656,
};

/// The same, downward acceleration over the lever, g per percent.
const HOVER_HEAVE: Transfer =
    Transfer { numerator: &[-0.0098, 0.0], denominator: &[1.0, 0.105], delay_s: 0.0074 };

/// The same, aeroplane at 170 KIAS, 8,000 ft.
pub const CRUISE_PITCH: Transfer =
    Transfer { numerator: &[-7.38, -6.568], denominator: &[1.0, 2.165, 4.080], delay_s: 0.005 };

impl Transfer {
    /// G(jω).
    pub fn at(&self, omega: f64) -> Complex {
        let s = Complex::new(0.0, omega);
        let value = |polynomial: &[f64]| {
            polynomial
                .iter()
                .fold(Complex::new(0.0, 0.0), |sum, &coefficient| sum * s + coefficient)
        };
        let angle = -omega * self.delay_s;
        value(self.numerator) / value(self.denominator) * Complex::new(cos(angle), sin(angle))
    }
}

/// Pitch rate over elevator of a system, in the source's sense: elevator down positive.
pub fn pitch_over_elevator(
    aircraft: &Aircraft,
    linear: &Linear,
    omega: f64,
) -> Result<Complex, Unsolved> {
    let gearing = aircraft.fcc.mixer.elevator_per_longitudinal_stick_rad_per_m;
    Ok(-linear.response(0, 4, omega)? / gearing)
}

/// Phase within ±180° of another.
pub fn near_deg(phase_deg: f64, other_deg: f64) -> f64 {
    let turns = ((other_deg - phase_deg) / 360.0).round();
    phase_deg + 360.0 * turns
}

fn compare(
    case: &mut Case,
    name: &str,
    omegas: &[f64],
    published: &Transfer,
    fits: &'static [Fit],
    ours: impl Fn(f64) -> Result<Complex, String>,
) {
    for &omega in omegas {
        let reference = published.at(omega);
        let found = ours(omega);
        let reference_db = decibels(reference.magnitude());
        let gain = found.as_ref().map(|g| decibels(g.magnitude())).map_err(Clone::clone);
        case.row(format!("{name} at {omega} rad/s, dB"), reference_db, gain, Band::Within(3.0), 1)
            .fitted(fits);
        let reference_deg = reference.phase_rad() * DEG;
        let phase = found.map(|g| near_deg(g.phase_rad() * DEG, reference_deg));
        case.row(
            format!("{name} at {omega} rad/s, deg"),
            reference_deg,
            phase,
            Band::Within(20.0),
            0,
        )
        .fitted(fits);
    }
}

fn system(aircraft: &Aircraft, target: &Target) -> Result<(Trim, Linear), String> {
    let trim = trim(aircraft, target).map_err(|failure| why(&failure))?;
    let linear = linearize(aircraft, &trim, &target.world);
    Ok((trim, linear))
}

/// Hover, SCAS off.
pub fn hovering(aircraft: &Aircraft) -> Result<(Trim, Linear), String> {
    system(aircraft, &Target::default())
}

/// 180 KCAS at 8,000 ft as true airspeed, the density ratio being .786.
pub fn cruise_kt() -> f64 {
    180.0 / sqrt(0.786)
}

fn cruising(aircraft: &Aircraft) -> Result<(Trim, Linear), String> {
    let airspeed_mps = cruise_kt() * KNOT_MPS;
    let target = Target {
        mast_tilt_rad: 0.5 * PI,
        airspeed_mps,
        altitude_m: 8000.0 * FOOT_M,
        flap_detent: 0,
        rpm_select: 2,
        ..Target::default()
    };
    system(aircraft, &target)
}

fn mode(found: &Result<(Trim, Linear), String>, name: &str) -> Result<Mode, String> {
    let (trim, linear) = found.as_ref().map_err(Clone::clone)?;
    modes(linear, trim.outputs.airspeed_mps)
        .map_err(|why| why.to_string())?
        .into_iter()
        .find(|mode| mode.name == name)
        .ok_or_else(|| format!("no mode of ours is called {name}"))
}

/// Case 9.
pub fn responses(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        9,
        Class::A,
        "frequency responses and modes, SCAS off",
        "Identified in flight, NASA TM-89428. Hover, and aeroplane at 170 KIAS (180 KCAS), 8,000 ft.",
    )
    .tolerance(
        "±3 dB and ±20 deg within the band of validity: what handling-quality work calls a good \
         model. Poles ±15 % and ±.1 of damping ratio.",
    )
    .set_up(
        "13,000 lb, centre of gravity aft, 458 rpm in cruise.",
    )
    .misses(
        "Hover, pitch: from 1 rad/s on it is the control's power over the inertia, and agrees. \
         Below, it is the oscillation, and that of the identified model takes a pitching moment \
         with speed of (σ² + ω²)·1.32/g = .045 rad/s² per m/s. Ours is about .01: what the discs' \
         tilt with speed and the in-plane forces make at the hubs (closed form .011). Trims have \
         less still: from 0 to 20 kt the stick of GTRS moves .12 in, which is .002. Its damping, \
         .3 1/s, is that of the discs' lag less Amer's in-plane force, which a test holds to \
         theory. No known term makes either number three times as large.",
    )
    .misses(
        "Hover, heave: blade elements against momentum have .14 to .20 1/s at this disc loading, \
         whether collective or power is held; the identified .105 is less than either.",
    )
    .misses(
        "Cruise: the identified elevator has 7.4 deg/s² per degree. The tables of GTRS (2.29 of \
         lift per rad, KH has the same) have 13.5, and 10.8 with the tail's pressure factor of \
         CR-166536 (.8, here as an aeroplane only: the printouts at 40 to 100 kt leave it out). \
         That is the 3 dB which are left.",
    )
    .settled_by(
        "The time histories of the sweeps. They would tell the low-frequency fit in hover from \
         the aircraft, and whether the elevator's deflection was measured at the surface or at \
         the stick in cruise.",
    );
    let hover = hovering(aircraft);
    let cruise = cruising(aircraft);
    let of = |found: &Result<(Trim, Linear), String>, omega: f64| {
        let (_, linear) = found.as_ref().map_err(Clone::clone)?;
        pitch_over_elevator(aircraft, linear, omega).map_err(|why| why.to_string())
    };
    let band = [0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0];
    compare(&mut case, "hover q/δe", &band, &HOVER_PITCH, &[], |omega| of(&hover, omega));
    compare(&mut case, "cruise q/δe", &band[1..], &CRUISE_PITCH, &[], |omega| of(&cruise, omega));
    const HEAVE_FITS: &[Fit] = &[Fit::Governor, Fit::LeverLaw];
    const OF_THE_SAME: &str = "the response it is a pole of";
    // One per cent of the lever; the accelerometer reads the specific force.
    let percent = 0.01 * aircraft.fcc.travel.collective_m / engine::GRAVITY_MPS2;
    compare(&mut case, "hover a_z/lever", &band[..8], &HOVER_HEAVE, HEAVE_FITS, |omega| {
        let (_, linear) = hover.as_ref().map_err(Clone::clone)?;
        linear.response(3, 10, omega).map(|g| g * percent).map_err(|why| why.to_string())
    });
    let pitching = mode(&hover, "hover oscillation in pitch");
    let omega = pitching.as_ref().map(Mode::frequency_radps).map_err(Clone::clone);
    case.row("hover oscillation ω, rad/s", 0.579, omega, Band::Part(0.15), 3).twice(OF_THE_SAME);
    let growth = pitching.map(|mode| mode.eigenvalue.re);
    case.row("hover oscillation σ, 1/s", 0.268, growth, Band::Within(0.08), 3).twice(OF_THE_SAME);
    let heave = mode(&hover, "heave").map(|mode| -mode.eigenvalue.re);
    case.row("hover heave damping, 1/s", 0.105, heave, Band::Part(0.25), 3)
        .fitted(HEAVE_FITS)
        .twice(OF_THE_SAME);
    let short = mode(&cruise, "short period");
    let omega = short.as_ref().map(Mode::frequency_radps).map_err(Clone::clone);
    case.row("cruise short period ω, rad/s", 2.02, omega, Band::Part(0.15), 2).twice(OF_THE_SAME);
    let zeta = short.map(|mode| mode.damping());
    case.row("cruise short period ζ", 0.536, zeta, Band::Within(0.1), 3).twice(OF_THE_SAME);
    book.add(case);
}

/// The aircraft of 1975: inertia and rotor speed in hover of NASA TM X-62,407, §3.1.3 and §6.
fn of_1975(aircraft: &Aircraft) -> Aircraft {
    aircraft.clone().with(|design| {
        let inertia = &mut design.weight_balance.inertia;
        inertia.xx_kg_m2 = 42_400.0 * SLUG_FT2_KG_M2;
        inertia.yy_kg_m2 = 14_300.0 * SLUG_FT2_KG_M2;
        inertia.zz_kg_m2 = 49_500.0 * SLUG_FT2_KG_M2;
        design.fcc.governor.rotor_speed_radps[0] = 565.0 * RPM_RADPS;
    })
}

/// SCAS, 1 when on; then of pitch, roll and yaw attitude after 1 s per inch, damping, sensitivity.
type Augmented = (&'static str, u64, [f64; 3], [f64; 3], [f64; 3]);

/// Case 10's published numbers.
const TMX: [Augmented; 2] = [
    ("off", 0, [9.0, 6.6, 4.0], [0.85, 0.77, 0.116], [0.350, 0.471, 0.132]),
    ("on", 1, [5.3, 11.5, 15.0], [1.54, 1.82, 2.5], [0.300, 0.489, 0.328]),
];

/// Attitude change in a second after an inch of stick or pedal, deg.
fn second_after_an_inch(aircraft: &Aircraft, target: &Target, trim: &Trim, axis: usize) -> f64 {
    let mut state = trim.state;
    let travel = &aircraft.fcc.travel;
    match axis {
        0 => state.cockpit.stick_aft_norm += INCH_M / travel.longitudinal_stick_m,
        1 => state.cockpit.stick_right_norm += INCH_M / travel.lateral_stick_m,
        _ => state.cockpit.pedal_right_norm += INCH_M / travel.pedal_m,
    }
    for _ in 0..250 {
        state = engine::step(aircraft, &state, &Inputs { events: &[], world: target.world }).0;
    }
    let (from, to) = (trim.state.plant.attitude.euler(), state.plant.attitude.euler());
    DEG * match axis {
        0 => to.pitch_rad - from.pitch_rad,
        1 => to.roll_rad - from.roll_rad,
        _ => to.heading_rad - from.heading_rad,
    }
}

/// Case 10.
pub fn control(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        10,
        Class::C,
        "hover control, SCAS off and on",
        "NASA TM X-62,407 Table 8.3.2, before the first flight.",
    )
    .tolerance("±25 %, sanity only.")
    .set_up(
        "Flown with what the table belongs to: the inertia of 1975 (42,400, 14,300 and 49,500 \
         slug ft² for 52,795, 21,360 and 66,335) and its 565 rpm; rotors, gearing and SCAS are \
         those of every other case. The gains of the SCAS were solved back from this very table, \
         so that the nine numbers with it predict nothing.",
    )
    .misses(
        "The table does not agree with itself. An acceleration S against a damping D turns by \
         S/D·(1 − (1 − exp(−D))/D) in a second: roll off, .471 and .77 make 10.6 deg, not 6.6; \
         yaw on, .328 makes 9.4 deg with no damping at all, not 15.0; roll on, .489 and 1.82 make \
         8.3 deg, not 11.5.",
    )
    .misses(
        "Damping in pitch and roll is that of ideal rotors: without the in-plane force of a \
         turning rotor (Amer), which takes nearly half of what the tilt of a loaded proprotor \
         gives, and without the losses of its inflow, ours were .9 and .8 1/s. Roll sensitivity: \
         the published gearing, .625 deg/in, at the measured thrust slope and 565 rpm makes .27 \
         rad/s²/in.",
    );
    let aircraft = &of_1975(aircraft);
    let axes = ["pitch", "roll", "yaw"];
    for (name, scas_on, attitudes, dampings, sensitivities) in TMX {
        let target = Target { scas_on, ..Target::default() };
        let found = system(aircraft, &target);
        let fits: &[Fit] = if scas_on == 1 { &[Fit::Scas] } else { &[] };
        for (axis, label) in axes.iter().enumerate() {
            let attitude = found
                .as_ref()
                .map(|(trim, _)| second_after_an_inch(aircraft, &target, trim, axis))
                .map_err(Clone::clone);
            let what = format!("SCAS {name}, {label} after 1 s, deg/in");
            case.row(what, attitudes[axis], attitude, Band::Part(0.25), 1).fitted(fits);
            let derivatives = found.as_ref().map_err(Clone::clone).map(|(_, linear)| {
                let slow = linear
                    .quasi_steady(|state| matches!(state.part(), Part::Rotors | Part::Actuators));
                // Roll, pitch, yaw rate are the states 3, 4, 5.
                let rate = [4, 3, 5][axis];
                (-slow.a[(rate, rate)], slow.b[(rate, axis)] * INCH_M)
            });
            let damping = derivatives.as_ref().map(|(damping, _)| *damping).map_err(Clone::clone);
            let what = format!("SCAS {name}, {label} damping, 1/s");
            case.row(what, dampings[axis], damping, Band::Part(0.25), 3).fitted(fits);
            let sensitivity = derivatives.map(|(_, sensitivity)| sensitivity);
            let what = format!("SCAS {name}, {label} sensitivity, rad/s²/in");
            case.row(what, sensitivities[axis], sensitivity, Band::Part(0.25), 3).fitted(fits);
        }
    }
    book.add(case);
}

/// Case 12.
pub fn symmetry(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        12,
        Class::Own,
        "left and right exchanged",
        "No source: what mirrors must fly as the mirror image.",
    )
    .tolerance("Exact, to the bit.")
    .set_up("500 ticks with stick and pedal over, and the same mirrored.");
    for (name, mast_tilt_rad, speed_kt, flap_detent) in [
        ("hover", 0.0, 0.0, 2),
        ("conversion, 120 kt", 0.25 * PI, 120.0, 1),
        ("aeroplane, 180 kt", 0.5 * PI, 180.0, 0),
    ] {
        let airspeed_mps = speed_kt * KNOT_MPS;
        let target = Target { mast_tilt_rad, airspeed_mps, flap_detent, ..Target::default() };
        let different = trim(aircraft, &target).map_err(|failure| why(&failure)).map(|trim| {
            let mut state = trim.state;
            state.cockpit.stick_right_norm = 0.2;
            state.cockpit.pedal_right_norm = -0.3;
            let mut mirror = state.mirrored();
            let mut different = 0.0;
            for _ in 0..500 {
                let fly = |state: &State| {
                    engine::step(aircraft, state, &Inputs { events: &[], world: target.world }).0
                };
                (state, mirror) = (fly(&state), fly(&mirror));
                if state.mirrored() != mirror {
                    different += 1.0;
                }
            }
            different
        });
        case.row(format!("{name}: ticks that differ"), 0.0, different, Band::Within(0.0), 0);
    }
    book.add(case);
}

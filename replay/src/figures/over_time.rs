//! Figures over time: one table says what each of them shows.

use chart::Curve;
use chart::stack::{Panel, Stack};
use engine::math::{max, min};
use engine::units::{FOOT_M, FPM_PER_MPS, RPM_PER_RADPS, degrees, knots};

use super::flight::{Flight, Row};
use super::list::Figure;
use super::look;

/// How a quantity is read off a row.
type Read = fn(&Row) -> f64;

/// What a panel shows.
struct Shown {
    /// What it is, with its unit.
    title: &'static str,
    /// Least range of the axis.
    least: f64,
    /// Values that the axis has in any case.
    with: &'static [f64],
    quantity: Quantity,
}

/// One curve, or two that are told apart.
enum Quantity {
    One(Read),
    Two([(&'static str, Read); 2]),
    Sides(Read, Read),
}

use Quantity::{One, Sides, Two};

const fn shown(title: &'static str, least: f64, with: &'static [f64], quantity: Quantity) -> Shown {
    Shown { title, least, with, quantity }
}

const PROFILE: [Shown; 6] = [
    shown("Height of the centre of gravity above the ground, m", 10.0, &[0.0], One(|r| r.height_m)),
    shown(
        "Airspeed, kt",
        20.0,
        &[0.0],
        Two([
            ("calibrated", |r| knots(r.calibrated_airspeed_mps)),
            ("true", |r| knots(r.airspeed_mps)),
        ]),
    ),
    shown("Climb, ft/min", 400.0, &[0.0], One(|r| -r.velocity_mps.z * FPM_PER_MPS)),
    shown(
        "Nacelle incidence, deg (90 helicopter, 0 aeroplane)",
        10.0,
        &[0.0, 90.0],
        One(|r| r.incidence_deg),
    ),
    shown("Load factor, g", 0.4, &[1.0], One(|r| r.load_factor)),
    shown(
        "Engine power, kW",
        200.0,
        &[0.0],
        Sides(|r| r.power_w.left * 1e-3, |r| r.power_w.right * 1e-3),
    ),
];

const EULER: [Shown; 3] = [
    shown("Roll φ, deg (right wing down positive)", 10.0, &[0.0], One(|r| degrees(r.roll_rad))),
    shown("Pitch θ, deg (nose up positive)", 10.0, &[0.0], One(|r| degrees(r.pitch_rad))),
    shown(
        "Heading ψ, deg (from north to the east, continued beyond a turn)",
        20.0,
        &[],
        One(|r| degrees(r.heading_rad)),
    ),
];

const CONTROLS: [Shown; 7] = [
    shown(
        "Longitudinal stick, % of travel (aft positive)",
        20.0,
        &[0.0],
        One(|r| 100.0 * r.stick_aft_norm),
    ),
    shown(
        "Lateral stick, % of travel (right positive)",
        20.0,
        &[0.0],
        One(|r| 100.0 * r.stick_right_norm),
    ),
    shown(
        "Pedals, % of travel (right positive)",
        20.0,
        &[0.0],
        One(|r| 100.0 * r.pedal_right_norm),
    ),
    shown(
        "Power lever, % of travel (up positive)",
        20.0,
        &[0.0, 100.0],
        One(|r| 100.0 * r.lever_norm),
    ),
    shown(
        "Collective pitch at ¾ radius, deg",
        5.0,
        &[],
        Sides(|r| degrees(r.collective_rad.left), |r| degrees(r.collective_rad.right)),
    ),
    shown(
        "Elevator, deg (trailing edge down positive)",
        5.0,
        &[0.0],
        One(|r| degrees(r.elevator_rad)),
    ),
    shown("Flaps, deg", 20.0, &[0.0], One(|r| degrees(r.flap_rad))),
];

const ROTORS: [Shown; 5] = [
    shown(
        "Thrust, kN",
        5.0,
        &[0.0],
        Sides(|r| r.thrust_n.left * 1e-3, |r| r.thrust_n.right * 1e-3),
    ),
    shown(
        "Torque at the mast, kN·m",
        2.0,
        &[0.0],
        Sides(|r| r.torque_n_m.left * 1e-3, |r| r.torque_n_m.right * 1e-3),
    ),
    shown(
        "Collective pitch at ¾ radius, deg",
        5.0,
        &[],
        Sides(|r| degrees(r.collective_rad.left), |r| degrees(r.collective_rad.right)),
    ),
    shown(
        "Tip path tilted aft, deg",
        2.0,
        &[0.0],
        Sides(|r| degrees(r.flapping_aft_rad.left), |r| degrees(r.flapping_aft_rad.right)),
    ),
    shown("Rotor speed, rpm", 60.0, &[], One(|r| r.rotor_speed_radps * RPM_PER_RADPS)),
];

/// A figure over time of a flight, or of two.
pub fn stack(figure: Figure, flights: &[&Flight]) -> Stack {
    let shown: &[Shown] = match figure {
        Figure::Euler => &EULER,
        Figure::Controls => &CONTROLS,
        Figure::Rotors => &ROTORS,
        _ => &PROFILE,
    };
    let ranges = flights.iter().map(|flight| flight.range_s());
    let x_range = ranges.fold((f64::MAX, f64::MIN), |(a, b), (c, d)| (min(a, c), max(b, d)));
    let height = if shown.len() > 5 { 76.0 } else { 96.0 };
    let panel = |shown: &Shown| Panel { height, ..panel(shown, flights) };
    let mut panels: Vec<Panel> = shown.iter().map(panel).collect();
    if figure == Figure::Profile {
        // Pilots read feet.
        let feet =
            flights.iter().flat_map(|flight| &flight.rows).map(|row| row.height_m).fold(0.0, max)
                / FOOT_M;
        panels[0].title += &format!("; greatest {feet:.0} ft");
    }
    Stack {
        title: figure.facts().words.into(),
        subtitle: look::subtitle(flights, ""),
        x_title: "Time, s".into(),
        x_range,
        bands: look::bands(flights),
        panels,
        moments: look::moments(flights),
    }
}

fn panel(shown: &Shown, flights: &[&Flight]) -> Panel {
    let alone = flights.len() == 1;
    let mut curves = Vec::new();
    for (of, flight) in flights.iter().enumerate() {
        let points = |read: Read| -> Vec<[f64; 2]> {
            flight.rows.iter().map(|row| [row.time_s, read(row)]).collect()
        };
        let mut add = |words: &str, pen, read: Read| {
            curves.push(Curve::line(look::name(flights, of, words), pen, points(read)));
        };
        match shown.quantity {
            One(read) => add("", look::pen(of, alone, false), read),
            Two(two) => {
                for (second, (words, read)) in two.into_iter().enumerate() {
                    add(words, look::pen(of, alone, second == 1), read);
                }
            }
            Sides(left, right) => {
                add("left", look::side_pen(of, alone, false), left);
                add("right", look::side_pen(of, alone, true), right);
            }
        }
    }
    Panel { with: shown.with.to_vec(), ..Panel::new(shown.title, shown.least, curves) }
}

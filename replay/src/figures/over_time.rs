//! Figures over time: one table says what each of them shows.

use chart::stack::{Panel, Stack};
use chart::{Curve, Dash, Pen};
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
    /// Whether it is an angle that goes round.
    turns: bool,
}

/// One curve, or two that are told apart.
enum Quantity {
    One(Read),
    Two([(&'static str, Read); 2]),
    Sides(Read, Read),
}

use Quantity::{One, Sides, Two};

const fn shown(title: &'static str, least: f64, with: &'static [f64], quantity: Quantity) -> Shown {
    Shown { title, least, with, quantity, turns: false }
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
    Shown {
        turns: true,
        ..shown(
            "Heading ψ, deg (from north to the east, continued beyond a turn)",
            20.0,
            &[],
            One(|r| degrees(r.heading_rad)),
        )
    },
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
    let mut all: Vec<&Shown> = shown.iter().collect();
    if figure == Figure::Profile && flights.iter().any(|flight| flight.crash_s().is_some()) {
        // How it came down.
        all.extend(EULER.iter().filter(|shown| !shown.turns));
    }
    let mut panels: Vec<Panel> = Vec::new();
    for shown in all {
        panels.push(Panel { height, ..panel(shown, flights) });
        if let [first, second] = flights {
            panels.push(difference(shown, first, second));
        }
    }
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
    let turns = shown.turns;
    Panel { with: shown.with.to_vec(), turns, ..Panel::new(shown.title, shown.least, curves) }
}

/// Height of a strip of differences.
const STRIP: f64 = 34.0;
/// It has this part of the range at least that the quantity itself has: what is less is rounding.
const STRIP_NORM: f64 = 1e-4;

/// The second flight less the first, where both are.
fn difference(shown: &Shown, first: &Flight, second: &Flight) -> Panel {
    let both = together(&first.rows, &second.rows);
    let points = |read: Read| -> Vec<[f64; 2]> {
        let apart = |(a, b): &(&Row, &Row)| {
            let apart = read(b) - read(a);
            [a.time_s, if shown.turns { around(apart) } else { apart }]
        };
        both.iter().map(apart).collect()
    };
    let pen = |dash| Pen { colour: look::DIFFERENCE, width: 1.0, dash };
    let line = |name: &str, dash, read| Curve::line(name, pen(dash), points(read));
    let curves = match shown.quantity {
        One(read) => vec![line("", Dash::Solid, read)],
        Two([(a, read_a), (b, read_b)]) => {
            vec![line(a, Dash::Solid, read_a), line(b, Dash::Dashed, read_b)]
        }
        Sides(left, right) => {
            vec![line("left", Dash::Solid, left), line("right", Dash::Dashed, right)]
        }
    };
    let unit = unit(shown.title);
    let title = format!("{} less {}{unit}; {}", second.name, first.name, largest(&curves));
    let least = STRIP_NORM * shown.least;
    Panel { height: STRIP, with: vec![0.0], ..Panel::new(title, least, curves) }
}

/// The largest difference of some curves, and when it is.
fn largest(curves: &[Curve]) -> String {
    let points = curves.iter().flat_map(|curve| &curve.points);
    let farther = |most: [f64; 2], next: &[f64; 2]| {
        if next[1].abs() > most[1].abs() { *next } else { most }
    };
    match points.fold([0.0; 2], farther) {
        [_, apart] if apart.abs() <= 0.0 => "the same".into(),
        [at_s, apart] => {
            let digits = if apart.abs() < 0.01 { 5 } else { 2 };
            format!("largest {} at {at_s:.2} s", chart::with_minus(format!("{apart:.digits$}")))
        }
    }
}

/// Rows of the same time.
fn together<'a>(first: &'a [Row], second: &'a [Row]) -> Vec<(&'a Row, &'a Row)> {
    let mut both = Vec::new();
    let mut rest = second.iter().peekable();
    for a in first {
        while rest.next_if(|b| b.time_s < a.time_s).is_some() {}
        // Of the same tick: the same bits.
        if let Some(b) = rest.next_if(|b| b.time_s <= a.time_s) {
            both.push((a, b));
        }
    }
    both
}

/// The shorter way round, deg.
fn around(apart_deg: f64) -> f64 {
    (apart_deg + 180.0).rem_euclid(360.0) - 180.0
}

/// The unit of a title, behind a comma; none of a ratio.
fn unit(title: &str) -> String {
    let words = title.split(" (").next().unwrap_or(title);
    words.rsplit_once(", ").map_or_else(String::new, |(_, unit)| format!(", {unit}"))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use engine::Outputs;
    use engine::math::PI;
    use engine::pair::Pair;

    use super::*;
    use crate::figures::flight::Gatherer;

    #[test]
    fn units_are_told_from_titles() {
        for shown in PROFILE.iter().chain(&EULER).chain(&CONTROLS).chain(&ROTORS) {
            let unit = unit(shown.title);
            assert!(unit.starts_with(", ") && unit.len() < 14, "{}: {unit}", shown.title);
        }
        assert_eq!(unit("Power lever, % of travel (up positive)"), ", % of travel");
        assert_eq!(unit(EULER[2].title), ", deg");
    }

    #[test]
    fn headings_differ_by_the_shorter_way_round() {
        assert!((around(359.0) + 1.0).abs() < 1e-9 && (around(-350.0) - 10.0).abs() < 1e-9);
    }

    /// A flight of one row, 20 ms after its begin.
    fn flight(name: &str, outputs: Outputs) -> Flight {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let mut gatherer = Gatherer::new(Path::new(name), &xv15);
        gatherer.add(&Outputs { tick: 5, ..outputs });
        gatherer.flight
    }

    /// Every quantity in SI, as the definitions of their units have it: a knot is 1852 m an hour, 1000 ft
    /// a minute are 304.8 m in 60 s, 30 deg are π/6 and 600 rpm are ten turns of 2π a second.
    fn outputs() -> Outputs {
        let kt = |kt: f64| kt * 1852.0 / 3600.0;
        let mut o = Outputs {
            height_above_ground_m: 30.0,
            calibrated_airspeed_mps: kt(100.0),
            airspeed_mps: kt(120.0),
            load_factor: 1.5,
            rotor_speed_radps: 20.0 * PI,
            ..Outputs::default()
        };
        o.velocity_mps.z = -304.8 / 60.0;
        (o.euler.roll_rad, o.euler.pitch_rad, o.euler.heading_rad) =
            (-PI / 6.0, PI / 18.0, PI / 2.0);
        (o.cockpit.stick_aft_norm, o.cockpit.stick_right_norm) = (0.25, -0.5);
        (o.cockpit.pedal_right_norm, o.cockpit.collective_norm) = (0.1, 0.7);
        (o.actuators.elevator_rad, o.actuators.flap_rad) = (-PI / 36.0, PI / 9.0);
        o.actuators.mast_tilt_rad = Pair { left: PI / 6.0, right: PI / 6.0 };
        o.actuators.collective_rad = Pair { left: PI / 18.0, right: PI / 12.0 };
        o.engines.power_w = Pair { left: 500e3, right: 400e3 };
        (o.rotors.left.thrust_n, o.rotors.right.thrust_n) = (30e3, 31e3);
        (o.rotors.left.torque_n_m, o.rotors.right.torque_n_m) = (12e3, 13e3);
        (o.rotors.left.tilt_aft_rad, o.rotors.right.tilt_aft_rad) = (PI / 90.0, -PI / 60.0);
        o
    }

    #[test]
    fn every_quantity_is_drawn_in_the_unit_of_its_title() {
        type Panels = &'static [(&'static str, &'static [f64])];
        let expected: [(Figure, Panels); 4] = [
            (
                Figure::Profile,
                &[
                    // 30 m over 0.3048 m.
                    (
                        "Height of the centre of gravity above the ground, m; greatest 98 ft",
                        &[30.0],
                    ),
                    ("Airspeed, kt", &[100.0, 120.0]),
                    ("Climb, ft/min", &[1000.0]),
                    ("Nacelle incidence, deg (90 helicopter, 0 aeroplane)", &[60.0]),
                    ("Load factor, g", &[1.5]),
                    ("Engine power, kW", &[500.0, 400.0]),
                ],
            ),
            (
                Figure::Euler,
                &[
                    ("Roll φ, deg (right wing down positive)", &[-30.0]),
                    ("Pitch θ, deg (nose up positive)", &[10.0]),
                    ("Heading ψ, deg (from north to the east, continued beyond a turn)", &[90.0]),
                ],
            ),
            (
                Figure::Controls,
                &[
                    ("Longitudinal stick, % of travel (aft positive)", &[25.0]),
                    ("Lateral stick, % of travel (right positive)", &[-50.0]),
                    ("Pedals, % of travel (right positive)", &[10.0]),
                    ("Power lever, % of travel (up positive)", &[70.0]),
                    ("Collective pitch at ¾ radius, deg", &[10.0, 15.0]),
                    ("Elevator, deg (trailing edge down positive)", &[-5.0]),
                    ("Flaps, deg", &[20.0]),
                ],
            ),
            (
                Figure::Rotors,
                &[
                    ("Thrust, kN", &[30.0, 31.0]),
                    ("Torque at the mast, kN·m", &[12.0, 13.0]),
                    ("Collective pitch at ¾ radius, deg", &[10.0, 15.0]),
                    ("Tip path tilted aft, deg", &[2.0, -3.0]),
                    ("Rotor speed, rpm", &[600.0]),
                ],
            ),
        ];
        let flight = flight("flight.mcap", outputs());
        for (figure, expected) in expected {
            let panels = stack(figure, &[&flight]).panels;
            assert_eq!(panels.len(), expected.len());
            for (panel, (title, values)) in panels.iter().zip(expected) {
                let points: Vec<_> = panel.curves.iter().map(|curve| curve.points[0]).collect();
                assert_eq!((&*panel.title, points.len()), (*title, values.len()));
                for ([time_s, drawn], value) in points.into_iter().zip(*values) {
                    assert!((time_s - 0.02).abs() < 1e-9, "{title}: at {time_s} s");
                    assert!((drawn - value).abs() < 1e-9, "{title}: {drawn} for {value}");
                }
            }
        }
    }

    #[test]
    fn below_each_quantity_of_two_flights_is_the_second_less_the_first() {
        let faster = Outputs { rotor_speed_radps: 20.2 * PI, ..outputs() };
        let (a, b) = (flight("a.mcap", outputs()), flight("b.mcap", faster));
        let panels = stack(Figure::Rotors, &[&a, &b]).panels;
        let titles: Vec<_> = panels.iter().skip(1).step_by(2).map(|panel| &*panel.title).collect();
        assert_eq!(
            titles,
            [
                "b.mcap less a.mcap, kN; the same",
                "b.mcap less a.mcap, kN·m; the same",
                "b.mcap less a.mcap, deg; the same",
                "b.mcap less a.mcap, deg; the same",
                "b.mcap less a.mcap, rpm; largest 6.00 at 0.02 s",
            ]
        );
        let [at_s, apart] = panels[9].curves[0].points[0];
        assert!((at_s - 0.02).abs() < 1e-9 && (apart - 6.0).abs() < 1e-9, "{apart} at {at_s} s");
    }
}

//! Colours and words that all figures share.

use chart::moments::{Gravity, Moment, Moments};
use chart::stack::Span;
use chart::{Colour, Dash, Pen};
use engine::STEP_S;
use logs::view::Level;

use super::flight::{Configuration, Flight};

/// The only flight.
const ALONE: Colour = Colour(0x15, 0x4A, 0x8C);
/// One flight, and another one beside it: apart for every kind of sight and in print, and from the colours of
/// the configurations and of the sides.
pub const FLIGHTS: [Colour; 2] = [Colour(0x4A, 0x4A, 0x4A), Colour(0xC7, 0x15, 0x8B)];
/// Left is red and right is green, as the navigation lights are.
pub const SIDES: [Colour; 2] = [Colour(0xC2, 0x3B, 0x32), Colour(0x1E, 0x84, 0x49)];
/// What is outside its limits.
pub const ALARM: Colour = Colour(0xC2, 0x1F, 0x1F);
/// What lies between two flights.
pub const DIFFERENCE: Colour = Colour(0x7A, 0x2E, 0x00);
/// A limit.
pub const LIMIT: Colour = Colour(0x8A, 0x8A, 0x8A);
/// Width of a curve, points.
const WIDTH: f64 = 1.15;

/// The pen of a curve: of the only flight, or of one of two.
pub fn pen(of: usize, alone: bool, second: bool) -> Pen {
    let dash = if second { Dash::Dashed } else { Dash::Solid };
    Pen { colour: of_flight(of, alone), width: width(of, alone), dash }
}

/// Colour of the only flight, or of one of two.
pub fn of_flight(of: usize, alone: bool) -> Colour {
    if alone { ALONE } else { FLIGHTS[of.min(1)] }
}

/// Of two flights the second is drawn within the first: where they are the same, both are seen.
fn width(of: usize, alone: bool) -> f64 {
    match (alone, of) {
        (true, _) => WIDTH,
        (false, 0) => 2.2 * WIDTH,
        (false, _) => 0.8 * WIDTH,
    }
}

/// The pen of a side of the only flight; of two, sides are told apart by their dashes.
pub fn side_pen(of: usize, alone: bool, right: bool) -> Pen {
    let colour = if alone { SIDES[usize::from(right)] } else { FLIGHTS[of.min(1)] };
    Pen { colour, width: width(of, alone), dash: if right { Dash::Dashed } else { Dash::Solid } }
}

/// Colour of a configuration, for a line.
pub fn colour(configuration: Configuration) -> Colour {
    match configuration {
        Configuration::Helicopter => Colour(0x15, 0x4A, 0x8C),
        Configuration::Converting => Colour(0xD9, 0x82, 0x00),
        Configuration::Aeroplane => Colour(0x1E, 0x84, 0x49),
    }
}

/// The same, behind words.
fn tint(configuration: Configuration) -> Colour {
    match configuration {
        Configuration::Helicopter => Colour(0xCF, 0xDD, 0xEF),
        Configuration::Converting => Colour(0xF6, 0xE0, 0xBD),
        Configuration::Aeroplane => Colour(0xCC, 0xE6, 0xD5),
    }
}

/// The name of a curve: of two flights each has the name of its log.
pub fn name(flights: &[&Flight], of: usize, words: &str) -> String {
    match (flights.len(), words) {
        (1, _) => words.into(),
        (_, "") => flights[of].name.clone(),
        _ => format!("{}: {words}", flights[of].name),
    }
}

/// Which log it is, or which two.
pub fn subtitle(flights: &[&Flight], more: &str) -> String {
    let named = |flight: &&Flight| {
        let crash = flight.crash_s().map(|at_s| format!("CRASH at {at_s:.1} s"));
        let told: Vec<String> = crash.into_iter().chain(flight.caveat.clone()).collect();
        match told[..] {
            [] => flight.name.clone(),
            _ => format!("{} ({})", flight.name, told.join("; ")),
        }
    };
    let names = flights.iter().map(named).collect::<Vec<_>>().join(" and ");
    if more.is_empty() { names } else { format!("{names}; {more}") }
}

/// The configurations of each flight over time.
pub fn bands(flights: &[&Flight]) -> Vec<Vec<Span>> {
    let band = |flight: &&Flight| {
        let span = |(configuration, first, last): (Configuration, usize, usize)| Span {
            from: flight.rows[first].time_s,
            to: flight.rows[last].time_s,
            words: configuration.words().into(),
            colour: tint(configuration),
        };
        flight.stretches().into_iter().map(span).collect()
    };
    flights.iter().map(band).collect()
}

/// What happened in each flight, numbered.
pub fn moments(flights: &[&Flight]) -> Vec<Moments> {
    let of = |(place, flight): (usize, &&Flight)| {
        let (chosen, left) = flight.moments();
        let list = chosen.into_iter().map(|happened| {
            let at = happened.tick as f64 * STEP_S;
            let gravity = match happened.level {
                Level::Info => Gravity::Told,
                Level::Warn => Gravity::Warned,
                Level::Error => Gravity::Failed,
            };
            Moment { at, words: format!("{at:.1} s  {}", happened.short()), gravity }
        });
        Moments {
            of: if flights.len() > 1 { flight.name.clone() } else { String::new() },
            colour: if flights.len() > 1 {
                FLIGHTS[place.min(1)]
            } else {
                Colour(0x40, 0x40, 0x40)
            },
            list: list.collect(),
            rest: match left {
                0 => String::new(),
                left => format!("and {left} more events, which `tiltrotor log info` lists"),
            },
        }
    };
    flights.iter().enumerate().map(of).collect()
}

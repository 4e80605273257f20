//! What happened in a flight, in sentences.

use engine::STEP_S;
use engine::math::max;
use engine::outputs::{Severity, Validity};
use engine::units::{FOOT_M, NAUTICAL_MILE_M, knots};
use logs::records::FlightEvent;
use logs::view::Level;
use replay::figures::{Configuration, Happened};

use crate::afterwards::Afterwards;

/// The flight in sentences, what matters most first.
pub fn summary(flown: &Afterwards) -> Vec<String> {
    let mut sentences: Vec<String> = crash(flown).into_iter().collect();
    sentences.push(what_was_flown(flown));
    sentences.extend(configurations(flown));
    sentences.extend(ground(flown));
    let failed: Vec<String> = of(flown, FlightEvent::Failures)
        .chain(of(flown, FlightEvent::GaveUp))
        .map(|event| format!("At {} {}.", s(event.tick), event.words))
        .collect();
    sentences.extend(failed);
    sentences
}

/// What ended the flight before its end, if anything did: the hull on the ground, or numbers that are none. Of
/// several the one after which nothing was restarted, if there is one.
pub fn crash(flown: &Afterwards) -> Option<String> {
    let met = flown.debrief.validity.told().find(|facts| facts.severity == Severity::Final)?;
    let happened = &flown.flight.happened;
    let restart = |tick: u64| {
        happened
            .iter()
            .find(|event| event.what == Some(FlightEvent::Restarted) && event.tick >= tick)
    };
    let is_end = |event: &&Happened| {
        event.what == Some(FlightEvent::Impact) && event.level == Level::Error
            || event.words.contains(met.words)
    };
    let last = happened.iter().find(|event| is_end(event) && restart(event.tick).is_none());
    let event = last.or_else(|| happened.iter().find(is_end));
    let when =
        event.map_or_else(String::new, |event| format!(" at {}: {}", s(event.tick), event.words));
    let what = if met.flag == Validity::HULL { "CRASH" } else { "FROZEN" };
    let after = match event.and_then(|event| restart(event.tick)) {
        Some(restart) => format!("until the restart at {}", s(restart.tick)),
        None => "after it".into(),
    };
    Some(format!("{what}, {}{when}. Nothing {after} means anything.", met.words))
}

fn what_was_flown(flown: &Afterwards) -> String {
    let rows = &flown.flight.rows;
    let (first, last) = flown.ticks;
    let height_m = rows.iter().map(|row| row.height_m).fold(0.0, max);
    let speed_mps = rows.iter().map(|row| row.airspeed_mps).fold(0.0, max);
    let distance_m = flown.margins.distance_m;
    let distance = if distance_m < 1000.0 {
        format!("{distance_m:.0} m")
    } else {
        let miles = distance_m / NAUTICAL_MILE_M;
        format!("{:.2} km ({miles:.2} nautical miles)", distance_m * 1e-3)
    };
    format!(
        "{}: {:.1} s of flight, {distance} over the ground, up to {height_m:.0} m ({:.0} ft) above it and \
         {:.0} kt true airspeed.",
        flown.aircraft,
        (last - first) as f64 * STEP_S,
        height_m / FOOT_M,
        knots(speed_mps),
    )
}

/// From which configuration to which, and when.
fn configurations(flown: &Afterwards) -> Option<String> {
    let flight = &flown.flight;
    let stretches = flight.stretches();
    let (begun, rest) = stretches.split_first()?;
    if rest.is_empty() {
        return Some(format!("As {} throughout.", article(begun.0)));
    }
    let told: Vec<String> = rest
        .iter()
        .map(|(configuration, first, _)| {
            let at_s = flight.rows[*first].time_s;
            format!("{} from {at_s:.1} s", article(*configuration))
        })
        .collect();
    Some(format!("It began as {}; {}.", article(begun.0), told.join(", ")))
}

fn article(configuration: Configuration) -> &'static str {
    match configuration {
        Configuration::Helicopter => "a helicopter",
        Configuration::Converting => "in conversion",
        Configuration::Aeroplane => "an aeroplane",
    }
}

/// Lift-offs and touchdowns.
fn ground(flown: &Afterwards) -> Vec<String> {
    let told: Vec<String> = of(flown, FlightEvent::WeightOnWheels)
        .map(|event| format!("{} at {}", event.short(), s(event.tick)))
        .collect();
    match told.len() {
        0 => vec!["The wheels neither left the ground nor came to it.".into()],
        1..=6 => vec![format!("Wheels: {}.", told.join(", "))],
        count => {
            vec![format!("Wheels: {}, and {} more until {}.", told[0], count - 2, told[count - 1])]
        }
    }
}

fn of(flown: &Afterwards, what: FlightEvent) -> impl Iterator<Item = &Happened> {
    flown.flight.happened.iter().filter(move |event| event.what == Some(what))
}

/// A tick's time.
pub fn s(tick: u64) -> String {
    format!("{:.3} s", tick as f64 * STEP_S)
}

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
    let seconds = (last - first) as f64 * STEP_S;
    in_a_sentence(&flown.aircraft, seconds, flown.margins.distance_m, (height_m, speed_mps))
}

/// What it is, how long and how far it flew, and how high and how fast at most.
fn in_a_sentence(
    aircraft: &str,
    seconds: f64,
    distance_m: f64,
    (height_m, speed_mps): (f64, f64),
) -> String {
    let distance = if distance_m < 1000.0 {
        format!("{distance_m:.0} m")
    } else {
        let miles = distance_m / NAUTICAL_MILE_M;
        format!("{:.2} km ({miles:.2} nautical miles)", distance_m * 1e-3)
    };
    format!(
        "{aircraft}: {seconds:.1} s of flight, {distance} over the ground, up to {height_m:.0} m ({:.0} ft) above it and \
         {:.0} kt true airspeed.",
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_flown_is_told_in_the_units_of_both_worlds() {
        // A foot is .3048 m, a nautical mile 1852 m, a knot one of these an hour.
        let knots_mps = 1852.0 / 3600.0;
        assert_eq!(
            in_a_sentence("XV-15", 12.5, 999.0, (304.8, 100.0 * knots_mps)),
            "XV-15: 12.5 s of flight, 999 m over the ground, up to 305 m (1000 ft) above it and 100 kt true \
             airspeed."
        );
        assert_eq!(
            in_a_sentence("XV-15", 0.0, 2.0 * 1852.0, (0.0, 0.0)),
            "XV-15: 0.0 s of flight, 3.70 km (2.00 nautical miles) over the ground, up to 0 m (0 ft) above \
             it and 0 kt true airspeed."
        );
        let kilometre = in_a_sentence("XV-15", 1.0, 1000.0, (0.0, 0.0));
        assert!(kilometre.contains(" 1.00 km (0.54 nautical miles) "), "{kilometre}");
    }
}

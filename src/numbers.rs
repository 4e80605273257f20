//! Numbers of the command line: each has a range and a unit, and is refused with both.

use std::num::NonZero;

use analysis::condition::limits;

/// Reads a number from `least` to `greatest` in that unit.
pub fn between(
    least: f64,
    greatest: f64,
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| match text.parse() {
        Ok(number) if (least..=greatest).contains(&number) => Ok(number),
        _ => Err(format!("expected {least} to {greatest} {unit}")),
    }
}

/// The same of limits that are said elsewhere.
pub fn within(
    (least, greatest): (f64, f64),
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone {
    between(least, greatest, unit)
}

/// Reads a true airspeed.
pub fn speed_kt(text: &str) -> Result<f64, String> {
    within(limits::SPEED_KT, "kt")(text)
}

/// Reads a nacelle incidence.
pub fn nacelle_deg(text: &str) -> Result<f64, String> {
    within(limits::NACELLE_DEG, "deg (0 aeroplane, 90 helicopter)")(text)
}

/// Reads a height above mean sea level.
pub fn altitude_ft(text: &str) -> Result<f64, String> {
    within(limits::ALTITUDE_FT, "ft")(text)
}

/// Reads a rate of climb.
pub fn climb_fpm(text: &str) -> Result<f64, String> {
    within(limits::CLIMB_FPM, "ft/min")(text)
}

/// Reads a flap lever position.
pub fn flap_deg(text: &str) -> Result<f64, String> {
    within(limits::FLAP_DEG, "deg")(text)
}

/// Reads a rotor speed.
pub fn rotor_rpm(text: &str) -> Result<f64, String> {
    within(limits::RPM, "rpm")(text)
}

/// Reads a whole number from `least` to `greatest`, of what is counted.
pub fn whole(
    least: u64,
    greatest: u64,
    of: &'static str,
) -> impl Fn(&str) -> Result<u64, String> + Clone {
    move |text| match text.parse() {
        Ok(number) if (least..=greatest).contains(&number) => Ok(number),
        _ => Err(format!("expected a whole number from {least} to {greatest}: {of}")),
    }
}

/// Reads the number of a processor.
pub fn processor(text: &str) -> Result<usize, String> {
    whole(0, 1023, "a processor's number")(text).map(|number| number as usize)
}

/// Reads a number of threads.
pub fn threads(text: &str) -> Result<NonZero<usize>, String> {
    let threads = whole(1, 1024, "threads")(text)?;
    Ok(NonZero::new(threads as usize).unwrap_or(NonZero::<usize>::MIN))
}

/// Reads a UDP port that has three more after it.
pub fn port(text: &str) -> Result<u16, String> {
    whole(1, 65_532, "a port that has three more after it")(text).map(|number| number as u16)
}

/// Reads a duration of a tick or more.
pub fn duration_s(text: &str) -> Result<f64, String> {
    between(engine::STEP_S, 1e7, "s")(text)
}

/// Reads how long something is kept up: a time, or `forever`.
pub fn hold_s(text: &str) -> Result<f64, String> {
    if text == "forever" {
        return Ok(f64::INFINITY);
    }
    between(0.0, 1e7, "s, or `forever`")(text)
}

/// What is wrong with a number that was refused, in a line: `--speed-kt 1e9: expected -60 to 400 kt`.
pub fn in_words(error: &clap::Error) -> Option<String> {
    use clap::error::{ContextKind, ContextValue, ErrorKind};
    let said = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let (ErrorKind::ValueValidation, Some(option), Some(value)) =
        (error.kind(), said(ContextKind::InvalidArg), said(ContextKind::InvalidValue))
    else {
        return None;
    };
    let option = option.split(' ').next().unwrap_or(option);
    let why = std::error::Error::source(error)?;
    Some(format!("{option} {value}: {why}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_have_their_limits() {
        assert_eq!(processor("0"), Ok(0));
        assert_eq!(processor("7"), Ok(7));
        assert_eq!(processor("1023"), Ok(1023));
        let words = "expected a whole number from 0 to 1023: a processor's number";
        for wrong in ["-1", "1024", "1.0", "", "two"] {
            assert_eq!(processor(wrong), Err(words.into()), "{wrong}");
        }
        assert_eq!(threads("1").map(NonZero::get), Ok(1));
        assert_eq!(threads("1024").map(NonZero::get), Ok(1024));
        assert!(threads("0").is_err() && threads("1025").is_err());
        assert_eq!(port("1"), Ok(1));
        // Three more after it are ports, too.
        assert_eq!(port("65532"), Ok(u16::MAX - 3));
        assert!(port("0").is_err() && port("65533").is_err());
    }

    #[test]
    fn durations_are_a_tick_or_more_and_what_is_held_may_be_held_for_ever() {
        let is = |found: Result<f64, String>, expected: f64| {
            found.is_ok_and(|found| found.to_bits() == expected.to_bits())
        };
        assert!(is(duration_s("0.004"), 0.004) && is(duration_s("1e7"), 1e7));
        assert!(duration_s("0.003").is_err() && duration_s("1.1e7").is_err());
        assert!(is(hold_s("0"), 0.0) && is(hold_s("2.5"), 2.5));
        assert!(is(hold_s("forever"), f64::INFINITY));
        for wrong in ["-1", "inf", "1.1e7", "never"] {
            assert_eq!(hold_s(wrong), Err("expected 0 to 10000000 s, or `forever`".into()));
        }
    }
}

//! Numbers of the command line: each has a range and a unit, and is refused with both.

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

/// True airspeeds, kt; backwards as far as helicopters fly so.
pub const SPEED_KT: (f64, f64) = (-60.0, 400.0);

/// Reads a true airspeed.
pub fn speed_kt(text: &str) -> Result<f64, String> {
    between(SPEED_KT.0, SPEED_KT.1, "kt")(text)
}

/// Reads a nacelle incidence; a degree beyond the stops, for trims at a stop.
pub fn nacelle_deg(text: &str) -> Result<f64, String> {
    between(-1.0, 96.0, "deg (0 aeroplane, 90 helicopter)")(text)
}

/// Reads a height above mean sea level, as far as there is air.
pub fn altitude_ft(text: &str) -> Result<f64, String> {
    between(-6_000.0, 60_000.0, "ft")(text)
}

/// Reads a rate of climb.
pub fn climb_fpm(text: &str) -> Result<f64, String> {
    between(-20_000.0, 20_000.0, "ft/min")(text)
}

/// Reads a flap lever position.
pub fn flap_deg(text: &str) -> Result<f64, String> {
    between(0.0, 90.0, "deg")(text)
}

/// Reads a rotor speed.
pub fn rotor_rpm(text: &str) -> Result<f64, String> {
    between(0.0, 2_000.0, "rpm")(text)
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

/// Reads a UDP port that has two more after it.
pub fn port(text: &str) -> Result<u16, String> {
    whole(1, 65_533, "a port that has two more after it")(text).map(|number| number as u16)
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

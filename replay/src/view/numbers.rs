//! Numbers at the cursor, as a table that changes with it.

use std::fmt::Write;

use engine::pair::Pair;
use engine::units::{FPM_PER_MPS, KT_PER_MPS, RPM_PER_RADPS, compass_deg, degrees};
use engine::{Outputs, STEP_S};
use rerun::{MediaType, RecordingStream, RecordingStreamResult, TextDocument};

use super::basics::rounded;
use super::canvas::{Canvas, times};
use super::heading::escaped;
use super::modes;

/// Of so many rows one is told: five a second, as fast as anybody reads.
pub const ROWS_PER_PAGE: u64 = 10;

/// A number, with its unit, and how many decimals are read.
struct Number {
    name: &'static str,
    decimals: usize,
    of: fn(&Outputs) -> f64,
}

const fn number(name: &'static str, decimals: usize, of: fn(&Outputs) -> f64) -> Number {
    Number { name, decimals, of }
}

const READ: &[Number] = &[
    number("height AGL, m", 1, |o| o.height_above_ground_m),
    number("airspeed, KCAS", 1, |o| o.calibrated_airspeed_mps * KT_PER_MPS),
    number("climb, ft/min", 0, |o| -o.velocity_mps.z * FPM_PER_MPS),
    number("heading, °", 0, |o| compass_deg(o.euler.heading_rad)),
    number("roll, °", 1, |o| degrees(o.euler.roll_rad)),
    number("pitch, °", 1, |o| degrees(o.euler.pitch_rad)),
    number("load, g", 2, |o| o.load_factor),
    number("nacelles, °", 1, |o| 90.0 - degrees(o.actuators.mast_tilt_rad.mean())),
    number("lever, %", 0, |o| 100.0 * o.cockpit.collective_norm),
    number("rotors, rpm", 0, |o| o.rotor_speed_radps * RPM_PER_RADPS),
    number("power, kW", 0, |o| 1e-3 * o.engines.power_w.sum()),
];

/// A number of each rotor: its name with its unit, its decimals.
type OfRotors = (&'static str, usize, fn(&Outputs) -> Pair<f64>);

/// What is read of each rotor.
const READ_OF_ROTORS: &[OfRotors] = &[
    ("thrust, kN", 2, |o| o.rotors.map(|rotor| 1e-3 * rotor.thrust_n)),
    ("torque, kN·m", 2, |o| o.rotors.map(|rotor| 1e-3 * rotor.torque_n_m)),
    ("collective, °", 1, |o| o.actuators.collective_rad.map(degrees)),
    ("cyclic forward, °", 1, |o| o.actuators.cyclic_forward_rad.map(degrees)),
    ("tip path aft, °", 1, |o| o.rotors.map(|rotor| degrees(rotor.tilt_aft_rad))),
    ("outboard, °", 1, |o| o.rotors.map(|rotor| degrees(rotor.tilt_outboard_rad))),
    ("induced, m/s", 1, |o| o.rotors.map(|rotor| rotor.induced_mps)),
    ("C_T/σ", 3, |o| o.rotors.map(|rotor| rotor.blade_loading)),
];

/// The first line of a table, and the one below it.
fn head(page: &mut String, first: &str) {
    let _ = write!(page, "| {first} |");
    READ.iter().for_each(|number| {
        let _ = write!(page, " {} |", number.name);
    });
    page.push_str(" flown as | flaps | gear |\n|---|");
    page.push_str(&"---|".repeat(READ.len() + 3));
    page.push('\n');
}

/// A cell of a table.
fn cell(page: &mut String, decimals: usize, value: f64) {
    let _ = write!(page, " {} |", rounded(value, decimals));
}

/// A line of a table.
fn line(page: &mut String, first: &str, of: impl Fn(&Number) -> f64) {
    let _ = write!(page, "| {first} |");
    READ.iter().for_each(|number| cell(page, number.decimals, of(number)));
}

/// How it flies, in words.
fn words(page: &mut String, outputs: &Outputs) {
    let [nacelles, gear] = modes::words(outputs);
    let flaps_deg = degrees(outputs.actuators.flap_rad);
    let _ = writeln!(page, " {nacelles} | {flaps_deg:.0}° | {gear} |");
}

/// The modes and the flap's detent.
pub type Settings = ([&'static str; 2], u64);

/// What a reader would not want to see late: what flies, how the flaps and the gear stand.
pub fn settings(outputs: &Outputs) -> Settings {
    (modes::words(outputs), outputs.cockpit.flap_detent)
}

/// What is read at a tick; when the flight is over with what it is worth.
pub fn page(outputs: &Outputs, over: Option<&str>) -> String {
    let mut page = String::new();
    head(&mut page, "time, s");
    line(&mut page, &format!("**{:.2}**", outputs.tick as f64 * STEP_S), |number| {
        (number.of)(outputs)
    });
    words(&mut page, outputs);
    if let Some(over) = over {
        let _ = write!(page, "\n**{over}: none of these numbers means anything.**\n");
    }
    page
}

/// What is read of both rotors at a tick.
pub fn page_of_rotors(outputs: &Outputs) -> String {
    let [nacelles, gear] = modes::words(outputs);
    let (at_s, flaps_deg) = (outputs.tick as f64 * STEP_S, degrees(outputs.actuators.flap_rad));
    let mut page = format!("| {at_s:.2} s: {nacelles}, flaps {flaps_deg:.0}°, gear {gear} |");
    READ_OF_ROTORS.iter().for_each(|(name, ..)| {
        let _ = write!(page, " {name} |");
    });
    page.push_str("\n|---|");
    page.push_str(&"---|".repeat(READ_OF_ROTORS.len()));
    for (name, is_left) in [("**left**", true), ("**right**", false)] {
        let _ = write!(page, "\n| {name} |");
        for (_, decimals, of) in READ_OF_ROTORS {
            let both = of(outputs);
            cell(&mut page, *decimals, if is_left { both.left } else { both.right });
        }
    }
    page.push('\n');
    page
}

/// What is read of two flights at a tick.
pub fn page_of_two(names: [&str; 2], both: [&Outputs; 2]) -> String {
    let mut page = String::new();
    head(&mut page, &format!("at {:.2} s", both[0].tick as f64 * STEP_S));
    for (name, outputs) in names.into_iter().zip(both) {
        line(&mut page, &format!("**{}**", escaped(name)), |number| (number.of)(outputs));
        words(&mut page, outputs);
    }
    line(&mut page, "difference", |number| {
        let apart = (number.of)(both[1]) - (number.of)(both[0]);
        if number.name.starts_with("heading") { around(apart) } else { apart }
    });
    page.push_str(" | | |\n");
    page
}

/// The shorter way round, deg.
fn around(apart_deg: f64) -> f64 {
    (apart_deg + 180.0).rem_euclid(360.0) - 180.0
}

/// Says that pages are Markdown.
pub fn send_still(recording: &RecordingStream, entity: &str) -> RecordingStreamResult<()> {
    let markdown = TextDocument::update_fields().with_media_type(MediaType::markdown());
    recording.log_static(entity, &markdown)
}

/// Pages that wait to be written.
#[derive(Default)]
pub struct Pages {
    ticks: Vec<u64>,
    pages: Vec<String>,
}

impl Pages {
    /// Adds one.
    pub fn add(&mut self, tick: u64, page: String) {
        self.ticks.push(tick);
        self.pages.push(page);
    }

    /// Writes them.
    pub fn flush(&mut self, canvas: &mut Canvas, entity: &str) {
        let pages = std::mem::take(&mut self.pages);
        if pages.is_empty() {
            return;
        }
        let columns = TextDocument::update_fields()
            .with_many_text(pages)
            .columns_of_unit_batches()
            .map(Vec::from_iter);
        canvas.send(entity, &times(&self.ticks), columns);
        self.ticks.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outputs(heading_deg: f64) -> Outputs {
        let mut outputs = Outputs { tick: 500, ..Outputs::default() };
        outputs.euler.heading_rad = heading_deg.to_radians();
        outputs.height_above_ground_m = 12.34;
        outputs
    }

    fn cells(line: &str) -> Vec<&str> {
        line.split('|').map(str::trim).collect()
    }

    #[test]
    fn every_number_stands_below_its_name() {
        let page = page(&outputs(350.0), None);
        let lines: Vec<Vec<&str>> = page.lines().map(cells).collect();
        assert_eq!(lines.len(), 3, "{page}");
        assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{page}");
        let of = |name: &str| {
            let place = lines[0].iter().position(|cell| *cell == name).expect(name);
            lines[2][place]
        };
        assert_eq!(of("time, s"), "**2.00**");
        assert_eq!(of("height AGL, m"), "12.3");
        assert_eq!(of("heading, °"), "350");
        assert_eq!(of("flown as"), "helicopter");
    }

    #[test]
    fn every_number_of_a_rotor_stands_below_its_name() {
        let mut outputs = outputs(0.0);
        outputs.rotors.left.thrust_n = 30e3;
        outputs.rotors.right.thrust_n = 31e3;
        let page = page_of_rotors(&outputs);
        let lines: Vec<Vec<&str>> = page.lines().map(cells).collect();
        assert_eq!(lines.len(), 4, "{page}");
        assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{page}");
        assert_eq!((lines[2][1], lines[2][2]), ("**left**", "30.00"));
        assert_eq!((lines[3][1], lines[3][2]), ("**right**", "31.00"));
    }

    #[test]
    fn after_a_crash_the_numbers_say_what_they_are_worth_and_nothing_has_no_sign() {
        let mut outputs = outputs(0.0);
        outputs.euler.roll_rad = -1e-9;
        let page = page(&outputs, Some("CRASH at 6.49 s: hull on the ground"));
        assert!(page.ends_with("ground: none of these numbers means anything.**\n"), "{page}");
        assert!(!page.contains("-0"), "{page}");
    }

    #[test]
    fn of_two_the_difference_goes_the_shorter_way_round() {
        let page = page_of_two(["a_1", "b|2"], [&outputs(350.0), &outputs(10.0)]);
        // A name is neither Markdown nor a column.
        assert!(page.contains("**a\\_1**") && page.contains("**b\\|2**"), "{page}");
        let page = page.replace("\\|", "");
        let lines: Vec<Vec<&str>> = page.lines().map(cells).collect();
        assert_eq!(lines.len(), 5, "{page}");
        assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{page}");
        let place = lines[0].iter().position(|cell| *cell == "heading, °").expect("a column");
        assert_eq!(lines[4][place], "20");
    }
}

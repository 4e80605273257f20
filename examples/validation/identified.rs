//! Frequency responses as flight test finds them: swept by a pilot model through raw device events, and
//! identified from what was flown.

use analysis::Polar;
use analysis::linearize::decibels;
use engine::{Aircraft, STEP_S};
use recorder::pilots::Pilot;
use recorder::rehearse;
use replay::identify::{Options, Point, Record, Signal};

use crate::book::{Band, Book, Case, Class, DEG, INCH_M};
use crate::dynamics::{CRUISE_PITCH, HOVER_PITCH, Transfer, cruise_kt, near_deg};

/// Longer than any sweep, s.
const PATIENCE_S: f64 = 600.0;
/// Frequencies of the published responses that a record of six minutes carries, rad/s.
const OMEGAS: [f64; 8] = [0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0];
/// So close to each other are the identified ones that the nearest is within 1 %.
const PER_DECADE: f64 = 120.0;

/// Sweeps from a steady flight and identifies pitch rate over stick.
fn swept(aircraft: &Aircraft, steady: &str) -> Result<Vec<Point>, String> {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).map_err(|e| e.to_string())?;
    let aircraft = aircraft.clone().with_cockpit(map);
    let scenario = format!("{}\n[trim]\n{steady}\nscas_on = 0\n", aircraft::DEFAULT_SCENARIO);
    let start = aircraft::start("scenario.toml", &scenario).map_err(|e| e.to_string())?;
    let pilot =
        Pilot::named("sweep-pitch", &aircraft.cockpit, &aircraft).ok_or("no such pilot model")?;
    let signal = |name| Signal::named(name).map_err(|unknown| unknown.to_string());
    let mut record = Record::new(signal("stick_aft")?, signal("pitch_rate")?);
    let mut unrecorded = None;
    let ticks = (PATIENCE_S / STEP_S) as u64;
    rehearse(&aircraft, &start, vec![Box::new(pilot)], ticks, |now| {
        if let Err(error) = record.add(&aircraft, now.state, now.outputs) {
            unrecorded.get_or_insert(error.to_string());
        }
    })
    .map_err(|failure| failure.to_string())?;
    if let Some(error) = unrecorded {
        return Err(error);
    }
    let low_radps = Some(0.25);
    let options =
        Options { low_radps, high_radps: 8.0, per_decade: PER_DECADE, ..Options::default() };
    record.response(&options).map_err(|refusal| refusal.to_string())
}

fn rows(case: &mut Case, name: &str, aircraft: &Aircraft, steady: &str, published: &Transfer) {
    const LINEARIZED: &str = "case 9, the linearised model";
    let found = swept(aircraft, steady);
    // The source's elevator goes down with the stick forward: deg of it an inch of stick.
    let gearing = -aircraft.fcc.mixer.elevator_per_longitudinal_stick_rad_per_m * INCH_M * DEG;
    for omega in OMEGAS {
        let nearest = found.as_ref().map_err(Clone::clone).and_then(|points| {
            let off = |point: &&Point| (point.omega_radps - omega).abs();
            points
                .iter()
                .min_by(|a, b| off(a).total_cmp(&off(b)))
                .ok_or_else(|| "not excited".to_owned())
        });
        let reference = published.at(nearest.as_ref().map_or(omega, |point| point.omega_radps));
        let reference_db = decibels(reference.magnitude());
        let reference_deg = reference.phase_rad() * DEG;
        let response = nearest.map(|point| point.response / gearing);
        let gain = response.as_ref().map(|g| decibels(g.norm())).map_err(Clone::clone);
        case.row(format!("{name} at {omega} rad/s, dB"), reference_db, gain, Band::Within(3.0), 1)
            .twice(LINEARIZED);
        let phase = response.map(|g| near_deg(g.arg() * DEG, reference_deg));
        let what = format!("{name} at {omega} rad/s, deg");
        case.row(what, reference_deg, phase, Band::Within(20.0), 0).twice(LINEARIZED);
    }
}

/// Case 26.
pub fn responses(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        26,
        Class::A,
        "the frequency responses of case 9 as flight test has them: swept and identified",
        "Identified in flight, NASA TM-89428, as in case 9.",
    )
    .tolerance(
        "±3 dB and ±20 deg as in case 9, whose numbers these are once more: what is new is that a \
         flight gives them.",
    )
    .set_up(
        "The pilot model `sweep-pitch` moves the stick three times from .2 to 15 rad/s about \
         hover, and about 180 KCAS at 8,000 ft, SCAS off; response and coherence come of the \
         record by `identify`. Frequencies are within 1 % of those named; at .3 rad/s resolution \
         takes 1.3 dB in hover. That identified and linearised responses agree within 1 dB and 5 \
         deg is a test of its own (`tests/command/identify.rs`).",
    )
    .misses("As in case 9.")
    .settled_by("As in case 9: the time histories of the sweeps.");
    let hover = "mast_tilt_deg = 0.0\nairspeed_kt = 0.0\naltitude_ft = 1000.0\nflap_detent = 2";
    rows(&mut case, "hover q/δe", aircraft, hover, &HOVER_PITCH);
    let cruise = format!(
        "mast_tilt_deg = 90.0\nairspeed_kt = {:?}\naltitude_ft = 8000.0\nflap_detent = 0\n\
         rpm_select = 2",
        cruise_kt()
    );
    rows(&mut case, "cruise q/δe", aircraft, &cruise, &CRUISE_PITCH);
    book.add(case);
}

//! Cases that take a pilot: flown by a pilot model through raw device events.

use engine::math::{FRAC_PI_2, max, min};
use engine::{Aircraft, Outputs, STEP_S};
use recorder::pilots::Pilot;
use recorder::rehearse;

use crate::book::{Band, Case, Class, FOOT_M, INCH_M, KNOT_MPS};
use crate::fits::Fit;

/// Nacelles nearer to down than this are down, rad.
const DOWN_RAD: f64 = 0.002;
/// By then it has converted, or never will, s.
const PATIENCE_S: f64 = 60.0;
/// It goes on this long after the nacelles are down, s.
const AFTER_S: f64 = 5.0;

/// What the conversion was like.
struct Conversion {
    time_s: f64,
    inside_mps: f64,
    stick_norm: (f64, f64),
    travel_used: f64,
    height_m: (f64, f64),
    airspeed_mps: f64,
}

/// The greatest part of its travel that an actuator of the pitch axis or the collective uses.
fn travel_used(aircraft: &Aircraft, seen: &Outputs) -> f64 {
    let actuators = &aircraft.actuators;
    let used = |actuator: &engine::actuators::Actuator, rad: f64| {
        let middle_rad = 0.5 * (actuator.rad_min + actuator.rad_max);
        (rad - middle_rad).abs() / (actuator.rad_max - middle_rad)
    };
    let cyclic = seen.actuators.cyclic_forward_rad;
    [
        used(&actuators.elevator, seen.actuators.elevator_rad),
        used(&actuators.cyclic, cyclic.left),
        used(&actuators.cyclic, cyclic.right),
        seen.cockpit.collective_norm,
    ]
    .into_iter()
    .fold(0.0, max)
}

fn fly(aircraft: &Aircraft) -> Result<Conversion, String> {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).map_err(|e| e.to_string())?;
    let aircraft = aircraft.clone().with_cockpit(map);
    let scenario = format!(
        "{}\n[trim]\nmast_tilt_deg = 0.0\nairspeed_kt = 80.0\naltitude_ft = 500.0\nflap_detent = 1\n\
         scas_on = 1\n",
        aircraft::DEFAULT_SCENARIO
    );
    let start = aircraft::start("scenario.toml", &scenario).map_err(|e| e.to_string())?;
    let corridor = &aircraft.envelope.corridor;
    let pilot = Pilot::named("convert", &aircraft.cockpit, &aircraft).ok_or("no such pilot")?;
    let mut flown = Conversion {
        time_s: 0.0,
        inside_mps: f64::INFINITY,
        stick_norm: (1.0, -1.0),
        travel_used: 0.0,
        height_m: (f64::INFINITY, 0.0),
        airspeed_mps: 0.0,
    };
    let (mut touched_s, mut down_s) = (None, None);
    let ticks = (PATIENCE_S / STEP_S) as u64;
    rehearse(&aircraft, &start, vec![Box::new(pilot)], ticks, |now| {
        let (seen, time_s) = (now.outputs, now.state.time_s());
        if seen.cockpit.nacelle_aft_norm < 0.0 {
            touched_s.get_or_insert(time_s);
        }
        let tilt_rad = seen.actuators.mast_tilt_rad.mean();
        if tilt_rad > FRAC_PI_2 - DOWN_RAD {
            down_s.get_or_insert(time_s);
        }
        if touched_s.is_none() || down_s.is_some_and(|down_s| time_s > down_s + AFTER_S) {
            return;
        }
        let inside_mps = corridor.margin_mps(tilt_rad, seen.calibrated_airspeed_mps);
        flown.inside_mps = min(flown.inside_mps, inside_mps);
        let stick = seen.cockpit.stick_aft_norm;
        flown.stick_norm = (min(flown.stick_norm.0, stick), max(flown.stick_norm.1, stick));
        flown.travel_used = max(flown.travel_used, travel_used(&aircraft, seen));
        let height_m = seen.height_above_ground_m;
        flown.height_m = (min(flown.height_m.0, height_m), max(flown.height_m.1, height_m));
        flown.airspeed_mps = max(flown.airspeed_mps, seen.airspeed_mps);
    })
    .map_err(|failure| failure.to_string())?;
    match (touched_s, down_s) {
        (Some(touched_s), Some(down_s)) => Ok(Conversion { time_s: down_s - touched_s, ..flown }),
        _ => Err("the nacelles never came down".into()),
    }
}

/// The flown part of case 11.
pub fn conversion(aircraft: &Aircraft, case: &mut Case) {
    let flown = fly(aircraft);
    let number = |of: fn(&Conversion) -> f64| flown.as_ref().map(of).map_err(Clone::clone);
    let stick_in = aircraft.fcc.travel.longitudinal_stick_m / INCH_M;
    // The published rate over the published travel.
    case.row("flown at 7.5 deg/s: time, s", 12.0, number(|c| c.time_s), Band::Within(2.0), 1)
        .class(Class::A);
    case.row(
        "flown: least distance inside the corridor, kt (more than)",
        0.0,
        number(|c| c.inside_mps / KNOT_MPS),
        Band::AtLeast(0.0),
        1,
    )
    .class(Class::A)
    .fitted(&[Fit::Pilot]);
    case.row(
        "flown: stick travel, in (less than)",
        3.0,
        number(|c| c.stick_norm.1 - c.stick_norm.0).map(|travel| travel * stick_in),
        Band::AtMost(3.0),
        2,
    );
    case.row(
        "flown: most of its travel that a control uses, % (less than)",
        100.0,
        number(|c| 100.0 * c.travel_used),
        Band::AtMost(99.9),
        2,
    );
    case.row(
        "flown: fastest within 5 s of nacelles down, kt",
        170.0,
        number(|c| c.airspeed_mps / KNOT_MPS),
        Band::Within(10.0),
        0,
    )
    .fitted(&[Fit::Pilot]);
    case.row(
        "flown: height left and regained, ft (level)",
        0.0,
        number(|c| (c.height_m.1 - c.height_m.0) / FOOT_M),
        Band::Within(100.0),
        0,
    )
    .fitted(&[Fit::Pilot]);
}

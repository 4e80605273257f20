//! Fuel, speed, stall, conversion, autorotation.

use analysis::trim::{GROUND_FAR_BELOW_M, Power, Target, Trim, trim};
use engine::Aircraft;
use engine::inputs::{Failures, World};

use crate::book::{Band, Book, Case, Class, DEG, FOOT_M, INCH_M, KNOT_MPS, POUND_KG, RPM_RADPS};
use crate::fits::Fit;
use crate::trims::{at, stick_in, why};

fn fuel_lb_per_h(trim: &Trim) -> f64 {
    trim.report.fuel_flow_kg_per_s * 3600.0 / POUND_KG
}

/// Fuel flow in a fixed helicopter rotor speed or as an aeroplane, lb/h.
fn fuel(aircraft: &Aircraft, nacelle_deg: f64, speed_kt: f64) -> Result<f64, String> {
    at(aircraft, nacelle_deg, speed_kt * KNOT_MPS).map(|trim| fuel_lb_per_h(&trim))
}

/// The two points through which the engine's fuel flow was laid: nacelles in deg, speed in kt.
const FUEL_FITTED: [(f64, f64); 2] = [(90.0, 0.0), (0.0, 141.0)];

/// Case 5.
pub fn bucket(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        5,
        Class::A,
        "fuel flow in level flight",
        "NASA TM-81244 fig. 13, weight and height not stated (13,000 lb at sea level taken).",
    )
    .tolerance("Ratios ±7 %, which need no engine data; single points ±10 %, which do.")
    .set_up(
        "13,000 lb at sea level; the source states neither. Fuel flow is fitted to hover and to \
         slow flight as an aeroplane.",
    )
    .misses(
        "The fast end at 0 deg is not at sea level: 258 kt there take 1,892 hp (case 7), for \
         which hover burns 1,280 lb/h. 30 deg at 88 kt is slower than the power-on stall of the \
         same report's fig. 14 (103 kt); at 141 kt the fuel of this figure and the power of case \
         4 contradict each other by a fifth.",
    )
    .settled_by("Weight and pressure height of each point of the figure.");
    let hover = fuel(aircraft, 90.0, 0.0);
    let ratio = |nacelle_deg: f64, speed_kt: f64| -> Result<f64, String> {
        Ok(hover.clone()? / fuel(aircraft, nacelle_deg, speed_kt)?)
    };
    case.row("hover over 60 kt helicopter", 1.45, ratio(90.0, 60.0), Band::Part(0.07), 2)
        .twice("0 and 60 kt below");
    case.row("hover over 141 kt aeroplane", 1.65, ratio(0.0, 141.0), Band::Part(0.07), 2)
        .fitted(&[Fit::FuelFlow])
        .twice("hover and 141 kt below");
    for (nacelle_deg, speed_kt, published) in [
        (90.0, 0.0, 1323.0),
        (90.0, 27.0, 1179.0),
        (90.0, 41.0, 1009.0),
        (90.0, 60.0, 914.0),
        (90.0, 76.0, 958.0),
        (30.0, 88.0, 832.0),
        (30.0, 113.0, 881.0),
        (30.0, 141.0, 975.0),
        (0.0, 141.0, 803.0),
        (0.0, 172.0, 830.0),
        (0.0, 200.0, 903.0),
        (0.0, 231.0, 1022.0),
        (0.0, 256.0, 1148.0),
    ] {
        let name = format!("{nacelle_deg:.0} deg, {speed_kt:.0} kt, lb/h");
        let ours = fuel(aircraft, nacelle_deg, speed_kt);
        let row = case.row(name, published, ours, Band::Part(0.1), 0);
        if FUEL_FITTED.contains(&(nacelle_deg, speed_kt)) {
            row.fitted(&[Fit::FuelFlow]);
        }
    }
    for (speed_kt, published) in [(109.0, 818.0), (134.0, 847.0), (165.0, 932.0), (200.0, 1073.0)] {
        let name = format!("0 deg, 98 % rpm, {speed_kt:.0} kt, lb/h");
        let target = Target {
            mast_tilt_rad: 90.0 / DEG,
            airspeed_mps: speed_kt * KNOT_MPS,
            flap_detent: 0,
            ..Target::default()
        };
        let found = trim(aircraft, &target).map(|trim| fuel_lb_per_h(&trim));
        case.row(name, published, found.map_err(|failure| why(&failure)), Band::Part(0.1), 0);
    }
    book.add(case);
}

/// Mast torque that is allowed all the time, N·m: 130,000 in-lb.
const TORQUE_N_M: f64 = 130_000.0 * INCH_M * crate::book::POUND_N;

/// Case 7.
pub fn speed(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        7,
        Class::A,
        "greatest level speed by torque, sea level, 458 rpm",
        "Where the torque limit begins, NASA TM-81244 figs. 11 and 15.",
    )
    .tolerance("±3 %: reading of the figure.")
    .set_up("130,000 in·lbf at each mast (TM X-62,407).");
    let torque =
        |speed_kt: f64| at(aircraft, 0.0, speed_kt * KNOT_MPS).map(|t| t.report.torque_n_m);
    let (mut low_kt, mut high_kt) = (150.0, 350.0);
    for _ in 0..12 {
        let middle_kt = 0.5 * (low_kt + high_kt);
        if torque(middle_kt).is_ok_and(|torque| torque < TORQUE_N_M) {
            low_kt = middle_kt;
        } else {
            high_kt = middle_kt;
        }
    }
    case.row("greatest speed, kt", 258.0, low_kt, Band::Part(0.03), 0);
    book.add(case);
}

/// Case 8.
pub fn stall(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        8,
        Class::A,
        "stall as an aeroplane, flaps up, 12,000 to 13,000 lb",
        "NASA TM-81244.",
    )
    .tolerance("±5 kt around 95 to 100 kt.")
    .set_up(
        "The slowest level flight with a trim, in steps of 1 kt, at 13,000 lb; each 1,000 lb less \
         is 4 kt. The speed passes at the edge of its band: 104 kt has no trim, and 95 to 100 kt \
         were flown. That the aircraft does not roll off is asked of the left–right symmetry \
         only: the wing has no asymmetric stall.",
    );
    let mut slowest: Option<(f64, Trim)> = None;
    for speed_kt in (70..=130).rev() {
        match at(aircraft, 0.0, f64::from(speed_kt) * KNOT_MPS) {
            Ok(trim) => slowest = Some((f64::from(speed_kt), trim)),
            Err(_) => break,
        }
    }
    let no = || "no trim below 130 kt".to_owned();
    let speed = slowest.as_ref().map(|(speed_kt, _)| *speed_kt).ok_or_else(no);
    case.row("slowest level flight, kt", 97.5, speed, Band::Between(90.0, 105.0), 0);
    let alpha = slowest.as_ref().map(|(_, trim)| trim.report.alpha_rad * DEG).ok_or_else(no);
    case.row("angle of attack there, deg", 16.0, alpha, Band::Within(2.0), 1);
    book.add(case);
}

/// The conversion of the plan in steady points: nacelles in deg, speed in kt.
const CONVERSION: [(f64, f64); 10] = [
    (90.0, 80.0),
    (80.0, 90.0),
    (70.0, 100.0),
    (60.0, 110.0),
    (50.0, 120.0),
    (40.0, 130.0),
    (30.0, 140.0),
    (20.0, 150.0),
    (10.0, 160.0),
    (0.0, 170.0),
];

/// Case 11.
pub fn conversion(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        11,
        Class::Own,
        "conversion from 80 to 170 kt, level",
        "The corridor and procedure of NASA TM-81244, in words; most limits are our own.",
    )
    .tolerance(
        "100 ft and 10 kt: what a test pilot is held to. Corridor of TM-81244 fig. 14, calibrated \
         airspeed.",
    )
    .set_up(
        "In steady points along a straight line through the corridor, flaps 20/12.5, 589 rpm; and \
         flown by the pilot model from steady flight at 80 kt and 500 ft, wanting 170 kt and no \
         climb. It releases the switch where the corridor's side comes within 8 kt, and where the \
         rotors are 5 % off their speed. Time is from the first touch of the switch to nacelles \
         down: 90 deg at 7.5 deg/s and the slow ends.",
    )
    .misses(
        "The pilot model waits for speed inside the corridor: gaining the 90 kt in 12 s takes .39 g throughout, \
         and .4 g is the greatest that flight reports.",
    )
    .settled_by(
        "A time history of one conversion in flight: nacelles, airspeed, height, power.",
    );
    let mut sticks_in: Vec<f64> = Vec::new();
    let mut reasons = Vec::new();
    for (nacelle_deg, speed_kt) in CONVERSION {
        let target = Target {
            mast_tilt_rad: (90.0 - nacelle_deg) / DEG,
            airspeed_mps: speed_kt * KNOT_MPS,
            flap_detent: 1,
            ..Target::default()
        };
        match trim(aircraft, &target) {
            Ok(trim) => sticks_in.push(stick_in(&trim)),
            Err(failure) => reasons.push(why(&failure)),
        }
    }
    let trimmed = sticks_in.len() as f64;
    case.row("steady points that can be flown, of 10", 10.0, trimmed, Band::Within(0.0), 0);
    let most = sticks_in.iter().fold(f64::NEG_INFINITY, |a, &b| engine::math::max(a, b));
    let least = sticks_in.iter().fold(f64::INFINITY, |a, &b| engine::math::min(a, b));
    let range = if sticks_in.is_empty() { Err(reasons.join(", ")) } else { Ok(most - least) };
    case.row("stick travel along it, in (less than)", 3.0, range, Band::AtMost(3.0), 2);
    crate::flown::conversion(aircraft, &mut case);
    book.add(case);
}

/// Case 13.
pub fn autorotation(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        13,
        Class::A,
        "autorotation, nacelles 95 deg, flaps 20, 80 kt, 92 % rpm",
        "NASA TM-81244, about 3,100 ft/min.",
    )
    .tolerance("±15 %: the source says \"about\".")
    .set_up("Both engines stopped, the governor set to 553 rpm.");
    let aircraft =
        aircraft.clone().with(|a| a.fcc.governor.rotor_speed_radps[0] = 553.0 * RPM_RADPS);
    let world =
        World { failures: Failures::ENGINES, ..World::default() }.with_ground(GROUND_FAR_BELOW_M);
    let target = Target {
        mast_tilt_rad: -5.0 / DEG,
        airspeed_mps: 80.0 * KNOT_MPS,
        power: Power::Lever(0.0),
        flap_detent: 1,
        world,
        ..Target::default()
    };
    let sink = trim(&aircraft, &target)
        .map(|trim| -trim.report.climb_mps / FOOT_M * 60.0)
        .map_err(|failure| why(&failure));
    case.row("rate of descent, ft/min", 3100.0, sink, Band::Part(0.15), 0);
    book.add(case);
}

//! Power as an aeroplane at both rotor speeds, and how high the aircraft flies.

use analysis::trim::{Power, Target, trim};
use engine::Aircraft;

use crate::book::{Band, Book, Case, Class, DEG, FOOT_M, KNOT_MPS};
use crate::trims::{POINTS, why};

/// Power of both rotors in level flight as an aeroplane at sea level, kW.
fn power_kw(aircraft: &Aircraft, airspeed_mps: f64, rpm_select: u64) -> Result<f64, String> {
    let target = Target {
        mast_tilt_rad: 90.0 / DEG,
        airspeed_mps,
        flap_detent: 0,
        rpm_select,
        ..Target::default()
    };
    trim(aircraft, &target).map(|trim| 1e-3 * trim.report.power_w).map_err(|failure| why(&failure))
}

/// Case 19.
pub fn aeroplane(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        19,
        Class::A,
        "power as an aeroplane at 517 and 458 rpm, level",
        "Flight, and GTRS (B), both digitised from Wang et al. 2025 fig. 1.",
    )
    .tolerance(
        "±8 %, twice the reading, as in case 4.",
    )
    .set_up(
        "The figure does not tell the rotor speed. The published collective of GTRS stands 3.2 to \
         3.7 deg above ours at 517 rpm, as at every nacelle angle whose rotor speed is known (3.3 \
         to 4.5), and .2 to .3 deg at 458 rpm: 517 rpm is the likelier, and the rows at 458 rpm \
         are the same measurements again.",
    )
    .misses(
        "The points of flight do not lie on one curve: those at 159 and 202 kt are as read, that at \
         184 kt has 45 kW for the digitiser's bias, with which the others would be 608 and 982 kW. At 517 rpm \
         ours is 9 % above the slowest, 10 % below the one at 184 kt and 5 % below the fastest.",
    )
    .settled_by(
        "The figure's original, and rotor speed and weight of each point.",
    );
    for (rpm_select, rpm) in [(1, 517), (2, 458)] {
        for (airspeed_mps, published_kw) in [(82.0, 563.0), (104.1, 937.0)] {
            let speed_kt = airspeed_mps / KNOT_MPS;
            let name = format!("{rpm} rpm, {speed_kt:.0} kt, flight: power, kW");
            let ours = power_kw(aircraft, airspeed_mps, rpm_select);
            let row = case.row(name, published_kw, ours, Band::Part(0.08), 0);
            if rpm_select == 2 {
                row.twice("at 517 rpm above");
            }
        }
    }
    for point in POINTS.iter().filter(|point| point.is_at(0.0)) {
        let speed_kt = point.airspeed_mps / KNOT_MPS;
        let flown = point.source == "flight";
        let who = if flown { "flight" } else { "GTRS" };
        let name = format!("517 rpm, {speed_kt:.0} kt, {who}: power, kW");
        let ours = power_kw(aircraft, point.airspeed_mps, 1);
        case.row(name, point.power_kw, ours, Band::Part(0.08), 0)
            .class(if flown { Class::A } else { Class::B })
            .twice("case 4, at 458 rpm");
    }
    book.add(case);
}

/// Normal rated power over take-off power at the rotor shafts, sea level: 1,110 and 1,375 hp (TM X-62,407).
const NORMAL_NORM: f64 = 1110.0 / 1375.0;
/// What is left of the climb at the service ceiling, ft/min.
const SERVICE_FTPM: f64 = 100.0;

/// A way to fly: nacelle angle, deg; flap detent; rotor speed selected.
const WAYS: [(f64, u64, u64); 7] =
    [(90.0, 2, 0), (75.0, 1, 0), (60.0, 1, 0), (30.0, 1, 0), (0.0, 0, 0), (0.0, 0, 1), (0.0, 0, 2)];

/// Whether normal rated power leaves that climb, inside the conversion corridor.
fn climbs(
    aircraft: &Aircraft,
    airspeed_mps: f64,
    altitude_m: f64,
    (nacelle_deg, flap_detent, rpm_select): (f64, u64, u64),
) -> bool {
    let target = Target {
        mast_tilt_rad: (90.0 - nacelle_deg) / DEG,
        airspeed_mps,
        power: Power::Climb(SERVICE_FTPM * FOOT_M / 60.0),
        altitude_m,
        flap_detent,
        rpm_select,
        ..Target::default()
    };
    trim(aircraft, &target).is_ok_and(|trim| {
        let airspeed_mps = trim.outputs.calibrated_airspeed_mps;
        let margin_mps = aircraft.envelope.corridor.margin_mps(target.mast_tilt_rad, airspeed_mps);
        let inside = nacelle_deg <= 0.0 || margin_mps >= 0.0;
        inside && trim.report.power_w <= NORMAL_NORM * trim.report.available_w
    })
}

/// The greatest height at which it climbs in one of the ways, ft, and the nacelle angle of that.
fn ceiling(aircraft: &Aircraft, airspeed_mps: f64) -> Result<f64, String> {
    let step_m = 500.0 * FOOT_M;
    let mut highest_m = None;
    for way in WAYS {
        // From below, in steps: beyond the first height that is too great there may be no trim at all.
        let from = highest_m.unwrap_or(0.0);
        if !climbs(aircraft, airspeed_mps, from, way) {
            continue;
        }
        let (mut low_m, mut high_m) = (from, from + step_m);
        while high_m < 15e3 && climbs(aircraft, airspeed_mps, high_m, way) {
            (low_m, high_m) = (high_m, high_m + step_m);
        }
        for _ in 0..4 {
            let middle_m = 0.5 * (low_m + high_m);
            if climbs(aircraft, airspeed_mps, middle_m, way) {
                low_m = middle_m;
            } else {
                high_m = middle_m;
            }
        }
        highest_m = Some(low_m);
    }
    highest_m.map(|m: f64| m / FOOT_M).ok_or_else(|| "no climb at sea level".to_owned())
}

/// Case 20.
pub fn ceilings(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        20,
        Class::A,
        "envelope: how high it flies at a speed",
        "NASA TM-81244 figs. 11 and 15.",
    )
    .tolerance("±1,500 ft: the reading of the figure.")
    .set_up(
        "True airspeed, 13,000 lb, standard day, 100 ft/min left at normal rated power (1,110 of \
         1,375 hp of take-off power), which the source says of its service ceiling at 205 kt; \
         what the rest of the boundary is, and at which weight, it does not say. Ours is the \
         highest that any of seven ways gives: nacelles at 90 (flaps 40), 75, 60 and 30 deg \
         (flaps 20) inside the corridor of the report's fig. 14, and as an aeroplane at 589, 517 \
         and 458 rpm.",
    )
    .misses(
        "At 50 kt, nacelles at 90 deg, ours ends where the blades stall, not by power. (At 0 kt \
         the figure has 9,600 ft, 2,000 ft over the report's own ceiling of hover at take-off \
         power, case 6.) At 150 kt ours ends where the wing stalls: 25,000 ft are 100 kt of \
         equivalent airspeed there, and ours stalls at 105 (case 8). The engines' data end at \
         20,000 ft (take-off 790 hp for 1,375).",
    )
    .settled_by("Weight, power and criterion of each point of the boundary.");
    for (speed_kt, height_ft) in
        [(50.0, 12_000.0), (100.0, 18_700.0), (150.0, 25_000.0), (205.0, 27_300.0)]
    {
        let ours = ceiling(aircraft, speed_kt * KNOT_MPS);
        let name = format!("{speed_kt:.0} kt, ft");
        case.row(name, height_ft, ours, Band::Within(1500.0), 0);
    }
    book.add(case);
}

//! What each pilot model flies: its phases, one after the other.

use engine::units::{DEGREE_RAD as DEG, KNOT_MPS};

use super::phase::{Phase, Speed};
use super::sweep::Axis;

/// Names of the pilot models, each with what it flies.
pub const PILOTS: [(&str, &str); 12] = [
    ("hover", "lifts off, hovers at 10 m and keeps hovering"),
    ("demo", "vertical take-off, conversion, left turn, reconversion, landing where it began"),
    ("takeoff", "lifts off, accelerates to the speed of a conversion as a helicopter and flies on"),
    ("convert", "the same, then converts and flies on as an aeroplane at its cruise"),
    ("turn", "the same, then turns left on and on"),
    ("reconvert", "begins as an aeroplane (or becomes one), reconverts, hovers"),
    ("land", "comes to a hover from whatever it begins in, and lands"),
    (
        "sideways",
        "flies to the right and to the left at 35 kt and rearward at 20 kt, hovers, lands",
    ),
    ("sweep-pitch", "sweeps the stick to and fro, three times from .2 to 15 rad/s, for `identify`"),
    ("sweep-roll", "the same from side to side"),
    ("sweep-yaw", "the same with the pedals"),
    ("sweep-lever", "the same with the power lever"),
];

/// Whether the pilot model of that name ends its flight by itself.
pub fn lands(name: &str) -> bool {
    matches!(name, "demo" | "land" | "sideways") || Axis::of(name).is_some()
}

/// Height of a hover, m: what every plan calls one.
const HOVER_M: f64 = 10.0;
/// Height above obstacles, where it accelerates, and that of a circuit, m.
const CLEAR_M: f64 = 60.0;
const CIRCUIT_M: f64 = 120.0;
/// Climb of a take-off, m/s: a passenger's.
const TAKE_OFF_MPS: f64 = 2.0;
/// Bank of a turn that goes on and on, and of the turn back, rad.
const TURN_RAD: f64 = 30.0 * DEG;
const HOME_RAD: f64 = 40.0 * DEG;
/// Speeds to the side and back, kt: those that flight tests of helicopters fly (35 kt and a part of it).
const SIDEWAYS_KT: f64 = 35.0;
const REARWARD_KT: f64 = 20.0;

/// From standing on the runway to flying as a helicopter.
fn take_off() -> Vec<(&'static str, Phase)> {
    vec![
        ("on the ground", Phase::Wait { seconds: 1.0 }),
        ("take-off", Phase::Rise { height_m: HOVER_M, climb_mps: TAKE_OFF_MPS }),
        ("acceleration", Phase::Accelerate { height_m: CLEAR_M }),
    ]
}

/// The plan of a pilot model, for a flight that begins on the wheels or in the air.
pub fn plan(name: &str, on_wheels: bool) -> Option<Vec<(&'static str, Phase)>> {
    let forever = Phase::Hold { seconds: f64::INFINITY };
    let mut plan = if on_wheels { take_off() } else { Vec::new() };
    let convert = ("conversion", Phase::Convert { to: Speed::Cruise });
    let cruise = ("aeroplane", forever);
    let stop = ("reconversion", Phase::Stop { height_m: None });
    let descend = ("descent", Phase::Stop { height_m: Some(HOVER_M) });
    match name {
        "hover" if on_wheels => {
            plan.truncate(2);
            plan.push(("hover", forever));
        }
        "hover" => plan.extend([stop, ("hover", forever)]),
        "takeoff" => plan.push(("helicopter", forever)),
        "convert" => plan.extend([convert, cruise]),
        "turn" => {
            plan.extend([convert, ("left turn", Phase::Circle { bank_rad: TURN_RAD })]);
        }
        "reconvert" => plan.extend([convert, cruise_for(5.0), stop, ("hover", forever)]),
        "land" if on_wheels => {
            plan.truncate(2);
            plan.push(("landing", Phase::Land));
        }
        "land" => plan.extend([descend, ("landing", Phase::Land)]),
        "sideways" => {
            if on_wheels {
                plan.truncate(2);
            } else {
                plan.push(stop);
            }
            plan.extend(sidling());
        }
        "demo" => {
            if on_wheels {
                let hover = ("hover", Phase::Hold { seconds: 3.0 });
                plan.splice(2..2, [hover, ("marker button", Phase::Mark)]);
            }
            plan.extend([
                ("conversion", Phase::Convert { to: Speed::Circuit }),
                ("climb", Phase::Climb { height_m: CIRCUIT_M }),
                ("left turn", Phase::Home { bank_rad: HOME_RAD }),
                ("approach", Phase::Approach { height_m: HOVER_M }),
                ("hover turn", Phase::FaceStart),
                ("hover", Phase::Hold { seconds: 2.0 }),
                ("landing", Phase::Land),
            ]);
        }
        _ => {
            let axis = Axis::of(name)?;
            if on_wheels {
                plan.truncate(2);
                plan.push(("hover", Phase::Hold { seconds: 20.0 }));
            }
            plan.push(("steady flight", Phase::Steady { seconds: 5.0 }));
            for sweep in ["first sweep", "second sweep", "third sweep"] {
                plan.push((sweep, Phase::Sweep { axis }));
            }
        }
    }
    Some(plan)
}

/// To either side, rearward, and down.
fn sidling() -> [(&'static str, Phase); 8] {
    let sidle = |forward_kt: f64, right_kt: f64, seconds: f64| {
        let (forward_mps, right_mps) = (forward_kt * KNOT_MPS, right_kt * KNOT_MPS);
        Phase::Sidle { forward_mps, right_mps, seconds }
    };
    let still = ("to a hover", sidle(0.0, 0.0, 28.0));
    [
        ("to the right", sidle(0.0, SIDEWAYS_KT, 40.0)),
        still,
        ("to the left", sidle(0.0, -SIDEWAYS_KT, 40.0)),
        still,
        ("rearward", sidle(-REARWARD_KT, 0.0, 30.0)),
        still,
        ("hover", Phase::Hold { seconds: 3.0 }),
        ("landing", Phase::Land),
    ]
}

fn cruise_for(seconds: f64) -> (&'static str, Phase) {
    ("aeroplane", Phase::Hold { seconds })
}

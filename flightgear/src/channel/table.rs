//! Every property of the second channel, in the order in which it is sent.

use engine::controls::PilotControls;
use engine::engines;
use engine::inputs::Failures;
use engine::math::{atan2, max, sqrt, square, wrap_angle};
use engine::outputs::{Severity, Validity};
use engine::units::{
    FOOT_M, HORSEPOWER_W, HOUR_S, POUND_KG, POUND_N, RPM_PER_RADPS, compass_deg, degrees, knots,
};
use engine::{GRAVITY_MPS2, STEP_S};

use super::kind::Kind::{self, Double, Float, Int};
use crate::display;
use crate::scene::Scene;

/// Version of the table. A change of what is sent, or of its order, counts it up.
pub const SCHEMA: i32 = 2;

/// One property, or the same of several parts.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Its place in FlightGear's tree, `#` where the part's number goes.
    pub node: &'static str,
    /// How many parts there are.
    pub count: usize,
    /// How it is sent.
    pub kind: Kind,
    /// Its unit; `1` for numbers without one.
    pub unit: &'static str,
    /// Where it starts again, in its unit; 0 where it does not.
    pub wrap: f64,
    /// What it is.
    pub meaning: &'static str,
    /// Its value for a part.
    pub value: fn(&Scene<'_>, usize) -> f64,
}

/// One part.
const fn one(
    node: &'static str,
    kind: Kind,
    unit: &'static str,
    meaning: &'static str,
    value: fn(&Scene<'_>, usize) -> f64,
) -> Row {
    Row { node, count: 1, kind, unit, wrap: 0.0, meaning, value }
}

/// The left part and the right one.
const fn both(
    node: &'static str,
    kind: Kind,
    unit: &'static str,
    meaning: &'static str,
    value: fn(&Scene<'_>, usize) -> f64,
) -> Row {
    Row { count: 2, ..one(node, kind, unit, meaning, value) }
}

/// Nose, left and right main gear.
const fn gear(
    node: &'static str,
    kind: Kind,
    unit: &'static str,
    meaning: &'static str,
    value: fn(&Scene<'_>, usize) -> f64,
) -> Row {
    Row { count: 3, ..one(node, kind, unit, meaning, value) }
}

impl Row {
    /// An angle that starts again after a turn.
    const fn around(self) -> Self {
        Self { wrap: 360.0, ..self }
    }
}

/// The properties, in the order in which they are sent.
pub const ROWS: &[Row] = &[
    one("tiltrotor/schema", Int, "1", "version of this table", |_, _| f64::from(SCHEMA)),
    one("tiltrotor/tick", Double, "1", "ticks flown", |s, _| s.outputs.tick as f64),
    one("tiltrotor/time-s", Double, "s", "simulated time", |s, _| s.outputs.tick as f64 * STEP_S),
    one("tiltrotor/position/latitude-deg", Double, "deg", "geodetic, north", |s, _| {
        degrees(s.outputs.place.latitude_rad)
    }),
    one("tiltrotor/position/longitude-deg", Double, "deg", "east, -180 to 180", |s, _| {
        degrees(wrap_angle(s.outputs.place.longitude_rad))
    })
    .around(),
    both(
        "tiltrotor/nacelle-deg[#]",
        Float,
        "deg",
        "nacelle incidence, 90 as a helicopter",
        |s, i| 90.0 - degrees(side(s.outputs.actuators.mast_tilt_rad, i)),
    ),
    one("tiltrotor/nacelle-rate-degps", Float, "deg/s", "its rate, up as a helicopter", |s, _| {
        -degrees(s.outputs.actuators.mast_tilt_rate_radps.mean())
    }),
    both("tiltrotor/rotor[#]/rpm", Float, "rpm", "rotor speed", |s, _| {
        s.outputs.rotor_speed_radps * RPM_PER_RADPS
    }),
    both("tiltrotor/rotor[#]/azimuth-deg", Float, "deg", AZIMUTH, |s, _| {
        degrees(s.outputs.rotor_azimuth_rad)
    })
    .around(),
    both("tiltrotor/rotor[#]/flap-aft-deg", Float, "deg", "tip path tilted aft", |s, i| {
        degrees(side(s.outputs.rotors, i).tilt_aft_rad)
    }),
    both("tiltrotor/rotor[#]/flap-right-deg", Float, "deg", "tip path tilted right", |s, i| {
        let outboard_deg = degrees(side(s.outputs.rotors, i).tilt_outboard_rad);
        if i == 0 { -outboard_deg } else { outboard_deg }
    }),
    both("tiltrotor/rotor[#]/coning-deg", Float, "deg", "coning", |s, i| {
        degrees(side(s.outputs.rotors, i).coning_rad)
    }),
    both("tiltrotor/rotor[#]/collective-deg", Float, "deg", "pitch at 3/4 radius", |s, i| {
        degrees(side(s.outputs.actuators.collective_rad, i))
    }),
    both("tiltrotor/rotor[#]/thrust-lbf", Float, "lbf", "thrust along the mast", |s, i| {
        side(s.outputs.rotors, i).thrust_n / POUND_N
    }),
    both("tiltrotor/rotor[#]/torque-percent", Float, "%", TORQUE, torque_percent),
    both("tiltrotor/engine[#]/power-hp", Float, "hp", "power at the rotor shaft", |s, i| {
        side(s.outputs.engines.power_w, i) / HORSEPOWER_W
    }),
    both("tiltrotor/engine[#]/egt-degf", Float, "degF", EGT, |s, i| {
        side(display::exhaust_gas_degf(s), i)
    }),
    both("tiltrotor/engine[#]/fuel-flow-pph", Float, "lb/h", "fuel flow", |s, i| {
        side(display::fuel_flow_kg_per_s(&s.outputs.engines), i) * HOUR_S / POUND_KG
    }),
    both("tiltrotor/engine[#]/running", Int, "0/1", "the engine runs", |s, i| {
        flag(display::runs(&s.outputs.engines, i))
    }),
    one("tiltrotor/fuel-lb", Float, "lb", "fuel aboard", |s, _| s.outputs.fuel_kg / POUND_KG),
    one("tiltrotor/surface/flap-deg", Float, "deg", "flaps, down", |s, _| {
        degrees(s.outputs.actuators.flap_rad)
    }),
    both("tiltrotor/surface/flaperon-deg[#]", Float, "deg", FLAPERON, |s, i| {
        degrees(side(s.outputs.actuators.flaperon_rad, i))
    }),
    one("tiltrotor/surface/elevator-deg", Float, "deg", "elevator, trailing edge down", |s, _| {
        degrees(s.outputs.actuators.elevator_rad)
    }),
    both("tiltrotor/surface/rudder-deg[#]", Float, "deg", "rudders, trailing edge left", |s, _| {
        -degrees(s.outputs.actuators.rudder_right_rad)
    }),
    gear("tiltrotor/gear/unit[#]/position-norm", Float, "1", "0 up, 1 down", |s, _| {
        s.outputs.actuators.gear_extension_norm
    }),
    gear("tiltrotor/gear/unit[#]/compression-m", Float, "m", "strut, compressed by", |s, i| {
        display::leg(s.outputs, i).compression_m
    }),
    gear("tiltrotor/gear/unit[#]/steer-deg", Float, "deg", STEER, |s, i| {
        if i == 0 { degrees(display::castor_rad(s)) } else { 0.0 }
    }),
    gear("tiltrotor/gear/unit[#]/on-ground", Int, "0/1", "the wheel bears weight", |s, i| {
        flag(display::leg(s.outputs, i).push_n > 0.0)
    }),
    gear("tiltrotor/gear/unit[#]/wheel-speed-mps", Float, "m/s", WHEEL_SPEED, |s, i| {
        let on_ground = display::leg(s.outputs, i).push_n > 0.0;
        if on_ground { s.outputs.body_velocity_mps.x } else { 0.0 }
    }),
    one("tiltrotor/gear/handle-down", Int, "0/1", "gear handle down", |s, _| {
        s.outputs.cockpit.gear_down as f64
    }),
    one("tiltrotor/air/cas-kt", Float, "kt", "calibrated airspeed", |s, _| {
        knots(s.outputs.calibrated_airspeed_mps)
    }),
    one("tiltrotor/air/tas-kt", Float, "kt", "true airspeed", |s, _| knots(s.outputs.airspeed_mps)),
    one("tiltrotor/air/groundspeed-kt", Float, "kt", "speed over the ground", |s, _| {
        let v = s.outputs.velocity_mps;
        knots(sqrt(square(v.x) + square(v.y)))
    }),
    one("tiltrotor/air/mach", Float, "1", "Mach number", |s, _| s.outputs.mach),
    one("tiltrotor/air/altitude-ft", Float, "ft", "above mean sea level", |s, _| {
        s.outputs.place.height_m / FOOT_M
    }),
    one("tiltrotor/air/radar-altitude-ft", Float, "ft", RADAR, |s, _| {
        display::wheels_above_ground_m(s) / FOOT_M
    }),
    one("tiltrotor/air/vertical-speed-fpm", Float, "ft/min", "climb", |s, _| {
        -s.outputs.velocity_mps.z * 60.0 / FOOT_M
    }),
    one("tiltrotor/air/alpha-deg", Float, "deg", "angle of attack", |s, _| {
        degrees(s.outputs.alpha_rad)
    }),
    one("tiltrotor/air/sideslip-deg", Float, "deg", "wind from the right", |s, _| {
        degrees(s.outputs.beta_rad)
    }),
    one("tiltrotor/air/wind-speed-kt", Float, "kt", "wind and gust, level", |s, _| {
        let w = s.outputs.air.wind_mps;
        knots(sqrt(square(w.x) + square(w.y)))
    }),
    one("tiltrotor/air/wind-from-deg", Float, "deg", "where it comes from, true", |s, _| {
        let w = s.outputs.air.wind_mps;
        if square(w.x) + square(w.y) > 0.0 { shown_compass_deg(atan2(-w.y, -w.x)) } else { 0.0 }
    })
    .around(),
    one("tiltrotor/attitude/roll-deg", Float, "deg", "right wing down", |s, _| {
        degrees(s.outputs.euler.roll_rad)
    })
    .around(),
    one("tiltrotor/attitude/pitch-deg", Float, "deg", "nose up", |s, _| {
        degrees(s.outputs.euler.pitch_rad)
    }),
    one("tiltrotor/attitude/heading-deg", Float, "deg", "true, 0 to 360", |s, _| {
        shown_compass_deg(s.outputs.euler.heading_rad)
    })
    .around(),
    one("tiltrotor/attitude/turn-rate-degps", Float, "deg/s", "heading's rate", |s, _| {
        degrees(s.outputs.euler_rate.heading_radps)
    }),
    one("tiltrotor/attitude/lateral-g", Float, "g", "felt push to the right", |s, _| {
        s.outputs.specific_force_mps2.y / GRAVITY_MPS2
    }),
    one("tiltrotor/attitude/load-factor-g", Float, "g", "1 in level flight", |s, _| {
        s.outputs.load_factor
    }),
    one("tiltrotor/corridor/speed-min-kt", Float, "kt", SLOWEST, |s, _| {
        knots(s.aircraft.envelope.corridor.slowest_mps(tilt_rad(s)))
    }),
    one("tiltrotor/corridor/speed-max-kt", Float, "kt", FASTEST, |s, _| {
        knots(s.aircraft.envelope.corridor.fastest_mps(tilt_rad(s)))
    }),
    one("tiltrotor/corridor/excursion", Int, "1", "0 inside, -1 too slow, 1 too fast", excursion),
    one("tiltrotor/flap-detent", Int, "1", "flap lever, 0 to 3", |s, _| {
        s.outputs.cockpit.flap_detent as f64
    }),
    one("tiltrotor/rpm-select", Int, "1", "0 helicopter, 1 and 2 aeroplane", |s, _| {
        s.outputs.cockpit.rpm_select as f64
    }),
    one("tiltrotor/rpm-command", Float, "rpm", "rotor speed selected", |s, _| {
        selected_radps(s) * RPM_PER_RADPS
    }),
    one("tiltrotor/scas/on", Int, "0/1", "SCAS switched on", |s, _| {
        s.outputs.cockpit.scas_on as f64
    }),
    one("tiltrotor/scas/pitch", Int, "0/1", WORKS, |s, _| scas(s, Failures::SCAS_PITCH)),
    one("tiltrotor/scas/roll", Int, "0/1", WORKS, |s, _| scas(s, Failures::SCAS_ROLL)),
    one("tiltrotor/scas/yaw", Int, "0/1", WORKS, |s, _| scas(s, Failures::SCAS_YAW)),
    one("tiltrotor/governor/on", Int, "0/1", "the governor works", |s, _| {
        flag(!s.world.failed(Failures::GOVERNOR))
    }),
    one("tiltrotor/control/stick-aft-norm", Float, "1", "-1 forward, 1 aft", |s, _| {
        controls(s).stick_aft_norm
    }),
    one("tiltrotor/control/stick-right-norm", Float, "1", "-1 left, 1 right", |s, _| {
        controls(s).stick_right_norm
    }),
    one("tiltrotor/control/collective-norm", Float, "1", "power lever, 0 down, 1 up", |s, _| {
        controls(s).collective_norm
    }),
    one("tiltrotor/control/pedal-right-norm", Float, "1", "-1 left, 1 right", |s, _| {
        controls(s).pedal_right_norm
    }),
    one("tiltrotor/control/nacelle-aft-norm", Float, "1", "nacelle switch, 1 aft", |s, _| {
        controls(s).nacelle_aft_norm
    }),
    one("tiltrotor/control/brake-left-norm", Float, "1", "left toe brake", |s, _| {
        controls(s).brake_norm.left
    }),
    one("tiltrotor/control/brake-right-norm", Float, "1", "right toe brake", |s, _| {
        controls(s).brake_norm.right
    }),
    one("tiltrotor/control/parking-brake", Int, "0/1", "parking brake set", |s, _| {
        controls(s).parking_brake as f64
    }),
    one("tiltrotor/lamp/recording", Int, "1", "0 none, 1 recording, 2 failed", |s, _| {
        f64::from(s.lamps.recording as u8)
    }),
    one("tiltrotor/lamp/marker", Int, "1", "how often the marker was pressed", |s, _| {
        controls(s).markers as f64
    }),
    one("tiltrotor/lamp/warning", Int, "bits", WARNING, |s, _| s.outputs.validity.bits() as f64),
    one("tiltrotor/lamp/master-warning", Int, "0/1", MASTER, |s, _| flag(master_warning(s))),
    one("tiltrotor/lamp/stall", Int, "0/1", "a rotor is stalled", |s, _| {
        flag(s.outputs.validity.intersects(Validity::ROTOR_STALL))
    }),
    both("tiltrotor/lamp/engine-fail[#]", Int, "0/1", "the engine does not run", |s, i| {
        flag(!display::runs(&s.outputs.engines, i))
    }),
    one("tiltrotor/lamp/low-rotor-rpm", Int, "0/1", LOW_RPM, |s, _| flag(rotor_is_slow(s))),
    one("tiltrotor/lamp/torque-limit", Int, "0/1", "a mast beyond its limit", |s, _| {
        flag((0..2).any(|i| torque_percent(s, i) > 100.0))
    }),
    one("tiltrotor/lamp/gear-warning", Int, "0/1", GEAR, |s, _| flag(gear_is_missing(s))),
    one("tiltrotor/lamp/replay", Int, "0/1", "a log is reflown", |s, _| flag(s.lamps.replay)),
    one("tiltrotor/lamp/paused", Int, "0/1", "flight or replay stand still", |s, _| {
        flag(s.lamps.paused || s.world.paused != 0)
    }),
];

const AZIMUTH: &str = "of a blade, from aft; the right rotor turns counter-clockwise seen from above, \
                       the left one is its mirror image";
const TORQUE: &str = "needed at the mast, of its continuous limit";
const EGT: &str = "exhaust gas, estimated from power for display only";
const FLAPERON: &str = "beyond the flap's setting, trailing edge down";
const STEER: &str = "the nose wheel casters along its way, to the right; the others do not turn";
const WHEEL_SPEED: &str = "of the wheel's rim; 0 in the air";
const RADAR: &str = "of the main wheels, struts extended, over the ground";
const SLOWEST: &str = "slowest calibrated airspeed at this nacelle incidence; 0 for none";
const FASTEST: &str = "fastest calibrated airspeed at this nacelle incidence";
const WORKS: &str = "the axis is on and has not failed";
const WARNING: &str =
    "where the model's answer is not to be trusted, a bit each: docs/flightgear.md";
const MASTER: &str = "one of the warnings below, or the model's answer is not to be trusted";
const LOW_RPM: &str = "rotor speed below the limit of the one selected";
const GEAR: &str = "low and slow with the gear not down";

fn side<T>(pair: engine::pair::Pair<T>, index: usize) -> T {
    if index == 0 { pair.left } else { pair.right }
}

fn flag(set: bool) -> f64 {
    f64::from(u8::from(set))
}

/// Rounded to single precision, too, it is below 360.
fn shown_compass_deg(angle_rad: f64) -> f64 {
    let compass_deg = compass_deg(angle_rad);
    if compass_deg as f32 >= 360.0 { 0.0 } else { compass_deg }
}

fn controls<'a>(scene: &Scene<'a>) -> &'a PilotControls {
    &scene.outputs.cockpit
}

fn tilt_rad(scene: &Scene<'_>) -> f64 {
    scene.outputs.actuators.mast_tilt_rad.mean()
}

fn torque_percent(scene: &Scene<'_>, index: usize) -> f64 {
    let engines::Params { torque_n_m_max, .. } = scene.aircraft.engines;
    side(scene.outputs.rotors, index).torque_n_m / torque_n_m_max * 100.0
}

fn excursion(scene: &Scene<'_>, _: usize) -> f64 {
    let (corridor, tilt_rad) = (&scene.aircraft.envelope.corridor, tilt_rad(scene));
    let airspeed_mps = scene.outputs.calibrated_airspeed_mps;
    let slowest_mps = corridor.slowest_mps(tilt_rad);
    if airspeed_mps > corridor.fastest_mps(tilt_rad) {
        1.0
    } else if slowest_mps > 0.0 && airspeed_mps < slowest_mps {
        -1.0
    } else {
        0.0
    }
}

fn selected_radps(scene: &Scene<'_>) -> f64 {
    let speeds = &scene.aircraft.fcc.governor.rotor_speed_radps;
    let index = usize::try_from(controls(scene).rpm_select).unwrap_or(0);
    speeds[index.min(speeds.len() - 1)]
}

fn scas(scene: &Scene<'_>, failure: Failures) -> f64 {
    flag(controls(scene).scas_on != 0 && !scene.world.failed(failure))
}

fn rotor_is_slow(scene: &Scene<'_>) -> bool {
    let least_radps = scene.aircraft.envelope.rotors.underspeed_norm * selected_radps(scene);
    scene.outputs.rotor_speed_radps < least_radps
}

/// Below 200 ft and 100 kt a landing is near, and the wheels should be out.
fn gear_is_missing(scene: &Scene<'_>) -> bool {
    let low = display::wheels_above_ground_m(scene) < 200.0 * FOOT_M;
    let slow = knots(max(0.0, scene.outputs.calibrated_airspeed_mps)) < 100.0;
    low && slow && scene.outputs.actuators.gear_extension_norm < 1.0
}

fn master_warning(scene: &Scene<'_>) -> bool {
    let gravest = scene.outputs.validity.gravest();
    gravest.is_some_and(|facts| facts.severity >= Severity::Warning)
        || (0..2).any(|i| !display::runs(&scene.outputs.engines, i))
        || rotor_is_slow(scene)
        || gear_is_missing(scene)
}

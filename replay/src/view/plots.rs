//! What is plotted: graphs, and the lines of each.

use engine::Outputs;
use engine::frames::Load;
use engine::outputs::Loads;
use engine::pair::Pair;
use engine::units::{FPM_PER_MPS, KT_PER_MPS, RPM_PER_RADPS, compass_deg, degrees};
use logs::records::TimingRecord;

use super::parts::PointDrawn;

/// Lines over the same time, in one unit. Each graph is one entity with as many values in a row as lines.
pub struct Graph<T: 'static> {
    /// Entity.
    pub entity: &'static str,
    /// Its name with the unit.
    pub title: &'static str,
    /// Its lines.
    pub lines: &'static [Line<T>],
}

/// One line of a graph.
pub struct Line<T: 'static> {
    /// In the legend.
    pub name: &'static str,
    /// RGBA.
    pub colour: u32,
    /// Broad where it lies below another that may equal it: left below right.
    pub width: f32,
    /// Its value.
    pub of: fn(&T) -> f64,
    /// Whether it is what the others are to be below, and no part of what was flown.
    pub is_limit: bool,
}

impl<T> Graph<T> {
    const fn new(entity: &'static str, title: &'static str, lines: &'static [Line<T>]) -> Self {
        Self { entity, title, lines }
    }

    /// Its values at a tick, each with the name of its line where there are several; not those of limits.
    pub fn drawn(&self, tick: u64, values: &[f64]) -> impl Iterator<Item = PointDrawn> {
        let several = self.lines.len() > 1;
        let lines = self.lines.iter().zip(values).filter(|(line, _)| !line.is_limit);
        lines.map(move |(line, value)| (tick, if several { line.name } else { "" }, *value))
    }

    /// Its name and its unit; that of a ratio is empty.
    pub fn named(&self) -> (&'static str, &'static str) {
        match self.title.rsplit_once(", ") {
            Some((name, unit)) if !unit.contains(['=', '/']) || unit.starts_with("deg/") => {
                (name, unit.split(" (").next().unwrap_or(unit))
            }
            Some((name, unit)) if ["ft/min", "m/s", "kg/h"].contains(&unit) => (name, unit),
            _ => (self.title, ""),
        }
    }
}

const LEFT: u32 = super::basics::SIDES.left;
const RIGHT: u32 = super::basics::SIDES.right;
const PALE_LEFT: u32 = 0xFF_B0_A8_FF;
const PALE_RIGHT: u32 = 0xA8_F0_B4_FF;
const BLUE: u32 = 0x5B_A8_F5_FF;
const ORANGE: u32 = 0xF5_A0_3C_FF;
const VIOLET: u32 = 0xB6_8C_F0_FF;
const YELLOW: u32 = 0xF0_DC_50_FF;
const CYAN: u32 = 0x48_D0_D0_FF;
const WHITE: u32 = 0xE6_E6_E6_FF;
const GREY: u32 = 0x8C_8C_8C_FF;

type Value<T> = fn(&T) -> f64;

const fn line<T>(name: &'static str, colour: u32, of: Value<T>) -> Line<T> {
    Line { name, colour, width: 1.5, of, is_limit: false }
}

const fn broad<T>(name: &'static str, colour: u32, of: Value<T>) -> Line<T> {
    Line { name, colour, width: 3.5, of, is_limit: false }
}

const fn limit<T>(name: &'static str, of: Value<T>) -> Line<T> {
    Line { name, colour: GREY, width: 1.5, of, is_limit: true }
}

/// A graph of something on both sides.
macro_rules! sides {
    ($entity:literal, $title:literal, $of:expr) => {
        Graph::new(
            $entity,
            $title,
            &[
                broad("left", LEFT, |o: &Outputs| {
                    let of: fn(&Outputs) -> Pair<f64> = $of;
                    of(o).left
                }),
                line("right", RIGHT, |o: &Outputs| {
                    let of: fn(&Outputs) -> Pair<f64> = $of;
                    of(o).right
                }),
            ],
        )
    };
}

/// A graph of what is asked for and what is there, on both sides.
macro_rules! followed {
    ($entity:literal, $title:literal, $asked:expr, $there:expr) => {
        Graph::new(
            $entity,
            $title,
            &[
                broad("asked left", PALE_LEFT, |o: &Outputs| {
                    let of: fn(&Outputs) -> Pair<f64> = $asked;
                    degrees(of(o).left)
                }),
                broad("asked right", PALE_RIGHT, |o: &Outputs| {
                    let of: fn(&Outputs) -> Pair<f64> = $asked;
                    degrees(of(o).right)
                }),
                line("left", LEFT, |o: &Outputs| {
                    let of: fn(&Outputs) -> Pair<f64> = $there;
                    degrees(of(o).left)
                }),
                line("right", RIGHT, |o: &Outputs| {
                    let of: fn(&Outputs) -> Pair<f64> = $there;
                    degrees(of(o).right)
                }),
            ],
        )
    };
}

/// A graph of one part of the loads of every component.
macro_rules! by_component {
    ($entity:literal, $title:literal, $part:expr) => {
        Graph::new(
            $entity,
            $title,
            &[
                broad("total", WHITE, |o: &Outputs| part(o.total, $part)),
                broad("left rotor", LEFT, |o: &Outputs| part(o.loads.rotors.left, $part)),
                line("right rotor", RIGHT, |o: &Outputs| part(o.loads.rotors.right, $part)),
                line("wing and pylons", BLUE, |o: &Outputs| part(o.loads.wing_pylon.sum(), $part)),
                line("fuselage", ORANGE, |o: &Outputs| part(o.loads.fuselage, $part)),
                line("tailplane", VIOLET, |o: &Outputs| part(o.loads.horizontal_stabilizer, $part)),
                line("fins", YELLOW, |o: &Outputs| part(o.loads.vertical_stabilizers.sum(), $part)),
                line("gear", GREY, |o: &Outputs| part(gear(&o.loads), $part)),
                line("engine jets", CYAN, |o: &Outputs| part(o.loads.jets.sum(), $part)),
            ],
        )
    };
}

fn part(load: Load, of: fn(Load) -> f64) -> f64 {
    1e-3 * of(load)
}

/// Of all three struts.
pub fn gear(loads: &Loads) -> Load {
    loads.landing_gear.main.sum() + loads.landing_gear.nose
}

/// As cockpits count: 90° as a helicopter.
fn incidence_deg(outputs: &Outputs) -> Pair<f64> {
    outputs.actuators.mast_tilt_rad.map(|tilt_rad| 90.0 - degrees(tilt_rad))
}

/// Everything plotted of what can be observed.
#[rustfmt::skip]
pub const GRAPHS: &[Graph<Outputs>] = &[
    Graph::new("plots/height", "Height, m", &[
        broad("above ground", ORANGE, |o| o.height_above_ground_m),
        line("above sea", BLUE, |o| o.place.height_m),
    ]),
    Graph::new("plots/airspeed", "Airspeed, kt", &[
        broad("calibrated", BLUE, |o| o.calibrated_airspeed_mps * KT_PER_MPS),
        line("true", GREY, |o| o.airspeed_mps * KT_PER_MPS),
    ]),
    Graph::new("plots/climb", "Climb, ft/min", &[
        line("climb", ORANGE, |o| -o.velocity_mps.z * FPM_PER_MPS),
    ]),
    Graph::new("plots/attitude", "Roll and pitch, deg", &[
        line("roll, right +", BLUE, |o| degrees(o.euler.roll_rad)),
        line("pitch, up +", ORANGE, |o| degrees(o.euler.pitch_rad)),
    ]),
    Graph::new("plots/heading", "Heading, deg", &[
        line("heading", VIOLET, |o| compass_deg(o.euler.heading_rad)),
    ]),
    Graph::new("plots/rates", "Body rates, deg/s", &[
        line("p, roll", BLUE, |o| degrees(o.angular_rate_radps.x)),
        line("q, pitch", ORANGE, |o| degrees(o.angular_rate_radps.y)),
        line("r, yaw", VIOLET, |o| degrees(o.angular_rate_radps.z)),
    ]),
    Graph::new("plots/flow", "Angle of attack and sideslip, deg", &[
        line("angle of attack", ORANGE, |o| degrees(o.alpha_rad)),
        line("sideslip", VIOLET, |o| degrees(o.beta_rad)),
    ]),
    Graph::new("plots/load_factor", "Load factor, g", &[
        line("load factor", ORANGE, |o| o.load_factor),
    ]),
    Graph::new("plots/wind", "Wind and turbulence, m/s", &[
        line("from the south", BLUE, |o| o.air.wind_mps.x),
        line("from the west", ORANGE, |o| o.air.wind_mps.y),
        line("turbulence up", VIOLET, |o| -o.air.turbulence_mps.z),
    ]),
    Graph::new("plots/pilot", "Controls, norm", &[
        line("stick aft", ORANGE, |o| o.cockpit.stick_aft_norm),
        line("stick right", BLUE, |o| o.cockpit.stick_right_norm),
        line("right pedal", VIOLET, |o| o.cockpit.pedal_right_norm),
        line("power lever", WHITE, |o| o.cockpit.collective_norm),
    ]),
    Graph::new("plots/scas", "SCAS, mm", &[
        line("aft", ORANGE, |o| 1e3 * o.scas.aft_m),
        line("right", BLUE, |o| 1e3 * o.scas.right_m),
        line("right pedal", VIOLET, |o| 1e3 * o.scas.pedal_right_m),
        line("trim, aft", WHITE, |o| 1e3 * o.scas.trim_aft_m),
    ]),
    sides!("plots/nacelle", "Nacelle incidence, deg (90 helicopter)", incidence_deg),
    Graph::new("plots/elevator", "Surfaces, deg", &[
        broad("elevator asked", GREY, |o| degrees(o.commands.elevator_rad)),
        line("elevator", ORANGE, |o| degrees(o.actuators.elevator_rad)),
        line("rudder right", VIOLET, |o| degrees(o.actuators.rudder_right_rad)),
        line("flap", WHITE, |o| degrees(o.actuators.flap_rad)),
    ]),
    followed!("plots/flaperons", "Flaperons beyond the flaps, deg", |o| o.commands.flaperon_rad, |o| o.actuators.flaperon_rad),
    followed!("plots/collective", "Collective at 3/4 radius, deg", |o| o.commands.collective_rad, |o| o.actuators.collective_rad),
    followed!("plots/cyclic", "Longitudinal cyclic, forward +, deg", |o| o.commands.cyclic_forward_rad, |o| o.actuators.cyclic_forward_rad),
    Graph::new("plots/rotor_speed", "Rotor speed, rpm", &[
        line("both rotors", WHITE, |o| o.rotor_speed_radps * RPM_PER_RADPS),
    ]),
    sides!("plots/thrust", "Thrust, kN", |o| o.rotors.map(|rotor| 1e-3 * rotor.thrust_n)),
    sides!("plots/torque", "Torque at the mast, kN·m", |o| o.rotors.map(|rotor| 1e-3 * rotor.torque_n_m)),
    sides!("plots/inflow", "Induced velocity, m/s", |o| o.rotors.map(|rotor| rotor.induced_mps)),
    sides!("plots/flapping_aft", "Tip path, aft +, deg", |o| o.rotors.map(|rotor| degrees(rotor.tilt_aft_rad))),
    sides!("plots/flapping_outboard", "Tip path, outboard +, deg", |o| o.rotors.map(|rotor| degrees(rotor.tilt_outboard_rad))),
    sides!("plots/coning", "Coning, deg", |o| o.rotors.map(|rotor| degrees(rotor.coning_rad))),
    sides!("plots/blade_loading", "Blade loading, C_T/σ", |o| o.rotors.map(|rotor| rotor.blade_loading)),
    sides!("plots/stalled", "Stalled part of the outer blades", |o| o.rotors.map(|rotor| rotor.stalled_norm)),
    Graph::new("plots/power", "Engine power, kW", &[
        broad("left", LEFT, |o| 1e-3 * o.engines.power_w.left),
        line("right", RIGHT, |o| 1e-3 * o.engines.power_w.right),
        limit("available", |o| 1e-3 * o.engines.available_w),
    ]),
    Graph::new("plots/fuel", "Fuel, kg", &[line("aboard", WHITE, |o| o.fuel_kg)]),
    Graph::new("plots/fuel_flow", "Fuel flow, kg/h", &[
        line("both engines", ORANGE, |o| 3600.0 * o.engines.fuel_flow_kg_per_s),
    ]),
    Graph::new("plots/gear_push", "Ground's push, kN", &[
        line("nose", BLUE, |o| 1e-3 * o.landing_gear.nose.push_n),
        broad("left", LEFT, |o| 1e-3 * o.landing_gear.main.left.push_n),
        line("right", RIGHT, |o| 1e-3 * o.landing_gear.main.right.push_n),
    ]),
    Graph::new("plots/gear_compression", "Strut compression, cm", &[
        line("nose", BLUE, |o| 1e2 * o.landing_gear.nose.compression_m),
        broad("left", LEFT, |o| 1e2 * o.landing_gear.main.left.compression_m),
        line("right", RIGHT, |o| 1e2 * o.landing_gear.main.right.compression_m),
    ]),
    Graph::new("plots/gear_extension", "Gear, 1 = down", &[
        line("gear", WHITE, |o| o.actuators.gear_extension_norm),
    ]),
    by_component!("plots/force_x", "Force forward, kN", |load| load.force_n.x),
    by_component!("plots/force_z", "Force up, kN", |load| -load.force_n.z),
    by_component!("plots/moment_roll", "Rolling moment, right +, kN·m", |load| load.moment_n_m.x),
    by_component!("plots/moment_pitch", "Pitching moment, up +, kN·m", |load| load.moment_n_m.y),
    by_component!("plots/moment_yaw", "Yawing moment, right +, kN·m", |load| load.moment_n_m.z),
];

/// From one tick to the next, in which all of its work is to be done.
const BUDGET_MS: f64 = 1e3 * engine::STEP_S;

fn ms(ns: u64) -> f64 {
    ns as f64 * 1e-6
}

/// How ticks kept time. Of the ticks of a row, the latest.
#[rustfmt::skip]
pub const TIMES: &[Graph<TimingRecord>] = &[
    Graph::new("times/sent", "From due to the picture's packet, ms", &[
        broad("lateness and all", ORANGE, |t| ms(t.late_ns.saturating_add(t.sent_ns))),
        line("lateness alone", BLUE, |t| ms(t.late_ns)),
        limit("a tick: 4 ms", |_| BUDGET_MS),
    ]),
    Graph::new("times/latency", "From an input in the kernel to the packet, ms", &[
        // Without an input of hardware there is none.
        line("each input of hardware", VIOLET, |t| if t.latency_ns == 0 { f64::NAN } else { ms(t.latency_ns) }),
    ]),
    Graph::new("times/step", "Work of a tick, ms", &[
        line("flight model", ORANGE, |t| ms(t.step_ns)),
        line("handing over to the log", BLUE, |t| ms(t.record_ns)),
        limit("a tick: 4 ms", |_| BUDGET_MS),
    ]),
    Graph::new("times/slip", "Slips of the clock, ms", &[
        line("slip", LEFT, |t| ms(t.slip_ns)),
    ]),
    Graph::new("times/overrun", "Overruns: ticks that ended late, of a flight in real time", &[
        line("ended after the next tick was due", LEFT, |t| t.overrun as f64),
    ]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn no_two_graphs_share_an_entity_and_every_line_has_a_name_of_its_own() {
        let entities = || {
            GRAPHS.iter().map(|graph| graph.entity).chain(TIMES.iter().map(|graph| graph.entity))
        };
        assert_eq!(entities().collect::<BTreeSet<_>>().len(), entities().count());
        for graph in GRAPHS {
            let names: BTreeSet<_> = graph.lines.iter().map(|line| line.name).collect();
            assert_eq!(names.len(), graph.lines.len(), "{}", graph.entity);
        }
    }

    /// A line with a number has a unit: in the title, unless it counts or is a ratio.
    #[test]
    fn every_graph_says_its_unit() {
        let ratios =
            ["plots/blade_loading", "plots/stalled", "plots/gear_extension", "times/overrun"];
        for (entity, title) in GRAPHS
            .iter()
            .map(|graph| (graph.entity, graph.title))
            .chain(TIMES.iter().map(|graph| (graph.entity, graph.title)))
        {
            let said = title.contains(", ") || ratios.contains(&entity);
            assert!(said, "{entity}: {title}");
        }
    }

    #[test]
    fn a_unit_is_told_from_the_name() {
        let named = |entity: &str| {
            GRAPHS.iter().find(|graph| graph.entity == entity).expect("a graph").named()
        };
        assert_eq!(named("plots/height"), ("Height", "m"));
        assert_eq!(named("plots/nacelle"), ("Nacelle incidence", "deg"));
        assert_eq!(named("plots/cyclic"), ("Longitudinal cyclic, forward +", "deg"));
        assert_eq!(named("plots/climb"), ("Climb", "ft/min"));
        assert_eq!(named("plots/rates"), ("Body rates", "deg/s"));
        assert_eq!(named("plots/blade_loading"), ("Blade loading, C_T/σ", ""));
        assert_eq!(named("plots/gear_extension"), ("Gear, 1 = down", ""));
    }

    #[test]
    fn the_forces_of_the_components_are_the_total() {
        let mut outputs = Outputs::default();
        let mut n = 0.0;
        let mut load = || {
            n += 1000.0;
            Load { force_n: engine::frames::Vec3::new(n, 0.0, -n), ..Load::default() }
        };
        outputs.loads.rotors = Pair { left: load(), right: load() };
        outputs.loads.wing_pylon = Pair { left: load(), right: load() };
        outputs.loads.fuselage = load();
        outputs.loads.horizontal_stabilizer = load();
        outputs.loads.vertical_stabilizers = Pair { left: load(), right: load() };
        outputs.loads.jets = Pair { left: load(), right: load() };
        outputs.loads.landing_gear.nose = load();
        outputs.total = outputs.loads.total();
        let graph = GRAPHS.iter().find(|graph| graph.entity == "plots/force_z").expect("a graph");
        let values: Vec<f64> = graph.lines.iter().map(|line| (line.of)(&outputs)).collect();
        let parts: f64 = values[1..].iter().sum();
        assert!((values[0] - parts).abs() < 1e-9, "{values:?}");
        assert!((values[0] - 66.0).abs() < 1e-9, "{values:?}");
    }
}

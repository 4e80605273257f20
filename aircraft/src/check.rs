//! Numbers that the engine could not work with, refused before it meets them.

use engine::inertia::Inertia;
use engine::math::PI;
use engine::table::Invalid;

use crate::error::{ConfigError, Problem};
use crate::tree::{Node, Value};
use crate::units;

/// No quantity of an aircraft is larger than this in SI units: beyond it something would overflow
/// sooner or later.
const LARGEST: f64 = 1e9;
/// What the engine divides by is at least this.
const SMALLEST: f64 = 1e-6;

/// Bounds by key, in SI units. What is not here is within ±[`LARGEST`].
const BOUNDS: &[(&str, f64, f64)] = &[
    // Divided by.
    ("mast_length_m", SMALLEST, LARGEST),
    ("radius_m", SMALLEST, LARGEST),
    ("solidity", SMALLEST, 1.0),
    ("blade_inertia_kg_m2", SMALLEST, LARGEST),
    ("frequency_radps", SMALLEST, LARGEST),
    ("stop_spring_n_m_per_rad", 0.0, LARGEST),
    ("hub_spring_n_m_per_rad", 0.0, LARGEST),
    ("root_norm", 0.0, 1.0),
    ("table_tip_mach", 0.0, 0.9),
    ("delta3_rad", -1.4, 1.4),
    ("polar_inertia_kg_m2", SMALLEST, LARGEST),
    ("drive_inertia_kg_m2", 0.0, LARGEST),
    ("area_m2", SMALLEST, LARGEST),
    ("chord_m", SMALLEST, LARGEST),
    ("span_m", SMALLEST, LARGEST),
    ("wake_length_m", SMALLEST, LARGEST),
    ("sidewash_speed_mps_min", SMALLEST, LARGEST),
    ("dynamic_pressure_pa", SMALLEST, LARGEST),
    ("rated_power_w", SMALLEST, LARGEST),
    ("zero_fuel_mass_kg", SMALLEST, LARGEST),
    ("stiffness_n_per_m", SMALLEST, LARGEST),
    ("tyre_stiffness_n_per_m", SMALLEST, LARGEST),
    ("tread_stiffness_n_per_m", SMALLEST, LARGEST),
    // Positive by their nature.
    ("rotor_speed_radps", SMALLEST, LARGEST),
    ("reference_radps2", SMALLEST, LARGEST),
    ("rate_radps_max", SMALLEST, LARGEST),
    ("torque_n_m_max", SMALLEST, LARGEST),
    ("flapping_rad_max", 0.0, PI),
    ("reference_radps", 0.0, LARGEST),
    ("tyre_damping_n_s_per_m", 0.0, LARGEST),
    ("tread_damping_n_s_per_m", 0.0, LARGEST),
    ("damping_n_s_per_m", 0.0, LARGEST),
    ("stroke_m", 0.0, LARGEST),
    ("fuel_kg", 0.0, LARGEST),
    ("fuel_kg_max", 0.0, LARGEST),
    ("wind_mps", 0.0, 100.0),
    // Limits of the envelope.
    ("cruise_mps_max", SMALLEST, LARGEST),
    ("dive_mps_max", SMALLEST, LARGEST),
    ("mach_max", SMALLEST, 1.0),
    ("flap_mps_max", SMALLEST, LARGEST),
    ("gear_cycle_mps_max", SMALLEST, LARGEST),
    ("rated_radps", SMALLEST, LARGEST),
    ("overspeed_radps", SMALLEST, LARGEST),
    ("speed_radps_max", SMALLEST, LARGEST),
    ("underspeed_norm", 0.0, 1.0),
    ("gross_kg_max", SMALLEST, LARGEST),
    ("touchdown_sink_mps_max", SMALLEST, LARGEST),
    ("reserve_sink_mps_max", SMALLEST, LARGEST),
    ("airspeed_mps_max", SMALLEST, LARGEST),
    ("height_m_max", SMALLEST, LARGEST),
    ("rotor_speed_radps_min", 0.0, LARGEST),
    ("rotor_speed_radps_max", SMALLEST, LARGEST),
    ("angular_rate_radps_max", SMALLEST, LARGEST),
    // What a pilot knows.
    ("helicopter_mps", SMALLEST, LARGEST),
    ("circuit_mps", SMALLEST, LARGEST),
    ("cruise_mps", SMALLEST, LARGEST),
    ("over_a_spot_mps_max", 0.0, LARGEST),
    ("flying_mps_min", SMALLEST, LARGEST),
    ("lift_m2_per_kg_rad", SMALLEST, LARGEST),
    ("lever_mps2", SMALLEST, LARGEST),
    ("lever_w_per_kg", SMALLEST, LARGEST),
    ("half_stick_pa", SMALLEST, LARGEST),
    // Shapes.
    ("sweep_rad", -1.4, 1.4),
    ("dihedral_rad", -1.4, 1.4),
    ("thickness_ratio", 0.0, 1.0),
    ("width_m", SMALLEST, LARGEST),
    ("spacing_m", 0.0, LARGEST),
    ("leg_radius_m", SMALLEST, LARGEST),
    // A place that the map projection can hold.
    ("latitude_rad", -1.55, 1.55),
    ("longitude_rad", -PI, PI),
    ("flap_detent", 0.0, engine::cockpit::FLAP_DETENT_LAST as f64),
];

/// Numbers that the model fixes by key, and what they are.
const FIXED: &[(&str, f64, &str)] =
    &[("count", 3.0, "3 blades: the model is of a three-bladed gimballed hub")];

/// A lag shorter than a tick would run away.
const TIMES: (f64, f64) = (engine::STEP_S, LARGEST);

fn error(file: &str, node: &Node, problem: Problem) -> ConfigError {
    ConfigError { file: file.to_owned(), line: node.line, key: node.key.clone(), problem }
}

/// Refuses numbers out of their bounds, and least values that are not below the greatest.
pub(crate) fn ranges(file: &str, tree: &Node) -> Result<(), ConfigError> {
    let Value::Table(nodes) = &tree.value else { return Ok(()) };
    for (name, node) in nodes {
        let bounds = BOUNDS
            .iter()
            .find(|(key, ..)| key == name)
            .map(|&(_, min, max)| (min, max))
            .or_else(|| name.ends_with("_s").then_some(TIMES))
            .unwrap_or((-LARGEST, LARGEST));
        within(file, node, bounds)?;
        if let Some((_, fixed, expected)) = FIXED.iter().find(|(key, ..)| key == name)
            && let Some(found) = node.value.number()
            && found.to_bits() != fixed.to_bits()
        {
            return Err(error(file, node, Problem::Fixed { expected, found }));
        }
        let greatest = name
            .strip_suffix("_min")
            .and_then(|stem| nodes.iter().find(|(other, _)| *other == format!("{stem}_max")));
        if let Some((_, greatest)) = greatest
            && let (Some(low), Some(high)) = (node.value.number(), greatest.value.number())
            && low >= high
        {
            return Err(error(file, node, Problem::Crossed { other: greatest.key.clone() }));
        }
    }
    Ok(())
}

/// The key that names the unit, of a path that may lead into a list or to the values behind a table's arguments.
fn quantity(path: &str) -> &str {
    let list = path.split('[').next().unwrap_or_default();
    let key = list.strip_suffix(".value").unwrap_or(list);
    key.rsplit('.').next().unwrap_or_default()
}

/// Every number of the node within its bounds; members of a table have their own.
fn within(file: &str, node: &Node, (min, max): (f64, f64)) -> Result<(), ConfigError> {
    match &node.value {
        Value::Table(_) => ranges(file, node),
        // What bounds a quantity does not bound the points of an axis.
        Value::Tabulated(parts) => {
            parts.iter().try_for_each(|(_, node)| within(file, node, (-LARGEST, LARGEST)))
        }
        Value::Array(nodes) => nodes.iter().try_for_each(|node| within(file, node, (min, max))),
        value => match value.number() {
            Some(found) if found < min || found > max => {
                // As whoever wrote the key counts.
                let (_, factor) = units::to_si(quantity(&node.key));
                let [min, max, found] = [min, max, found].map(|si| si / factor);
                Err(error(file, node, Problem::OutOfRange { min, max, found }))
            }
            _ => Ok(()),
        },
    }
}

/// Refuses tables that cannot be looked up, and inertias that cannot be inverted.
pub(crate) fn aircraft(
    file: &str,
    tree: &Node,
    aircraft: &engine::aircraft::Params,
) -> Result<(), ConfigError> {
    if let Err(Invalid { key: name, expected }) = aircraft.validate() {
        return Err(error(file, find(tree, name), Problem::Unusable(expected)));
    }
    let weights = &aircraft.weight_balance;
    let (upright, change) = (&weights.inertia, &weights.inertia_change);
    let level = Inertia {
        xx_kg_m2: upright.xx_kg_m2 + change.xx_kg_m2,
        yy_kg_m2: upright.yy_kg_m2 + change.yy_kg_m2,
        zz_kg_m2: upright.zz_kg_m2 + change.zz_kg_m2,
        xz_kg_m2: upright.xz_kg_m2 + change.xz_kg_m2,
    };
    for (inertia, name) in
        [(upright, "weight_balance.inertia"), (&level, "weight_balance.inertia_change")]
    {
        if !is_a_body(inertia) {
            return Err(error(file, find(tree, name), Problem::Inertia));
        }
    }
    Ok(())
}

fn is_a_body(inertia: &Inertia) -> bool {
    let Inertia { xx_kg_m2: xx, yy_kg_m2: yy, zz_kg_m2: zz, xz_kg_m2: xz } = *inertia;
    xx > 0.0 && yy > 0.0 && zz > 0.0 && xx * zz > xz * xz
}

/// The node that the engine calls `name`: its keys without their units.
fn find<'a>(tree: &'a Node, name: &str) -> &'a Node {
    let (first, rest) = name.split_once('.').map_or((name, None), |(a, b)| (a, Some(b)));
    let (stem, bound) = units::without_bound(first);
    let Value::Table(nodes) = &tree.value else { return tree };
    let called = |key: &str| {
        let unit = key.strip_prefix(stem).and_then(|unit| unit.strip_suffix(bound));
        unit.is_some_and(|unit| unit.is_empty() || unit.starts_with('_'))
    };
    // The key itself counts before a longer one that begins alike.
    let found = nodes
        .iter()
        .find(|(key, _)| key == first)
        .or_else(|| nodes.iter().find(|(key, _)| called(key)));
    match (found, rest) {
        (Some((_, node)), Some(rest)) => find(node, rest),
        (Some((_, node)), None) => node,
        (None, _) => tree,
    }
}

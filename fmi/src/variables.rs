//! The one table of what a simulation tool can set and read.
//!
//! A variable's value reference is its place in the table, in both versions of FMI.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use engine::Outputs;
use engine::cockpit::{AxisControl, ButtonControl, Travel};
use engine::controls::Commands;
use engine::inputs::Failures;
use logs::fields::{Value as Number, fields};
use logs::units::unit_of;

/// What is said of the fields of every public struct, by `provenance` from the sources.
type Described = (&'static str, &'static [(&'static str, &'static str)]);
static DESCRIBED: &[Described] = include!(concat!(env!("OUT_DIR"), "/descriptions.rs"));

/// A value of a parameter or an input.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Real(f64),
    /// A switch.
    Boolean(bool),
    /// A text.
    Text(String),
}

/// What a variable is to the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Simulated time, which the tool counts too.
    Time,
    /// Set before the flight begins.
    Parameter,
    /// May change at each communication point, and holds until the next.
    Input,
    /// What the flight gives: a number that moves with time, or one that jumps.
    Output {
        /// Whether it is a whole number: a count, a switch, flags.
        whole: bool,
    },
}

/// What a variable moves or shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Simulated time.
    Time,
    /// A parameter, by its name.
    Parameter,
    /// A control in the cockpit.
    Axis(AxisControl),
    /// A button.
    Button(ButtonControl),
    /// A failure.
    Failure(Failures),
    /// Whether the actuators are driven from outside.
    Drive,
    /// A command to the actuators, by its place.
    Command(usize),
    /// An output, by its place.
    Output(usize),
}

/// A variable.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Its name, the unit last.
    pub name: String,
    /// What it is to the tool.
    pub role: Role,
    /// What it moves or shows.
    pub target: Target,
    /// Empty for a count, a switch, a text or a ratio.
    pub unit: String,
    /// What it is.
    pub description: String,
    /// Its value unless set; of an output only the type counts.
    pub start: Value,
}

/// Parameters: name, value unless set, what it is. The unit is in the name.
const REALS: [(&str, &str, f64, &str); 14] = [
    ("nacelle_deg", "deg", 90.0, "Nacelle incidence at the start: 90 helicopter, 0 aeroplane"),
    ("speed_kt", "kt", 0.0, "True airspeed at the start"),
    (
        "altitude_ft",
        "ft",
        1000.0,
        "Altitude above mean sea level at the start; the ground is at 44 ft",
    ),
    ("climb_fpm", "ft/min", 0.0, "Rate of climb at the start"),
    ("heading_deg", "deg", 270.0, "True heading at the start"),
    ("fuel_lb", "lb", -1.0, "Fuel aboard at the start; below 0: full tanks"),
    ("wind_kt", "kt", 0.0, "Speed of the steady wind"),
    ("wind_from_deg", "deg", 0.0, "True direction from which the wind blows"),
    (
        "wind_roughness_m",
        "m",
        0.0,
        "Roughness length of the ground; 0: the same wind at every height",
    ),
    ("turbulence_mps", "m/s", 0.0, "Vertical intensity of the turbulence; 0: still air"),
    ("turbulence_seed", "", 0.0, "Seed of the turbulence, a whole number"),
    ("temperature_offset_k", "K", 0.0, "Warmer than the standard atmosphere by"),
    ("pressure_offset_pa", "Pa", 0.0, "Sea-level pressure above the standard one by"),
    (
        "flap_detent",
        "",
        -1.0,
        "Flap lever's detent at the start, 0 to 3; -1: the usual one for the nacelles",
    ),
];

const FLAGS: [(&str, bool, &str); 4] = [
    ("scas_on", true, "SCAS on at the start"),
    ("gear_down", false, "Landing gear down at the start"),
    (
        "absolute_inputs",
        false,
        "false: control inputs are added to where the controls stand at the start, and `drive` inputs to what the \
         aircraft's own computer asks for, so that an unconnected input, which is 0, changes nothing; true: they are \
         positions and commands themselves",
    ),
    ("log_force", false, "Whether a log that is there already may be replaced"),
];

const TEXTS: [(&str, &str, &str); 3] = [
    (
        "start",
        "trim",
        "trim: in the steady flight that nacelle_deg, speed_kt, altitude_ft, climb_fpm, heading_deg, fuel_lb, flap_detent, \
         scas_on and gear_down say; or a start position, which has its own: runway, hover-50ft, approach-60, downwind",
    ),
    ("aircraft_file", "", "Path of an aircraft file; empty: the built-in XV-15"),
    ("log_file", "", "Path of the flight log to record, which replays bit for bit; empty: none"),
];

/// The table.
pub fn table() -> &'static [Variable] {
    static TABLE: OnceLock<Vec<Variable>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut table = vec![Variable {
            name: "time".into(),
            role: Role::Time,
            target: Target::Time,
            unit: "s".into(),
            description: "Simulated time".into(),
            start: Value::Real(0.0),
        }];
        parameters(&mut table);
        inputs(&mut table);
        outputs(&mut table);
        table
    })
}

/// Places in the table by name.
pub fn place(name: &str) -> Option<usize> {
    static PLACES: OnceLock<BTreeMap<&'static str, usize>> = OnceLock::new();
    let by_name =
        || table().iter().enumerate().map(|(place, v)| (v.name.as_str(), place)).collect();
    PLACES.get_or_init(by_name).get(name).copied()
}

fn parameters(table: &mut Vec<Variable>) {
    let mut add = |name: &str, unit: &str, start, description: &str| {
        table.push(Variable {
            name: name.into(),
            role: Role::Parameter,
            target: Target::Parameter,
            unit: unit.into(),
            description: description.into(),
            start,
        });
    };
    for (name, start, description) in TEXTS {
        add(name, "", Value::Text(start.into()), description);
    }
    for (name, unit, start, description) in REALS {
        add(name, unit, Value::Real(start), description);
    }
    for (name, start, description) in FLAGS {
        add(name, "", Value::Boolean(start), description);
    }
}

/// The axes that the built-in cockpit map has, by name: the order in which movements are recorded.
pub fn axes() -> Vec<AxisControl> {
    let mut axes: Vec<_> = AxisControl::ALL
        .iter()
        .copied()
        .filter(|axis| !axis.facts().springs_back && *axis != AxisControl::FlapLever)
        .collect();
    axes.sort_by_key(|axis| axis.facts().key);
    axes
}

fn inputs(table: &mut Vec<Variable>) {
    let mut add = |name: String, target, unit: &str, start, description: String| {
        let unit = unit.to_string();
        table.push(Variable { name, role: Role::Input, target, unit, description, start });
    };
    for axis in axes() {
        let facts = axis.facts();
        let ends = match facts.travel {
            Travel::Centred => "-1 to 1",
            Travel::FromEnd => "0 to 1",
        };
        let description = format!(
            "{} Its travel is {ends}; added to where it stands at the start unless absolute_inputs",
            facts.description
        );
        add(facts.key.into(), Target::Axis(axis), "norm", Value::Real(0.0), description);
    }
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).ok();
    let bound: Vec<_> = map.iter().flat_map(|map| &map.device).flat_map(|d| &d.button).collect();
    for &button in ButtonControl::ALL {
        if bound.iter().any(|binding| binding.control == button) {
            let facts = button.facts();
            let name = format!("button.{}", facts.key);
            let target = Target::Button(button);
            add(name, target, "", Value::Boolean(false), facts.description.into());
        }
    }
    for facts in Failures::FACTS {
        let name = format!("fail.{}", facts.key);
        let target = Target::Failure(facts.flag);
        add(name, target, "", Value::Boolean(false), facts.description.into());
    }
    let description =
        "Whether the actuators obey the `drive` inputs in place of the aircraft's own computer";
    add("drive_actuators".into(), Target::Drive, "", Value::Boolean(false), description.into());
    for (place, field) in fields(&Commands::default()).into_iter().flatten().enumerate() {
        let name = format!("drive.{}", field.path);
        let description = format!(
            "{} Added to what the aircraft's own computer asks for unless absolute_inputs",
            said_of("Commands", "elevator_rad", &field.path)
        );
        let target = Target::Command(place);
        add(name, target, &unit_of(&field.path), Value::Real(0.0), description);
    }
}

fn outputs(table: &mut Vec<Variable>) {
    for (place, field) in fields(&Outputs::default()).into_iter().flatten().enumerate() {
        table.push(Variable {
            description: said_of("Outputs", "height_above_ground_m", &field.path),
            unit: unit_of(&field.path),
            name: field.path,
            role: Role::Output { whole: !matches!(field.value, Number::F64(_)) },
            target: Target::Output(place),
            start: Value::Real(0.0),
        });
    }
}

/// What the sources say of a struct's field, of the first name of a path. Blocks have outputs, too: a field tells which
/// struct of that name is meant.
fn said_of(of: &str, having: &str, path: &str) -> String {
    let first = path.split(['.', '[']).next().unwrap_or_default();
    let meant = |fields: &[(&str, &str)]| fields.iter().any(|(name, _)| *name == having);
    let fields = DESCRIBED.iter().find(|(name, fields)| *name == of && meant(fields));
    let fields = fields.map(|(_, fields)| *fields);
    let said = fields.into_iter().flatten().find(|(name, _)| *name == first);
    said.map_or_else(String::new, |(_, said)| (*said).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::base_unit;

    #[test]
    fn every_variable_has_a_name_of_its_own_and_a_unit_that_fmi_knows() {
        let names: std::collections::BTreeSet<_> = table().iter().map(|v| &v.name).collect();
        assert_eq!(names.len(), table().len());
        for variable in table() {
            let known = variable.unit.is_empty() || base_unit(&variable.unit).is_some();
            assert!(known, "{}: {}", variable.name, variable.unit);
            assert!(!variable.description.is_empty(), "{}: what is it?", variable.name);
        }
        assert!(table().iter().filter(|v| matches!(v.role, Role::Output { .. })).count() > 200);
    }

    #[test]
    fn the_axes_are_those_of_the_map_that_programs_move() {
        let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).expect("our own");
        let mut bound: Vec<_> = map.device[0].axis.iter().map(|a| a.control.facts().key).collect();
        bound.sort_unstable();
        assert_eq!(axes().iter().map(|axis| axis.facts().key).collect::<Vec<_>>(), bound);
    }
}

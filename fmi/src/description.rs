//! `modelDescription.xml` of either version, from the one table.

use std::fmt::Write as _;

use crate::units::{BASES, BaseUnit, base_unit};
use crate::variables::{Role, Value, Variable, table};

/// The name under which a simulation tool loads the library.
pub const MODEL_IDENTIFIER: &str = "XV15";

/// A version of the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Fmi2,
    /// FMI 3.0.
    Fmi3,
}

/// What ties a description to the library that it was made with: made of the program's version and the table.
pub fn token() -> String {
    let mut halves = [0xcbf2_9ce4_8422_2325_u64, 0x8422_2325_cbf2_9ce4];
    let mut take = |text: &str| {
        for byte in text.bytes().chain([0]) {
            for half in &mut halves {
                // FNV-1a, from two beginnings.
                *half = (*half ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
            }
        }
    };
    take(env!("TILTROTOR_VERSION"));
    for Variable { name, unit, role, start, .. } in table() {
        take(&format!("{name}|{unit}|{role:?}|{start:?}"));
    }
    let [high, low] = halves;
    let (a, b, c) = (high >> 32, high >> 16 & 0xffff, high & 0xffff);
    format!("{{{a:08x}-{b:04x}-{c:04x}-{:04x}-{:012x}}}", low >> 48, low & 0xffff_ffff_ffff)
}

/// The whole text.
pub fn model_description(version: Version) -> String {
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let (fmi, token_name, state) = match version {
        Version::Fmi2 => ("2.0", "guid", "canGetAndSetFMUstate"),
        Version::Fmi3 => ("3.0", "instantiationToken", "canGetAndSetFMUState"),
    };
    let internal = match version {
        Version::Fmi2 => String::new(),
        Version::Fmi3 => format!(" fixedInternalStepSize=\"{}\"", engine::STEP_S),
    };
    let _ = write!(
        xml,
        "<fmiModelDescription fmiVersion=\"{fmi}\" modelName=\"Bell XV-15\" {token_name}=\"{token}\" \
         description=\"Flight model of the Bell XV-15 tilt rotor, 250 Hz\" version=\"{version}\" \
         license=\"MIT OR Apache-2.0\" generationTool=\"tiltrotor\" variableNamingConvention=\"flat\">\n\
         \x20 <CoSimulation modelIdentifier=\"{MODEL_IDENTIFIER}\" canHandleVariableCommunicationStepSize=\"true\"\
         {internal} {state}=\"true\"/>\n",
        token = token(),
        version = escaped(env!("TILTROTOR_VERSION")),
    );
    units(&mut xml);
    let _ = write!(
        xml,
        "  <LogCategories>\n    <Category name=\"error\" description=\"What was refused, and what to do\"/>\n  \
         </LogCategories>\n  <DefaultExperiment startTime=\"0\" stopTime=\"10\" stepSize=\"{}\"/>\n  \
         <ModelVariables>\n",
        engine::STEP_S
    );
    for (reference, variable) in table().iter().enumerate() {
        match version {
            Version::Fmi2 => variable_of_2(&mut xml, reference, variable),
            Version::Fmi3 => variable_of_3(&mut xml, reference, variable),
        }
    }
    xml.push_str("  </ModelVariables>\n");
    structure(&mut xml, version);
    xml.push_str("</fmiModelDescription>\n");
    xml
}

fn units(xml: &mut String) {
    let mut names: Vec<_> = table().iter().map(|v| &v.unit).filter(|u| !u.is_empty()).collect();
    names.sort_unstable();
    names.dedup();
    xml.push_str("  <UnitDefinitions>\n");
    for name in names {
        let BaseUnit { powers, factor } =
            base_unit(name).unwrap_or(BaseUnit { powers: [0; 5], factor: 1.0 });
        let _ = write!(xml, "    <Unit name=\"{name}\"><BaseUnit");
        for (base, power) in BASES.iter().zip(powers).filter(|(_, power)| *power != 0) {
            let _ = write!(xml, " {base}=\"{power}\"");
        }
        if factor.to_bits() != 1.0_f64.to_bits() {
            let _ = write!(xml, " factor=\"{factor:?}\"");
        }
        xml.push_str("/></Unit>\n");
    }
    xml.push_str("  </UnitDefinitions>\n");
}

/// Causality, variability and initial.
fn attributes(variable: &Variable) -> &'static str {
    match (variable.role, &variable.start) {
        (Role::Time, _) => "causality=\"independent\" variability=\"continuous\"",
        (Role::Parameter, _) => "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"",
        (Role::Input, Value::Real(_)) => "causality=\"input\" variability=\"continuous\"",
        (Role::Input, _) => "causality=\"input\" variability=\"discrete\"",
        (Role::Output { whole: false }, _) => {
            "causality=\"output\" variability=\"continuous\" initial=\"calculated\""
        }
        (Role::Output { whole: true }, _) => {
            "causality=\"output\" variability=\"discrete\" initial=\"calculated\""
        }
    }
}

/// The unit of a number.
fn unit(variable: &Variable) -> String {
    if variable.unit.is_empty() { String::new() } else { format!(" unit=\"{}\"", variable.unit) }
}

/// The value unless set, of what can be set.
fn start(variable: &Variable) -> Option<String> {
    let settable = matches!(variable.role, Role::Parameter | Role::Input);
    settable.then(|| match &variable.start {
        Value::Real(value) => format!("{value:?}"),
        Value::Boolean(value) => value.to_string(),
        Value::Text(value) => escaped(value),
    })
}

fn named(reference: usize, variable: &Variable) -> String {
    format!(
        "name=\"{}\" valueReference=\"{reference}\" description=\"{}\" {}",
        escaped(&variable.name),
        escaped(&variable.description),
        attributes(variable)
    )
}

fn variable_of_2(xml: &mut String, reference: usize, variable: &Variable) {
    let kind = match variable.start {
        Value::Real(_) => "Real",
        Value::Boolean(_) => "Boolean",
        Value::Text(_) => "String",
    };
    let start = start(variable).map_or_else(String::new, |start| format!(" start=\"{start}\""));
    let (named, unit) = (named(reference, variable), unit(variable));
    let _ = writeln!(xml, "    <ScalarVariable {named}><{kind}{unit}{start}/></ScalarVariable>");
}

fn variable_of_3(xml: &mut String, reference: usize, variable: &Variable) {
    let (named, unit) = (named(reference, variable), unit(variable));
    let start = start(variable);
    let _ = match (&variable.start, start) {
        (Value::Text(_), start) => writeln!(
            xml,
            "    <String {named}><Start value=\"{}\"/></String>",
            start.unwrap_or_default()
        ),
        (Value::Boolean(_), start) => {
            writeln!(xml, "    <Boolean {named} start=\"{}\"/>", start.unwrap_or_default())
        }
        (Value::Real(_), Some(start)) => {
            writeln!(xml, "    <Float64 {named}{unit} start=\"{start}\"/>")
        }
        (Value::Real(_), None) => writeln!(xml, "    <Float64 {named}{unit}/>"),
    };
}

/// What the outputs depend on: at a communication point on no input of that point, so that a tool sees no
/// algebraic loop.
fn structure(xml: &mut String, version: Version) {
    let outputs = table().iter().enumerate();
    let outputs = outputs.filter(|(_, variable)| matches!(variable.role, Role::Output { .. }));
    let outputs: Vec<usize> = outputs.map(|(reference, _)| reference).collect();
    xml.push_str("  <ModelStructure>\n");
    match version {
        Version::Fmi2 => {
            // Counted from 1.
            xml.push_str("    <Outputs>\n");
            for place in &outputs {
                let _ = writeln!(xml, "      <Unknown index=\"{}\" dependencies=\"\"/>", place + 1);
            }
            xml.push_str("    </Outputs>\n    <InitialUnknowns>\n");
            for place in &outputs {
                let _ = writeln!(xml, "      <Unknown index=\"{}\"/>", place + 1);
            }
            xml.push_str("    </InitialUnknowns>\n");
        }
        Version::Fmi3 => {
            for place in &outputs {
                let _ = writeln!(xml, "    <Output valueReference=\"{place}\" dependencies=\"\"/>");
            }
            for place in &outputs {
                let _ = writeln!(xml, "    <InitialUnknown valueReference=\"{place}\"/>");
            }
        }
    }
    xml.push_str("  </ModelStructure>\n");
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

//! TOML text to a plain tree in SI units, without provenance, that remembers lines.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::error::{ConfigError, Problem};
use crate::provenance::{Provenance, Trust};
use crate::units;

/// Whether numbers carry their source.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Numbers {
    /// Each is a table of value, source and trust.
    Sourced,
    /// They stand alone.
    Bare,
}

/// A value and where it is.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    /// Its key with the tables it is in, as written.
    pub key: String,
    /// Line of its key, from 1.
    pub line: usize,
    /// The value.
    pub value: Value,
}

/// A value in SI units.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Float(f64),
    Integer(i64),
    Bool(bool),
    Text(String),
    Array(Vec<Node>),
    /// By SI key, in the file's order.
    Table(Vec<(String, Node)>),
}

impl Value {
    /// What it is, for messages.
    pub fn describe(&self) -> &'static str {
        match self {
            Self::Float(_) | Self::Integer(_) => "a number",
            Self::Bool(_) => "true or false",
            Self::Text(_) => "a string",
            Self::Array(_) => "an array",
            Self::Table(_) => "a table",
        }
    }

    /// As a number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Float(number) => Some(*number),
            Self::Integer(number) => Some(*number as f64),
            _ => None,
        }
    }

    /// With every number in it multiplied; whole numbers stay whole where nothing changes.
    fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Float(number) => Self::Float(number * factor),
            Self::Integer(number) if factor.to_bits() != 1.0_f64.to_bits() => {
                Self::Float(number as f64 * factor)
            }
            Self::Array(nodes) => Self::Array(
                nodes
                    .into_iter()
                    .map(|node| Node { value: node.value.scaled(factor), ..node })
                    .collect(),
            ),
            other => other,
        }
    }
}

/// The file's tree, and where its numbers come from.
pub(crate) fn parse(
    file: &str,
    text: &str,
    numbers: Numbers,
) -> Result<(Node, Vec<Provenance>), ConfigError> {
    let lines = Lines::of(text);
    let document = DeTable::parse(text).map_err(|error| ConfigError {
        file: file.to_owned(),
        line: error.span().map_or(1, |span| lines.at(span.start)),
        key: String::new(),
        problem: Problem::Syntax(error.message().replace('\n', "; ")),
    })?;
    let mut walk = Walk { file, lines, numbers, provenance: Vec::new() };
    let value = walk.table("", document.get_ref())?;
    Ok((Node { key: String::new(), line: 1, value }, walk.provenance))
}

/// Where the lines of a text begin.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &str) -> Self {
        Self(text.match_indices('\n').map(|(at, _)| at + 1).collect())
    }

    /// The line, from 1, of a byte.
    fn at(&self, byte: usize) -> usize {
        1 + self.0.partition_point(|&start| start <= byte)
    }
}

/// The engine's tables: (key, arguments), in SI. A key that two blocks have with other arguments stands with the
/// tables that it is in; of the rows that fit, the longest counts.
const TABLES: &[(&str, &[&str])] = &[
    ("attitude_by_tilt_norm", &["mast_tilt_rad"]),
    ("stick_by_tilt_m_per_rad", &["mast_tilt_rad"]),
    ("speed_by_tilt_mps_per_rad", &["mast_tilt_rad"]),
    ("collective_per_lever_rad_per_m", &["mast_tilt_rad"]),
    ("collective_per_lateral_stick_rad_per_m", &["mast_tilt_rad"]),
    ("cyclic_per_longitudinal_stick_rad_per_m", &["mast_tilt_rad"]),
    ("cyclic_per_pedal_rad_per_m", &["mast_tilt_rad", "airspeed_mps"]),
    ("lateral_cyclic_rad", &["airspeed_mps"]),
    ("lateral_cyclic_norm", &["mast_tilt_rad"]),
    ("blade_chord_m", &["radius_norm"]),
    ("twist_rad", &["radius_norm"]),
    ("lift_coefficient", &["radius_norm", "alpha_rad"]),
    ("drag_coefficient", &["radius_norm", "alpha_rad"]),
    ("thickness_norm", &["radius_norm"]),
    ("download_near_ground", &["height_over_diameter"]),
    ("downwind", &["advance_ratio"]),
    ("abreast", &["advance_ratio"]),
    ("lever_bottom_rad", &["mast_tilt_rad"]),
    ("proportional_rad_per_radps", &["mast_tilt_rad"]),
    ("integral_rad_per_rad", &["mast_tilt_rad"]),
    ("nacelle_radps", &["mast_tilt_rad"]),
    ("power_by_lever_norm", &["lever_norm"]),
    // Envelope.
    ("calibrated_airspeed_mps_min", &["mast_tilt_rad"]),
    ("calibrated_airspeed_mps_max", &["mast_tilt_rad"]),
    ("short_torque_n_m_max", &["rotor_speed_radps"]),
    // Rotor wake.
    ("tail_ratio", &["mast_tilt_rad", "alpha_rad", "airspeed_mps"]),
    ("rotor_wake.sideslip_factor", &["beta_rad", "mast_tilt_rad"]),
    // Wing and pylons.
    ("flap_0", &["alpha_rad"]),
    ("flap_20", &["alpha_rad"]),
    ("flap_40", &["alpha_rad"]),
    ("flap_75", &["alpha_rad"]),
    ("mach_0_4", &["alpha_rad"]),
    ("mach_0_5", &["alpha_rad"]),
    ("mach_0_6", &["alpha_rad"]),
    ("pitching_moment", &["mast_tilt_rad", "flap_rad"]),
    ("drag_at_no_lift", &["mast_tilt_rad", "flap_rad"]),
    ("rolling_by_sideslip_per_rad", &["mast_tilt_rad", "flap_rad"]),
    ("rolling_by_sideslip_and_lift_per_rad", &["mast_tilt_rad", "flap_rad"]),
    ("flaperon_factor", &["mast_tilt_rad", "flap_rad"]),
    ("lift_loss_by_flaperon_per_rad", &["flap_rad"]),
    ("yawing_by_flaperon_per_rad", &["mast_tilt_rad", "flap_rad"]),
    ("yawing_by_flaperon_and_lift", &["mast_tilt_rad", "flap_rad"]),
    ("interference_m2", &["mast_tilt_rad"]),
    ("platform_factor", &["angle_rad"]),
    // Fuselage.
    ("lift_m2", &["alpha_rad"]),
    ("drag_m2", &["alpha_rad"]),
    ("pitching_m3", &["alpha_rad"]),
    ("lift_by_sideslip_m2", &["beta_rad"]),
    ("drag_by_sideslip_m2", &["beta_rad"]),
    ("pitching_by_sideslip_m3", &["beta_rad"]),
    ("side_m2", &["beta_rad"]),
    ("rolling_m3", &["beta_rad"]),
    ("yawing_m3", &["beta_rad"]),
    // Stabilisers.
    ("elevator_by_mach", &["mach"]),
    ("lift", &["alpha_rad", "elevator_rad"]),
    ("horizontal_stabilizer.drag", &["alpha_rad"]),
    ("horizontal_stabilizer.sideslip_factor", &["beta_rad"]),
    ("downwash_rad", &["mast_tilt_rad", "alpha_rad", "flap_rad"]),
    ("pressure_ratio", &["mast_tilt_rad", "alpha_rad", "airspeed_mps"]),
    ("pressure_factor", &["mast_tilt_rad"]),
    ("side_force", &["beta_rad", "rudder_rad"]),
    ("vertical_stabilizers.drag", &["beta_rad"]),
    ("side_force_by_mach.mach_0_4", &["beta_rad"]),
    ("side_force_by_mach.mach_0_5", &["beta_rad"]),
    ("side_force_by_mach.mach_0_6", &["beta_rad"]),
    ("vertical_stabilizers.drag_by_mach.mach_0_4", &["beta_rad"]),
    ("vertical_stabilizers.drag_by_mach.mach_0_5", &["beta_rad"]),
    ("vertical_stabilizers.drag_by_mach.mach_0_6", &["beta_rad"]),
    ("rudder_by_mach", &["mach"]),
    ("rotor_sidewash", &["airspeed_mps", "beta_rad"]),
    ("fuselage_sidewash.flap_0", &["mast_tilt_rad", "alpha_rad", "beta_rad"]),
    ("fuselage_sidewash.flap_20", &["mast_tilt_rad", "alpha_rad", "beta_rad"]),
    ("fuselage_sidewash.flap_40", &["mast_tilt_rad", "alpha_rad", "beta_rad"]),
    ("fuselage_sidewash.flap_75", &["mast_tilt_rad", "alpha_rad", "beta_rad"]),
];

/// What accompanies a sourced number's value.
const PARTS: [&str; 4] = ["value", "source", "trust", "note"];

/// One walk over a document.
struct Walk<'a> {
    file: &'a str,
    lines: Lines,
    numbers: Numbers,
    provenance: Vec<Provenance>,
}

/// A key of the document with its value.
struct Entry<'a, 'i> {
    name: &'a str,
    path: String,
    line: usize,
    value: &'a DeValue<'i>,
}

impl Walk<'_> {
    fn error(&self, key: &str, line: usize, problem: Problem) -> ConfigError {
        ConfigError { file: self.file.to_owned(), line, key: key.to_owned(), problem }
    }

    /// The table's entries in the file's order.
    fn entries<'a, 'i>(&self, path: &str, table: &'a DeTable<'i>) -> Vec<Entry<'a, 'i>> {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let entry = |(key, value): (&'a Spanned<_>, &'a Spanned<DeValue<'i>>)| {
            let name: &'a std::borrow::Cow<'_, str> = key.get_ref();
            Entry {
                name,
                path: if path.is_empty() { name.to_string() } else { format!("{path}.{name}") },
                line: self.lines.at(key.span().start),
                value: value.get_ref(),
            }
        };
        entries.into_iter().map(entry).collect()
    }

    fn table(&mut self, path: &str, table: &DeTable<'_>) -> Result<Value, ConfigError> {
        let mut nodes: Vec<(String, Node)> = Vec::new();
        for entry in self.entries(path, table) {
            let (si_name, factor) = units::to_si(entry.name);
            let value = self.value(&entry, &si_name, factor)?;
            let Entry { path: key, line, .. } = entry;
            if let Some((_, other)) = nodes.iter().find(|(name, _)| *name == si_name) {
                let problem = Problem::GivenTwice { other: other.key.clone(), line: other.line };
                return Err(self.error(&key, line, problem));
            }
            nodes.push((si_name, Node { key, line, value }));
        }
        Ok(Value::Table(nodes))
    }

    fn value(
        &mut self,
        entry: &Entry<'_, '_>,
        si_name: &str,
        factor: f64,
    ) -> Result<Value, ConfigError> {
        let sourced = self.numbers == Numbers::Sourced;
        match entry.value {
            DeValue::Table(table)
                if sourced && PARTS.iter().any(|part| table.get(*part).is_some()) =>
            {
                self.quantity(entry, table, si_name, factor)
            }
            DeValue::Table(table) => self.table(&entry.path, table),
            DeValue::Integer(_) | DeValue::Float(_) | DeValue::Array(_) if sourced => {
                let found = match entry.value {
                    DeValue::Integer(number) => number.to_string(),
                    DeValue::Float(number) => number.to_string(),
                    _ => "[...]".to_owned(),
                };
                Err(self.error(&entry.path, entry.line, Problem::Unsourced { found }))
            }
            value => Ok(self.plain(&entry.path, entry.line, value)?.scaled(factor)),
        }
    }

    /// A number, vector or table with its source.
    fn quantity(
        &mut self,
        entry: &Entry<'_, '_>,
        table: &DeTable<'_>,
        si_name: &str,
        factor: f64,
    ) -> Result<Value, ConfigError> {
        let (mut value, mut source, mut trust, mut note) = (None, None, None, None);
        let mut arguments: Vec<(String, Node)> = Vec::new();
        for part in self.entries(&entry.path, table) {
            match part.name {
                "value" => value = Some(self.plain(&part.path, part.line, part.value)?),
                "source" => source = Some(self.text(&part)?),
                "note" => note = Some(self.text(&part)?),
                "trust" => {
                    let label = self.text(&part)?;
                    trust = Some(Trust::from_label(&label).ok_or_else(|| {
                        let problem = Problem::UnknownTrust { found: label };
                        self.error(&entry.path, part.line, problem)
                    })?);
                }
                _ => {
                    let (name, factor) = units::to_si(part.name);
                    let value = self.plain(&part.path, part.line, part.value)?.scaled(factor);
                    arguments.push((name, Node { key: part.path, line: part.line, value }));
                }
            }
        }
        let incomplete = |what| self.error(&entry.path, entry.line, Problem::Incomplete(what));
        let value = value.ok_or_else(|| incomplete("value"))?.scaled(factor);
        let source =
            source.filter(|text| !text.trim().is_empty()).ok_or_else(|| incomplete("source"))?;
        let trust = trust.ok_or_else(|| incomplete("trust"))?;
        let value = self.with_arguments(entry, si_name, value, arguments)?;
        self.provenance.push(Provenance { key: entry.path.clone(), source, trust, note });
        Ok(value)
    }

    /// The value as the engine's table over its arguments, if it is one.
    fn with_arguments(
        &self,
        entry: &Entry<'_, '_>,
        si_name: &str,
        value: Value,
        arguments: Vec<(String, Node)>,
    ) -> Result<Value, ConfigError> {
        let within = entry.path.rsplit_once('.').map_or("", |(tables, _)| tables);
        let place = format!("{within}.{si_name}");
        let fits = |name: &str| {
            place
                .strip_suffix(name)
                .is_some_and(|before| before.is_empty() || before.ends_with('.'))
        };
        let rows = TABLES.iter().filter(|(name, _)| fits(name));
        let expected = rows.max_by_key(|(name, _)| name.len()).map(|(_, names)| *names);
        let given = |expected: &&[&str]| {
            arguments.iter().map(|(name, _)| name.as_str()).eq(expected.iter().copied())
        };
        let Some(expected) = expected else {
            return match arguments.into_iter().next() {
                None => Ok(value),
                // A table of a name that the engine does not have: who reads it knows which there are.
                Some((_, Node { value: Value::Array(_), .. })) => Ok(Value::Table(Vec::new())),
                Some((_, extra)) => {
                    let expected = PARTS.map(str::to_owned).to_vec();
                    Err(self.error(&extra.key, extra.line, Problem::UnknownKey { expected }))
                }
            };
        };
        if !given(&expected) {
            let problem = Problem::Arguments {
                expected: expected.iter().map(|&name| name.to_owned()).collect(),
                found: arguments.into_iter().map(|(name, _)| name).collect(),
            };
            return Err(self.error(&entry.path, entry.line, problem));
        }
        let node = Node { key: format!("{}.value", entry.path), line: entry.line, value };
        let nodes = arguments.into_iter().map(|(_, node)| node).chain([node]);
        let names = ["x", "y", "z", "w"].map(str::to_owned);
        Ok(Value::Table(names.into_iter().zip(nodes).collect()))
    }

    fn text(&mut self, entry: &Entry<'_, '_>) -> Result<String, ConfigError> {
        match self.plain(&entry.path, entry.line, entry.value)? {
            Value::Text(text) => Ok(text),
            other => Err(self.wrong_type(&entry.path, entry.line, "a string", other.describe())),
        }
    }

    fn wrong_type(&self, key: &str, line: usize, expected: &str, found: &str) -> ConfigError {
        let (expected, found) = (expected.to_owned(), found.to_owned());
        self.error(key, line, Problem::WrongType { expected, found })
    }

    /// A value that has no source of its own.
    fn plain(
        &mut self,
        path: &str,
        line: usize,
        value: &DeValue<'_>,
    ) -> Result<Value, ConfigError> {
        let not_finite = |found: String| self.error(path, line, Problem::NotFinite(found));
        match value {
            DeValue::String(text) => Ok(Value::Text(text.to_string())),
            DeValue::Boolean(set) => Ok(Value::Bool(*set)),
            DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix())
                .map(Value::Integer)
                .map_err(|_| not_finite(number.to_string())),
            DeValue::Float(number) => number
                .as_str()
                .parse()
                .ok()
                .filter(|number: &f64| number.is_finite())
                .map(Value::Float)
                .ok_or_else(|| not_finite(number.to_string())),
            DeValue::Array(array) => self.array(path, array),
            DeValue::Table(table) if self.numbers == Numbers::Bare => self.table(path, table),
            DeValue::Table(_) => Err(self.wrong_type(path, line, "a number", "a table")),
            DeValue::Datetime(_) => Err(self.wrong_type(path, line, "a number", "a date")),
        }
    }

    fn array(&mut self, path: &str, array: &DeArray<'_>) -> Result<Value, ConfigError> {
        let mut nodes = Vec::new();
        for (i, value) in array.iter().enumerate() {
            let key = format!("{path}[{i}]");
            let line = self.lines.at(value.span().start);
            let value = self.plain(&key, line, value.get_ref())?;
            nodes.push(Node { key, line, value });
        }
        Ok(Value::Array(nodes))
    }
}

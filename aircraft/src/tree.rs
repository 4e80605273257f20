//! TOML text to a plain tree in SI units, without provenance, that remembers lines.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use engine::table::VALUE;

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
    /// A number's values over arguments: these by SI key in the file's order, and the values behind them
    /// as [`VALUE`].
    Tabulated(Vec<(String, Node)>),
}

impl Value {
    /// What it is, for messages.
    pub fn describe(&self) -> String {
        let kind = match self {
            Self::Float(_) | Self::Integer(_) => "a number",
            Self::Bool(_) => "true or false",
            Self::Text(_) => "a string",
            Self::Array(_) => "an array",
            Self::Table(_) => "a table",
            Self::Tabulated(_) => {
                return format!("values over {}", self.arguments_as_written().join(", "));
            }
        };
        kind.to_owned()
    }

    /// The keys of its arguments as the file has them, if it has arguments.
    pub fn arguments_as_written(&self) -> Vec<String> {
        let Self::Tabulated(parts) = self else { return Vec::new() };
        let arguments = parts.iter().filter(|(name, _)| name != VALUE);
        let written = |node: &Node| node.key.rsplit('.').next().unwrap_or_default().to_owned();
        arguments.map(|(_, node)| written(node)).collect()
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

/// What accompanies a sourced number's value.
pub(crate) const PARTS: [&str; 4] = [VALUE, "source", "trust", "note"];

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
            let value = self.value(&entry, factor)?;
            let Entry { path: key, line, .. } = entry;
            if let Some((_, other)) = nodes.iter().find(|(name, _)| *name == si_name) {
                let problem = Problem::GivenTwice { other: other.key.clone(), line: other.line };
                return Err(self.error(&key, line, problem));
            }
            nodes.push((si_name, Node { key, line, value }));
        }
        Ok(Value::Table(nodes))
    }

    fn value(&mut self, entry: &Entry<'_, '_>, factor: f64) -> Result<Value, ConfigError> {
        let sourced = self.numbers == Numbers::Sourced;
        match entry.value {
            DeValue::Table(table)
                if sourced && PARTS.iter().any(|part| table.get(*part).is_some()) =>
            {
                self.quantity(entry, table, factor)
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
        factor: f64,
    ) -> Result<Value, ConfigError> {
        let (mut value, mut source, mut trust, mut note) = (None, None, None, None);
        let mut arguments: Vec<(String, Node)> = Vec::new();
        for part in self.entries(&entry.path, table) {
            match part.name {
                VALUE => value = Some(self.plain(&part.path, part.line, part.value)?),
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
        let value = value.ok_or_else(|| incomplete(VALUE))?.scaled(factor);
        let source =
            source.filter(|text| !text.trim().is_empty()).ok_or_else(|| incomplete("source"))?;
        let trust = trust.ok_or_else(|| incomplete("trust"))?;
        self.provenance.push(Provenance { key: entry.path.clone(), source, trust, note });
        if arguments.is_empty() {
            return Ok(value);
        }
        let key = format!("{}.{VALUE}", entry.path);
        arguments.push((VALUE.to_owned(), Node { key, line: entry.line, value }));
        Ok(Value::Tabulated(arguments))
    }

    fn text(&mut self, entry: &Entry<'_, '_>) -> Result<String, ConfigError> {
        match self.plain(&entry.path, entry.line, entry.value)? {
            Value::Text(text) => Ok(text),
            other => Err(self.wrong_type(&entry.path, entry.line, "a string", &other.describe())),
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

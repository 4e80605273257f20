//! The layout of a message, read off the schema that stands in the log itself.
//!
//! A log outlives the structs of the program that wrote it. What only reads (`log cat`, `log export`)
//! goes by the log's own layout; what flies goes through [`evolution`](crate::evolution).

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use crate::fields::{Field, Value, fields};
use crate::{LogError, cdr};

/// No recorded struct has more numbers; a schema that says so is damage, or meant ill.
const NUMBERS_MAX: usize = 1 << 16;
/// Nor are structs nested deeper.
const DEPTH_MAX: usize = 32;

/// What eight bytes mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `float64`.
    F64,
    /// `uint64`.
    U64,
    /// `int64`.
    I64,
}

impl Kind {
    fn of(ros_type: &str) -> Option<Self> {
        match ros_type {
            "float64" => Some(Self::F64),
            "uint64" => Some(Self::U64),
            "int64" => Some(Self::I64),
            _ => None,
        }
    }

    /// The number that the bytes are.
    pub fn value(self, bits: u64) -> Value {
        match self {
            Self::F64 => Value::F64(f64::from_bits(bits)),
            Self::U64 => Value::U64(bits),
            Self::I64 => Value::I64(bits.cast_signed()),
        }
    }
}

/// A number of a message: its name, and what its eight bytes mean.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Number {
    /// Names joined by dots, as in [`Field::path`].
    pub path: String,
    /// Its type.
    pub kind: Kind,
}

/// The numbers of a message, in the order of its bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout(Vec<Number>);

impl Layout {
    /// Of a `ros2msg` definition; `None` unless it is made of eight-byte numbers, as ours are.
    pub fn parse(definition: &str) -> Option<Self> {
        let mut types: BTreeMap<&str, Vec<(&str, &str)>> = BTreeMap::new();
        let mut current = "";
        for line in definition.lines().map(|line| line.split('#').next().unwrap_or("").trim()) {
            if let Some(name) = line.strip_prefix("MSG:") {
                current = name.trim();
                types.entry(current).or_default();
            } else if let Some((kind, name)) = line.split_once(char::is_whitespace) {
                types.entry(current).or_default().push((kind, name.trim()));
            } else if !line.is_empty() && !line.chars().all(|c| c == '=') {
                return None;
            }
        }
        let mut numbers = Vec::new();
        expand(&types, "", &mut String::new(), 0, &mut numbers)?;
        let names: BTreeSet<_> = numbers.iter().map(|number| &number.path).collect();
        (!numbers.is_empty() && names.len() == numbers.len()).then_some(Self(numbers))
    }

    /// Of one of today's structs.
    ///
    /// # Errors
    /// When it is not recordable.
    pub fn of<T: Serialize + Default>() -> Result<Self, LogError> {
        let number = |field: Field| {
            let kind = match field.value {
                Value::F64(_) => Kind::F64,
                Value::U64(_) => Kind::U64,
                Value::I64(_) => Kind::I64,
            };
            Number { path: field.path, kind }
        };
        Ok(Self(fields(&T::default())?.into_iter().map(number).collect()))
    }

    /// The numbers, in the order of the bytes.
    pub fn numbers(&self) -> &[Number] {
        &self.0
    }

    /// Whether it is one of a `/state` message: the digest, then the state.
    pub(crate) fn is_of_state(&self) -> bool {
        self.0.split_first().is_some_and(|(digest, state)| {
            let is_digest = digest.path == "digest" && digest.kind == Kind::U64;
            is_digest && state.iter().all(|number| number.path.starts_with("state."))
        })
    }

    /// The same numbers under other names.
    pub(crate) fn renamed(&self, mut name: impl FnMut(&str) -> String) -> Self {
        Self(self.0.iter().map(|number| Number { path: name(&number.path), ..*number }).collect())
    }

    /// The bits of every number of a message, in order.
    ///
    /// # Errors
    /// When the message is longer or shorter than its schema says, or not little-endian CDR.
    pub fn bits<'a>(
        &self,
        message: &'a [u8],
    ) -> Result<impl ExactSizeIterator<Item = u64> + use<'a>, LogError> {
        let (words, rest) = cdr::body_of(message)?.as_chunks::<8>();
        if words.len() != self.0.len() || !rest.is_empty() {
            return Err(LogError::Decode(format!(
                "expected {} bytes by its schema, got {}",
                8 * self.0.len() + cdr::HEADER.len(),
                message.len()
            )));
        }
        Ok(words.iter().map(|word| u64::from_le_bytes(*word)))
    }

    /// The numbers of a message with their names.
    ///
    /// # Errors
    /// As for [`Layout::bits`].
    pub fn fields(&self, message: &[u8]) -> Result<Vec<Field>, LogError> {
        let field = |(number, bits): (&Number, u64)| Field {
            path: number.path.clone(),
            value: number.kind.value(bits),
        };
        Ok(self.0.iter().zip(self.bits(message)?).map(field).collect())
    }
}

/// Puts the numbers of a type in place, its parts under `path`.
fn expand(
    types: &BTreeMap<&str, Vec<(&str, &str)>>,
    name: &str,
    path: &mut String,
    depth: usize,
    numbers: &mut Vec<Number>,
) -> Option<()> {
    for (kind, field) in types.get(name)? {
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if depth > DEPTH_MAX || field.is_empty() || !field.chars().all(plain) {
            return None;
        }
        let length = path.len();
        if !path.is_empty() {
            path.push('.');
        }
        path.push_str(field);
        let (kind, items) = match kind.strip_suffix(']').and_then(|array| array.split_once('[')) {
            Some((kind, items)) => (kind, Some(items.parse::<usize>().ok()?)),
            None => (*kind, None),
        };
        match (Kind::of(kind), items) {
            (Some(kind), None) => numbers.push(Number { path: path.clone(), kind }),
            (Some(kind), Some(items)) if items <= NUMBERS_MAX => {
                let item = |i| Number { path: format!("{path}[{i}]"), kind };
                numbers.extend((0..items).map(item));
            }
            // An empty type adds nothing, and would let a schema expand without end.
            (None, None) if types.get(kind).is_some_and(|fields| !fields.is_empty()) => {
                expand(types, kind, path, depth + 1, numbers)?;
            }
            _ => return None,
        }
        if numbers.len() > NUMBERS_MAX {
            return None;
        }
        path.truncate(length);
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::Types;
    use engine::State;

    #[test]
    fn the_layout_of_a_schema_is_that_of_the_struct_it_was_made_from() {
        let mut types = Types::default();
        for described in [types.describe::<State>(), types.describe::<engine::Outputs>()] {
            let described = described.unwrap();
            assert_eq!(Layout::parse(&described.text).as_ref(), described.layout.as_deref());
        }
    }

    #[test]
    fn what_is_not_made_of_eight_byte_numbers_has_no_layout() {
        for definition in [
            "",
            "string data\n",
            "float32 x\n",
            "float64[] x\n",
            "float64[<=3] x\n",
            "tiltrotor/Nowhere x\n",
            "float64 x\" y\n",
            "nonsense\n",
            "t/A a\n=\nMSG: t/A\nt/A a\n",
            "float64[99999999999] x\n",
            "float64 x\nfloat64 x\n",
        ] {
            assert_eq!(Layout::parse(definition), None, "{definition}");
        }
    }

    #[test]
    fn a_state_message_is_a_digest_and_then_a_state() {
        let is_of_state = |fields: &str| {
            let definition = format!("{fields}\n===\nMSG: t/S\nfloat64 x\nuint64 tick\n");
            Layout::parse(&definition).expect("a layout").is_of_state()
        };
        assert!(is_of_state("uint64 digest\nt/S state"));
        for other in [
            "t/S state\nuint64 digest",
            "int64 digest\nt/S state",
            "uint64 crc\nt/S state",
            "uint64 digest\nt/S plant",
            "uint64 digest\nt/S state\nfloat64 more",
        ] {
            assert!(!is_of_state(other), "{other}");
        }
    }

    #[test]
    fn a_schema_that_grows_without_end_is_refused_in_time() {
        let mut definition = String::from("t/T0 a\nt/T0 b\n");
        for i in 0..30 {
            let next = i + 1;
            definition += &format!("===\nMSG: t/T{i}\nt/T{next} a\nt/T{next} b\n");
        }
        assert_eq!(Layout::parse(&(definition.clone() + "===\nMSG: t/T30\nfloat64 x\n")), None);
        assert_eq!(Layout::parse(&(definition + "===\nMSG: t/T30\n")), None);
    }
}

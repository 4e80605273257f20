//! The fields of a recorded struct: their names, types and values, read off its serde form.
//!
//! One walk serves the schema, the comparison of states and every export: a field that is added to a
//! struct appears in all of them.

use std::fmt;

use serde::Serialize;
use serde::ser::{self, Impossible, SerializeStruct, SerializeTuple};

/// A number of eight bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// `float64`.
    F64(f64),
    /// `uint64`.
    U64(u64),
    /// `int64`.
    I64(i64),
}

impl Value {
    /// The type's name in a ROS 2 message definition.
    pub fn ros_type(self) -> &'static str {
        match self {
            Self::F64(_) => "float64",
            Self::U64(_) => "uint64",
            Self::I64(_) => "int64",
        }
    }

    /// The bytes, as a number.
    pub fn bits(self) -> u64 {
        match self {
            Self::F64(value) => value.to_bits(),
            Self::U64(value) => value,
            Self::I64(value) => value.cast_unsigned(),
        }
    }

    /// How many representable numbers lie between, if both are of the same type.
    pub fn ulps_to(self, other: Self) -> Option<u64> {
        // Order the bits as the numbers are ordered.
        let ordered = |value: f64| {
            let bits = value.to_bits().cast_signed();
            i128::from(if bits < 0 { i64::MIN - bits } else { bits })
        };
        let apart = match (self, other) {
            (Self::F64(a), Self::F64(b)) => ordered(a) - ordered(b),
            (Self::U64(a), Self::U64(b)) => i128::from(a) - i128::from(b),
            (Self::I64(a), Self::I64(b)) => i128::from(a) - i128::from(b),
            _ => return None,
        };
        u64::try_from(apart.unsigned_abs()).ok()
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // Enough digits to give the same bits back.
            Self::F64(value) => write!(f, "{value:?}"),
            Self::U64(value) => write!(f, "{value}"),
            Self::I64(value) => write!(f, "{value}"),
        }
    }
}

/// A struct's shape with its values.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A number.
    Leaf(Value),
    /// A struct: its name, and its fields in order.
    Struct(&'static str, Vec<(&'static str, Node)>),
    /// An array of fixed length.
    Array(Vec<Node>),
}

/// One number of a struct.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Where: names joined by dots, the unit last (`plant.position_m.x`).
    pub path: String,
    /// What.
    pub value: Value,
}

/// The shape of a recorded value.
///
/// # Errors
/// When it holds anything but numbers of eight bytes, structs and arrays: such a thing has no place
/// in a recorded struct.
pub fn tree<T: Serialize>(value: &T) -> Result<Node, NotRecordable> {
    value.serialize(Walker)
}

/// Every number of a recorded value, in the order of its bytes.
///
/// # Errors
/// As for [`tree`].
pub fn fields<T: Serialize>(value: &T) -> Result<Vec<Field>, NotRecordable> {
    let mut fields = Vec::new();
    flatten(&tree(value)?, &mut String::new(), &mut fields);
    Ok(fields)
}

fn flatten(node: &Node, path: &mut String, fields: &mut Vec<Field>) {
    let mut below = |name: &str, child: &Node| {
        let length = path.len();
        if !path.is_empty() && !name.starts_with('[') {
            path.push('.');
        }
        path.push_str(name);
        flatten(child, path, fields);
        path.truncate(length);
    };
    match node {
        Node::Leaf(value) => fields.push(Field { path: path.clone(), value: *value }),
        Node::Struct(_, children) => children.iter().for_each(|(name, child)| below(name, child)),
        Node::Array(children) => {
            children.iter().enumerate().for_each(|(i, child)| below(&format!("[{i}]"), child));
        }
    }
}

/// A type that cannot be part of a recorded struct.
#[derive(Debug, thiserror::Error)]
#[error("a recorded struct holds numbers of eight bytes, structs and arrays, not {0}")]
pub struct NotRecordable(String);

impl ser::Error for NotRecordable {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

struct Walker;

struct Children {
    name: &'static str,
    named: Vec<(&'static str, Node)>,
    listed: Vec<Node>,
}

impl Children {
    fn of(name: &'static str) -> Self {
        Self { name, named: Vec::new(), listed: Vec::new() }
    }
}

impl SerializeStruct for Children {
    type Ok = Node;
    type Error = NotRecordable;
    fn serialize_field<T: Serialize + ?Sized>(
        &mut self,
        key: &'static str,
        value: &T,
    ) -> Result<(), NotRecordable> {
        self.named.push((key, value.serialize(Walker)?));
        Ok(())
    }
    fn end(self) -> Result<Node, NotRecordable> {
        Ok(Node::Struct(self.name, self.named))
    }
}

impl SerializeTuple for Children {
    type Ok = Node;
    type Error = NotRecordable;
    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), NotRecordable> {
        self.listed.push(value.serialize(Walker)?);
        Ok(())
    }
    fn end(self) -> Result<Node, NotRecordable> {
        Ok(Node::Array(self.listed))
    }
}

macro_rules! refuse {
    ($($method:ident($($argument:ident: $kind:ty),*) $what:literal;)+) => {
        $(fn $method(self, $(_: $kind),*) -> Result<Node, NotRecordable> {
            Err(NotRecordable($what.into()))
        })+
    };
}

macro_rules! refuse_parts {
    ($($method:ident($($argument:ident: $kind:ty),*) -> $parts:ident $what:literal;)+) => {
        $(fn $method(self, $(_: $kind),*) -> Result<Self::$parts, NotRecordable> {
            Err(NotRecordable($what.into()))
        })+
    };
}

impl ser::Serializer for Walker {
    type Ok = Node;
    type Error = NotRecordable;
    type SerializeSeq = Impossible<Node, NotRecordable>;
    type SerializeTuple = Children;
    type SerializeTupleStruct = Impossible<Node, NotRecordable>;
    type SerializeTupleVariant = Impossible<Node, NotRecordable>;
    type SerializeMap = Impossible<Node, NotRecordable>;
    type SerializeStruct = Children;
    type SerializeStructVariant = Impossible<Node, NotRecordable>;

    fn serialize_f64(self, v: f64) -> Result<Node, NotRecordable> {
        Ok(Node::Leaf(Value::F64(v)))
    }
    fn serialize_u64(self, v: u64) -> Result<Node, NotRecordable> {
        Ok(Node::Leaf(Value::U64(v)))
    }
    fn serialize_i64(self, v: i64) -> Result<Node, NotRecordable> {
        Ok(Node::Leaf(Value::I64(v)))
    }
    fn serialize_struct(self, name: &'static str, _: usize) -> Result<Children, NotRecordable> {
        Ok(Children::of(name))
    }
    fn serialize_tuple(self, _: usize) -> Result<Children, NotRecordable> {
        Ok(Children::of(""))
    }

    refuse! {
        serialize_bool(v: bool) "a bool";
        serialize_i8(v: i8) "an i8";
        serialize_i16(v: i16) "an i16";
        serialize_i32(v: i32) "an i32";
        serialize_u8(v: u8) "a u8";
        serialize_u16(v: u16) "a u16";
        serialize_u32(v: u32) "a u32";
        serialize_f32(v: f32) "an f32";
        serialize_char(v: char) "a char";
        serialize_str(v: &str) "a string";
        serialize_bytes(v: &[u8]) "bytes";
        serialize_none() "an option";
        serialize_unit() "a unit";
        serialize_unit_struct(name: &'static str) "a unit";
        serialize_unit_variant(name: &'static str, index: u32, variant: &'static str) "an enum";
    }
    fn serialize_some<T: Serialize + ?Sized>(self, _: &T) -> Result<Node, NotRecordable> {
        Err(NotRecordable("an option".into()))
    }
    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<Node, NotRecordable> {
        value.serialize(Self)
    }
    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: &T,
    ) -> Result<Node, NotRecordable> {
        Err(NotRecordable("an enum".into()))
    }
    refuse_parts! {
        serialize_seq(size: Option<usize>) -> SerializeSeq "a list of any length";
        serialize_tuple_struct(name: &'static str, size: usize) -> SerializeTupleStruct "a tuple struct";
        serialize_tuple_variant(name: &'static str, index: u32, variant: &'static str, size: usize)
            -> SerializeTupleVariant "an enum";
        serialize_map(size: Option<usize>) -> SerializeMap "a map";
        serialize_struct_variant(name: &'static str, index: u32, variant: &'static str, size: usize)
            -> SerializeStructVariant "an enum";
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_is_nothing_but_eight_byte_numbers() {
        let state = engine::State::default();
        let fields = fields(&state).unwrap();
        let bytes = crate::cdr::encode(&state).unwrap();
        assert_eq!(fields.len() * 8 + crate::cdr::HEADER.len(), bytes.len());
        assert!(fields.iter().any(|field| field.path == "plant.velocity_mps.x"));
    }

    #[test]
    fn ulps_count_across_zero() {
        let apart = |a: f64, b: f64| Value::F64(a).ulps_to(Value::F64(b)).unwrap();
        assert_eq!(apart(1.0, 1.0), 0);
        assert_eq!(apart(1.0, 1.0 + f64::EPSILON), 1);
        assert_eq!(apart(-0.0, 0.0), 0);
        assert_eq!(apart(f64::from_bits(1), -f64::from_bits(1)), 2);
    }

    #[test]
    fn a_short_number_is_refused() {
        assert!(fields(&3_u32).is_err());
    }

    #[test]
    fn whole_numbers_lie_as_many_apart_as_they_differ_and_kinds_are_not_compared() {
        use Value::{F64, I64, U64};
        assert_eq!(U64(3).ulps_to(U64(10)), Some(7));
        assert_eq!(U64(0).ulps_to(U64(u64::MAX)), Some(u64::MAX));
        assert_eq!(I64(-3).ulps_to(I64(4)), Some(7));
        assert_eq!(I64(4).ulps_to(I64(-3)), Some(7));
        assert_eq!(I64(i64::MIN).ulps_to(I64(i64::MAX)), Some(u64::MAX));
        // Each of them is 1 to the bit of its own kind.
        for (a, b) in [(U64(1), I64(1)), (F64(1.0), U64(1)), (I64(1), F64(1.0))] {
            assert_eq!((a.ulps_to(b), b.ulps_to(a)), (None, None), "{a:?}, {b:?}");
        }
    }
}

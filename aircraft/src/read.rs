//! The tree to the engine's structs.

use std::fmt::Display;

use serde::de::{
    self, DeserializeOwned, DeserializeSeed, Deserializer, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, Visitor,
};

use engine::table::{self, VALUE};

use crate::error::{ConfigError, Problem};
use crate::tree::{Node, PARTS, Value};

/// The engine's struct that the tree describes.
pub(crate) fn read<T: DeserializeOwned>(file: &str, tree: &Node) -> Result<T, ConfigError> {
    T::deserialize(tree).map_err(|fault| {
        let (key, line) = fault.place.unwrap_or_default();
        ConfigError { file: file.to_owned(), line, key, problem: fault.problem }
    })
}

/// A problem on its way up to where its place is known.
#[derive(Debug)]
pub(crate) struct Fault {
    place: Option<(String, usize)>,
    problem: Problem,
}

impl Fault {
    fn new(problem: Problem) -> Self {
        Self { place: None, problem }
    }

    /// With the innermost place that knows of it.
    fn at(mut self, node: &Node) -> Self {
        self.place.get_or_insert_with(|| (node.key.clone(), node.line));
        self
    }
}

impl Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.problem.fmt(f)
    }
}

impl std::error::Error for Fault {}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

impl de::Error for Fault {
    fn custom<T: Display>(message: T) -> Self {
        Self::new(Problem::Other(message.to_string()))
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let (expected, found) = (expected.to_string(), found.to_string());
        Self::new(Problem::WrongType { expected, found })
    }

    fn unknown_variant(found: &str, expected: &'static [&'static str]) -> Self {
        Self::new(Problem::UnknownName { found: found.to_owned(), expected: owned(expected) })
    }

    fn unknown_field(_: &str, expected: &'static [&'static str]) -> Self {
        Self::new(Problem::UnknownKey { expected: owned(expected) })
    }

    fn missing_field(name: &'static str) -> Self {
        Self::new(Problem::MissingKey { name: name.to_owned() })
    }
}

impl Node {
    fn wrong_type(&self, expected: impl Into<String>) -> Fault {
        // What is no array can be no argument: then the key is what is wrong.
        if let Value::Tabulated(parts) = &self.value
            && let Some((_, stray)) = parts
                .iter()
                .find(|(name, node)| name != VALUE && !matches!(node.value, Value::Array(_)))
        {
            return Fault::new(Problem::UnknownKey { expected: owned(&PARTS) }).at(stray);
        }
        let found = self.value.describe();
        Fault::new(Problem::WrongType { expected: expected.into(), found }).at(self)
    }

    /// Values over the arguments whose keys the engine's table has, in its order.
    fn tabulated<'de, V: Visitor<'de>>(
        &'de self,
        keys: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match &self.value {
            Value::Tabulated(parts) if parts.iter().map(|(name, _)| name).eq(keys) => {
                let members = Members { rest: parts.iter(), value: None };
                visitor.visit_map(members).map_err(|fault| fault.at(self))
            }
            value => {
                let axes = keys.iter().filter(|key| **key != VALUE).copied();
                let expected = axes.map(str::to_owned).collect();
                let found = value.arguments_as_written();
                Err(Fault::new(Problem::Arguments { expected, found }).at(self))
            }
        }
    }

    fn sequence<'de, V: Visitor<'de>>(
        &'de self,
        visitor: V,
        length: Option<usize>,
    ) -> Result<V::Value, Fault> {
        let expected = match length {
            Some(length) => format!("an array of {length}"),
            None => "an array".to_owned(),
        };
        let Value::Array(nodes) = &self.value else { return Err(self.wrong_type(expected)) };
        if length.is_some_and(|length| length != nodes.len()) {
            let found = format!("one of {}", nodes.len());
            return Err(Fault::new(Problem::WrongType { expected, found }).at(self));
        }
        visitor.visit_seq(Elements(nodes.iter())).map_err(|fault| fault.at(self))
    }
}

/// Refuses everything but what the struct asks for.
macro_rules! numbers {
    ($($method:ident $visit:ident $type:ty, $expected:literal;)+) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
            match self.value {
                Value::Integer(number) => {
                    let number = <$type>::try_from(number).map_err(|_| self.wrong_type($expected))?;
                    visitor.$visit(number).map_err(|fault: Fault| fault.at(self))
                }
                _ => Err(self.wrong_type($expected)),
            }
        }
    )+};
}

impl<'de> Deserializer<'de> for &'de Node {
    type Error = Fault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match &self.value {
            Value::Float(_) => self.deserialize_f64(visitor),
            Value::Integer(_) => self.deserialize_i64(visitor),
            Value::Bool(_) => self.deserialize_bool(visitor),
            Value::Text(_) => self.deserialize_str(visitor),
            Value::Array(_) => self.deserialize_seq(visitor),
            Value::Table(_) | Value::Tabulated(_) => self.deserialize_map(visitor),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match self.value.number() {
            Some(number) => visitor.visit_f64(number).map_err(|fault: Fault| fault.at(self)),
            None => Err(self.wrong_type("a number")),
        }
    }

    numbers! {
        deserialize_i64 visit_i64 i64, "a whole number";
        deserialize_u64 visit_u64 u64, "a whole number from 0";
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match self.value {
            Value::Bool(set) => visitor.visit_bool(set),
            _ => Err(self.wrong_type("true or false")),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match &self.value {
            Value::Text(text) => visitor.visit_borrowed_str(text),
            _ => Err(self.wrong_type("a string")),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        visitor.visit_some(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.sequence(visitor, None)
    }

    fn deserialize_tuple<V: Visitor<'de>>(
        self,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, Fault> {
        self.sequence(visitor, Some(length))
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match &self.value {
            Value::Table(nodes) => {
                let members = Members { rest: nodes.iter(), value: None };
                visitor.visit_map(members).map_err(|fault| fault.at(self))
            }
            _ => Err(self.wrong_type("a table")),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match name {
            // A vector is written as an array of its components.
            "Vec3" => self.sequence(visitor, Some(fields.len())),
            table::NAME => self.tabulated(fields, visitor),
            _ => self.deserialize_map(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match &self.value {
            Value::Text(text) => visitor
                .visit_enum(text.as_str().into_deserializer())
                .map_err(|fault: Fault| fault.at(self)),
            _ => Err(self.wrong_type("a name")),
        }
    }

    serde::forward_to_deserialize_any! {
        i8 i16 i32 i128 u8 u16 u32 u128 f32 char bytes byte_buf unit unit_struct newtype_struct
        tuple_struct identifier ignored_any
    }
}

/// The elements of an array, one after the other.
struct Elements<'de>(std::slice::Iter<'de, Node>);

impl<'de> SeqAccess<'de> for Elements<'de> {
    type Error = Fault;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Fault> {
        self.0.next().map(|node| seed.deserialize(node)).transpose()
    }
}

/// The members of a table, one after the other.
struct Members<'de> {
    rest: std::slice::Iter<'de, (String, Node)>,
    value: Option<&'de Node>,
}

impl<'de> MapAccess<'de> for Members<'de> {
    type Error = Fault;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Fault> {
        let Some((name, node)) = self.rest.next() else { return Ok(None) };
        self.value = Some(node);
        seed.deserialize(name.as_str().into_deserializer())
            .map(Some)
            .map_err(|fault: Fault| fault.at(node))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Fault> {
        match self.value.take() {
            Some(node) => seed.deserialize(node),
            None => Err(de::Error::custom("a value before its key")),
        }
    }
}

//! What a table is made of, whatever it is written as.

use std::borrow::Cow;

use crate::LogError;
use crate::fields::Value;
use crate::layout::Kind;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    Number(Kind),
    Text,
}

/// A column of a table; a unit ends its name if it has one, or stands before the axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    pub name: String,
    pub kind: ColumnKind,
}

impl Column {
    pub fn number(name: impl Into<String>, kind: Kind) -> Self {
        Self { name: name.into(), kind: ColumnKind::Number(kind) }
    }

    pub fn text(name: impl Into<String>) -> Self {
        Self { name: name.into(), kind: ColumnKind::Text }
    }
}

/// A value of a row.
#[derive(Clone, Debug)]
pub enum Cell<'a> {
    Number(Value),
    Text(Cow<'a, str>),
}

/// A file of rows being written.
pub trait Table {
    /// Adds a row: a cell a column, of the column's kind.
    fn push(&mut self, row: &[Cell]) -> Result<(), LogError>;

    /// Ends the file and brings it to disk.
    fn finish(self: Box<Self>) -> Result<(), LogError>;
}

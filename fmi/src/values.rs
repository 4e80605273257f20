//! What parameters and inputs are set to.

use crate::variables::{Target, Value, place, table};

/// The values of parameters and inputs, by their places in the table.
#[derive(Clone, Debug)]
pub struct Values(pub(crate) Vec<Value>);

impl Default for Values {
    fn default() -> Self {
        Self(table().iter().map(|variable| variable.start.clone()).collect())
    }
}

impl Values {
    fn named(&self, name: &str) -> Option<&Value> {
        place(name).and_then(|place| self.0.get(place))
    }

    /// A number, by its name in the table.
    pub fn real(&self, name: &str) -> f64 {
        match self.named(name) {
            Some(Value::Real(value)) => *value,
            _ => 0.0,
        }
    }

    /// A switch, by its name in the table.
    pub fn flag(&self, name: &str) -> bool {
        place(name).is_some_and(|place| self.flag_at(place))
    }

    /// A switch, by its place in the table.
    pub fn flag_at(&self, place: usize) -> bool {
        matches!(self.0.get(place), Some(Value::Boolean(true)))
    }

    /// A text, by its name in the table.
    pub fn text(&self, name: &str) -> &str {
        match self.named(name) {
            Some(Value::Text(value)) => value,
            _ => "",
        }
    }

    /// A command to the actuators, by its place among them.
    pub fn command(&self, command: usize) -> f64 {
        let place = table().iter().position(|v| v.target == Target::Command(command));
        match place.and_then(|place| self.0.get(place)) {
            Some(Value::Real(value)) => *value,
            _ => 0.0,
        }
    }
}

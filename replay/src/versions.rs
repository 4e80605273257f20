//! What stands between the version that wrote a log and this one.

use logs::evolution::Difference;
use logs::records::STATE;
use logs::{FlightReader, Identity};

/// The log's version and this one.
#[derive(Clone, Debug)]
pub struct Versions {
    /// Version of the flight model that flew the log.
    pub recorded_model: String,
    /// Version of this one.
    pub model: &'static str,
    /// Channels whose fields are not today's.
    pub differences: Vec<(&'static str, Difference)>,
    /// What else is not as the log says.
    pub notes: Vec<String>,
}

impl Versions {
    /// `None` when nothing differs.
    pub(crate) fn of(reader: &FlightReader, notes: &[String]) -> Option<Self> {
        let differences = reader.differences();
        if reader.same_model && differences.is_empty() && notes.is_empty() {
            return None;
        }
        Some(Self {
            recorded_model: reader.identity.get(Identity::MODEL).into(),
            model: engine::MODEL_VERSION,
            differences,
            notes: notes.to_vec(),
        })
    }

    /// Whether nothing that comes out of it is exact: another flight model, another aircraft, or
    /// recorded numbers of the state that this program cannot give.
    pub fn comparison(&self) -> bool {
        let unknown = |(topic, difference): &(&str, Difference)| {
            *topic == STATE && !difference.ignored.is_empty()
        };
        self.recorded_model != self.model
            || !self.notes.is_empty()
            || self.differences.iter().any(unknown)
    }
}

//! What stands between the version that wrote a log and this one.

use std::fmt;

use logs::Identity;
use logs::evolution::Difference;
use logs::records::STATE;

use crate::refly::Reflight;

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
    pub(crate) fn of(flight: &Reflight) -> Option<Self> {
        let reader = &flight.reader;
        let differences = reader.differences();
        let notes = flight.notes.clone();
        if reader.same_model && differences.is_empty() && notes.is_empty() {
            return None;
        }
        Some(Self {
            recorded_model: reader.identity.get(Identity::MODEL).into(),
            model: engine::MODEL_VERSION,
            differences,
            notes,
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

impl fmt::Display for Versions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { recorded_model, model, differences, notes } = self;
        if recorded_model == model {
            write!(f, "read by the names of its fields: flight model {model}, in another layout")?;
        } else {
            write!(
                f,
                "a comparison, and never exact: recorded by flight model {recorded_model}, flown by {model}"
            )?;
        }
        for (topic, Difference { missing, ignored }) in differences {
            if !missing.is_empty() {
                write!(f, "\n  {topic} of the log lacks {}", listed(missing))?;
            }
            if !ignored.is_empty() {
                write!(
                    f,
                    "\n  {topic} of the log has, and nobody knows today, {}",
                    listed(ignored)
                )?;
            }
        }
        notes.iter().try_for_each(|note| write!(f, "\n  {note}"))
    }
}

/// So many names are told; the rest are counted.
const NAMES_TOLD: usize = 8;

fn listed(names: &[String]) -> String {
    let told = names.iter().take(NAMES_TOLD).map(String::as_str).collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(NAMES_TOLD) {
        0 => told,
        more => format!("{told} and {more} more"),
    }
}

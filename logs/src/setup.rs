//! What a flight was flown with: files, and who made the program.

use std::collections::BTreeMap;

/// Name of the metadata record that makes an MCAP file a flight of ours.
pub const METADATA: &str = "tiltrotor";

/// Name of the metadata record with which the writer closes a log.
pub(crate) const CLOSING: &str = "tiltrotor_closing";
/// Its key for the last tick.
pub(crate) const CLOSING_TICK: &str = "tick";
/// Its key for the last digest.
pub(crate) const CLOSING_DIGEST: &str = "digest";
/// Its key for the roll call of all messages.
pub(crate) const CLOSING_MESSAGES: &str = "messages";

/// Ticks a second.
pub(crate) const RATE_HZ: &str = "250";
const _: () = assert!(250 * engine::STEP_NS == 1_000_000_000);

/// The texts a flight is reflown from; each is an attachment of the log.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Setup {
    /// The aircraft.
    pub aircraft_toml: String,
    /// Devices and what they move, as flown.
    pub cockpit_toml: String,
    /// Where and how the flight began.
    pub scenario_toml: String,
}

impl Setup {
    /// The names of the attachments.
    pub const NAMES: [&'static str; 3] = ["aircraft.toml", "cockpit.toml", "scenario.toml"];

    /// Name and text of each attachment.
    pub fn files(&self) -> [(&'static str, &str); 3] {
        let [aircraft, cockpit, scenario] = Self::NAMES;
        [
            (aircraft, &self.aircraft_toml),
            (cockpit, &self.cockpit_toml),
            (scenario, &self.scenario_toml),
        ]
    }

    /// The text under the name of an attachment, to be filled in.
    pub(crate) fn file_mut(&mut self, name: &str) -> Option<&mut String> {
        let [aircraft, cockpit, scenario] = Self::NAMES;
        match name {
            _ if name == aircraft => Some(&mut self.aircraft_toml),
            _ if name == cockpit => Some(&mut self.cockpit_toml),
            _ if name == scenario => Some(&mut self.scenario_toml),
            _ => None,
        }
    }
}

/// Who made the program that flew, and when it flew: key and value, for people and for `log info`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity(pub BTreeMap<String, String>);

impl Identity {
    /// Key of the model version.
    pub const MODEL: &'static str = "model_version";
    /// Key of the format version.
    pub const FORMAT: &'static str = "format_version";
    /// Key of the number of ticks a second.
    pub const RATE: &'static str = "rate_hz";
    /// Key of the wall clock at the start, ns since the Unix epoch.
    pub const STARTED: &'static str = "started_unix_ns";

    /// With what the engine and this crate know of themselves; the caller adds its build.
    pub fn new() -> Self {
        let facts = [
            (Self::MODEL, engine::MODEL_VERSION.to_string()),
            (Self::FORMAT, crate::records::FORMAT_VERSION.to_string()),
            (Self::RATE, RATE_HZ.to_string()),
        ];
        Self(facts.into_iter().map(|(key, value)| (key.to_string(), value)).collect())
    }

    /// A value, or "unknown".
    pub fn get(&self, key: &str) -> &str {
        self.0.get(key).map_or("unknown", String::as_str)
    }

    /// Adds a fact.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Into<String>) -> Self {
        self.0.insert(key.to_string(), value.into());
        self
    }
}

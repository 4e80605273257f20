//! What a flight was flown with: files, and who made the program.

use std::collections::BTreeMap;

use crate::LogError;
use crate::devices::DeviceIdentity;
use crate::records::FORMATS_READ;

/// Name of the metadata record that makes an MCAP file a flight of ours.
pub const METADATA: &str = "tiltrotor";

/// Name of the metadata record that makes a file a compacted log.
pub(crate) const COMPACT_HEAD: &str = "tiltrotor_compact";

/// Whether a flight is opened with the metadata or the attachment of this name.
pub(crate) fn opens_a_flight(name: &str) -> bool {
    name == METADATA || name == COMPACT_HEAD || Setup::NAMES.contains(&name)
}

/// Name of the metadata record with which the writer closes a log.
pub(crate) const CLOSING: &str = "tiltrotor_closing";
/// Its key for the last tick.
pub(crate) const CLOSING_TICK: &str = "tick";
/// Its key for the last digest.
pub(crate) const CLOSING_DIGEST: &str = "digest";
/// Its key for the message digest of all messages.
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

    /// Takes the text of an attachment.
    pub(crate) fn put(&mut self, name: &str, data: Vec<u8>) -> Result<(), LogError> {
        let [aircraft, cockpit, scenario] = Self::NAMES;
        let text = String::from_utf8(data)
            .map_err(|_| LogError::NotAFlight(format!("{name} is not text")))?;
        match name {
            _ if name == aircraft => self.aircraft_toml = text,
            _ if name == cockpit => self.cockpit_toml = text,
            _ if name == scenario => self.scenario_toml = text,
            _ => {}
        }
        Ok(())
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
    /// Key of who or what moved the controls, in words: a pilot model, a script, the keyboard, devices by name.
    pub const FLOWN_BY: &'static str = "flown_by";

    /// Key of the name of the file that a log was recovered from.
    pub(crate) const RECOVERED_FROM: &'static str = "recovered_from";

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

    /// Adds one more that moved the controls.
    #[must_use]
    pub fn flown_by(self, who: &str) -> Self {
        let all = self.0.get(Self::FLOWN_BY).map(|others| format!("{others}, {who}"));
        self.with(Self::FLOWN_BY, all.unwrap_or_else(|| who.into()))
    }

    /// Who or what moved the controls; of a log that does not say, what can be told from its input devices.
    pub fn who(&self, devices: &[DeviceIdentity]) -> String {
        if let Some(who) = self.0.get(Self::FLOWN_BY) {
            return who.clone();
        }
        let mapped = devices.iter().filter(|device| device.mapped != 0);
        let mapped: Vec<&str> = mapped.map(|device| device.name.as_str()).collect();
        if mapped.is_empty() {
            "a pilot model, script or keyboard".into()
        } else {
            mapped.join(", ")
        }
    }

    pub(crate) fn refuse_other_versions(&self) -> Result<(), LogError> {
        self.refuse_other_formats()?;
        self.refuse_others(Self::MODEL, "flight model", &[engine::MODEL_VERSION])
    }

    pub(crate) fn refuse_other_formats(&self) -> Result<(), LogError> {
        self.refuse_others(Self::FORMAT, "log format", &FORMATS_READ)?;
        self.refuse_others(Self::RATE, "number of ticks a second", &[RATE_HZ])
    }

    /// The last of those that are read is the one that is written.
    fn refuse_others(
        &self,
        key: &str,
        what: &'static str,
        read: &[&'static str],
    ) -> Result<(), LogError> {
        let theirs = self.get(key);
        match read.last() {
            Some(ours) if !read.contains(&theirs) => {
                Err(LogError::Version { what, theirs: theirs.into(), ours })
            }
            _ => Ok(()),
        }
    }
}

/// The identity of the program that calls it: a name, and what its build script was told by `provenance`.
#[macro_export]
macro_rules! identity {
    ($program:literal) => {
        $crate::Identity::new()
            .with("program", concat!($program, " ", env!("CARGO_PKG_VERSION")))
            .with("commit", env!("TILTROTOR_COMMIT"))
            .with("dirty", env!("TILTROTOR_DIRTY"))
            .with("compiler", env!("TILTROTOR_RUSTC"))
            .with("target", env!("TILTROTOR_TARGET"))
            .with("target_features", env!("TILTROTOR_TARGET_FEATURES"))
            .with("profile", env!("TILTROTOR_PROFILE"))
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_flew_is_what_the_log_says_or_what_its_devices_were() {
        let device = |mapped, name: &str| DeviceIdentity {
            mapped,
            name: name.into(),
            ..DeviceIdentity::default()
        };
        let devices = [device(0, "mouse"), device(1, "X52"), device(1, "pedals")];
        assert_eq!(Identity::new().who(&devices), "X52, pedals");
        assert_eq!(Identity::new().who(&devices[..1]), "a pilot model, script or keyboard");
        let said = Identity::new().flown_by("pilot model demo").flown_by("script kick.toml");
        assert_eq!(said.who(&devices), "pilot model demo, script kick.toml");
    }
}

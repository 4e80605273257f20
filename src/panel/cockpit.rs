//! What the panel knows before the flight.

use engine::envelope::Params as Envelope;

/// What the panel is told before the flight and does not change.
pub struct Cockpit {
    /// The log's name.
    pub log: String,
    /// The aircraft's name.
    pub aircraft: String,
    /// Its limits.
    pub envelope: Envelope,
    /// Names of the pilot model's phases.
    pub phases: Vec<&'static str>,
    /// Whether this machine will hold real time, in a line.
    pub verdict: String,
    /// What the active controls are, line by line.
    pub controls: Vec<String>,
    /// Whether keys fly.
    pub keys_fly: bool,
}

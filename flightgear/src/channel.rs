//! The second channel: what FlightGear's own packet cannot carry, by its generic protocol.
//!
//! One table, [`ROWS`], says what is sent, in which order, as what type, and where it goes in
//! FlightGear's tree. The packet, its reader and `data/Protocol/tiltrotor.xml`, which FlightGear
//! reads, all follow from it.
//!
//! # Signs
//! Big-endian, tightly packed. The first number is [`SCHEMA`], the second the tick: FlightGear itself
//! checks nothing but the length. Of pairs the left part is 0 and the right one 1.
//!
//! # Source
//! The form of the protocol file and the types were tried with FlightGear 2020.3.16.

mod kind;
mod table;
mod xml;

pub use kind::Kind;
pub use table::{ROWS, Row, SCHEMA};
pub use xml::protocol;

use crate::scene::Scene;

/// Name of the protocol: FlightGear looks for `Protocol/tiltrotor.xml`.
pub const PROTOCOL: &str = "tiltrotor";
/// The same table for a second aircraft beside the first.
pub const GHOST_PROTOCOL: &str = "tiltrotor-ghost";
/// Where the second aircraft's properties are in FlightGear's tree.
pub const GHOST: &str = "/ghost";
/// Numbers in a packet.
pub const COUNT: usize = count();
/// Bytes of a packet.
pub const LENGTH: usize = length();

/// Why bytes are not a packet of the channel.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChannelError {
    /// Too short or too long.
    #[error("packet of {got} bytes, expected {LENGTH}")]
    Length {
        /// Bytes received.
        got: usize,
    },
    /// Another version of the table, or another byte order.
    #[error("schema {got}, expected {SCHEMA}")]
    Schema {
        /// Version received.
        got: i64,
    },
    /// A NaN or an infinity.
    #[error("{node} is not a finite number")]
    NotFinite {
        /// Which.
        node: String,
    },
}

/// One packet, as it is on the wire.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Channel {
    bytes: [u8; LENGTH],
}

impl Channel {
    /// What the channel says of a moment. Asks for no memory.
    pub fn of(scene: &Scene<'_>) -> Self {
        let mut bytes = [0; LENGTH];
        let mut at = 0;
        for row in ROWS {
            for index in 0..row.count {
                let end = at + row.kind.size();
                row.kind.write((row.value)(scene, index), &mut bytes[at..end]);
                at = end;
            }
        }
        Self { bytes }
    }

    /// Reads a packet.
    ///
    /// # Errors
    /// When it is of another length or schema, or not all numbers are finite.
    pub fn parse(bytes: &[u8]) -> Result<Self, ChannelError> {
        let bytes = bytes.try_into().map_err(|_| ChannelError::Length { got: bytes.len() })?;
        let channel = Self { bytes };
        let schema = ROWS[0].kind.read(&channel.bytes[..ROWS[0].kind.size()]);
        if schema as i64 != i64::from(SCHEMA) {
            return Err(ChannelError::Schema { got: schema as i64 });
        }
        match channel.values().find(|(_, _, value)| !value.is_finite()) {
            Some((row, index, _)) => Err(ChannelError::NotFinite { node: row.node_of(index) }),
            None => Ok(channel),
        }
    }

    /// The packet as it is sent.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Every number with its row and part, in order.
    pub fn values(&self) -> impl Iterator<Item = (&'static Row, usize, f64)> + '_ {
        let mut at = 0;
        ROWS.iter().flat_map(|row| (0..row.count).map(move |index| (row, index))).map(
            move |(row, index)| {
                let end = at + row.kind.size();
                let value = row.kind.read(&self.bytes[at..end]);
                at = end;
                (row, index, value)
            },
        )
    }

    /// A number by its place in FlightGear's tree.
    pub fn get(&self, node: &str) -> Option<f64> {
        self.values().find(|(row, index, _)| row.node_of(*index) == node).map(|(_, _, value)| value)
    }

    /// Between two packets, `part` of the way from one to the other, for display only: numbers that
    /// are counted are those of the nearer one.
    #[must_use]
    pub fn between(from: &Self, to: &Self, part: f64) -> Self {
        let mut bytes = [0; LENGTH];
        let mut at = 0;
        for ((row, _, a), (_, _, b)) in from.values().zip(to.values()) {
            let end = at + row.kind.size();
            let value = match row.kind {
                Kind::Int => {
                    if part < 0.5 {
                        a
                    } else {
                        b
                    }
                }
                Kind::Float | Kind::Double => between(a, b, part, row.wrap),
            };
            row.kind.write(value, &mut bytes[at..end]);
            at = end;
        }
        Self { bytes }
    }
}

impl std::fmt::Debug for Channel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let values = self.values().map(|(row, index, value)| (row.node_of(index), value));
        f.debug_map().entries(values).finish()
    }
}

impl Row {
    /// The place of a part in FlightGear's tree.
    pub fn node_of(&self, index: usize) -> String {
        self.node.replace('#', &index.to_string())
    }
}

/// Part of the way from one number to another, the shorter way round where it starts again at `wrap`.
pub(crate) fn between(from: f64, to: f64, part: f64, wrap: f64) -> f64 {
    if wrap <= 0.0 {
        return from + (to - from) * part;
    }
    let turns = ((to - from) / wrap).round();
    let value = from + (to - from - turns * wrap) * part;
    // Back to where both are: 0 up to wrap for those, either side of 0 for these.
    if from < 0.0 || to < 0.0 {
        value - (value / wrap).round() * wrap
    } else {
        value.rem_euclid(wrap)
    }
}

const fn count() -> usize {
    let (mut row, mut sum) = (0, 0);
    while row < ROWS.len() {
        sum += ROWS[row].count;
        row += 1;
    }
    sum
}

const fn length() -> usize {
    let (mut row, mut sum) = (0, 0);
    while row < ROWS.len() {
        sum += ROWS[row].count * ROWS[row].kind.size();
        row += 1;
    }
    sum
}

#[cfg(test)]
mod tests;

//! The protocol file that FlightGear reads, from the table.

use std::fmt::Write as _;

use super::{COUNT, LENGTH, ROWS, SCHEMA};

/// A protocol file whose properties are below a node: the root (empty) in `Protocol/tiltrotor.xml`,
/// [`GHOST`](super::GHOST) in `Protocol/tiltrotor-ghost.xml`.
pub fn protocol(below: &str) -> String {
    let mut xml = format!(
        "<?xml version=\"1.0\"?>\n\
         <!-- Generated from flightgear/src/channel/table.rs: change it there, then run\n     \
         BLESS=1 cargo test -p flightgear protocol.\n     \
         Schema {SCHEMA}: {COUNT} numbers in {LENGTH} bytes. -->\n\
         <PropertyList>\n <generic>\n  <input>\n   <binary_mode>true</binary_mode>\n   \
         <byte_order>network</byte_order>\n   <binary_footer>none</binary_footer>\n"
    );
    for row in ROWS {
        for index in 0..row.count {
            let _ = writeln!(
                xml,
                "   <chunk>\n    <!-- {}: {} -->\n    <node>{below}/{}</node>\n    <type>{}</type>\n   </chunk>",
                row.unit,
                row.meaning.replace("--", "- -"),
                row.node_of(index),
                row.kind.name()
            );
        }
    }
    xml.push_str("  </input>\n </generic>\n</PropertyList>\n");
    xml
}

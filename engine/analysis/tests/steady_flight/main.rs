//! Steady flight: trimmed and linearised, and what the SCAS makes of it with the stick let go.

mod scas;
mod trim;

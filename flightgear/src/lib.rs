//! FlightGear's wire formats and link.

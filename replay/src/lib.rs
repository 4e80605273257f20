//! Rerunning a flight log.

//! Messages as bytes and numbers: encoding, names, definitions, older layouts.

pub mod cdr;
pub mod evolution;
pub mod fields;
pub mod layout;
pub mod schema;
pub mod units;

//! The aircraft's data, and its reader.

//! The flight log: format, writer, reader.

//! The piloted flight in real time.

//! What goes wrong, as exceptions.

use std::error::Error;
use std::fmt::Display;

use logs::text::with_causes;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

create_exception!(
    tiltrotor,
    TiltrotorError,
    PyException,
    "What the simulator cannot do, in words."
);
create_exception!(
    tiltrotor,
    NoSteadyFlight,
    TiltrotorError,
    "There is no such steady flight, or the aircraft cannot fly it."
);

/// Words of ours.
pub fn refused(words: impl Into<String>) -> PyErr {
    TiltrotorError::new_err(words.into())
}

/// An error of ours, with all that led to it.
pub fn told(error: impl Error) -> PyErr {
    refused(with_causes(&error))
}

/// The same behind the name of what it is about.
pub fn told_of(what: &str, error: impl Error) -> PyErr {
    refused(format!("{what}: {}", with_causes(&error)))
}

/// There is no such steady flight.
pub fn unsteady(error: &impl Display) -> PyErr {
    NoSteadyFlight::new_err(error.to_string())
}

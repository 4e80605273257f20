//! What goes wrong, as exceptions.

use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

create_exception!(tiltrotor, TiltrotorError, PyException, "What the simulator cannot do, in words.");
create_exception!(tiltrotor, NoSteadyFlight, TiltrotorError, "There is no such steady flight, or the aircraft cannot fly it.");

/// An error of ours, with all that led to it.
pub fn told(error: impl std::error::Error) -> PyErr {
    TiltrotorError::new_err(in_words(&error))
}

/// The same behind the name of what it is about.
pub fn told_of(what: &str, error: impl std::error::Error) -> PyErr {
    TiltrotorError::new_err(format!("{what}: {}", in_words(&error)))
}

/// There is no such steady flight.
pub fn unsteady(error: &impl std::fmt::Display) -> PyErr {
    NoSteadyFlight::new_err(error.to_string())
}

fn in_words(error: &dyn std::error::Error) -> String {
    let mut words = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        let cause_words = cause.to_string();
        if !words.contains(&cause_words) {
            words = format!("{words}: {cause_words}");
        }
        source = cause.source();
    }
    words
}

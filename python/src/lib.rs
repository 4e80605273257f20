//! The flight model and its logs in Python: the engine that the command flies, with the same bits.
//!
//! What Python sees is described in `python/tiltrotor`; this is the thin layer below it. No call holds the
//! interpreter's lock while it flies or reads, and every long one looks for Ctrl-C.

mod aircraft;
mod commands;
mod errors;
mod flight;
mod linear;
mod logs_read;
mod numbers;
mod provenance;
mod reflown;
mod verdict;
mod waiting;

use pyo3::prelude::*;

/// The module `tiltrotor._native`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::aircraft::{Aircraft, Trim};
    #[pymodule_export]
    use super::errors::{NoSteadyFlight, TiltrotorError};
    #[pymodule_export]
    use super::flight::Flight;
    #[pymodule_export]
    use super::linear::Linear;
    #[pymodule_export]
    use super::logs_read::{channels, facts, messages};
    #[pymodule_export]
    use super::reflown::{identify, refly, whatif};
    #[pymodule_export]
    use super::verdict::{Verdict, verify};

    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("BUILD", env!("TILTROTOR_VERSION"))?;
        module.add("STEP_S", engine::STEP_S)?;
        let starts = ::aircraft::STARTS.iter().map(|(name, what, _)| (*name, *what));
        module.add("STARTS", starts.collect::<Vec<_>>())
    }
}

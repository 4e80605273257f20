//! The C functions of FMI 2.0 for co-simulation.
//!
//! `fmi2Boolean` is an `int`, `fmi2Real` a `double`. What the description does not announce is refused in words.
#![allow(unsafe_code, reason = "a C interface")]
#![allow(non_snake_case, clippy::too_many_arguments, reason = "as FMI has them")]

use std::ffi::{CString, c_char, c_int, c_uint, c_void};

use crate::handle::{
    ERROR, Logger, Logger2, Teller, call, fill, free, give, give_state, instantiate, read, text,
};
use crate::instance::Copied;
use crate::variables::Value;

/// `fmi2CallbackFunctions`.
#[repr(C)]
pub struct Callbacks {
    logger: Option<Logger2>,
    // Memory is our own, and steps are not asynchronous.
    _allocate_memory: *const c_void,
    _free_memory: *const c_void,
    _step_finished: *const c_void,
    environment: *mut c_void,
}

/// `fmi2CoSimulation`.
const CO_SIMULATION: c_int = 1;
/// `fmi2LastSuccessfulTime`.
const LAST_SUCCESSFUL_TIME: c_int = 2;
/// `fmi2Terminated`.
const TERMINATED: c_int = 3;

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    token: *const c_char,
    _resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging: c_int,
) -> *mut c_void {
    // SAFETY: null, or the tool's struct, as FMI says.
    let callbacks = unsafe { callbacks.as_ref() };
    // SAFETY: null or texts, as FMI says.
    let (name, token) = unsafe { (text(name).unwrap_or("XV15"), text(token)) };
    let teller = Teller {
        logger: Logger::Fmi2(callbacks.and_then(|callbacks| callbacks.logger)),
        environment: callbacks.map_or(std::ptr::null_mut(), |callbacks| callbacks.environment),
        name: CString::new(name).unwrap_or_default(),
    };
    if kind != CO_SIMULATION {
        teller.tell(ERROR, "model exchange: this FMU is for co-simulation");
        return std::ptr::null_mut();
    }
    instantiate(teller, token)
}

#[unsafe(no_mangle)]
extern "C" fn fmi2FreeInstance(instance: *mut c_void) {
    free(instance);
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetDebugLogging(
    instance: *mut c_void,
    _on: c_int,
    _count: usize,
    _categories: *const *const c_char,
) -> c_int {
    // There are no messages but errors.
    call(instance, |_| Ok(()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetupExperiment(
    instance: *mut c_void,
    _tolerance_defined: c_int,
    _tolerance: f64,
    start_s: f64,
    _stop_defined: c_int,
    _stop_s: f64,
) -> c_int {
    call(instance, |handle| handle.instance.begins_at(start_s))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2EnterInitializationMode(instance: *mut c_void) -> c_int {
    call(instance, |handle| handle.instance.enter_initialization())
}

#[unsafe(no_mangle)]
extern "C" fn fmi2ExitInitializationMode(instance: *mut c_void) -> c_int {
    call(instance, |handle| handle.instance.exit_initialization())
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Terminate(instance: *mut c_void) -> c_int {
    call(instance, |handle| handle.instance.terminate())
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Reset(instance: *mut c_void) -> c_int {
    call(instance, |handle| handle.instance.reset())
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetReal(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *mut f64,
) -> c_int {
    call(instance, |handle| {
        // SAFETY: arrays of the tool's, as FMI says.
        let (references, values) = unsafe { (read(references, count)?, fill(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            *value = handle.instance.real(*reference)?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBoolean(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *mut c_int,
) -> c_int {
    call(instance, |handle| {
        // SAFETY: arrays of the tool's, as FMI says.
        let (references, values) = unsafe { (read(references, count)?, fill(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            *value = handle.instance.boolean(*reference)?.into();
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetString(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *mut *const c_char,
) -> c_int {
    call(instance, |handle| {
        // SAFETY: arrays of the tool's, as FMI says.
        let (references, values) = unsafe { (read(references, count)?, fill(values, count)?) };
        handle.texts.clear();
        for (reference, value) in references.iter().zip(values) {
            let text = CString::new(handle.instance.text(*reference)?).unwrap_or_default();
            *value = text.as_ptr();
            handle.texts.push(text);
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetReal(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const f64,
) -> c_int {
    call(instance, |handle| {
        // SAFETY: arrays of the tool's, as FMI says.
        let (references, values) = unsafe { (read(references, count)?, read(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            handle.instance.set(*reference, Value::Real(*value))?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetBoolean(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const c_int,
) -> c_int {
    call(instance, |handle| {
        // SAFETY: arrays of the tool's, as FMI says.
        let (references, values) = unsafe { (read(references, count)?, read(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            handle.instance.set(*reference, Value::Boolean(*value != 0))?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetString(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const *const c_char,
) -> c_int {
    call(instance, |handle| {
        // SAFETY: arrays of the tool's, as FMI says.
        let (references, values) = unsafe { (read(references, count)?, read(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            // SAFETY: null or a text, as FMI says.
            let value = unsafe { text(*value) }.ok_or("a text: expected UTF-8")?;
            handle.instance.set(*reference, Value::Text(value.into()))?;
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2DoStep(
    instance: *mut c_void,
    from_s: f64,
    step_s: f64,
    _no_set_state_before: c_int,
) -> c_int {
    call(instance, |handle| handle.instance.step(from_s, step_s))
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetFMUstate(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    call(instance, |handle| {
        // SAFETY: null, or a place that holds null or what this function gave, as FMI says.
        unsafe { give_state(state, handle.instance.copied()) }
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetFMUstate(instance: *mut c_void, state: *mut c_void) -> c_int {
    call(instance, |handle| {
        // SAFETY: null, or what fmi2GetFMUstate gave.
        let copied =
            unsafe { state.cast::<Copied>().as_ref() }.ok_or("FMU state: a null pointer")?;
        handle.instance.go_to(copied)
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeFMUstate(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    call(instance, |_| {
        // SAFETY: null, or a place that holds null or what fmi2GetFMUstate gave.
        let Some(state) = (unsafe { state.as_mut() }) else { return Ok(()) };
        if !state.is_null() {
            // SAFETY: as above, and it is not used again.
            drop(unsafe { Box::from_raw(state.cast::<Copied>()) });
            *state = std::ptr::null_mut();
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealStatus(
    instance: *mut c_void,
    kind: c_int,
    value: *mut f64,
) -> c_int {
    call(instance, |handle| match kind {
        // SAFETY: a place of the tool's, as FMI says.
        LAST_SUCCESSFUL_TIME => unsafe { give(value, handle.instance.time_s(), "status") },
        _ => Err("status: there is none but the last successful time".into()),
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBooleanStatus(
    instance: *mut c_void,
    kind: c_int,
    value: *mut c_int,
) -> c_int {
    call(instance, |_| match kind {
        // SAFETY: a place of the tool's, as FMI says.
        TERMINATED => unsafe { give(value, 0, "status") },
        _ => Err("status: there is none but whether the flight is over".into()),
    })
}

/// Functions of what the description does not announce. A tool has no reason to call them; their other
/// arguments are not looked at, which C's calling conventions on x86-64 and AArch64 allow.
macro_rules! refused {
    ($($name:ident: $words:literal)+) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void) -> c_int {
                call(instance, |_| Err(concat!(stringify!($name), ": ", $words).into()))
            }
        )+
    };
}

refused! {
    fmi2GetInteger: "there are no whole numbers among the variables"
    fmi2SetInteger: "there are no whole numbers among the variables"
    fmi2SerializedFMUstateSize: "states are not written to bytes: record a log by log_file"
    fmi2SerializeFMUstate: "states are not written to bytes: record a log by log_file"
    fmi2DeSerializeFMUstate: "states are not written to bytes: record a log by log_file"
    fmi2GetDirectionalDerivative: "there are no derivatives: `tiltrotor linearize` gives matrices"
    fmi2SetRealInputDerivatives: "inputs are held through the step"
    fmi2GetRealOutputDerivatives: "outputs have no derivatives"
    fmi2CancelStep: "steps are not asynchronous"
    fmi2GetStatus: "steps are not asynchronous"
    fmi2GetIntegerStatus: "there is none"
    fmi2GetStringStatus: "there is none"
}

//! The C functions of FMI 3.0 for co-simulation.
//!
//! `fmi3Boolean` is a `bool`, read as a byte: C may have any bits in it. What the description does not announce
//! is refused in words.
#![allow(unsafe_code, reason = "a C interface")]
#![allow(non_snake_case, clippy::too_many_arguments, reason = "as FMI has them")]

use std::ffi::{CString, c_char, c_int, c_uint, c_void};

use crate::handle::{
    ERROR, Handle, Logger, Logger3, Teller, call, fill, free, give_state, instantiate, put, read,
    text,
};
use crate::instance::Copied;
use crate::variables::Value;

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    _resources: *const c_char,
    _visible: u8,
    _logging: u8,
    event_mode: u8,
    _early_return: u8,
    _intermediate: *const c_uint,
    _intermediate_count: usize,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _intermediate_update: *const c_void,
) -> *mut c_void {
    // SAFETY: null or texts, as FMI says.
    let (name, token) = unsafe { (text(name).unwrap_or("XV15"), text(token)) };
    let name = CString::new(name).unwrap_or_default();
    let teller = Teller { logger: Logger::Fmi3(logger), environment, name };
    if event_mode != 0 {
        teller.tell(ERROR, "event mode: this FMU has none");
        return std::ptr::null_mut();
    }
    instantiate(teller, token)
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: u8,
    _logging: u8,
    environment: *mut c_void,
    logger: Option<Logger3>,
) -> *mut c_void {
    let teller = Teller { logger: Logger::Fmi3(logger), environment, name: CString::default() };
    teller.tell(ERROR, "model exchange: this FMU is for co-simulation");
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: u8,
    _logging: u8,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut c_void {
    let teller = Teller { logger: Logger::Fmi3(logger), environment, name: CString::default() };
    teller.tell(ERROR, "scheduled execution: this FMU is for co-simulation");
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    free(instance);
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    _on: u8,
    _count: usize,
    _categories: *const *const c_char,
) -> c_int {
    // There are no messages but errors.
    call(instance, |_| Ok(()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    _tolerance_defined: u8,
    _tolerance: f64,
    start_s: f64,
    _stop_defined: u8,
    _stop_s: f64,
) -> c_int {
    call(instance, |handle| {
        handle.instance.begins_at(start_s)?;
        handle.instance.enter_initialization()
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3ExitInitializationMode(instance: *mut c_void) -> c_int {
    call(instance, |handle| handle.instance.exit_initialization())
}

#[unsafe(no_mangle)]
extern "C" fn fmi3Terminate(instance: *mut c_void) -> c_int {
    call(instance, |handle| handle.instance.terminate())
}

#[unsafe(no_mangle)]
extern "C" fn fmi3Reset(instance: *mut c_void) -> c_int {
    call(instance, |handle| handle.instance.reset())
}

/// Reads values: as many as references, since no variable is an array.
///
/// # Safety
/// Null, or arrays of the tool's of these lengths.
unsafe fn get<T>(
    instance: *mut c_void,
    (references, count): (*const c_uint, usize),
    (values, values_count): (*mut T, usize),
    mut one: impl FnMut(&mut Handle, u32) -> Result<T, String>,
) -> c_int {
    call(instance, |handle| {
        as_many(count, values_count)?;
        // SAFETY: as the caller says.
        let (references, values) = unsafe { (read(references, count)?, fill(values, count)?) };
        handle.texts.clear();
        for (reference, value) in references.iter().zip(values) {
            *value = one(handle, *reference)?;
        }
        Ok(())
    })
}

/// Sets values in the same way.
///
/// # Safety
/// Null, or arrays of the tool's of these lengths.
unsafe fn set<T: Copy>(
    instance: *mut c_void,
    (references, count): (*const c_uint, usize),
    (values, values_count): (*const T, usize),
    value_of: impl Fn(T) -> Result<Value, String>,
) -> c_int {
    call(instance, |handle| {
        as_many(count, values_count)?;
        // SAFETY: as the caller says.
        let (references, values) = unsafe { (read(references, count)?, read(values, count)?) };
        for (reference, value) in references.iter().zip(values) {
            handle.instance.set(*reference, value_of(*value)?)?;
        }
        Ok(())
    })
}

fn as_many(references: usize, values: usize) -> Result<(), String> {
    if references == values {
        return Ok(());
    }
    Err(format!(
        "{references} value references and {values} values: expected as many, there are no arrays"
    ))
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *mut f64,
    values_count: usize,
) -> c_int {
    // SAFETY: arrays of the tool's, as FMI says.
    unsafe {
        get(instance, (references, count), (values, values_count), |handle, reference| {
            handle.instance.real(reference)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetBoolean(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    // Bytes, for a tool's memory may hold any bits before.
    values: *mut u8,
    values_count: usize,
) -> c_int {
    // SAFETY: arrays of the tool's, as FMI says.
    unsafe {
        get(instance, (references, count), (values, values_count), |handle, reference| {
            handle.instance.boolean(reference).map(u8::from)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetString(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *mut *const c_char,
    values_count: usize,
) -> c_int {
    // SAFETY: arrays of the tool's, as FMI says.
    unsafe {
        get(instance, (references, count), (values, values_count), |handle, reference| {
            let text = CString::new(handle.instance.text(reference)?).unwrap_or_default();
            let pointer = text.as_ptr();
            handle.texts.push(text);
            Ok(pointer)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const f64,
    values_count: usize,
) -> c_int {
    // SAFETY: arrays of the tool's, as FMI says.
    unsafe {
        set(instance, (references, count), (values, values_count), |value| Ok(Value::Real(value)))
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetBoolean(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const u8,
    values_count: usize,
) -> c_int {
    // SAFETY: arrays of the tool's, as FMI says.
    unsafe {
        set(instance, (references, count), (values, values_count), |value| {
            Ok(Value::Boolean(value != 0))
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetString(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const *const c_char,
    values_count: usize,
) -> c_int {
    // SAFETY: arrays of the tool's, each text null or with its NUL, as FMI says.
    unsafe {
        set(instance, (references, count), (values, values_count), |value| {
            text(value).map(|text| Value::Text(text.into())).ok_or("a text: expected UTF-8".into())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    from_s: f64,
    step_s: f64,
    _no_set_state_before: u8,
    event: *mut bool,
    terminate: *mut bool,
    early: *mut bool,
    last_successful_s: *mut f64,
) -> c_int {
    call(instance, |handle| {
        let flown = handle.instance.step(from_s, step_s);
        // SAFETY: places of the tool's, as FMI says.
        unsafe {
            put(event, false);
            put(terminate, false);
            put(early, false);
            put(last_successful_s, handle.instance.time_s());
        }
        flown
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFMUState(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    call(instance, |handle| {
        // SAFETY: null, or a place that holds null or what this function gave, as FMI says.
        unsafe { give_state(state, handle.instance.copied()) }
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFMUState(instance: *mut c_void, state: *mut c_void) -> c_int {
    call(instance, |handle| {
        // SAFETY: null, or what fmi3GetFMUState gave.
        let copied =
            unsafe { state.cast::<Copied>().as_ref() }.ok_or("FMU state: a null pointer")?;
        handle.instance.go_to(copied)
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeFMUState(instance: *mut c_void, state: *mut *mut c_void) -> c_int {
    call(instance, |_| {
        // SAFETY: null, or a place that holds null or what fmi3GetFMUState gave.
        let Some(state) = (unsafe { state.as_mut() }) else { return Ok(()) };
        if !state.is_null() {
            // SAFETY: as above, and it is not used again.
            drop(unsafe { Box::from_raw(state.cast::<Copied>()) });
            *state = std::ptr::null_mut();
        }
        Ok(())
    })
}

/// Functions of what the description does not announce. A tool has no reason to call them; their other
/// arguments are not looked at, which C's calling conventions on x86-64 and AArch64 allow.
macro_rules! refused {
    ($($words:literal { $($name:ident)+ })+) => {
        $($(
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void) -> c_int {
                call(instance, |_| Err(concat!(stringify!($name), ": ", $words).into()))
            }
        )+)+
    };
}

refused! {
    "the variables are Float64, Boolean and String" {
        fmi3GetFloat32 fmi3GetInt8 fmi3GetUInt8 fmi3GetInt16 fmi3GetUInt16 fmi3GetInt32 fmi3GetUInt32
        fmi3GetInt64 fmi3GetUInt64 fmi3GetBinary fmi3GetClock
        fmi3SetFloat32 fmi3SetInt8 fmi3SetUInt8 fmi3SetInt16 fmi3SetUInt16 fmi3SetInt32 fmi3SetUInt32
        fmi3SetInt64 fmi3SetUInt64 fmi3SetBinary fmi3SetClock
    }
    "dependencies are in the description" {
        fmi3GetNumberOfVariableDependencies fmi3GetVariableDependencies
    }
    "states are not written to bytes: record a log by log_file" {
        fmi3SerializedFMUStateSize fmi3SerializeFMUState fmi3DeserializeFMUState
    }
    "there are no derivatives: `tiltrotor linearize` gives matrices" {
        fmi3GetDirectionalDerivative fmi3GetAdjointDerivative fmi3GetOutputDerivatives
    }
    "there is no configuration mode" { fmi3EnterConfigurationMode fmi3ExitConfigurationMode }
    "there are no clocks" {
        fmi3GetIntervalDecimal fmi3GetIntervalFraction fmi3GetShiftDecimal fmi3GetShiftFraction
        fmi3SetIntervalDecimal fmi3SetIntervalFraction fmi3SetShiftDecimal fmi3SetShiftFraction
        fmi3ActivateModelPartition
    }
    "there is no event mode" {
        fmi3EnterEventMode fmi3EnterStepMode fmi3EvaluateDiscreteStates fmi3UpdateDiscreteStates
    }
    "this FMU is for co-simulation, not for model exchange" {
        fmi3EnterContinuousTimeMode fmi3CompletedIntegratorStep fmi3SetTime fmi3SetContinuousStates
        fmi3GetContinuousStateDerivatives fmi3GetEventIndicators fmi3GetContinuousStates
        fmi3GetNominalsOfContinuousStates fmi3GetNumberOfEventIndicators fmi3GetNumberOfContinuousStates
    }
}

//! What stands behind the pointer that a simulation tool holds: an instance, and how the tool is told things.
//!
//! Pointers from the tool become slices and texts here and nowhere else, and no panic passes [`call`].
#![allow(unsafe_code, reason = "pointers of a C interface")]

use std::any::Any;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

use crate::instance::{Copied, Instance};

/// `fmi2OK`, `fmi3OK`.
pub const OK: c_int = 0;
/// `fmi2Error`, `fmi3Error`: refused; the instance is as it was.
pub const ERROR: c_int = 3;
/// `fmi2Fatal`, `fmi3Fatal`: a fault of this program; the instance is of no use any more.
pub const FATAL: c_int = 4;

/// Category of every message.
const CATEGORY: &CStr = c"error";

/// `fmi2CallbackLogger`.
pub type Logger2 =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi3LogMessageCallback`.
pub type Logger3 = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// How the tool is told things.
#[derive(Clone, Copy)]
pub enum Logger {
    /// As FMI 2.0 has it.
    Fmi2(Option<Logger2>),
    /// As FMI 3.0 has it.
    Fmi3(Option<Logger3>),
}

/// What the pointer points to.
pub struct Handle {
    /// The flight.
    pub instance: Instance,
    /// Texts that the tool was given, there until the next call that gives some.
    pub texts: Vec<CString>,
    teller: Teller,
    /// After a panic.
    broken: bool,
}

/// A logger, and what it wants to be called with.
pub struct Teller {
    /// Which.
    pub logger: Logger,
    /// The tool's own pointer.
    pub environment: *mut c_void,
    /// The instance's name, which FMI 2.0 wants with each message.
    pub name: CString,
}

impl Teller {
    /// Tells words. Errors are told whether or not the tool switched logging on: they are why a call failed.
    pub fn tell(&self, status: c_int, words: &str) {
        // FMI 2.0 takes it for a format, and neither takes a NUL.
        let words = words.replace('%', " percent").replace('\0', " ");
        let Ok(words) = CString::new(words) else { return };
        let (environment, category) = (self.environment, CATEGORY.as_ptr());
        match self.logger {
            Logger::Fmi2(Some(logger)) => {
                // SAFETY: the tool's own function with the pointer that it gave; all texts outlive the call.
                unsafe { logger(environment, self.name.as_ptr(), status, category, words.as_ptr()) }
            }
            Logger::Fmi3(Some(logger)) => {
                // SAFETY: as above.
                unsafe { logger(environment, status, category, words.as_ptr()) }
            }
            Logger::Fmi2(None) | Logger::Fmi3(None) => {}
        }
    }
}

/// A new instance as the tool holds it; null when the token is not that of this library.
pub fn instantiate(teller: Teller, token: Option<&str>) -> *mut c_void {
    let made = catch_unwind(AssertUnwindSafe(|| {
        let own = crate::description::token();
        if token != Some(own.as_str()) {
            let words = format!(
                "the FMU's description is not that of its library: token {}, expected {own}; build both anew",
                token.unwrap_or("none")
            );
            teller.tell(ERROR, &words);
            return ptr::null_mut();
        }
        let (instance, texts) = (Instance::default(), Vec::new());
        let handle = Box::new(Handle { instance, texts, teller, broken: false });
        Box::into_raw(handle).cast::<c_void>()
    }));
    made.unwrap_or(ptr::null_mut())
}

/// Does something with an instance; what is refused is told in words, what panics ends the instance.
pub fn call(pointer: *mut c_void, work: impl FnOnce(&mut Handle) -> Result<(), String>) -> c_int {
    // SAFETY: null, or what `instantiate` gave and `free` has not taken back; FMI lets tools make one call
    // at a time on an instance.
    let Some(handle) = (unsafe { pointer.cast::<Handle>().as_mut() }) else { return ERROR };
    if handle.broken {
        handle.teller.tell(FATAL, "this instance had a fault before: free it");
        return FATAL;
    }
    match catch_unwind(AssertUnwindSafe(|| work(handle))) {
        Ok(Ok(())) => OK,
        Ok(Err(words)) => {
            handle.teller.tell(ERROR, &words);
            ERROR
        }
        Err(panic) => {
            handle.broken = true;
            let words =
                format!("this is a fault of tiltrotor's, please report it: {}", said(&*panic));
            handle.teller.tell(FATAL, &words);
            FATAL
        }
    }
}

fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no words")
}

/// Ends an instance: its log is closed as ended by the crew unless it was terminated before.
pub fn free(pointer: *mut c_void) {
    // SAFETY: null, or what `instantiate` gave.
    let is_whole =
        unsafe { pointer.cast::<Handle>().as_ref() }.is_some_and(|handle| !handle.broken);
    if is_whole {
        let _ = call(pointer, |handle| handle.instance.leave());
    }
    if !pointer.is_null() {
        // SAFETY: what `instantiate` gave; the tool does not use it again.
        let handle = unsafe { Box::from_raw(pointer.cast::<Handle>()) };
        let _ = catch_unwind(AssertUnwindSafe(|| drop(handle)));
    }
}

/// Gives a copy of the instance's state: into the one that the tool holds already, or as a new one.
///
/// # Safety
/// `place` is null, or holds null or what this function gave and nobody freed.
pub unsafe fn give_state(place: *mut *mut c_void, copied: Copied) -> Result<(), String> {
    // SAFETY: as the caller says.
    let place = unsafe { place.as_mut() }.ok_or("FMU state: a null pointer")?;
    // SAFETY: as the caller says.
    match unsafe { place.cast::<Copied>().as_mut() } {
        Some(held) => *held = copied,
        None => *place = Box::into_raw(Box::new(copied)).cast(),
    }
    Ok(())
}

/// An array of the tool's, to read.
///
/// # Safety
/// A pointer that is not null points to so many values, which stay as they are as long as the slice is used.
pub unsafe fn read<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], String> {
    if count == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err("an array is missing: a null pointer".into());
    }
    // SAFETY: as the caller says.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// An array of the tool's, to fill.
///
/// # Safety
/// As for [`read`], and nobody else uses it meanwhile.
pub unsafe fn fill<'a, T>(pointer: *mut T, count: usize) -> Result<&'a mut [T], String> {
    if count == 0 {
        return Ok(&mut []);
    }
    if pointer.is_null() {
        return Err("an array is missing: a null pointer".into());
    }
    // SAFETY: as the caller says.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) })
}

/// A text of the tool's; nothing where there is none or it is no UTF-8.
///
/// # Safety
/// A pointer that is not null points to a text with a NUL at its end.
pub unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a str> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: as the caller says.
    unsafe { CStr::from_ptr(pointer) }.to_str().ok()
}

/// Puts a value where the tool wants it, if it says where.
///
/// # Safety
/// A pointer that is not null points to a place for it.
pub unsafe fn put<T>(pointer: *mut T, value: T) {
    if !pointer.is_null() {
        // SAFETY: as the caller says.
        unsafe { pointer.write(value) }
    }
}

/// The same with a name to complain of.
///
/// # Safety
/// As for [`put`].
pub unsafe fn give<T>(pointer: *mut T, value: T, what: &str) -> Result<(), String> {
    if pointer.is_null() {
        return Err(format!("{what}: a null pointer to put it at"));
    }
    // SAFETY: as the caller says.
    unsafe { pointer.write(value) };
    Ok(())
}

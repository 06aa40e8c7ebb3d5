//! The C interface of Open Image Denoise 2, as its manual describes it ("Open Image Denoise API").
//!
//! All that is unsafe about it is here. The library is trusted to keep to its manual: it reads and writes the buffers that
//! it is given, of the size that it is told, while it executes, and none of them afterwards.
#![expect(unsafe_code, reason = "a library of C, called through pointers")]

use libloading::Symbol;
use std::ffi::{CStr, OsStr, c_char, c_int, c_void};

/// `OIDNDevice` and `OIDNFilter`: pointers to what only the library knows.
type Handle = *mut c_void;

/// `OIDN_DEVICE_TYPE_CPU`: of all devices the one that surely reads the memory of programs.
const DEVICE_CPU: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`.
const FORMAT_FLOAT3: c_int = 3;
/// `OIDN_ERROR_NONE`.
const NO_ERROR: c_int = 0;

/// The loaded library with the functions that are called. They are found once, when it is loaded; it stays loaded as
/// long as this lives.
pub struct Library {
    new_device: unsafe extern "C" fn(c_int) -> Handle,
    commit_device: unsafe extern "C" fn(Handle),
    device_error: unsafe extern "C" fn(Handle, *mut *const c_char) -> c_int,
    release_device: unsafe extern "C" fn(Handle),
    new_filter: unsafe extern "C" fn(Handle, *const c_char) -> Handle,
    set_image: SetSharedFilterImage,
    set_bool: unsafe extern "C" fn(Handle, *const c_char, bool),
    commit_filter: unsafe extern "C" fn(Handle),
    execute_filter: unsafe extern "C" fn(Handle),
    release_filter: unsafe extern "C" fn(Handle),
    /// Last, since it must outlive the functions.
    _loaded: libloading::Library,
}

/// Filter, name, memory, format, width, height, and three strides, of which 0 means that the pixels are dense.
type SetSharedFilterImage =
    unsafe extern "C" fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);

/// A picture of three components for a filter.
pub struct Input {
    /// What it is to the filter.
    pub name: &'static CStr,
    /// Its values, pixel by pixel.
    pub values: Vec<f32>,
}

impl Library {
    /// Loads it from a path or by a name that the system looks for; otherwise the reason.
    pub fn load(name: &OsStr) -> Result<Self, String> {
        // SAFETY: loading runs the library's initialisation, which does no more than its manual says.
        let library = unsafe { libloading::Library::new(name) }.map_err(|e| e.to_string())?;
        macro_rules! function {
            ($name:literal) => {{
                // SAFETY: the type is that of the function in the library's header.
                let symbol: Result<Symbol<_>, _> = unsafe { library.get($name) };
                *symbol.map_err(|e| e.to_string())?
            }};
        }
        Ok(Self {
            new_device: function!(b"oidnNewDevice\0"),
            commit_device: function!(b"oidnCommitDevice\0"),
            device_error: function!(b"oidnGetDeviceError\0"),
            release_device: function!(b"oidnReleaseDevice\0"),
            new_filter: function!(b"oidnNewFilter\0"),
            set_image: function!(b"oidnSetSharedFilterImage\0"),
            set_bool: function!(b"oidnSetFilterBool\0"),
            commit_filter: function!(b"oidnCommitFilter\0"),
            execute_filter: function!(b"oidnExecuteFilter\0"),
            release_filter: function!(b"oidnReleaseFilter\0"),
            _loaded: library,
        })
    }

    /// Runs the filter for rendered pictures; the result, or the library's own words for why there is none.
    pub fn run(&self, mut inputs: Vec<Input>, [width, height]: [usize; 2]) -> Result<Vec<f32>, String> {
        let length = 3 * width * height;
        if inputs.iter().any(|input| input.values.len() != length) {
            return Err("the inputs differ in size".to_owned());
        }
        let mut output = vec![0.0f32; length];
        // SAFETY: handles are used with the library that made them, until they are released, once each. Every buffer
        // holds width x height pixels of three floats without gaps, as is said of it, and outlives the filter.
        unsafe {
            let device = (self.new_device)(DEVICE_CPU);
            if device.is_null() {
                return Err("there is no device".to_owned());
            }
            (self.commit_device)(device);
            let filter = (self.new_filter)(device, c"RT".as_ptr());
            if !filter.is_null() {
                let set = |name: &CStr, values: &mut Vec<f32>| {
                    let memory = values.as_mut_ptr().cast();
                    (self.set_image)(filter, name.as_ptr(), memory, FORMAT_FLOAT3, width, height, 0, 0, 0);
                };
                for input in &mut inputs {
                    set(input.name, &mut input.values);
                }
                set(c"output", &mut output);
                (self.set_bool)(filter, c"hdr".as_ptr(), true);
                (self.commit_filter)(filter);
                (self.execute_filter)(filter);
                (self.release_filter)(filter);
            }
            let error = self.error(device);
            (self.release_device)(device);
            error.map_or(Ok(output), Err)
        }
    }

    /// The first error since the device was made.
    ///
    /// # Safety
    /// The device must be the library's, and not released.
    unsafe fn error(&self, device: Handle) -> Option<String> {
        let mut message = std::ptr::null();
        // SAFETY: the message is a text that ends with 0 and lives at least until the next call, or null.
        unsafe {
            let code = (self.device_error)(device, &raw mut message);
            let said = (!message.is_null()).then(|| CStr::from_ptr(message).to_string_lossy().into_owned());
            (code != NO_ERROR).then(|| said.unwrap_or_else(|| format!("error {code}")))
        }
    }
}

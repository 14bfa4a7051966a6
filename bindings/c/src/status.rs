//! Status codes and error messages. [`call`] runs every C function: it turns an error into a status and a
//! message, and a panic into an error.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The result of a call. darboux_last_error returns a message for every error.
///
/// Degenerate triangles and values that are not finite are not errors; reports count them. After an error
/// other than DARBOUX_STATUS_INTERNAL and DARBOUX_STATUS_CANCELLED, nothing has been written to the caller's
/// arrays.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum darboux_status {
    /// Success.
    Ok = 0,
    /// A required pointer is null.
    NullPointer = 1,
    /// The `size` of a struct is invalid, or the struct has non-zero fields that this version of the library
    /// does not support.
    StructSize = 2,
    /// A value is not in its enumeration, or two fields are set of which one must be null.
    UnknownValue = 3,
    /// A stride is smaller than an element.
    Stride = 4,
    /// An array of integers is not aligned to the size of its elements.
    Alignment = 5,
    /// There are too many vertices or corners, or an array would exceed the address space.
    TooLarge = 6,
    /// A count differs from that of the mesh or of another array.
    Length = 7,
    /// An index is out of range.
    Index = 8,
    /// The corners do not make whole faces.
    Faces = 9,
    /// The function must be called before any other, and was called later.
    TooLate = 10,
    /// A defect of the library, not of the caller. Please report it with the message.
    Internal = 11,
    /// Two axes of a convention are parallel.
    Axes = 12,
    /// Threads cannot be started.
    Threads = 13,
    /// The context was cancelled; the output array is unspecified.
    Cancelled = 14,
}

/// An error inside the library, before it becomes a status and a message.
#[derive(Debug)]
pub(crate) struct Error {
    status: darboux_status,
    message: String,
}

impl Error {
    pub fn new(status: darboux_status, message: String) -> Self {
        Self { status, message }
    }
}

impl From<darboux::Error> for Error {
    fn from(error: darboux::Error) -> Self {
        let status = match error {
            darboux::Error::IndexOutOfRange { .. } => darboux_status::Index,
            darboux::Error::PartialFace { .. } | darboux::Error::FaceSizes { .. } => darboux_status::Faces,
            darboux::Error::StrideTooSmall { .. } => darboux_status::Stride,
            darboux::Error::TooManyCorners { .. } | darboux::Error::TooManyVertices { .. } => {
                darboux_status::TooLarge
            }
            darboux::Error::Cancelled => darboux_status::Cancelled,
            _ => darboux_status::Length,
        };
        Self::new(status, error.to_string())
    }
}

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// Runs a call and returns its status. A panic becomes [`darboux_status::Internal`].
pub(crate) fn call(body: impl FnOnce() -> Result<(), Error>) -> darboux_status {
    let panicked = |_| {
        let message = "the library met a defect of its own; the sentence on standard error says where";
        Err(Error::new(darboux_status::Internal, message.into()))
    };
    match catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(panicked) {
        Ok(()) => darboux_status::Ok,
        Err(error) => {
            keep(error.message);
            error.status
        }
    }
}

/// Stores the message that [`darboux_last_error`] returns. Does nothing on a thread whose thread-local
/// storage is already destroyed.
fn keep(message: String) {
    let message = CString::new(message).unwrap_or_default();
    let _ = LAST_ERROR.try_with(|last| last.replace(message));
}

/// Returns the message of the last error on this thread: one sentence in UTF-8. The empty string where no
/// call has failed yet.
///
/// The pointer is valid until the next call on this thread that fails, or until the thread ends. Calls that
/// succeed do not change the message.
#[unsafe(no_mangle)]
pub extern "C" fn darboux_last_error() -> *const c_char {
    const NONE: &CStr = c"";
    LAST_ERROR.try_with(|last| last.borrow().as_ptr()).unwrap_or(NONE.as_ptr())
}

/// Returns the library's version, for example "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn darboux_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

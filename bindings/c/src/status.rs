//! What calls return, and the one place where they end: errors become a status and a message, panics an error.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use darboux::MeshError;

/// What a call came to. darboux_last_error has a sentence on every error.
///
/// Degenerate triangles and values that are not finite are not errors: reports count them. After an error other than
/// DARBOUX_STATUS_INTERNAL and DARBOUX_STATUS_CANCELLED nothing was written.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum darboux_status {
    /// All was done.
    Ok = 0,
    /// A pointer is null where there must be memory.
    NullPointer = 1,
    /// A struct's `size` is no version's size, or has values that this version of the library does not know.
    StructSize = 2,
    /// A number is none of its enumeration, or two fields are set of which one must be null.
    UnknownValue = 3,
    /// A stride is smaller than the element that it steps over.
    Stride = 4,
    /// Integers do not lie at a multiple of their size.
    Alignment = 5,
    /// More vertices or corners than 32-bit numbers can count, or more memory than there can be.
    TooLarge = 6,
    /// A count is not what the mesh or another array asks for.
    Length = 7,
    /// An index names no vertex.
    Index = 8,
    /// The corners do not make whole faces.
    Faces = 9,
    /// A call that must come before any other came later.
    TooLate = 10,
    /// A defect of the library, which is none of the caller's doing. Please report it with the message.
    Internal = 11,
    /// Two of a convention's axes lie along one line.
    Axes = 12,
    /// Threads cannot be started.
    Threads = 13,
    /// The context was cancelled; the output array is unspecified.
    Cancelled = 14,
}

/// An error on its way to the border.
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

impl From<MeshError> for Error {
    fn from(error: MeshError) -> Self {
        let status = match error {
            MeshError::IndexOutOfRange { .. } => darboux_status::Index,
            MeshError::PartialFace { .. } | MeshError::FaceSizes { .. } => darboux_status::Faces,
            MeshError::StrideTooSmall { .. } => darboux_status::Stride,
            MeshError::TooManyCorners { .. } | MeshError::TooManyVertices { .. } => darboux_status::TooLarge,
            MeshError::Cancelled => darboux_status::Cancelled,
            _ => darboux_status::Length,
        };
        Self::new(status, error.to_string())
    }
}

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// Runs a call to its status. A panic becomes [`darboux_status::Internal`].
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

/// Keeps a message for [`darboux_last_error`]; on a thread that is ending there is no place for it.
fn keep(message: String) {
    let message = CString::new(message).unwrap_or_default();
    let _ = LAST_ERROR.try_with(|last| last.replace(message));
}

/// Returns the message of the last error on this thread, one sentence in UTF-8; empty where there was none.
///
/// Valid until this thread's next call that fails, or its end. Calls that succeed leave it as it is.
#[unsafe(no_mangle)]
pub extern "C" fn darboux_last_error() -> *const c_char {
    const NONE: &CStr = c"";
    LAST_ERROR.try_with(|last| last.borrow().as_ptr()).unwrap_or(NONE.as_ptr())
}

/// Returns the library's version, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn darboux_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

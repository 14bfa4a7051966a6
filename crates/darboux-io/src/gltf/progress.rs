//! Progress of a long operation on a document.

/// How much of an operation is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The units done: triangles or primitives.
    pub done: usize,
    /// The units in total.
    pub total: usize,
}

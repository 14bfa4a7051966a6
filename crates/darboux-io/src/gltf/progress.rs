//! Progress of a long operation on a document.

/// How far [`add_tangents`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Triangles computed.
    pub done: usize,
    /// Triangles to compute.
    pub total: usize,
}

//! What `darboux devices` reports of an adapter.

use serde::Serialize;

/// An adapter and whether it can compute tangents.
#[derive(Serialize)]
pub struct Adapter {
    pub name: String,
    pub kind: String,
    pub backend: String,
    pub driver: String,
    /// The largest buffer binding in bytes.
    pub largest_binding: u64,
    /// The number of triangles that one dispatch can process.
    pub triangle_limit: u64,
    /// Why the adapter cannot be used; `None` for a usable adapter.
    pub problem: Option<String>,
}

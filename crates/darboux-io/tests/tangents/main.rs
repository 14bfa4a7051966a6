//! Adding tangents to documents: selection of primitives and UVs, splitting of vertices, data that is kept.

mod faults;
mod selection;
mod splits;
#[path = "../support/mod.rs"]
mod support;

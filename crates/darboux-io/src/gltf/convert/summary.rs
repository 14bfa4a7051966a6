//! The result of [`convert_vertices`](super::convert_vertices).

use serde::Serialize;

/// The changes that [`convert_vertices`](super::convert_vertices) made to a document.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ConversionSummary {
    /// The number of primitives that changed.
    pub primitives: usize,
    /// Whether vectors or nodes have other axes.
    pub axes_changed: bool,
    /// Whether v was flipped.
    pub uvs_flipped: bool,
    /// Whether the winding of faces was reversed.
    pub faces_reversed: bool,
    /// Whether tangents were inverted, or their signs changed.
    pub tangents_changed: bool,
    /// Warnings, one sentence each. They are not part of the serialized form.
    #[serde(skip)]
    pub warnings: Vec<String>,
}

impl ConversionSummary {
    /// Whether anything changed.
    pub fn has_changes(&self) -> bool {
        self.primitives > 0 || self.axes_changed
    }
}

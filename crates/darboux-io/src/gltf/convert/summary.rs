//! The result of [`convert_vertices`](super::convert_vertices).

use serde::Serialize;

/// What [`convert_vertices`](super::convert_vertices) did to a document: only what it did, not what other documents would have had changed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ConversionSummary {
    /// Primitives that changed.
    pub primitives: usize,
    /// Whether vectors, or nodes, got other axes.
    pub axes_changed: bool,
    /// Whether v runs the other way.
    pub uvs_flipped: bool,
    /// Whether fronts are wound the other way.
    pub faces_reversed: bool,
    /// Whether tangents point the other way, or their signs changed.
    pub tangents_changed: bool,
    /// What a user should look at, one sentence each. Reports have them beside this.
    #[serde(skip)]
    pub warnings: Vec<String>,
}

impl ConversionSummary {
    /// Whether anything changed.
    pub fn has_changes(&self) -> bool {
        self.primitives > 0 || self.axes_changed
    }
}

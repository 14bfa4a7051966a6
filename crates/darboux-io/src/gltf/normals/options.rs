//! Options of [`add_normals`](super::add_normals).

use darboux::NormalOptions;

/// Options of [`add_normals`](super::add_normals). The default adds smooth normals to triangle primitives without normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NormalsOptions {
    /// How normals are computed.
    pub normals: NormalOptions,
    /// Replaces existing normals.
    pub overwrite: bool,
}

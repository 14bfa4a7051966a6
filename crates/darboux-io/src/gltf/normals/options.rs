//! Options of [`add_normals`](super::add_normals).

use darboux::NormalOptions;

/// What [`add_normals`](super::add_normals) does. The default gives smooth normals to the triangle primitives that have none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NormalsOptions {
    /// How normals are made.
    pub normals: NormalOptions,
    /// Replace normals that exist.
    pub overwrite: bool,
}

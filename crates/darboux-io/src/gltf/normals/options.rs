//! Options of [`add_normals`](super::add_normals).

use darboux::NormalOptions;

/// Options of [`add_normals`](super::add_normals). The default adds smooth normals to triangle primitives
/// without normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct AddNormalsOptions {
    /// How normals are computed.
    pub normals: NormalOptions,
    /// Replaces existing normals.
    pub overwrite: bool,
}

impl AddNormalsOptions {
    /// These options with another way to compute normals.
    #[must_use]
    pub fn with_normals(self, normals: NormalOptions) -> Self {
        Self { normals, ..self }
    }

    /// These options with existing normals replaced, or kept.
    #[must_use]
    pub fn with_overwrite(self, overwrite: bool) -> Self {
        Self { overwrite, ..self }
    }
}

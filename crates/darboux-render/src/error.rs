//! Why there is no picture.

use darboux_gpu::GpuError;

/// Why a picture could not be drawn. Its text is one sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The model has no triangles with finite positions, or the UV layout no UVs.
    #[error(
        "has nothing to draw: no triangles with finite positions, or for the UV layout none with finite UVs"
    )]
    Nothing,
    /// A size past the limits of the adapter.
    #[error("{adapter:?} draws from 1 x 1 to {limit} x {limit} pixels, and {most} in all: {} x {} are not possible", .size[0], .size[1])]
    Size {
        /// Pixels across and down.
        size: [u32; 2],
        /// The most in either direction.
        limit: u32,
        /// The most in all.
        most: u64,
        /// The adapter's name.
        adapter: String,
    },
    /// More than can be drawn in reasonable time.
    #[error(
        "its nodes place {triangles} triangles, more than the {limit} that are drawn: render a part of the scene"
    )]
    TooMany {
        /// The triangles.
        triangles: u64,
        /// The most.
        limit: u64,
    },
    /// The device has no memory left.
    #[error(
        "the adapter's memory is too small for this model and size: choose a smaller size, or render a part of the scene"
    )]
    Memory,
    /// The device stopped or refused.
    #[error(transparent)]
    Gpu(GpuError),
}

impl From<GpuError> for RenderError {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::OutOfMemory => Self::Memory,
            error => Self::Gpu(error),
        }
    }
}

//! The errors of [`render`](crate::render::render).

use darboux_gpu::GpuError;

/// Why a picture could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The model has no triangles with finite positions, or the UV layout no UVs.
    #[error(
        "has nothing to draw: it has no triangles with finite positions, or for the UV layout none with \
         finite UVs"
    )]
    NothingToDraw,
    /// The size is outside the limits of the adapter.
    #[error("{adapter:?} cannot draw {} x {} pixels: choose a size from 1 x 1 to {limit} x {limit} with at \
         most {most} pixels in total", .size[0], .size[1])]
    UnsupportedSize {
        /// The width and height in pixels.
        size: [u32; 2],
        /// The largest width and height.
        limit: u32,
        /// The largest number of pixels.
        most: u64,
        /// The name of the adapter.
        adapter: String,
    },
    /// The scene has more triangles than can be drawn in reasonable time.
    #[error(
        "its scene has {triangles} triangles, more than the limit of {limit}: render a part of the scene"
    )]
    TooManyTriangles {
        /// The number of triangles.
        triangles: u64,
        /// The limit.
        limit: u64,
    },
    /// The device is out of memory.
    #[error(
        "the adapter does not have enough memory for this model and size: choose a smaller size, or render a \
         part of the scene"
    )]
    OutOfMemory,
    /// The device is lost, or reported an error.
    #[error(transparent)]
    Gpu(GpuError),
}

impl From<GpuError> for RenderError {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::OutOfMemory => Self::OutOfMemory,
            error => Self::Gpu(error),
        }
    }
}

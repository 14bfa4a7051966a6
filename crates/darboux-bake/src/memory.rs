//! How many bytes runs need, estimated before anything large is allocated.

use crate::budget::Budget;
use crate::images::TexelState;
use crate::{BakeError, BakeOptions, HighSurface, bvh, padding};

/// The bytes per texel of the two normal maps that a verification compares.
const BYTES_PER_COMPARED_TEXEL: u64 = 24;

impl BakeOptions {
    /// Refuses images that do not fit into the memory limit, whatever the models are.
    ///
    /// # Errors
    ///
    /// [`BakeError::Memory`].
    pub fn check_memory(&self) -> Result<(), BakeError> {
        Budget::new(self.memory_limit).add(of_bake(&[], self))
    }
}

/// The bytes of the images, of what filling them needs, and of the hierarchies over the high surfaces.
pub fn of_bake(high: &[HighSurface<'_>], options: &BakeOptions) -> u64 {
    texels(options) * (bytes_of_images(options) + padding::BYTES_PER_TEXEL) + of_hierarchies(high)
}

/// The bytes of the baked images, of two decoded normal maps, and of the hierarchies over the high surfaces;
/// without the points.
pub fn of_verification(high: &[HighSurface<'_>], options: &BakeOptions) -> u64 {
    texels(options) * (bytes_of_images(options) + BYTES_PER_COMPARED_TEXEL) + of_hierarchies(high)
}

fn texels(options: &BakeOptions) -> u64 {
    u64::from(options.size[0]) * u64::from(options.size[1])
}

/// The bytes of the hierarchies over the high surfaces.
pub fn of_hierarchies(high: &[HighSurface<'_>]) -> u64 {
    let triangles: u64 = high.iter().map(|surface| surface.triangle_count() as u64).sum();
    triangles * bvh::BYTES_PER_TRIANGLE
}

/// The bytes per texel of the images.
fn bytes_of_images(options: &BakeOptions) -> u64 {
    let of_maps: u64 = options.maps.kinds().map(|kind| 4 * kind.channels() as u64).sum();
    of_maps + size_of::<TexelState>() as u64
}

//! The memory of a run, estimated before anything is allocated.

use crate::images::TexelState;
use crate::{BakeOptions, HighSurface, MapKind, bvh, padding};

/// The bytes of two decoded normal maps, of the compared points, and of the hierarchies over the high surfaces.
pub fn needed_to_verify(high: &[HighSurface<'_>], options: &BakeOptions, of_points: u64) -> u64 {
    texels(options) * 24 + of_points + of_hierarchies(high)
}

/// The bytes of the images, of what filling them needs, and of the hierarchies over the high surfaces.
pub fn needed(high: &[HighSurface<'_>], options: &BakeOptions) -> u64 {
    texels(options) * bytes_per_texel(options) + of_hierarchies(high)
}

fn texels(options: &BakeOptions) -> u64 {
    u64::from(options.size[0]) * u64::from(options.size[1])
}

fn of_hierarchies(high: &[HighSurface<'_>]) -> u64 {
    let triangles: u64 = high.iter().map(|surface| surface.triangle_count() as u64).sum();
    triangles * bvh::BYTES_PER_TRIANGLE
}

fn bytes_per_texel(options: &BakeOptions) -> u64 {
    let bytes = |kind: &MapKind| match kind {
        MapKind::Height | MapKind::Occlusion => 4,
        MapKind::Normal | MapKind::ObjectNormal | MapKind::Position => 12,
    };
    let of_maps: u64 = MapKind::ALL.iter().filter(|&&kind| options.maps.has(kind)).map(bytes).sum();
    of_maps + size_of::<TexelState>() as u64 + padding::BYTES_PER_TEXEL
}

//! What black and white mean where that depends on more than an image: the box of positions, and tiles that
//! differ.

use darboux_bake::{BakeOptions, HighSurface};

use super::encode::FileKind;
use super::write::WrittenMap;

/// The extents of the box around the high surfaces along the axes of the map. Coordinates that are not finite
/// do not count.
pub fn of_positions(highs: &[HighSurface<'_>], options: &BakeOptions) -> Vec<[f32; 2]> {
    let conversion = options.surface_convention.generated().to(options.map_convention);
    let mut ranges = vec![[f32::INFINITY, f32::NEG_INFINITY]; 3];
    for surface in highs {
        let positions = surface.mesh().positions();
        for vertex in 0..surface.mesh().vertex_count() {
            let place = conversion.vector(positions.get(vertex));
            for ([from, to], x) in ranges.iter_mut().zip(place).filter(|(_, x)| x.is_finite()) {
                (*from, *to) = (from.min(x), to.max(x));
            }
        }
    }
    ranges
}

/// A warning where black and white mean other numbers in one tile than in another; none for files that have
/// the numbers themselves.
pub fn warning_of_tiles(kind: FileKind, maps: &[WrittenMap]) -> Option<String> {
    let has_codes = |map: &&WrittenMap| kind.has_codes(map.bits);
    let differs = |map: &&WrittenMap| {
        let first = maps.iter().find(|first| first.map == map.map);
        first.is_some_and(|first| first.range != map.range)
    };
    let mut names: Vec<&str> =
        maps.iter().filter(has_codes).filter(differs).map(|map| map.map.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let several = if names.len() == 1 { "has" } else { "have" };
    (!names.is_empty()).then(|| {
        format!(
            "{} {several} a range of its own in each tile, which the file and --json say, so that tiles do not fit \
             together as they are; EXR and TIFF with --bits 32 have the numbers themselves",
            names.join(", ")
        )
    })
}

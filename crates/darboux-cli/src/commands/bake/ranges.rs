//! What black and white mean where that depends on more than an image: the box of positions, and what the
//! tiles of a bake have together.

use darboux_bake::{BakeOptions, HighSurface, MapKind, MapSet, MaterialProperty};

use super::arguments::BakeArguments;
use super::encode::FileKind;
use super::outputs::{maps_of, packs_of};

/// The maps whose range every tile may widen, so that no tile can be encoded before all were baked: of files
/// that have codes, heights, thickness, and light where a high surface may have more than 1.
pub fn maps_of_all_tiles(arguments: &BakeArguments, highs: &[HighSurface<'_>]) -> MapSet {
    let kind = FileKind::of(&arguments.output).unwrap_or(FileKind::Png);
    let maps = maps_of(arguments).into_iter().map(|(map, _)| map);
    let mut coded: Vec<MapKind> =
        maps.filter(|&map| kind.has_codes(arguments.bits_of_map(kind, map))).collect();
    if kind.has_codes(arguments.bits_of_packs(kind)) {
        coded.extend(packs_of(arguments).flat_map(|(pack, _)| &pack.maps));
    }
    let is_bright = |property| highs.iter().any(|high| high.most_light(property) > 1.0);
    coded.retain(|map| match map {
        MapKind::Height | MapKind::Thickness => true,
        MapKind::BaseColor => is_bright(MaterialProperty::BaseColor),
        MapKind::Emission => is_bright(MaterialProperty::Emission),
        _ => false,
    });
    MapSet::of(&coded)
}

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

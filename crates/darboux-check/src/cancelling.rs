//! Mistakes in a map and in the tangents of a surface that cancel each other: bumps look right, and would be
//! inverted if one were repaired alone.

use darboux::Recipe;

use crate::code::Code;
use crate::defect::{Cancelled, Defect, Fault, MapFault, PAIRS, Pair, TangentFault};
use crate::hypotheses::{are_nearly_all_flipped, damaged_under_inverted_map, most_severe};
use crate::severity::Severity;

/// All codes of the pairs.
const CODES: [Code; 4] =
    [Code::MapGreenFlipped, Code::MapRedFlipped, Code::TangentSignFlipped, Code::TangentNegated];

/// The pair of defects, one of a map and one of a surface that uses the map, that cancel each other; none
/// where none do.
pub fn pair_of<'a>(
    on_map: impl IntoIterator<Item = &'a Defect>,
    on_surface: impl IntoIterator<Item = &'a Defect>,
) -> Option<&'static Pair> {
    let is_about_a_part =
        |defect: &Defect| matches!(defect.fault, Fault::Map(MapFault::Contradiction { .. }));
    let on_whole_map = on_map.into_iter().filter(|defect| !is_about_a_part(defect));
    let of_map: Vec<Code> = on_whole_map.map(Defect::code).collect();
    let of_surface: Vec<Code> = on_surface.into_iter().filter_map(code_in_pair).collect();
    PAIRS.iter().find(|pair| are_exactly(&of_map, pair.on_map) && are_exactly(&of_surface, pair.on_surface))
}

/// Whether a defect is a part of a pair.
pub fn is_part(pair: &Pair, defect: &Defect) -> bool {
    code_in_pair(defect).is_some_and(|code| pair.contains(code))
}

/// The code of a defect as a part of a pair. One that lists vertices or triangles is about a part of the
/// surface and none, unless it is about the signs of nearly all of it.
fn code_in_pair(defect: &Defect) -> Option<Code> {
    if are_nearly_all_flipped(defect) {
        Some(Code::TangentSignFlipped)
    } else {
        Some(defect.code()).filter(|_| !defect.lists_items())
    }
}

/// The pair of defects of a map and of each surface.
pub fn pairs_of(on_map: &[Defect], surfaces: &[Vec<&mut Defect>]) -> Vec<Option<&'static Pair>> {
    surfaces.iter().map(|surface| pair_of(on_map, surface.iter().map(|defect| &**defect))).collect()
}

/// Marks the defects of a map and of the surfaces that use the map that cancel each other. The map's defects
/// are marked where they cancel on all surfaces, and their codes are returned. Cancelling defects make no
/// picture wrong: they are a warning, unless much of a surface has other signs, and one finding where the map
/// is marked. `image`: the image of the map. `cancels`: per surface whether all maps that it uses cancel its
/// defects.
pub fn mark(
    on_map: &mut [Defect],
    surfaces: &mut [Vec<&mut Defect>],
    cancels: impl Fn(usize) -> bool,
    image: Option<usize>,
) -> &'static [Code] {
    let mut pairs = pairs_of(on_map, surfaces);
    for (index, pair) in pairs.iter_mut().enumerate() {
        *pair = pair.filter(|_| cancels(index));
    }
    let damaged = pairs.iter().zip(&*surfaces).filter_map(|(pair, surface)| {
        let of_pair = surface.iter().filter(|defect| pair.is_some_and(|pair| is_part(pair, defect)));
        pair.map(|_| of_pair.map(|defect| damaged_under_inverted_map(defect)).sum::<f64>())
    });
    let most = most_severe(damaged.sum());
    let mut severity = Severity::Warning;
    for (pair, surface) in pairs.iter().zip(&mut *surfaces) {
        let Some(pair) = *pair else { continue };
        for defect in surface.iter_mut().filter(|defect| is_part(pair, defect)) {
            defect.cancelled.get_or_insert(Cancelled::ByMap { pair, image, is_whole: false });
            defect.severity = defect.severity.min(most);
            severity = severity.max(defect.severity);
        }
    }
    let first_pair = pairs.first().copied().flatten();
    let Some(pair) = first_pair.filter(|first| pairs.iter().all(|pair| *pair == Some(*first))) else {
        return &[];
    };
    let first = surfaces.iter().flatten().next().map(|defect| defect.place.clone());
    let recipe = fold_recipes(surfaces);
    let is_of_most = surfaces.iter().flatten().any(|defect| defect.lists_items() && is_part(pair, defect));
    for defect in on_map.iter_mut().filter(|defect| is_part(pair, defect)) {
        let (first, are_several) = (first.clone(), surfaces.len() > 1);
        defect.cancelled.get_or_insert(Cancelled::BySurface { pair, first, are_several, is_of_most, recipe });
        defect.severity = defect.severity.min(severity);
    }
    for defect in surfaces.iter_mut().flatten().filter(|defect| is_part(pair, defect)) {
        if let Some(Cancelled::ByMap { image: of, is_whole, .. }) = &mut defect.cancelled {
            *is_whole = *of == image;
        }
    }
    pair.on_map
}

/// The finding of the pair also names the known method of the tangents, which is that of the program that
/// flipped the signs. So the method is no warning of its own. Returns the first one.
fn fold_recipes(surfaces: &mut [Vec<&mut Defect>]) -> Option<Recipe> {
    let mut first = None;
    for defect in surfaces.iter_mut().flatten() {
        let Fault::Tangent(TangentFault::OtherRecipe { recognised, .. }) = &defect.fault else { continue };
        let Some(recipe) = recognised.other_method() else { continue };
        first.get_or_insert(recipe);
        defect.severity = defect.severity.min(Severity::Info);
    }
    first
}

/// Whether these codes of the pairs are among others, and no other ones of the pairs.
fn are_exactly(found: &[Code], codes: &[Code]) -> bool {
    CODES.iter().all(|code| found.contains(code) == codes.contains(code))
}

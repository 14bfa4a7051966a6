//! What [`AddTangentsOptions::strict`](super::AddTangentsOptions::strict) refuses in primitives that get no
//! tangents. In the other primitives it is found while their tangents are computed.

use std::collections::HashSet;

use super::select::{TangentSelection, TangentVerdict};
use crate::Error;
use crate::gltf::Document;
use crate::words::counted;

/// Errors: an attribute of a primitive that is kept or skipped has values that are not finite.
pub fn refuse_unusable_rest(document: &Document, selection: &TangentSelection) -> Result<(), Error> {
    let mut seen = HashSet::new();
    let is_rest = |verdict: &TangentVerdict| !matches!(verdict, TangentVerdict::Chosen(_));
    for name in selection.candidates.iter().filter(|one| is_rest(&one.verdict)).map(|one| &one.name) {
        let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
        for (semantic, &accessor) in &primitive.attributes {
            if !seen.insert(accessor) {
                continue;
            }
            let unusable = match &**semantic {
                "POSITION" | "NORMAL" => not_finite::<3>(document, accessor),
                "TANGENT" => not_finite::<4>(document, accessor),
                set if set.starts_with("TEXCOORD_") => not_finite::<2>(document, accessor),
                _ => 0,
            };
            if unusable > 0 {
                let values = counted(unusable, "value that is not finite", "values that are not finite");
                let problem = format!("has {values} in {semantic}");
                let advice = "repair the model, or run without strict";
                return Err(document.invalid(name.path(), format!("{problem}; {advice}")));
            }
        }
    }
    Ok(())
}

/// The number of vectors that are not finite; 0 where they cannot be read, which is no matter of a primitive
/// that nothing is computed for.
fn not_finite<const N: usize>(document: &Document, accessor: usize) -> usize {
    let vectors = document.vectors::<N>(accessor);
    let count =
        |vectors: &[[f32; N]]| vectors.iter().filter(|vector| !vector.iter().all(|x| x.is_finite())).count();
    vectors.map_or(0, |vectors| count(&vectors))
}

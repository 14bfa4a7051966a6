//! Pairs the tangents of two documents of one model, corner by corner.

use super::primitives::corners::{PrimitiveCorners, triangle_count};
use super::primitives::limits;
use super::primitives::triangles::{TriangleMode, mode_name};
use super::tangents::AddTangentsOptions;
use super::tangents::select::{TangentCandidate, select};
use super::{Document, PrimitiveName, schema};
use crate::Error;

/// A primitive of both documents.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The primitive. Mesh and primitive have the same indices in both documents.
    pub name: PrimitiveName,
    /// The corners, or the reason why they cannot be compared.
    pub corners: Result<PairedCorners, Unpaired>,
}

/// The reason why a primitive cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unpaired {
    /// The reason, as a sentence.
    pub reason: String,
    /// Whether exactly one of the documents has tangents.
    pub is_one_sided: bool,
}

/// The corners of a primitive, three per triangle, in the order of the files.
#[derive(Clone, Debug, Default)]
pub struct PairedCorners {
    /// The positions in the first document.
    pub positions: Vec<[f32; 3]>,
    /// The UVs in the first document, of the set that its tangents follow, if it has that set.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// The tangents of both documents.
    pub tangents: [Vec<[f32; 4]>; 2],
    /// The number of corners with another position in the second document.
    pub moved: usize,
}

/// Pairs the primitives of two documents by the indices of mesh and primitive. Compressed documents are decompressed.
///
/// Errors: different numbers of meshes, primitives or corners; invalid data of a primitive with tangents.
pub fn pair_tangents(a: &mut Document, b: &mut Document) -> Result<Vec<Pair>, Error> {
    for document in [&mut *a, &mut *b] {
        if document.is_compressed() {
            document.decompress()?;
        }
        limits::check_triangles(document, triangle_counts(document))?;
    }
    let shape = |document: &Document| -> Vec<usize> {
        document.meshes().iter().map(|mesh| mesh.primitives.len()).collect()
    };
    if shape(a) != shape(b) {
        let problem = format!("has other meshes or primitives than {}; compare files of one model", a.name());
        return Err(b.invalid("meshes", problem));
    }
    let options = AddTangentsOptions::default().with_overwrite(true);
    select(a, &options, &|_| true)?.candidates.iter().map(|candidate| pair(a, b, candidate)).collect()
}

/// The number of triangles of every primitive with tangents, by the counts of its accessors.
fn triangle_counts(document: &Document) -> impl Iterator<Item = usize> {
    let primitives = document.meshes().iter().flat_map(|mesh| &mesh.primitives).filter(|p| has_tangents(p));
    primitives.filter_map(|primitive| triangle_count(document, primitive))
}

fn has_tangents(primitive: &schema::Primitive) -> bool {
    primitive.attributes.contains_key("TANGENT")
}

fn pair(a: &Document, b: &Document, candidate: &TangentCandidate) -> Result<Pair, Error> {
    let name = &candidate.name;
    let [first, second] = [a, b].map(|document| &document.meshes()[name.mesh].primitives[name.primitive]);
    if let Some(unpaired) = unpaired([a, b], [first, second]) {
        return Ok(Pair { name: name.clone(), corners: Err(unpaired) });
    }
    let [corners, others] = [corners(a, name, first)?, corners(b, name, second)?];
    if corners.len() != others.len() {
        let problem = format!(
            "has {} corners, but {} in {}; compare files of one model",
            others.len(),
            corners.len(),
            a.name()
        );
        return Err(b.invalid(name.path(), problem));
    }
    let positions = corners.vectors::<3>("POSITION")?.unwrap_or_default();
    let moved = others.vectors::<3>("POSITION")?.unwrap_or_default();
    let tangents = corners.vectors("TANGENT")?.unwrap_or_default();
    let other_tangents = others.vectors("TANGENT")?.unwrap_or_default();
    let uvs = corners.vectors(&format!("TEXCOORD_{}", candidate.uv.set))?;
    let moved = positions.iter().zip(&moved).filter(|(position, moved)| position != moved).count();
    let tangents = [tangents, other_tangents];
    Ok(Pair { corners: Ok(PairedCorners { positions, uvs, tangents, moved }), name: name.clone() })
}

/// The reason why two primitives cannot be compared, if there is one.
fn unpaired([a, b]: [&Document; 2], [first, second]: [&schema::Primitive; 2]) -> Option<Unpaired> {
    let reason = match (has_tangents(first), has_tangents(second)) {
        (true, true) if TriangleMode::from_mode(first.mode).is_some() => return None,
        (true, true) => {
            let mode = mode_name(first.mode).unwrap_or("unknown");
            format!("its mode is {mode}; only triangles are compared")
        }
        (false, true) => format!("it has no tangents in {}", a.name()),
        (true, false) => format!("it has no tangents in {}", b.name()),
        (false, false) => "it has no tangents in either".to_owned(),
    };
    Some(Unpaired { reason, is_one_sided: has_tangents(first) != has_tangents(second) })
}

fn corners<'a>(
    document: &'a Document,
    name: &PrimitiveName,
    primitive: &'a schema::Primitive,
) -> Result<PrimitiveCorners<'a>, Error> {
    PrimitiveCorners::find(document, name, primitive)?.ok_or_else(|| {
        document.invalid(name.path(), "has another mode in the other file; compare files of one model")
    })
}

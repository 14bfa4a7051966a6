//! The tangents of two documents of one model, corner by corner.

use darboux::MeshError;

use super::tangents::select::{Candidate, element_count, select};
use super::tangents::topology::{Topology, mode_name};
use super::tangents::{PrimitiveName, TangentsOptions, excess};
use super::{Document, schema};
use crate::Error;

/// A primitive of both documents.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Which one: mesh and primitive have the same numbers in both.
    pub name: PrimitiveName,
    /// Its corners, or why there is nothing to compare.
    pub corners: Result<PairedCorners, Unpaired>,
}

/// A primitive without tangents on both sides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unpaired {
    /// Why, as a sentence.
    pub reason: String,
    /// Whether one side has tangents.
    pub is_one_sided: bool,
}

/// The corners of a primitive, three per triangle, in the order of the files.
#[derive(Clone, Debug, Default)]
pub struct PairedCorners {
    /// Positions in the first document.
    pub positions: Vec<[f32; 3]>,
    /// UVs in the first document, of the set that its tangents follow; none where it has no such set.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// Tangents of both.
    pub tangents: [Vec<[f32; 4]>; 2],
    /// How many corners have another position in the second document.
    pub moved: usize,
}

/// Pairs the primitives of two documents by the numbers of mesh and primitive. Compressed documents are decompressed.
///
/// Errors: other numbers of meshes, primitives or corners; broken data behind a primitive with tangents.
pub fn pair_tangents(a: &mut Document, b: &mut Document) -> Result<Vec<Pair>, Error> {
    for document in [&mut *a, &mut *b] {
        if document.is_compressed() {
            document.decompress()?;
        }
        excess::check_triangles(document, triangle_counts(document))?;
    }
    let shape = |document: &Document| -> Vec<usize> {
        document.meshes().iter().map(|mesh| mesh.primitives.len()).collect()
    };
    if shape(a) != shape(b) {
        let problem = format!("has other meshes or primitives than {}; compare files of one model", a.name());
        return Err(b.invalid("meshes", problem));
    }
    let options = TangentsOptions { overwrite: true, ..TangentsOptions::default() };
    select(a, &options)?.candidates.iter().map(|candidate| pair(a, b, candidate)).collect()
}

/// The triangles of every primitive with tangents, as its accessors claim them.
fn triangle_counts(document: &Document) -> impl Iterator<Item = usize> {
    let primitives = document.meshes().iter().flat_map(|mesh| &mesh.primitives).filter(|p| has_tangents(p));
    primitives.filter_map(|primitive| {
        let source = primitive.indices.or_else(|| primitive.attributes.get("POSITION").copied());
        let count =
            source.and_then(|accessor| document.accessors().get(accessor)).map_or(0, |found| found.count);
        Topology::from_mode(primitive.mode).map(|topology| topology.triangle_count(count))
    })
}

fn has_tangents(primitive: &schema::Primitive) -> bool {
    primitive.attributes.contains_key("TANGENT")
}

fn pair(a: &Document, b: &Document, candidate: &Candidate) -> Result<Pair, Error> {
    let name = candidate.name.clone();
    let [first, second] = [a, b].map(|document| &document.meshes()[name.mesh].primitives[name.primitive]);
    if let Some(unpaired) = unpaired([a, b], [first, second]) {
        return Ok(Pair { name, corners: Err(unpaired) });
    }
    let [corners, others] = [corners(a, &name, first)?, corners(b, &name, second)?];
    if corners.len() != others.len() {
        let problem = format!(
            "has {} corners, but {} in {}; compare files of one model",
            others.len(),
            corners.len(),
            a.name()
        );
        return Err(b.invalid(name.path(), problem));
    }
    let positions = gather::<3>(a, &name, first, "POSITION", &corners)?.unwrap_or_default();
    let moved = gather::<3>(b, &name, second, "POSITION", &others)?.unwrap_or_default();
    let tangents = gather(a, &name, first, "TANGENT", &corners)?.unwrap_or_default();
    let other_tangents = gather(b, &name, second, "TANGENT", &others)?.unwrap_or_default();
    let uvs = gather(a, &name, first, &format!("TEXCOORD_{}", candidate.uv.set), &corners)?;
    let moved = positions.iter().zip(&moved).filter(|(position, moved)| position != moved).count();
    let tangents = [tangents, other_tangents];
    Ok(Pair { corners: Ok(PairedCorners { positions, uvs, tangents, moved }), name })
}

/// Why there is nothing to compare, if there is nothing.
fn unpaired([a, b]: [&Document; 2], [first, second]: [&schema::Primitive; 2]) -> Option<Unpaired> {
    let reason = match (has_tangents(first), has_tangents(second)) {
        (true, true) if Topology::from_mode(first.mode).is_some() => return None,
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

/// The vertices of all whole triangles, three each.
fn corners(
    document: &Document,
    name: &PrimitiveName,
    primitive: &schema::Primitive,
) -> Result<Vec<u32>, Error> {
    let Some(topology) = Topology::from_mode(primitive.mode) else {
        return Err(
            document.invalid(name.path(), "has another mode in the other file; compare files of one model")
        );
    };
    let mut indices = match (primitive.indices, primitive.attributes.get("POSITION")) {
        (Some(accessor), _) => document.read_indices(accessor)?,
        (None, Some(&position)) => (0..element_count(document, position)? as u32).collect(),
        (None, None) => Vec::new(),
    };
    indices.truncate(topology.whole(indices.len()));
    Ok(topology.corners(indices))
}

/// An attribute at every corner; none where the primitive does not have it. Errors: an index out of range.
fn gather<const N: usize>(
    document: &Document,
    name: &PrimitiveName,
    primitive: &schema::Primitive,
    semantic: &str,
    corners: &[u32],
) -> Result<Option<Vec<[f32; N]>>, Error> {
    let Some(&accessor) = primitive.attributes.get(semantic) else { return Ok(None) };
    let vectors = document.vectors::<N>(accessor)?;
    let vertices = vectors.len();
    let at = |(at, &index): (usize, &u32)| {
        let vector = vectors.get(index as usize).copied();
        vector.ok_or_else(|| {
            document.mesh_error(name.path(), MeshError::IndexOutOfRange { at, index, vertices })
        })
    };
    corners.iter().enumerate().map(at).collect::<Result<_, _>>().map(Some)
}

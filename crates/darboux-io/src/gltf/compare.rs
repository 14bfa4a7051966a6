//! Pairs the tangents of two documents of one model, corner by corner.

use std::borrow::Cow;

use super::primitives::corners::{PrimitiveCorners, triangle_count};
use super::primitives::limits;
use super::primitives::triangles::{TriangleMode, mode_name};
use super::tangents::AddTangentsOptions;
use super::tangents::select::{TangentCandidate, select};
use super::{Document, PrimitiveName, schema};
use crate::Error;
use crate::words::counted;

/// A primitive of both documents.
#[derive(Clone, Debug)]
pub struct Pair<'a> {
    /// The primitive. Mesh and primitive have the same indices in both documents.
    pub name: PrimitiveName,
    /// The corners, or the reason why they cannot be compared.
    pub corners: Result<PairedCorners<'a>, Unpaired>,
}

/// The reason why a primitive cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unpaired {
    /// The reason, as a sentence.
    pub reason: String,
    /// Whether exactly one of the documents has tangents.
    pub is_one_sided: bool,
}

/// The corners of a primitive, three per triangle, in the order of the files. Values are stored per vertex,
/// borrowed from the files if their layout permits; of vertices that many primitives share, only those are
/// stored that this primitive uses.
#[derive(Clone, Debug, Default)]
pub struct PairedCorners<'a> {
    /// The vertex of each corner in the first document. It is a vertex of all arrays of that document.
    pub vertices: Vec<u32>,
    /// The vertex of each corner in the second document. `None` if all are as in the first document.
    pub other_vertices: Option<Vec<u32>>,
    /// The positions of the first document's vertices; empty if it has none.
    pub positions: Cow<'a, [[f32; 3]]>,
    /// The UVs of the first document's vertices, of the set that its tangents follow, if it has that set.
    pub uvs: Option<Cow<'a, [[f32; 2]]>>,
    /// The tangents of the vertices of both documents.
    pub tangents: [Cow<'a, [[f32; 4]]>; 2],
    /// The number of corners with another position in the second document.
    pub moved: usize,
}

impl PairedCorners<'_> {
    /// The number of corners.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// Whether there are no corners.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty()
    }

    /// The tangents of a corner in both documents. Panics: there is no such corner.
    pub fn tangents(&self, corner: usize) -> [[f32; 4]; 2] {
        let [first, second] = self.vertices_of(corner);
        [self.tangents[0][first], self.tangents[1][second]]
    }

    /// The position of a corner in the first document, if it has positions.
    pub fn position(&self, corner: usize) -> Option<[f32; 3]> {
        self.positions.get(*self.vertices.get(corner)? as usize).copied()
    }

    /// The UV of a corner in the first document, if it has the set.
    pub fn uv(&self, corner: usize) -> Option<[f32; 2]> {
        self.uvs.as_ref()?.get(*self.vertices.get(corner)? as usize).copied()
    }

    fn vertices_of(&self, corner: usize) -> [usize; 2] {
        let second = self.other_vertices.as_ref().unwrap_or(&self.vertices);
        [self.vertices[corner] as usize, second[corner] as usize]
    }
}

/// Pairs the primitives of two documents by the indices of mesh and primitive.
///
/// Errors: different numbers of meshes, primitives or corners; invalid data of a primitive with tangents.
pub fn pair_tangents<'a>(a: &'a Document, b: &'a Document) -> Result<Vec<Pair<'a>>, Error> {
    for document in [a, b] {
        limits::check_triangles(document, triangle_counts(document))?;
    }
    let shape = |document: &Document| -> Vec<usize> {
        document.meshes().iter().map(|mesh| mesh.primitives.len()).collect()
    };
    if shape(a) != shape(b) {
        return Err(other_meshes(a, b, &shape(a), &shape(b)));
    }
    let options = AddTangentsOptions::default().with_overwrite(true);
    select(a, &options, &|_| true)?.candidates.iter().map(|candidate| pair(a, b, candidate)).collect()
}

/// The error of documents whose meshes do not pair. `of_a`, `of_b`: the number of primitives of each mesh.
fn other_meshes(a: &Document, b: &Document, of_a: &[usize], of_b: &[usize]) -> Error {
    let advice =
        "compare files of one model with the same meshes (a PLY has one for all, an STL one per solid)";
    let mut pairs = of_a.iter().zip(of_b).enumerate();
    match pairs.find(|(_, (a, b))| a != b) {
        Some((mesh, (of_a, of_b))) if a.meshes().len() == b.meshes().len() => {
            let primitives = counted(*of_b, "primitive", "primitives");
            let problem = format!("has {primitives}, but {of_a} in {}; {advice}", a.name());
            b.invalid(format!("meshes[{mesh}]"), problem)
        }
        _ => {
            let meshes = counted(of_b.len(), "mesh", "meshes");
            b.invalid("meshes", format!("has {meshes}, but {} has {}; {advice}", a.name(), of_a.len()))
        }
    }
}

/// The number of triangles of every primitive with tangents, by the counts of its accessors.
fn triangle_counts(document: &Document) -> impl Iterator<Item = usize> {
    let primitives = document.meshes().iter().flat_map(|mesh| &mesh.primitives).filter(|p| has_tangents(p));
    primitives.filter_map(|primitive| triangle_count(document, primitive))
}

fn has_tangents(primitive: &schema::Primitive) -> bool {
    primitive.attributes.contains_key("TANGENT")
}

fn pair<'a>(a: &'a Document, b: &'a Document, candidate: &TangentCandidate) -> Result<Pair<'a>, Error> {
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
    let positions = corners.used_vectors("POSITION")?.unwrap_or_default();
    let moved = others.used_vectors::<3>("POSITION")?.unwrap_or_default();
    let tangents = [
        corners.used_vectors("TANGENT")?.unwrap_or_default(),
        others.used_vectors("TANGENT")?.unwrap_or_default(),
    ];
    let uvs = corners.used_vectors(&format!("TEXCOORD_{}", candidate.uv.set))?;
    let both = corners.used_indices().iter().zip(others.used_indices());
    let positions_of =
        |(first, second): (&u32, &u32)| Some((positions.get(*first as usize)?, moved.get(*second as usize)?));
    let moved = both.filter_map(positions_of).filter(|(position, moved)| position != moved).count();
    let other_vertices =
        (corners.used_indices() != others.used_indices()).then(|| others.into_used_indices());
    let vertices = corners.into_used_indices();
    let corners = PairedCorners { vertices, other_vertices, positions, uvs, tangents, moved };
    Ok(Pair { name: name.clone(), corners: Ok(corners) })
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

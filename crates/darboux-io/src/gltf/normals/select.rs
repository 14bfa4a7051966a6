//! Selects the primitives that get normals, with a reason for each of the others.

use super::options::AddNormalsOptions;
use super::summary::{NormalsOutcome, WrittenNormals};
use crate::Error;
use crate::gltf::primitives::element_count;
use crate::gltf::primitives::triangles::{TriangleMode, mode_name};
use crate::gltf::schema::Primitive;
use crate::gltf::{Document, PrimitiveName};

/// The wanted primitives of a document, in its order, each with a verdict.
#[derive(Debug)]
pub struct NormalSelection {
    pub candidates: Vec<NormalCandidate>,
}

/// A primitive and the verdict on it.
#[derive(Debug)]
pub struct NormalCandidate {
    pub name: PrimitiveName,
    pub verdict: NormalVerdict,
}

/// Whether a primitive gets normals.
#[derive(Debug)]
pub enum NormalVerdict {
    /// The primitive gets normals.
    Chosen(NormalInput),
    /// The primitive keeps its normals, for a reason.
    Kept(String),
    /// The primitive gets no normals, for a reason.
    Skipped(String),
}

/// The input of a computation of normals.
#[derive(Clone, Copy, Debug)]
pub struct NormalInput {
    pub position: usize,
    pub indices: Option<usize>,
    pub topology: TriangleMode,
    pub index_count: usize,
}

impl NormalInput {
    pub fn triangle_count(&self) -> usize {
        self.topology.triangle_count(self.index_count)
    }
}

impl NormalVerdict {
    /// The outcome. `written` gives the report of a chosen primitive.
    pub fn outcome(self, written: impl FnOnce() -> WrittenNormals) -> NormalsOutcome {
        match self {
            Self::Chosen(_) => NormalsOutcome::Written(written()),
            Self::Kept(reason) => NormalsOutcome::Kept { reason },
            Self::Skipped(reason) => NormalsOutcome::Skipped { reason },
        }
    }
}

impl NormalSelection {
    /// The candidates that get normals, with their indices.
    pub fn chosen(&self) -> impl Iterator<Item = (usize, &NormalInput)> {
        self.candidates.iter().enumerate().filter_map(|(place, candidate)| match &candidate.verdict {
            NormalVerdict::Chosen(chosen) => Some((place, chosen)),
            NormalVerdict::Kept(_) | NormalVerdict::Skipped(_) => None,
        })
    }
}

/// Selects primitives. Errors: accessors that do not exist.
pub fn select(
    document: &Document,
    options: &AddNormalsOptions,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
) -> Result<NormalSelection, Error> {
    let mut candidates = Vec::new();
    for (index, mesh) in document.meshes().iter().enumerate() {
        for (place, primitive) in mesh.primitives.iter().enumerate() {
            let name = PrimitiveName::new(index, mesh, place);
            if is_wanted(&name) {
                let verdict = judge(document, primitive, options)?;
                candidates.push(NormalCandidate { name, verdict });
            }
        }
    }
    Ok(NormalSelection { candidates })
}

fn judge(
    document: &Document,
    primitive: &Primitive,
    options: &AddNormalsOptions,
) -> Result<NormalVerdict, Error> {
    let skipped = |reason: &str| Ok(NormalVerdict::Skipped(reason.to_owned()));
    let Some(topology) = TriangleMode::from_mode(primitive.mode) else {
        let mode = mode_name(primitive.mode).unwrap_or("unknown");
        return Ok(NormalVerdict::Skipped(format!("its mode is {mode}; only triangles get normals")));
    };
    if primitive.attributes.contains_key("NORMAL") && !options.overwrite {
        return Ok(NormalVerdict::Kept("it has normals already".to_owned()));
    }
    let Some(&position) = primitive.attributes.get("POSITION") else {
        return skipped("it has no POSITION, which normals need");
    };
    let vertex_count = element_count(document, position)?;
    let index_count =
        primitive.indices.map_or(Ok(vertex_count), |indices| element_count(document, indices))?;
    let chosen = NormalInput { position, indices: primitive.indices, topology, index_count };
    if chosen.triangle_count() == 0 {
        skipped("it has no complete triangle")
    } else {
        Ok(NormalVerdict::Chosen(chosen))
    }
}

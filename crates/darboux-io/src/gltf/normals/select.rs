//! Selects the primitives that get normals, with a reason for each of the others.

use super::options::NormalsOptions;
use super::summary::{NormalsOutcome, WrittenNormals};
use crate::Error;
use crate::gltf::primitives::element_count;
use crate::gltf::primitives::triangles::{TriangleMode, mode_name};
use crate::gltf::schema::Primitive;
use crate::gltf::{Document, PrimitiveName};

/// Every primitive of a document, in its order, with a verdict.
#[derive(Debug)]
pub struct Selection {
    pub candidates: Vec<Candidate>,
}

/// A primitive and the verdict on it.
#[derive(Debug)]
pub struct Candidate {
    pub name: PrimitiveName,
    pub verdict: Verdict,
}

/// Whether a primitive gets normals.
#[derive(Debug)]
pub enum Verdict {
    /// The primitive gets normals.
    Chosen(Chosen),
    /// The primitive keeps its normals, for a reason.
    Kept(String),
    /// The primitive gets no normals, for a reason.
    Skipped(String),
}

/// The input of a computation of normals.
#[derive(Clone, Copy, Debug)]
pub struct Chosen {
    pub position: usize,
    pub indices: Option<usize>,
    pub topology: TriangleMode,
    pub index_count: usize,
}

impl Chosen {
    pub fn triangle_count(&self) -> usize {
        self.topology.triangle_count(self.index_count)
    }
}

impl Verdict {
    /// The outcome. `written` gives the report of a chosen primitive.
    pub fn outcome(self, written: impl FnOnce() -> WrittenNormals) -> NormalsOutcome {
        match self {
            Self::Chosen(_) => NormalsOutcome::Written(written()),
            Self::Kept(reason) => NormalsOutcome::Kept { reason },
            Self::Skipped(reason) => NormalsOutcome::Skipped { reason },
        }
    }
}

impl Selection {
    /// The candidates that get normals, with their indices.
    pub fn chosen(&self) -> impl Iterator<Item = (usize, &Chosen)> {
        self.candidates.iter().enumerate().filter_map(|(place, candidate)| match &candidate.verdict {
            Verdict::Chosen(chosen) => Some((place, chosen)),
            Verdict::Kept(_) | Verdict::Skipped(_) => None,
        })
    }
}

/// Selects primitives. Errors: accessors that do not exist, unknown modes.
pub fn select(document: &Document, options: &NormalsOptions) -> Result<Selection, Error> {
    let mut candidates = Vec::new();
    for (index, mesh) in document.meshes().iter().enumerate() {
        for (place, primitive) in mesh.primitives.iter().enumerate() {
            let name = PrimitiveName { mesh: index, mesh_name: mesh.name.clone(), primitive: place };
            let verdict = judge(document, &name, primitive, options)?;
            candidates.push(Candidate { name, verdict });
        }
    }
    Ok(Selection { candidates })
}

fn judge(
    document: &Document,
    name: &PrimitiveName,
    primitive: &Primitive,
    options: &NormalsOptions,
) -> Result<Verdict, Error> {
    let skipped = |reason: &str| Ok(Verdict::Skipped(reason.to_owned()));
    let Some(mode) = mode_name(primitive.mode) else {
        let problem = format!("{} is not a mode; use 0 to 6", primitive.mode);
        return Err(document.invalid(format!("{}.mode", name.path()), problem));
    };
    let Some(topology) = TriangleMode::from_mode(primitive.mode) else {
        return Ok(Verdict::Skipped(format!("its mode is {mode}; only triangles get normals")));
    };
    if primitive.attributes.contains_key("NORMAL") && !options.overwrite {
        return Ok(Verdict::Kept("it has normals already".to_owned()));
    }
    let Some(&position) = primitive.attributes.get("POSITION") else {
        return skipped("it has no POSITION, which normals need");
    };
    let vertex_count = element_count(document, position)?;
    let index_count =
        primitive.indices.map_or(Ok(vertex_count), |indices| element_count(document, indices))?;
    let chosen = Chosen { position, indices: primitive.indices, topology, index_count };
    if chosen.triangle_count() == 0 {
        skipped("it has no complete triangle")
    } else {
        Ok(Verdict::Chosen(chosen))
    }
}

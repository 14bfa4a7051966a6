//! Describes every primitive of a document: its attributes, and the tangents that it could have.

use darboux::{Context, Convention};
use serde::Serialize;

use super::primitives::canonical::CanonicalAccessors;
use super::primitives::limits;
use super::primitives::triangles::{TriangleMode, mode_name};
use super::tangents::compute::{self, Generate, Vertices};
use super::tangents::groups;
use super::tangents::select::{self, TangentCandidate};
use super::tangents::{AddTangentsOptions, ReportCounts};
use super::{Document, PrimitiveName};
use crate::Error;

/// The result of [`inspect`] for a primitive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PrimitiveInfo {
    /// The primitive.
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// The mode: `TRIANGLES`, `TRIANGLE_STRIP`, `POINTS` and so on.
    pub mode: &'static str,
    /// The number of vertices.
    pub vertices: usize,
    /// The semantics of its attributes.
    pub attributes: Vec<String>,
    /// The number of morph targets.
    pub morph_targets: usize,
    /// The UV set n of `TEXCOORD_n` that its tangents follow.
    pub uv_set: usize,
    /// The reason for this set: the texture that uses it, or that no texture does.
    pub uv_reason: String,
    /// Whether it has tangents.
    pub has_tangents: bool,
    /// Whether its material uses tangents.
    pub needs_tangents: bool,
    /// The reason why tangents cannot be computed, as a sentence; none if they can.
    pub ineligible: Option<String>,
    /// The number of triangles whose texture is mirrored.
    pub mirrored_triangles: usize,
    /// Counts of its triangles and of degenerate data.
    #[serde(flatten)]
    pub counts: ReportCounts,
}

/// Describes every primitive of a document. The tangents that it could have are computed and not written.
///
/// Errors: invalid data of a primitive that can have tangents.
pub fn inspect(document: &Document) -> Result<Vec<PrimitiveInfo>, Error> {
    let options = AddTangentsOptions::default().with_overwrite(true);
    let selection = select::select(document, &options, &|_| true)?;
    let groups = groups::group(&CanonicalAccessors::new(document), selection.chosen(), |_| None);
    limits::check_triangles(document, groups::triangle_counts(&groups))?;
    let mut context = Context::new();
    let mut infos: Vec<_> =
        selection.candidates.iter().map(|candidate| describe(document, candidate)).collect();
    for group in &groups {
        let mut vertices = Vertices::read_used(document, group)?;
        let mut found = Vec::with_capacity(group.jobs.len());
        for job in &group.jobs {
            let name = infos[job.first].name.clone();
            let generate = (&mut Generate::OnCpu, &mut context);
            let result =
                compute::compute_job(document, &name, &mut vertices, job, false, &options, generate)?;
            found.push((result.report.into(), mirrored_triangles(&result.tangents)));
        }
        for member in &group.members {
            let info = &mut infos[member.candidate];
            (info.counts, info.mirrored_triangles) = found[member.job];
        }
    }
    Ok(infos)
}

/// The description of a primitive by its JSON.
fn describe(document: &Document, candidate: &TangentCandidate) -> PrimitiveInfo {
    let name = candidate.name.clone();
    let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
    let count = |accessor: usize| document.accessors().get(accessor).map_or(0, |accessor| accessor.count);
    let vertices = primitive.attributes.get("POSITION").map_or(0, |&accessor| count(accessor));
    let corners = primitive.indices.map_or(vertices, count);
    let triangles =
        TriangleMode::from_mode(primitive.mode).map_or(0, |topology| topology.triangle_count(corners));
    PrimitiveInfo {
        mode: mode_name(primitive.mode).unwrap_or_default(),
        vertices,
        attributes: primitive.attributes.keys().cloned().collect(),
        morph_targets: primitive.targets.len(),
        uv_set: candidate.uv.set,
        uv_reason: candidate.uv.reason.clone(),
        has_tangents: primitive.attributes.contains_key("TANGENT"),
        needs_tangents: candidate.needs_tangents,
        ineligible: candidate.verdict.reason().map(str::to_owned),
        mirrored_triangles: 0,
        counts: ReportCounts { triangles, ..ReportCounts::default() },
        name,
    }
}

/// Counts triangles whose sign is that of a mirrored texture.
fn mirrored_triangles(tangents: &[[f32; 4]]) -> usize {
    let to_gltf = Convention::GLTF.generated().to(Convention::GLTF);
    let triangles = tangents.as_chunks::<3>().0.iter();
    triangles.filter(|[first, ..]| to_gltf.tangent(*first)[3] < 0.0).count()
}

//! What a document holds, per primitive, without changing it.

use darboux::{Context, Convention, CornerTangents};
use serde::Serialize;

use super::primitives::canonical::CanonicalAccessors;
use super::primitives::limits;
use super::primitives::triangles::{TriangleMode, mode_name};
use super::tangents::compute::{self, Generate, Vertices};
use super::tangents::groups;
use super::tangents::select::{Candidate, Verdict};
use super::tangents::{Counts, TangentsOptions, select_readable};
use super::{Document, PrimitiveName};
use crate::Error;

/// What [`inspect`] finds out about a primitive.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PrimitiveInfo {
    /// Which one.
    #[serde(flatten)]
    pub name: PrimitiveName,
    /// `TRIANGLES`, `TRIANGLE_STRIP`, `POINTS` and so on.
    pub mode: &'static str,
    /// The length of its vertex attributes.
    pub vertices: usize,
    /// Its attributes, as the file names them.
    pub attributes: Vec<String>,
    /// The number of morph targets.
    pub morph_targets: usize,
    /// The UV set that its tangents follow: n of `TEXCOORD_n`.
    pub uv_set: usize,
    /// Why this one: the texture that names it, or that none does.
    pub uv_reason: String,
    /// Whether it has tangents.
    pub has_tangents: bool,
    /// Whether its material uses tangents.
    pub needs_tangents: bool,
    /// Why tangents cannot be computed, as a sentence; none where they can.
    pub ineligible: Option<String>,
    /// Triangles whose texture is mirrored.
    pub mirrored_triangles: usize,
    /// Its triangles, and what computing their tangents meets.
    #[serde(flatten)]
    pub counts: Counts,
}

/// Looks at every primitive of the document, computing the tangents that it could have without writing them.
///
/// Compressed documents are decompressed. Errors: broken data behind a primitive that can have tangents.
pub fn inspect(document: &mut Document) -> Result<Vec<PrimitiveInfo>, Error> {
    let options = TangentsOptions { overwrite: true, ..TangentsOptions::default() };
    let selection = select_readable(document, &options)?;
    let groups = groups::group(&CanonicalAccessors::new(document), selection.chosen());
    limits::check_triangles(document, groups::triangle_counts(&groups))?;
    let mut context = Context::new();
    let mut infos: Vec<_> =
        selection.candidates.iter().map(|candidate| describe(document, candidate)).collect();
    for group in &groups {
        let mut vertices = Vertices::read(document, group)?;
        let mut found = Vec::with_capacity(group.jobs.len());
        for job in &group.jobs {
            let at = infos[job.first].name.path();
            let on_cpu = (&mut compute::on_cpu as &mut Generate<'_>, &mut context);
            let result = compute::compute_job(document, &at, &mut vertices, job, false, &options, on_cpu)?;
            found.push((result.report.into(), mirrored_triangles(&result.tangents)));
        }
        for member in &group.members {
            let info = &mut infos[member.candidate];
            (info.counts, info.mirrored_triangles) = found[member.job];
        }
    }
    Ok(infos)
}

/// What the JSON says about a primitive.
fn describe(document: &Document, candidate: &Candidate) -> PrimitiveInfo {
    let name = candidate.name.clone();
    let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
    let count = |accessor: usize| document.accessors().get(accessor).map_or(0, |accessor| accessor.count);
    let vertices = primitive.attributes.get("POSITION").map_or(0, |&accessor| count(accessor));
    let corners = primitive.indices.map_or(vertices, count);
    let triangles =
        TriangleMode::from_mode(primitive.mode).map_or(0, |topology| topology.triangle_count(corners));
    let ineligible = match &candidate.verdict {
        Verdict::Chosen(_) => None,
        Verdict::Kept(reason) | Verdict::Skipped(reason) => Some(reason.clone()),
    };
    PrimitiveInfo {
        mode: mode_name(primitive.mode).unwrap_or_default(),
        vertices,
        attributes: primitive.attributes.keys().cloned().collect(),
        morph_targets: primitive.targets.len(),
        uv_set: candidate.uv.set,
        uv_reason: candidate.uv.reason.clone(),
        has_tangents: primitive.attributes.contains_key("TANGENT"),
        needs_tangents: candidate.needs_tangents,
        ineligible,
        mirrored_triangles: 0,
        counts: Counts { triangles, ..Counts::default() },
        name,
    }
}

/// Triangles whose sign says that they show their texture mirrored.
fn mirrored_triangles(tangents: &CornerTangents) -> usize {
    let to_gltf = Convention::GLTF.generated().to(Convention::GLTF);
    let triangles = tangents.per_corner().as_chunks::<3>().0.iter();
    triangles.filter(|[first, ..]| to_gltf.tangent(*first)[3] < 0.0).count()
}

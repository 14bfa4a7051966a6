//! Adds normals to the primitives of a document and keeps everything else.
//!
//! ```text
//! select    which primitives get normals
//! compute   normals per corner, mesh by mesh, at rest and for every morph target
//! write     splits the vertices of each accessor of positions jointly, and writes new accessors
//! ```

mod compute;
mod options;
mod select;
mod summary;
mod write;

pub use options::AddNormalsOptions;
pub use summary::{NormalsOutcome, NormalsSummary, PrimitiveNormals, WrittenNormals};

use std::collections::{BTreeMap, BTreeSet};

use darboux::Context;

use super::Document;
use super::PrimitiveName;
use super::Progress;
use super::primitives::canonical::CanonicalAccessors;
use super::primitives::limits;
use crate::Error;
use compute::ShadedPrimitive;
use select::{NormalSelection, select};

/// Adds normals to every triangle primitive. The primitives of one mesh are shaded as one surface.
///
/// Tangents that belonged to other normals are removed. Morph targets with position offsets get normal
/// offsets. A document with nothing to do stays unchanged. Errors: invalid data of a primitive that gets
/// normals; more corners than the memory limit permits. After an error the document is unspecified: drop it.
pub fn add_normals(
    document: &mut Document,
    options: &AddNormalsOptions,
    progress: &mut dyn FnMut(Progress),
) -> Result<NormalsSummary, Error> {
    add_normals_with(document, options, &mut Context::new(), progress)
}

/// As [`add_normals`], with a context. Further error: the context's token was cancelled.
pub fn add_normals_with(
    document: &mut Document,
    options: &AddNormalsOptions,
    context: &mut Context,
    progress: &mut dyn FnMut(Progress),
) -> Result<NormalsSummary, Error> {
    add_normals_to(document, options, &|_| true, context, progress)
}

/// As [`add_normals_with`], for the primitives that `is_wanted` accepts. The others keep what they have, and
/// do not count as parts of their meshes.
pub fn add_normals_to(
    document: &mut Document,
    options: &AddNormalsOptions,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
    context: &mut Context,
    progress: &mut dyn FnMut(Progress),
) -> Result<NormalsSummary, Error> {
    let selection = select(document, options, is_wanted)?;
    let accessors = CanonicalAccessors::new(document);
    limits::check_triangles(document, selection.chosen().map(|(_, chosen)| chosen.triangle_count()))?;
    check_vertices(document, &accessors, &selection)?;
    let parts = compute::shade(document, &accessors, &selection, (&options.normals, context), progress)?;
    let mut parts_of_position: BTreeMap<usize, Vec<&ShadedPrimitive>> = BTreeMap::new();
    for part in &parts {
        parts_of_position.entry(part.position).or_default().push(part);
    }
    let mut summary = NormalsSummary::default();
    let mut written = BTreeMap::new();
    for (position, parts) in parts_of_position {
        written.extend(write::write(document, &accessors, position, &parts, &mut summary.warnings)?);
    }
    summary.warnings.extend(document.unused_data_warning());
    selection.candidates.into_iter().enumerate().for_each(|(place, candidate)| {
        summary
            .push(candidate.name, candidate.verdict.outcome(|| written.remove(&place).unwrap_or_default()));
    });
    Ok(summary)
}

/// Checks the vertices that get normals, which primitives may share, at rest and for morph targets with
/// normals. Errors: their normals take more than the memory limit.
fn check_vertices(
    document: &Document,
    accessors: &CanonicalAccessors,
    selection: &NormalSelection,
) -> Result<(), Error> {
    let mut written = BTreeSet::new();
    for (candidate, chosen) in selection.chosen() {
        let name = &selection.candidates[candidate].name;
        let targets = &document.meshes()[name.mesh].primitives[name.primitive].targets;
        let moves = targets
            .iter()
            .filter(|target| target.contains_key("NORMAL"))
            .filter_map(|target| target.get("POSITION"))
            .map(|&moved| Some(accessors.of(moved)));
        let position = accessors.of(chosen.position);
        written.extend([None].into_iter().chain(moves).map(|moved| (position, moved)));
    }
    let count = |position: usize| document.accessors().get(position).map_or(0, |accessor| accessor.count);
    let vertices = written.into_iter().map(|(position, _)| count(position)).fold(0, usize::saturating_add);
    limits::check_more_output(document, vertices.saturating_mul(size_of::<[f32; 3]>()))
}

//! Adds tangents to the primitives of a document and keeps everything else.
//!
//! ```text
//! select    which primitives get tangents, and from which accessors
//! groups    primitives over the same vertices are processed together, and equal index lists once
//! compute   tangents per corner; small groups side by side, each on one thread
//! split     vertices whose corners have different tangents are duplicated
//! morph     tangent offsets of morph targets
//! write     new accessors, and primitives that refer to them
//! ```

pub(super) mod compute;
mod corner_memory;
mod encoding;
mod given;
mod group_computation;
pub(super) mod groups;
mod morph;
mod options;
pub(super) mod select;
mod set_corners;
mod split;
mod strict;
mod summary;
pub(super) mod uv;
mod write;

pub use compute::{Generate, GenerateFn};
pub use encoding::TangentEncoding;
pub use given::GivenTangents;
pub use options::AddTangentsOptions;
pub use summary::{
    PrimitiveTangents, ReportCounts, TangentsOutcome, TangentsSummary, TangentsTotals, WrittenTangents,
};

use std::collections::HashMap;

use darboux::Context;
use darboux::internal::jobs;

use super::primitives::append::lacks_buffer_view;
use super::primitives::canonical::CanonicalAccessors;
use super::primitives::{foreign_extensions, limits};
use super::{Document, PrimitiveName, Progress};
use crate::Error;
use given::GivenPlaces;
use group_computation::{GroupComputation, GroupTangents};
use groups::Group;
use morph::{Morph, Movement, StaleCorners};
use select::{TangentSelection, TangentVerdict};
use write::{GroupAccessors, TangentWriter};

/// Adds tangents to every triangle primitive that has positions, normals and UVs.
///
/// A document without such primitives stays unchanged. Errors: invalid data of a primitive that gets
/// tangents; more corners than the memory limit permits; with [`AddTangentsOptions::strict`], unusable vertex
/// data. After an error the document is unspecified: drop it.
pub fn add_tangents(
    document: &mut Document,
    options: &AddTangentsOptions,
    progress: &mut dyn FnMut(Progress),
) -> Result<TangentsSummary, Error> {
    add_tangents_with(document, options, &mut Context::new(), Generate::OnCpu, progress)
}

/// As [`add_tangents`], with a context, and with tangents that `generate` computes, for example on a GPU.
/// Tangents of morph targets are computed on the CPU.
///
/// Further errors: the errors of `generate`; the context's token was cancelled.
pub fn add_tangents_with(
    document: &mut Document,
    options: &AddTangentsOptions,
    context: &mut Context,
    generate: Generate<'_>,
    progress: &mut dyn FnMut(Progress),
) -> Result<TangentsSummary, Error> {
    add_tangents_to(document, options, &|_| true, context, generate, progress)
}

/// As [`add_tangents_with`], for the primitives that `is_wanted` accepts. The others keep what they have.
pub fn add_tangents_to(
    document: &mut Document,
    options: &AddTangentsOptions,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
    context: &mut Context,
    generate: Generate<'_>,
    progress: &mut dyn FnMut(Progress),
) -> Result<TangentsSummary, Error> {
    run(document, options, is_wanted, &GivenPlaces::default(), (context, generate), progress)
}

/// As [`add_tangents_to`]. Primitives with `given` tangents get these.
fn run(
    document: &mut Document,
    options: &AddTangentsOptions,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
    given: &GivenPlaces<'_>,
    (context, generate): (&mut Context, Generate<'_>),
    progress: &mut dyn FnMut(Progress),
) -> Result<TangentsSummary, Error> {
    let selection = select::select(document, options, is_wanted)?;
    if options.strict {
        strict::refuse_unusable_rest(document, &selection)?;
    }
    let accessors = CanonicalAccessors::new(document);
    let given_of = |candidate: usize| given.of(&selection.candidates[candidate].name);
    let groups = groups::group(&accessors, selection.chosen(), given_of);
    limits::check_triangles(document, groups::triangle_counts(&groups))?;
    let vertices = |group: &Group| document.accessors()[group.position].count;
    let all_vertices = groups.iter().map(vertices).fold(0, usize::saturating_add);
    limits::check_more_output(document, all_vertices.saturating_mul(options.encoding.bytes()))?;
    let total = groups::triangle_counts(&groups).sum();
    let at = Progress { done: 0, total };
    let summary = TangentsSummary::default();
    let batches = match generate {
        Generate::OnCpu => groups::batches(&groups, vertices),
        Generate::With(_) => groups.chunks(1).collect(),
    };
    let contexts = Vec::new();
    let mut run =
        Run { selection, accessors, options, given, generate, progress, at, context, contexts, summary };
    let mut written = HashMap::new();
    for batch in batches {
        let computed = run.compute(document, batch)?;
        if run.at.done == total {
            run.free_memory();
        }
        for (group, tangents) in batch.iter().zip(computed) {
            written.extend(run.write(document, group, tangents)?);
        }
    }
    run.summary.warnings.extend(document.unused_data_warning());
    Ok(run.summarize(written))
}

/// One run of [`add_tangents`].
struct Run<'a, 'g> {
    selection: TangentSelection,
    accessors: CanonicalAccessors,
    options: &'a AddTangentsOptions,
    given: &'a GivenPlaces<'a>,
    generate: Generate<'g>,
    progress: &'a mut dyn FnMut(Progress),
    at: Progress,
    context: &'a mut Context,
    /// The contexts of the threads that compute small groups; empty before the first of these.
    contexts: Vec<Context>,
    summary: TangentsSummary,
}

impl Run<'_, '_> {
    /// Computes groups of one batch.
    fn compute(&mut self, document: &Document, batch: &[Group]) -> Result<Vec<GroupTangents>, Error> {
        let Self { selection, accessors, options, given, generate, at, .. } = self;
        let computation = GroupComputation { document, selection, accessors, options, given };
        if let [group] = batch {
            let mut on_job = |triangles| {
                at.done += triangles;
                (self.progress)(*at);
            };
            return Ok(vec![computation.run(group, generate, self.context, &mut on_job)?]);
        }
        if self.contexts.is_empty() {
            self.contexts = jobs::contexts(self.context, batch.len());
        }
        let computed = jobs::map_with(&mut self.contexts, batch, |group, context| {
            computation.run(group, &mut Generate::OnCpu, context, &mut |_| {})
        });
        at.done += groups::triangle_counts(batch).sum::<usize>();
        (self.progress)(*at);
        computed.into_iter().collect()
    }

    /// Frees the memory of the computation, before the document is saved.
    fn free_memory(&mut self) {
        self.context.free_memory();
        self.contexts.clear();
    }

    /// Writes the tangents of a group. Returns a report for each candidate.
    fn write(
        &mut self,
        document: &mut Document,
        group: &Group,
        computed: GroupTangents,
    ) -> Result<Vec<(usize, WrittenTangents)>, Error> {
        let GroupTangents { reports, split, lists, offsets, warnings } = computed;
        self.summary.warnings.extend(warnings);
        let totals = &mut self.summary.totals;
        totals.triangles += groups::triangle_counts(std::slice::from_ref(group)).sum::<usize>();
        totals.vertices_before += split.old_vertex_count();
        totals.vertices_after += split.vertex_count();
        let first = &self.selection.candidates[group.members[0].candidate].name;
        let old =
            document.meshes()[first.mesh].primitives[first.primitive].attributes.get("TANGENT").copied();
        let tangents = write::push_tangents(document, old, self.options.encoding, &split.tangents);
        limits::check_output(document)?;
        let mut offset_accessors = HashMap::new();
        let mut stale_corners: HashMap<(Movement, usize), StaleCorners> = HashMap::new();
        for (Morph { movement, old, jobs, .. }, moved) in offsets {
            let sparse = movement.accessors().all(|accessor| lacks_buffer_view(document, accessor));
            offset_accessors.insert(movement, moved.of_vertices.push(document, old, sparse));
            limits::check_output(document)?;
            stale_corners.extend(jobs.into_iter().map(|job| (movement, job)).zip(moved.stale_corners));
        }
        let results = GroupAccessors { split: &split, lists, tangents, offsets: offset_accessors };
        let mut writer = TangentWriter::new(&self.accessors, self.options, group, results);
        let mut written = Vec::with_capacity(group.members.len());
        for member in &group.members {
            let candidate = &self.selection.candidates[member.candidate];
            if split.is_needed() {
                self.summary.warnings.extend(foreign_extensions::warning(document, &candidate.name));
            }
            let morphed = writer.write(document, member, candidate)?;
            let stale_corners =
                morphed.iter().filter_map(|&movement| stale_corners.get(&(movement, member.job)));
            let stale_corners =
                stale_corners.fold(StaleCorners::default(), |sum, &stale_corners| sum + stale_corners);
            let (uv_set, uv_reason) = candidate.uv_set_and_reason();
            written.push((
                member.candidate,
                WrittenTangents {
                    uv_set,
                    uv_reason,
                    replaced: candidate.replaces(),
                    sharing_primitives: group.members.len(),
                    vertices_before: split.old_vertex_count(),
                    vertices_after: split.vertex_count(),
                    morph_targets: morphed.len(),
                    regrouped_corners: stale_corners.regrouped,
                    conflicting_corners: stale_corners.conflicting,
                    counts: reports[member.job].into(),
                },
            ));
        }
        Ok(written)
    }

    fn summarize(self, mut written: HashMap<usize, WrittenTangents>) -> TangentsSummary {
        let Self { selection, mut summary, .. } = self;
        summary.warnings.splice(0..0, selection.warnings);
        for (place, candidate) in selection.candidates.into_iter().enumerate() {
            let reason = candidate.verdict.reason().unwrap_or_default().to_owned();
            let outcome = match candidate.verdict {
                TangentVerdict::Chosen(_) => {
                    TangentsOutcome::Written(written.remove(&place).unwrap_or_default())
                }
                TangentVerdict::Kept(_) => TangentsOutcome::Kept { reason },
                TangentVerdict::WithoutNormals => {
                    summary.totals.without_normals += 1;
                    TangentsOutcome::Skipped { reason }
                }
                TangentVerdict::Skipped(_) => TangentsOutcome::Skipped { reason },
            };
            summary.push(PrimitiveTangents { name: candidate.name, outcome });
        }
        summary
    }
}

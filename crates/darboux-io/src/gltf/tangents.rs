//! Adds tangents to the primitives of a document and keeps everything else.
//!
//! ```text
//! select    which primitives get tangents, and from which accessors
//! groups    primitives over the same vertices are processed together, and equal index lists once
//! compute   tangents per corner
//! split     vertices whose corners have different tangents are duplicated
//! morph     tangent offsets of morph targets
//! write     new accessors, and primitives that refer to them
//! ```

pub(super) mod compute;
mod encoding;
pub(super) mod groups;
mod morph;
mod options;
pub(super) mod select;
mod split;
mod summary;
pub(super) mod uv;
mod write;

pub use compute::{Generate, generate_on_cpu};
pub use encoding::TangentEncoding;
pub use options::AddTangentsOptions;
pub use summary::{
    PrimitiveTangents, ReportCounts, TangentsOutcome, TangentsSummary, TangentsTotals, WrittenTangents,
};

use std::collections::{HashMap, HashSet};

use darboux::{Context, Method, Mode, Report};

use super::primitives::append::{lacks_buffer_view, push_vectors};
use super::primitives::canonical::CanonicalAccessors;
use super::primitives::{foreign_extensions, limits};
use super::{Document, ElementType, PrimitiveName, Progress};
use crate::Error;
use compute::{JobResult, Vertices};
use groups::{Group, Job};
use morph::{Morph, Movement, Offsets, StaleCorners};
use select::{TangentSelection, TangentVerdict};
use split::Split;
use write::{GroupAccessors, TangentWriter};

/// Adds tangents to every triangle primitive that has positions, normals and UVs.
///
/// A document without such primitives stays unchanged. Errors: invalid data of a primitive that gets tangents; more corners than the
/// memory limit permits; with [`AddTangentsOptions::strict`], unusable vertex data. After an error the document is unspecified: drop it.
pub fn add_tangents(
    document: &mut Document,
    options: &AddTangentsOptions,
    progress: &mut dyn FnMut(Progress),
) -> Result<TangentsSummary, Error> {
    add_tangents_with(document, options, &mut Context::new(), &mut compute::generate_on_cpu, progress)
}

/// As [`add_tangents`], with a context, and with tangents that `generate` computes, for example on a GPU. Tangents of morph targets are
/// computed here.
///
/// Further errors: those of `generate`; the context's token was cancelled.
pub fn add_tangents_with(
    document: &mut Document,
    options: &AddTangentsOptions,
    context: &mut Context,
    generate: &mut Generate<'_>,
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
    generate: &mut Generate<'_>,
    progress: &mut dyn FnMut(Progress),
) -> Result<TangentsSummary, Error> {
    let selection = select_readable(document, options, is_wanted)?;
    let accessors = CanonicalAccessors::new(document);
    let groups = groups::group(&accessors, selection.chosen());
    limits::check_triangles(document, groups::triangle_counts(&groups))?;
    let total = groups::triangle_counts(&groups).sum();
    let at = Progress { done: 0, total };
    let summary = TangentsSummary::default();
    let mut run = Run { selection, accessors, options, generate, progress, at, context, summary };
    let mut written = HashMap::new();
    for group in &groups {
        let tangents = run.group_tangents(document, group)?;
        written.extend(run.write(document, group, tangents)?);
    }
    run.summary.warnings.extend(document.unused_data_warning());
    Ok(run.summarize(written))
}

/// Selects the primitives. A compressed document is decompressed if any is selected.
pub(super) fn select_readable(
    document: &mut Document,
    options: &AddTangentsOptions,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
) -> Result<TangentSelection, Error> {
    let selection = select::select(document, options, is_wanted)?;
    if selection.is_empty() || !document.is_compressed() {
        return Ok(selection);
    }
    document.decompress()?;
    select::select(document, options, is_wanted)
}

/// The tangents of a group before they are written. They borrow nothing from the document.
struct GroupTangents {
    reports: Vec<Report>,
    split: Split,
    /// The new index list of each job; none if the old one is kept.
    lists: Vec<Option<Vec<u32>>>,
    offsets: Vec<(Morph, Offsets)>,
}

/// One run of [`add_tangents`].
struct Run<'a, 'g> {
    selection: TangentSelection,
    accessors: CanonicalAccessors,
    options: &'a AddTangentsOptions,
    generate: &'a mut Generate<'g>,
    progress: &'a mut dyn FnMut(Progress),
    at: Progress,
    context: &'a mut Context,
    summary: TangentsSummary,
}

impl Run<'_, '_> {
    fn group_tangents(&mut self, document: &Document, group: &Group) -> Result<GroupTangents, Error> {
        let mut vertices = Vertices::read(document, group)?;
        let morphs = morph::morphs(document, &self.accessors, group, &self.selection, self.options);
        let results = self.compute(document, group, &mut vertices, &morphs)?;
        let mut split = self.split(document, group, &mut vertices, &results)?;
        let offsets = self.morph(document, group, &mut vertices, morphs, &results, &split)?;
        let lists = split.take_lists(group, &results);
        let reports = results.iter().map(|result| result.report).collect();
        Ok(GroupTangents { reports, split, lists, offsets })
    }

    /// The JSON path of the first primitive with this job.
    fn path(&self, job: &Job) -> String {
        self.selection.candidates[job.first].name.path()
    }

    fn compute<'a>(
        &mut self,
        document: &'a Document,
        group: &Group,
        vertices: &mut Vertices<'_>,
        morphs: &[Morph],
    ) -> Result<Vec<JobResult<'a>>, Error> {
        let moved: HashSet<_> = morphs.iter().flat_map(|morph| &morph.jobs).copied().collect();
        let mut results = Vec::with_capacity(group.jobs.len());
        for (index, job) in group.jobs.iter().enumerate() {
            let (at, moves) = (self.path(job), moved.contains(&index));
            let compute = (&mut *self.generate, &mut *self.context);
            let result = compute::compute_job(document, &at, vertices, job, moves, self.options, compute)?;
            self.warn_unusable(job, &result);
            self.warn_merged(job, &result);
            self.at.done += job.triangle_count;
            (self.progress)(self.at);
            results.push(result);
        }
        if self.at.done == self.at.total {
            self.context.free_memory();
        }
        Ok(results)
    }

    fn warn_unusable(&mut self, job: &Job, result: &JobResult<'_>) {
        let unusable = result.report.repaired_corners;
        let keeps_them = matches!(self.options.tangents.method, Method::MikkTSpace(options) if options.mode == Mode::Reference);
        if keeps_them && unusable > 0 {
            let name = &self.selection.candidates[job.first].name;
            self.summary.warnings.push(format!(
                "{name}: {unusable} corners have an unusable tangent, as in the reference implementation; validators will report them"
            ));
        }
    }

    fn warn_merged(&mut self, job: &Job, result: &JobResult<'_>) {
        let merged = result.report.merged_vertices;
        if merged > 0 {
            let name = &self.selection.candidates[job.first].name;
            self.summary.warnings.push(format!(
                "{name}: {merged} vertices on mirrored seams have one tangent for both sides with this method; \
                 normal maps are wrong there"
            ));
        }
    }

    fn split(
        &mut self,
        document: &Document,
        group: &Group,
        vertices: &mut Vertices<'_>,
        results: &[JobResult<'_>],
    ) -> Result<Split, Error> {
        let split = split::split(document, &self.path(&group.jobs[0]), group, vertices, results)?;
        let totals = &mut self.summary.totals;
        totals.triangles += group.jobs.iter().map(|job| job.triangle_count).sum::<usize>();
        totals.vertices_before += split.old_vertex_count();
        totals.vertices_after += split.vertex_count();
        Ok(split)
    }

    fn morph(
        &mut self,
        document: &Document,
        group: &Group,
        vertices: &mut Vertices<'_>,
        morphs: Vec<Morph>,
        results: &[JobResult<'_>],
        split: &Split,
    ) -> Result<Vec<(Morph, Offsets)>, Error> {
        let mut offsets = Vec::with_capacity(morphs.len());
        for morph in morphs {
            let computed = (results, split);
            let moved =
                morph::offsets(document, &morph, group, vertices, computed, self.options, self.context)?;
            offsets.push((morph, moved));
            limits::check_more_output(
                document,
                offsets.len() * split.vertex_count() * size_of::<[f32; 3]>(),
            )?;
        }
        Ok(offsets)
    }

    /// Writes the tangents of a group. Returns a report for each candidate.
    fn write(
        &mut self,
        document: &mut Document,
        group: &Group,
        field: GroupTangents,
    ) -> Result<Vec<(usize, WrittenTangents)>, Error> {
        let GroupTangents { reports, split, lists, offsets } = field;
        let first = &self.selection.candidates[group.members[0].candidate].name;
        let old =
            document.meshes()[first.mesh].primitives[first.primitive].attributes.get("TANGENT").copied();
        let tangents = write::push_tangents(document, old, self.options.encoding, &split.tangents);
        limits::check_output(document)?;
        let mut offset_accessors = HashMap::new();
        let mut stale_corners: HashMap<(Movement, usize), StaleCorners> = HashMap::new();
        for (Morph { movement, old, jobs, .. }, moved) in offsets {
            let sparse = movement.accessors().all(|accessor| lacks_buffer_view(document, accessor));
            let accessor = push_vectors(document, old, ElementType::Vec3, &moved.of_vertex, sparse);
            offset_accessors.insert(movement, accessor);
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
            let outcome = match candidate.verdict {
                TangentVerdict::Chosen(_) => {
                    TangentsOutcome::Written(written.remove(&place).unwrap_or_default())
                }
                TangentVerdict::Kept(reason) => TangentsOutcome::Kept { reason },
                TangentVerdict::Skipped(reason) => TangentsOutcome::Skipped { reason },
            };
            summary.push(PrimitiveTangents { name: candidate.name, outcome });
        }
        summary
    }
}

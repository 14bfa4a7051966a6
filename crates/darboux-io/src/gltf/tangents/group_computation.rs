//! Computes what is written for one group: tangents, new vertices and index lists, and offsets of morph
//! targets.

use std::collections::HashSet;

use darboux::{Context, Mesh, Method, Mode, Report, TangentOptions};

use super::compute::{self, Generate, JobResult, Vertices};
use super::given::GivenPlaces;
use super::groups::{Group, Job};
use super::morph::{self, Morph, Offsets};
use super::options::AddTangentsOptions;
use super::select::TangentSelection;
use super::split::{self, Split};
use crate::Error;
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::primitives::limits;
use crate::gltf::{Document, PrimitiveName};

/// The tangents of a group before they are written. They borrow nothing from the document.
pub struct GroupTangents {
    pub reports: Vec<Report>,
    pub split: Split,
    /// The new index list of each job; none if the old one is kept.
    pub lists: Vec<Option<Vec<u32>>>,
    pub offsets: Vec<(Morph, Offsets)>,
    pub warnings: Vec<String>,
}

/// What the computation of a group reads.
#[derive(Clone, Copy)]
pub struct GroupComputation<'a> {
    pub document: &'a Document,
    pub selection: &'a TangentSelection,
    pub accessors: &'a CanonicalAccessors,
    pub options: &'a AddTangentsOptions,
    pub given: &'a GivenPlaces<'a>,
}

impl GroupComputation<'_> {
    /// Computes a group. `on_job` is called with the triangles of each job that is done.
    pub fn run(
        &self,
        group: &Group,
        generate: &mut Generate<'_>,
        context: &mut Context,
        on_job: &mut dyn FnMut(usize),
    ) -> Result<GroupTangents, Error> {
        let Self { document, selection, accessors, options, .. } = *self;
        let mut vertices = Vertices::read(document, group)?;
        let morphs = morph::morphs(document, accessors, group, selection, options);
        let results = self.jobs(group, &mut vertices, &morphs, (generate, &mut *context), on_job)?;
        let mut split =
            split::split(document, &self.name(&group.jobs[0]).path(), group, &mut vertices, &results)?;
        let offsets = self.offsets(group, &mut vertices, morphs, &results, &split, context)?;
        let lists = split.take_lists(group, &results);
        let reports = results.iter().map(|result| result.report).collect();
        let warnings =
            group.jobs.iter().zip(&results).flat_map(|(job, result)| self.warnings(job, result)).collect();
        Ok(GroupTangents { reports, split, lists, offsets, warnings })
    }

    /// The first primitive with a job.
    fn name(&self, job: &Job) -> &PrimitiveName {
        &self.selection.candidates[job.first].name
    }

    fn jobs(
        &self,
        group: &Group,
        vertices: &mut Vertices<'_>,
        morphs: &[Morph],
        (generate, context): (&mut Generate<'_>, &mut Context),
        on_job: &mut dyn FnMut(usize),
    ) -> Result<Vec<JobResult<'_>>, Error> {
        let moved: HashSet<_> = morphs.iter().flat_map(|morph| &morph.jobs).copied().collect();
        let mut results = Vec::with_capacity(group.jobs.len());
        for (index, job) in group.jobs.iter().enumerate() {
            let (name, moves) = (self.name(job), moved.contains(&index));
            let result = if job.given.is_none() {
                let by = (&mut *generate, &mut *context);
                compute::compute_job(self.document, name, vertices, job, moves, self.options, by)
            } else {
                let mut give = |mesh: &Mesh<'_>, _: &TangentOptions, _: &mut Context| {
                    self.given.tangents(job.given, mesh.corner_count())
                };
                let by = (&mut Generate::With(&mut give), &mut *context);
                compute::compute_job(self.document, name, vertices, job, moves, self.options, by)
            };
            results.push(result?);
            on_job(job.triangle_count);
        }
        Ok(results)
    }

    fn offsets(
        &self,
        group: &Group,
        vertices: &mut Vertices<'_>,
        morphs: Vec<Morph>,
        results: &[JobResult<'_>],
        split: &Split,
        context: &mut Context,
    ) -> Result<Vec<(Morph, Offsets)>, Error> {
        let Self { document, options, .. } = *self;
        let mut offsets = Vec::with_capacity(morphs.len());
        let mut bytes = 0;
        for morph in morphs {
            let computed = (results, split);
            let moved = morph::offsets(document, &morph, group, vertices, computed, options, context)?;
            bytes += moved.of_vertices.byte_length();
            offsets.push((morph, moved));
            limits::check_more_output(document, bytes)?;
        }
        Ok(offsets)
    }

    fn warnings(&self, job: &Job, result: &JobResult<'_>) -> impl Iterator<Item = String> + use<> {
        let name = self.name(job);
        let (unusable, merged) = (result.report.repaired_corners, result.report.merged_vertices);
        let keeps_them = matches!(self.options.tangents.method, Method::MikkTSpace(options) if options.mode == Mode::Reference);
        let of_unusable = (keeps_them && unusable > 0).then(|| {
            format!(
                "{name}: {unusable} corners have an unusable tangent, as in the reference implementation; \
                 validators will report them"
            )
        });
        let of_merged = (merged > 0).then(|| {
            format!(
                "{name}: {merged} vertices on mirrored seams have one tangent for both sides with this \
                 method; normal maps are wrong there"
            )
        });
        of_unusable.into_iter().chain(of_merged)
    }
}

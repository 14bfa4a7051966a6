//! Groups primitives over the same vertices, so that shared data is computed, split and written once.

use std::collections::HashMap;

use super::select::TangentInput;
use super::uv::UvTransform;
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::primitives::triangles::TriangleMode;

/// Primitives over the same positions, normals and UVs. They are split jointly and share one `TANGENT`
/// accessor.
///
/// All other attributes and morph targets of the members are split in the same way. A primitive with another
/// UV set belongs to another group, and gets its own copies.
#[derive(Debug)]
pub struct Group {
    pub position: usize,
    pub normal: usize,
    pub uv: Option<usize>,
    /// The different jobs.
    pub jobs: Vec<Job>,
    /// The primitives, in the order of the file.
    pub members: Vec<GroupMember>,
}

/// The computation for all primitives with the same indices, mode, texture transform and given tangents.
#[derive(Debug)]
pub struct Job {
    pub indices: Option<usize>,
    pub topology: TriangleMode,
    pub transform: Option<UvTransform>,
    pub triangle_count: usize,
    /// The place of the tangents that the caller gave; none if they are computed.
    pub given: Option<usize>,
    /// The index in the selection of the first primitive with this job.
    pub first: usize,
}

/// A primitive of a group.
#[derive(Debug)]
pub struct GroupMember {
    /// The index in the selection.
    pub candidate: usize,
    /// The index in [`Group::jobs`].
    pub job: usize,
}

/// Groups primitives. Groups are in the order of their first primitives. `given`: the place of a candidate's
/// given tangents.
pub fn group<'a>(
    accessors: &CanonicalAccessors,
    chosen: impl Iterator<Item = (usize, &'a TangentInput)>,
    given: impl Fn(usize) -> Option<usize>,
) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut group_of = HashMap::new();
    let mut job_of = HashMap::new();
    for (candidate, chosen) in chosen {
        let [position, normal] = [chosen.position, chosen.normal].map(|accessor| accessors.of(accessor));
        let uv = chosen.uv.map(|accessor| accessors.of(accessor));
        let place = *group_of.entry((position, normal, uv)).or_insert_with(|| {
            groups.push(Group { position, normal, uv, jobs: Vec::new(), members: Vec::new() });
            groups.len() - 1
        });
        let TangentInput { topology, transform, .. } = *chosen;
        let indices = chosen.indices.map(|accessor| accessors.of(accessor));
        let jobs = &mut groups[place].jobs;
        let given = given(candidate);
        let key = (place, indices, topology, transform.map(|transform| transform.bits()), given);
        let job = *job_of.entry(key).or_insert_with(|| {
            let triangle_count = topology.triangle_count(chosen.index_count);
            jobs.push(Job { indices, topology, transform, triangle_count, given, first: candidate });
            jobs.len() - 1
        });
        groups[place].members.push(GroupMember { candidate, job });
    }
    groups
}

/// Groups with at least so many triangles are computed on all threads, one after the other: the core shares
/// meshes of this size.
const LARGE_GROUP: usize = 1 << 14;

/// Small groups are computed side by side, so many triangles before they are written.
const BATCH_TRIANGLES: usize = 1 << 18;

/// Small groups of a batch have at most so many vertices together: each may have many that other groups use.
const BATCH_VERTICES: usize = 1 << 20;

/// Divides groups into batches of consecutive ones: a large group, or several small ones. `vertices`: the
/// number of vertices of a group.
pub fn batches(groups: &[Group], vertices: impl Fn(&Group) -> usize) -> Vec<&[Group]> {
    let mut batches = Vec::new();
    let (mut start, mut triangles, mut was_large) = (0, 0, false);
    let mut all_vertices: usize = 0;
    for (at, group) in groups.iter().enumerate() {
        let more = triangle_counts(std::slice::from_ref(group)).sum::<usize>();
        let is_large = more >= LARGE_GROUP;
        let own_vertices = vertices(group);
        all_vertices = all_vertices.saturating_add(own_vertices);
        let is_full = triangles + more > BATCH_TRIANGLES || all_vertices > BATCH_VERTICES;
        if at > start && (was_large || is_large || is_full) {
            batches.push(&groups[start..at]);
            (start, triangles, all_vertices) = (at, 0, own_vertices);
        }
        (triangles, was_large) = (triangles + more, is_large);
    }
    if start < groups.len() {
        batches.push(&groups[start..]);
    }
    batches
}

/// The number of triangles of every job.
pub fn triangle_counts(groups: &[Group]) -> impl Iterator<Item = usize> {
    groups.iter().flat_map(|group| &group.jobs).map(|job| job.triangle_count)
}

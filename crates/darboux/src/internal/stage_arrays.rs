//! What lies between the stages of MikkTSpace, for `darboux-gpu`, whose kernels are their twins, and for tests. Not part of the API: it
//! changes as the stages do.

use std::collections::HashMap;

use crate::CornerFrames;
use crate::Frames;
use crate::Mesh;
use crate::TangentOptions;
use crate::exec::limits::RunLimits;
use crate::math::cosine_of_degrees;
use crate::topology::neighbours::neighbours;
use crate::topology::triangulate::triangulate;

use crate::tangents::mikktspace::degenerate::copies;
use crate::tangents::mikktspace::derivatives::agreed_derivatives;
use crate::tangents::mikktspace::evaluate::joined;
use crate::tangents::mikktspace::subgroups::SubgroupFinder;
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::mikktspace::{GroupedMesh, edge_order};

pub use crate::tangents::mikktspace::degenerate::{CopySource, CornerCopy};
pub use crate::tangents::mikktspace::derivatives::Derivative;
pub use crate::tangents::mikktspace::groups::Groups;
pub use crate::topology::triangles::NONE;
pub use crate::topology::triangles::{Triangles, Triangulation};

/// The arrays of all stages of one run.
#[derive(Clone, Debug)]
pub struct Stages {
    /// Triangles, welded. `good.vertices` has the representative of every corner; all arrays below go over `good`.
    pub triangulation: Triangulation,
    /// The triangle across the edges 0-1, 1-2, 2-0, or [`NONE`].
    pub neighbours: Vec<[u32; 3]>,
    /// Before groups are made, quads agreed.
    pub derivatives: Vec<Derivative>,
    /// The orientation of each triangle once UV-degenerate ones have adopted their first group's.
    pub preserves: Vec<bool>,
    /// The groups, in the order of their seeds.
    pub groups: Groups,
    /// Over which members each corner sums.
    pub sums: SubgroupSums,
    /// What fills the corners that only degenerate triangles have.
    pub copies: Vec<CornerCopy>,
    /// The cosine above which members join.
    pub threshold_cosine: f32,
}

/// SubgroupFinder: the sums that a run makes, group after group.
#[derive(Clone, Debug, Default)]
pub struct SubgroupSums {
    /// Corners `k` of triangles `t` as `3 t + k`, ascending in each sum, without the UV-degenerate ones, which add nothing.
    pub members: Vec<u32>,
    /// Where the members of each sum end.
    pub ends: Vec<u32>,
    /// The corner of the mesh that represents each sum's vertex: the normal is its.
    pub vertices: Vec<u32>,
    /// Of each corner of the mesh: the sum that it has, or the two of which it has the average, or [`NONE`].
    pub of_corner: Vec<[u32; 2]>,
}

impl Stages {
    /// Runs every stage in its general form. `None` where the members of all sums would be more than `limit`.
    pub fn new(mesh: &Mesh<'_>, options: &TangentOptions, limit: usize) -> Option<Self> {
        let triangulation = triangulate(mesh);
        let neighbours = neighbours(&triangulation.good, edge_order(options));
        let derivatives =
            agreed_derivatives(&triangulation.good, &WeldedMesh::welded(mesh), RunLimits::default());
        let known = (&neighbours[..], derivatives.clone());
        let topology = GroupedMesh::of(mesh, triangulation, known, |_| true, options);
        let threshold_cosine = cosine_of_degrees(options.threshold);
        Some(Self {
            neighbours,
            derivatives,
            preserves: topology.base.derivatives.iter().map(|derivative| derivative.preserves).collect(),
            sums: SubgroupSums::new(&topology, threshold_cosine, mesh.corner_count(), limit)?,
            copies: copies(&topology.triangulation),
            threshold_cosine,
            groups: topology.groups,
            triangulation: topology.triangulation,
        })
    }
}

/// As [`crate::generate_frames`], by all stages in their general form.
pub fn frames(mesh: &Mesh<'_>, options: &TangentOptions) -> Frames {
    let limits = RunLimits::default();
    let Some(topology) = GroupedMesh::new(mesh, options, limits) else { return Frames::default() };
    let (corners, report) = topology.frames(mesh, limits);
    Frames { corners: CornerFrames(corners), report }
}

impl SubgroupSums {
    fn new(topology: &GroupedMesh, threshold_cosine: f32, corners: usize, limit: usize) -> Option<Self> {
        let (good, groups, base) = (&topology.triangulation.good, &topology.groups, &topology.base);
        let mut out = Self { of_corner: vec![[NONE; 2]; corners], ..Self::default() };
        let mut subgroups = SubgroupFinder::new(threshold_cosine);
        for group in 0..groups.len() {
            let members = groups.members(group);
            let vertex = good.vertices.as_flattened()[members[0] as usize];
            let mut sorted = members.to_vec();
            sorted.sort_unstable();
            subgroups.set(good, &sorted, &base.derivatives, base.normal_of_group[group]);
            let all_joined = subgroups.all_joined();
            let mut known = HashMap::new();
            let mut left_out = Vec::new();
            for &member in members {
                if !all_joined {
                    let at = sorted.partition_point(|&other| other < member);
                    subgroups.find_left_out(subgroups.first_alike(at), &mut left_out);
                }
                let sum = *known.entry(left_out.clone()).or_insert_with(|| {
                    let adds = |member: &u32| !base.derivatives[*member as usize / 3].any;
                    let joined = joined(sorted.len(), &left_out).map(|at| sorted[at]);
                    out.members.extend(joined.filter(adds));
                    out.ends.push(out.members.len() as u32);
                    out.vertices.push(vertex);
                    out.ends.len() as u32 - 1
                });
                let slots = &mut out.of_corner[good.corners.as_flattened()[member as usize] as usize];
                slots[usize::from(slots[0] != NONE)] = sum;
                if out.members.len() > limit {
                    return None;
                }
            }
        }
        Some(out)
    }
}

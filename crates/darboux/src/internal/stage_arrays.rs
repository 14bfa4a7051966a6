//! The arrays between the stages of MikkTSpace: for the kernels of `darboux-gpu`, which mirror the stages,
//! and for tests.
//!
//! Not part of the API: these types change with the stages.

use crate::Context;
use crate::CornerFrames;
use crate::Error;
use crate::Frames;
use crate::Mesh;
use crate::MikkTSpaceOptions;
use crate::exec::limits::RunLimits;
use crate::math::cosine_of_degrees;
use crate::topology::neighbours::neighbours;
use crate::topology::triangulate::triangulate;

use crate::tangents::mikktspace::degenerate::copies;
use crate::tangents::mikktspace::derivatives::quad_derivatives;
use crate::tangents::mikktspace::subgroups::{SubgroupFinder, SubgroupVisitor, included};
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::mikktspace::{GroupedMesh, edge_order};
use crate::util::hash_map::KeyTable;

pub use crate::tangents::mikktspace::degenerate::{CopySource, CornerCopy};
pub use crate::tangents::mikktspace::derivatives::Derivative;
pub use crate::tangents::mikktspace::groups::Groups;
pub use crate::topology::triangles::{NONE, Triangles, Triangulation};

/// The output of every stage of one run.
#[derive(Clone, Debug)]
pub struct Stages {
    /// The welded triangles. All arrays per triangle below follow `triangulation.good`.
    pub triangulation: Triangulation,
    /// The triangle across each of the edges 0-1, 1-2, 2-0, or [`NONE`].
    pub neighbours: Vec<[u32; 3]>,
    /// The derivatives with one orientation per quad, before grouping.
    pub derivatives: Vec<Derivative>,
    /// The orientation of each triangle after grouping: UV-degenerate triangles have adopted that of their
    /// first group.
    pub preserves: Vec<bool>,
    /// The groups, in the order of their first triangles.
    pub groups: Groups,
    /// The subgroups over which corners sum.
    pub sums: SubgroupSums,
    /// The copies that fill the corners that only degenerate triangles have.
    pub copies: Vec<CornerCopy>,
    /// The cosine of the threshold. Members join when their cosines exceed it.
    pub threshold_cosine: f32,
}

/// The distinct subgroups of all groups, as compressed rows.
#[derive(Clone, Debug, Default)]
pub struct SubgroupSums {
    /// The members of each sum, ascending: corner `k` of triangle `t` as `3 t + k`. UV-degenerate members,
    /// which add nothing, are absent.
    pub members: Vec<u32>,
    /// The end of each sum in `members`.
    pub ends: Vec<u32>,
    /// The welded vertex of each sum, which has the normal.
    pub vertices: Vec<u32>,
    /// The sum of each corner of the mesh, or two sums whose frames are averaged. Unused entries are
    /// [`NONE`].
    pub of_corner: Vec<[u32; 2]>,
}

impl Stages {
    /// Runs every exact stage. `None` where the members of all sums would exceed `limit`. Errors: the
    /// context's token was cancelled.
    pub fn new(
        mesh: &Mesh<'_>,
        options: &MikkTSpaceOptions,
        context: &mut Context,
        limit: usize,
    ) -> Result<Option<Self>, Error> {
        let limits = context.limits();
        let triangulation = triangulate(mesh, limits);
        limits.check()?;
        let neighbours = neighbours(&triangulation.good, edge_order(options), limits);
        limits.check()?;
        let derivatives = quad_derivatives(&triangulation.good, &WeldedMesh::new(mesh), limits);
        limits.check()?;
        let stages = (&neighbours[..], derivatives.clone());
        let grouped = GroupedMesh::from_stages(mesh, triangulation, stages, |_| true, (options, limits));
        limits.check()?;
        let threshold_cosine = cosine_of_degrees(options.threshold);
        let sums = SubgroupSums::new(&grouped, (threshold_cosine, limits), mesh.corner_count(), limit);
        limits.check()?;
        let Some(sums) = sums else { return Ok(None) };
        Ok(Some(Self {
            neighbours,
            derivatives,
            preserves: grouped.base.derivatives.iter().map(|derivative| derivative.preserves).collect(),
            sums,
            copies: copies(&grouped.triangulation),
            threshold_cosine,
            groups: grouped.groups,
            triangulation: grouped.triangulation,
        }))
    }
}

/// As [`crate::generate_frames`], by the exact stages alone.
pub fn frames(mesh: &Mesh<'_>, options: &MikkTSpaceOptions) -> Frames {
    let limits = RunLimits::default();
    let Some(grouped) = GroupedMesh::new(mesh, options, limits) else { return Frames::default() };
    let (corners, report) = grouped.frames(mesh, limits);
    Frames { corners: CornerFrames(corners), report }
}

impl SubgroupSums {
    /// `None` after cancellation, and where the members would exceed `limit`.
    fn new(
        grouped: &GroupedMesh,
        (threshold_cosine, limits): (f32, RunLimits<'_>),
        corners: usize,
        limit: usize,
    ) -> Option<Self> {
        let (good, groups, base) = (&grouped.triangulation.good, &grouped.groups, &grouped.base);
        let sums = Self { of_corner: vec![[NONE; 2]; corners], ..Self::default() };
        let mut collector = SumCollector { grouped, members: Vec::new(), vertex: NONE, limits, limit, sums };
        let mut subgroups = SubgroupFinder::new(threshold_cosine, limits);
        for group in 0..groups.len() {
            let members = groups.members(group);
            subgroups.load(good, members, &base.derivatives, base.normal_of_group[group]);
            collector.members.clear();
            collector.members.extend_from_slice(subgroups.members());
            collector.vertex = good.vertices.as_flattened()[members[0] as usize];
            subgroups.visit(members, &mut collector);
            if collector.is_stopped() {
                return None;
            }
        }
        Some(collector.sums)
    }
}

/// Lists the members of each subgroup instead of adding their terms.
struct SumCollector<'a> {
    grouped: &'a GroupedMesh,
    /// The members of the current group, ascending, and its welded vertex.
    members: Vec<u32>,
    vertex: u32,
    limits: RunLimits<'a>,
    /// The most members of all sums.
    limit: usize,
    sums: SubgroupSums,
}

impl SumCollector<'_> {
    fn add_sum(&mut self, excluded: &[u32]) -> u32 {
        let has_term = |member: &u32| !self.grouped.base.derivatives[*member as usize / 3].joins_any;
        let members = included(self.members.len(), excluded).map(|at| self.members[at]);
        if !self.is_stopped() {
            self.sums.members.extend(members.filter(has_term));
        }
        self.sums.ends.push(self.sums.members.len() as u32);
        self.sums.vertices.push(self.vertex);
        self.sums.ends.len() as u32 - 1
    }
}

impl SubgroupVisitor for SumCollector<'_> {
    /// The number of the sum.
    type Value = u32;

    fn compute(&mut self, excluded: &KeyTable) -> Vec<u32> {
        (0..excluded.len()).map(|number| self.add_sum(excluded.key(number))).collect()
    }

    fn write(&mut self, member: u32, &sum: &u32, _excluded: &[u32]) {
        let corner = self.grouped.triangulation.good.corners.as_flattened()[member as usize];
        let slots = &mut self.sums.of_corner[corner as usize];
        slots[usize::from(slots[0] != NONE)] = sum;
    }

    fn is_stopped(&self) -> bool {
        self.sums.members.len() > self.limit || self.limits.is_cancelled()
    }
}

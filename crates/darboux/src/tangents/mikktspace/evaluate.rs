//! From groups to frames: weighted sums over subgroups, written to the corners.
//!
//! ```text
//! for each group, in order:
//!     term of a member = its derivatives in the tangent plane, times the angle of its corner
//!     for each member, in the order in which the group was built:
//!         sum = terms of its subgroup, added in triangle order
//!         frame = sum, normalised; corner = frame, or the average where the other half of a quad has written it before
//! ```
//!
//! A group whose members all join, which is nearly every group, is summed once. In other groups, the
//! subgroups share most of the work of their additions ([`crate::tangents::mikktspace::sums_without`]).
//!
//! Source: mikktspace.c, `GenerateTSpaces`, `EvalTspace`, `AvgTSpace`. We deviate: the reference lists, sorts
//! and compares the members of every subgroup; here a subgroup is the list of the members that it excludes.

use std::cell::OnceCell;

use crate::Frame;
use crate::exec::limits::RunLimits;
use crate::exec::vertex_progress::VertexProgress;
use crate::math::{V3, add, angle, direction_in_plane, dot, equal, normalized_unless_zero, scale, sub};
use crate::topology::triangles::Triangles;
use crate::util::hash_map::KeyTable;

use crate::tangents::mikktspace::derivatives::Derivative;
use crate::tangents::mikktspace::groups::Groups;
use crate::tangents::mikktspace::raw_frames::RawFrames;
use crate::tangents::mikktspace::subgroups::{SubgroupFinder, SubgroupVisitor, included};
use crate::tangents::mikktspace::sums_without::{TermLanes, TermList};
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::repair::{is_usable, mean_in_plane};

/// The size from which on the progress on a group is reported.
const LARGE_GROUP: usize = 1 << 12;

/// What evaluation reads besides the groups: the derivatives of all triangles, and the normal of each group's
/// vertex.
#[derive(Clone, Debug, Default)]
pub(crate) struct GroupInputs {
    pub derivatives: Vec<Derivative>,
    pub normal_of_group: Vec<V3>,
}

impl GroupInputs {
    pub fn new(
        triangles: &Triangles,
        groups: &Groups,
        derivatives: Vec<Derivative>,
        welded: &WeldedMesh<'_>,
    ) -> Self {
        let vertices = triangles.vertices.as_flattened();
        let normal = |group| welded.normal(vertices[groups.members(group)[0] as usize]);
        Self { derivatives, normal_of_group: (0..groups.len()).map(normal).collect() }
    }
}

/// The threshold, and cancellation, which is checked between groups and between the members of a group that
/// the threshold splits.
pub(crate) struct EvaluateOptions<'a> {
    pub threshold_cosine: f32,
    pub limits: RunLimits<'a>,
}

/// Evaluates every group, in order, and writes the frames of the groups' corners.
///
/// `membership`: decides which members join; a plan passes its base. `values`: what the members add; a plan
/// passes the moved mesh. A fresh run passes the same inputs twice. `initial`: the frames of corners without
/// a group.
pub(crate) fn evaluate(
    triangles: &Triangles,
    groups: &Groups,
    options: &EvaluateOptions<'_>,
    (membership, values): (&GroupInputs, &GroupInputs),
    welded: &WeldedMesh<'_>,
    initial: Vec<Frame>,
) -> RawFrames {
    let corner_count = welded.corner_count();
    let raw = RawFrames { of_corner: initial, mean_of_corner: vec![[0.0; 3]; corner_count] };
    let (written, terms, tangents) = (vec![false; corner_count], TermList::default(), Vec::new());
    let limits = options.limits;
    let mut evaluator =
        Evaluator { triangles, values, welded, terms, tangents, sign: 1.0, written, raw, limits };
    let mut subgroups = SubgroupFinder::new(options.threshold_cosine, limits);
    for group in (0..groups.len()).take_while(|_| !limits.is_cancelled()) {
        let members = groups.members(group);
        subgroups.load(triangles, members, &membership.derivatives, membership.normal_of_group[group]);
        evaluator.load(subgroups.members(), values.normal_of_group[group], groups.preserves(group));
        subgroups.visit(members, &mut evaluator);
        if let Some(progress) = evaluator.shown_progress() {
            progress.clear();
        }
    }
    evaluator.raw
}

struct Evaluator<'a> {
    triangles: &'a Triangles,
    values: &'a GroupInputs,
    welded: &'a WeldedMesh<'a>,
    /// The terms of the current group's members, ascending. UV-degenerate members have none.
    terms: TermList,
    /// The tangents of the members' triangles, for repairs.
    tangents: Vec<V3>,
    /// The sign of the current group.
    sign: f32,
    /// True for corners that a group has written.
    written: Vec<bool>,
    raw: RawFrames,
    limits: RunLimits<'a>,
}

/// One subgroup's frame, and the mean of its tangents, which is computed when the frame is unusable.
struct SubgroupFrame {
    frame: Frame,
    mean: OnceCell<Option<V3>>,
}

impl Evaluator<'_> {
    /// Where the progress on the current group is reported. Other runs may share it, so small groups leave it
    /// alone.
    fn shown_progress(&self) -> Option<&VertexProgress> {
        self.limits.progress.filter(|_| self.tangents.len() >= LARGE_GROUP)
    }

    /// Computes the terms of a group's members, which ascend.
    fn load(&mut self, members: &[u32], normal: V3, preserves: bool) {
        let derivative = |&member: &u32| &self.values.derivatives[member as usize / 3];
        self.sign = if preserves { 1.0 } else { -1.0 };
        self.tangents.clear();
        self.tangents.extend(members.iter().map(|member| derivative(member).s));
        self.terms.load(members.iter().map(|member| {
            let (triangle, k) = (*member as usize / 3, *member as usize % 3);
            let positions = || self.welded.positions(self.triangles, triangle);
            (!derivative(member).joins_any).then(|| term(derivative(member), positions(), k, normal))
        }));
    }
}

impl SubgroupVisitor for Evaluator<'_> {
    type Value = SubgroupFrame;

    fn compute(&mut self, excluded: &KeyTable) -> Vec<SubgroupFrame> {
        let sums = self.terms.sums_without(excluded, self.limits);
        let subgroup = |sum| SubgroupFrame { frame: frame(sum, self.sign), mean: OnceCell::new() };
        sums.iter().map(subgroup).collect()
    }

    /// Writes the frame to the member's corner. The corners of a quad's diagonal may be written twice and
    /// then have the average. The order of the writes matters only where both frames differ in nothing
    /// but the sign of a zero.
    fn write(&mut self, member: u32, subgroup: &SubgroupFrame, excluded: &[u32]) {
        let corner = self.triangles.corners.as_flattened()[member as usize];
        let slot = &mut self.raw.of_corner[corner as usize];
        let is_second = std::mem::replace(&mut self.written[corner as usize], true);
        *slot = if is_second { average(slot, &subgroup.frame) } else { subgroup.frame };
        let mean = &mut self.raw.mean_of_corner[corner as usize];
        if is_second {
            *mean = [0.0; 3];
        }
        let normal = self.welded.normal(corner);
        if !is_usable(slot.tangent, normal) {
            let members = || included(self.tangents.len(), excluded);
            let tangents = || members().filter(|&at| self.terms.has_term(at)).map(|at| self.tangents[at]);
            if let Some(found) = subgroup.mean.get_or_init(|| mean_in_plane(tangents(), normal)) {
                *mean = *found;
            }
        }
    }

    fn is_stopped(&self) -> bool {
        self.limits.is_cancelled()
    }

    fn show_progress(&self, found: usize) {
        if let Some(progress) = self.shown_progress() {
            progress.set(found, self.tangents.len());
        }
    }
}

/// The term of corner `k` of a triangle: its derivatives in the tangent plane, times the angle of the corner
/// in that plane.
///
/// Lanes: s and the angle; t and a zero; the magnitudes and two zeros. So one addition is three additions of
/// four lanes.
fn term(derivative: &Derivative, positions: [V3; 3], k: usize, normal: V3) -> TermLanes {
    let [before, here, after] = [(k + 2) % 3, k, (k + 1) % 3].map(|k| positions[k]);
    let to_before = direction_in_plane(normal, sub(before, here));
    let to_after = direction_in_plane(normal, sub(after, here));
    let weight = angle(dot(to_before, to_after));
    let [s0, s1, s2] = scale(weight, direction_in_plane(normal, derivative.s));
    let [t0, t1, t2] = scale(weight, direction_in_plane(normal, derivative.t));
    let [m0, m1] = derivative.magnitude.map(|magnitude| weight * magnitude);
    TermLanes([s0, s1, s2, weight, t0, t1, t2, 0.0, m0, m1, 0.0, 0.0])
}

/// The frame of a sum of terms.
fn frame(sum: &TermLanes, sign: f32) -> Frame {
    let [s0, s1, s2, weight, t0, t1, t2, _, m0, m1, _, _] = sum.0;
    let magnitude = if weight > 0.0 { [m0 / weight, m1 / weight] } else { [m0, m1] };
    let (tangent, bitangent) = (normalized_unless_zero([s0, s1, s2]), normalized_unless_zero([t0, t1, t2]));
    Frame { tangent, bitangent, magnitude, sign }
}

/// The mean of two frames; the first frame where both are equal. The sign is the second's.
fn average(a: &Frame, b: &Frame) -> Frame {
    let same =
        equal(a.magnitude, b.magnitude) && equal(a.tangent, b.tangent) && equal(a.bitangent, b.bitangent);
    if same {
        return Frame { sign: b.sign, ..*a };
    }
    Frame {
        tangent: normalized_unless_zero(add(a.tangent, b.tangent)),
        bitangent: normalized_unless_zero(add(a.bitangent, b.bitangent)),
        magnitude: [0, 1].map(|i| 0.5 * (a.magnitude[i] + b.magnitude[i])),
        sign: b.sign,
    }
}

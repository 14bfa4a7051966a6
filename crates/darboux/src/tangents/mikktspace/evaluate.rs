//! From groups to frames: weighted sums over subgroups, and output to corners.
//!
//! Source: mikktspace.c, `GenerateTSpaces`, `EvalTspace`, `AvgTSpace`. There the members of each subgroup are listed, sorted and
//! compared; here a group whose members all join each other, which is nearly every group, is summed once, and subgroups are lists
//! of the members left out.

use std::cell::OnceCell;
use std::ops::Range;
use std::rc::Rc;

use crate::Frame;
use crate::exec::limits::RunLimits;
use crate::math::{V3, add, angle, direction_in_plane, dot, equal, normalized_unless_zero, scale, sub};
use crate::topology::triangles::Triangles;
use crate::util::hash_map::InsertionMap;
use crate::util::radix_sort::sort;

use crate::tangents::mikktspace::derivatives::Derivative;
use crate::tangents::mikktspace::groups::Groups;
use crate::tangents::mikktspace::prefix_sums::{PrefixSums, TermLanes};
use crate::tangents::mikktspace::raw_frames::RawFrames;
use crate::tangents::mikktspace::subgroups::SubgroupFinder;
use crate::tangents::mikktspace::welded_mesh::WeldedMesh;
use crate::tangents::repair::{is_usable, mean_in_plane};

/// At most this many bytes of subgroups are remembered per group, to find those that several members share.
const REMEMBERED_BYTES: usize = 1 << 24;

/// What depends on the positions and normals that groups are evaluated on.
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
        shape: &WeldedMesh<'_>,
    ) -> Self {
        let vertices = triangles.vertices.as_flattened();
        let normal = |group| shape.normal(vertices[groups.members(group)[0] as usize]);
        Self { derivatives, normal_of_group: (0..groups.len()).map(normal).collect() }
    }
}

/// Options of [`evaluate`]. Each member of a group that the threshold splits may look at all others, so cancellation is checked between them.
pub(crate) struct EvaluateOptions<'a> {
    pub threshold_cosine: f32,
    pub limits: RunLimits<'a>,
}

/// Evaluates every group, in order, and writes the results to the groups' corners.
///
/// `membership` decides which members join (a plan's base), `values` what they add; on a fresh run they are the same. Corners of
/// no group keep what they have in `known`.
pub(crate) fn evaluate(
    triangles: &Triangles,
    groups: &Groups,
    how: &EvaluateOptions<'_>,
    (membership, values): (&GroupInputs, &GroupInputs),
    shape: &WeldedMesh<'_>,
    known: Vec<Frame>,
) -> RawFrames {
    let mut evaluator = Evaluator {
        triangles,
        values,
        shape,
        running: PrefixSums::default(),
        tangents: Vec::new(),
        written: vec![false; shape.corner_count()],
        of_corner: known,
        mean_of_corner: vec![[0.0; 3]; shape.corner_count()],
    };
    let mut subgroups = SubgroupFinder::new(how.threshold_cosine);
    let mut sorted = Vec::new();
    for group in 0..groups.len() {
        if how.limits.is_cancelled() {
            break;
        }
        let members = groups.members(group);
        sorted.clear();
        sorted.extend_from_slice(members);
        sort(&mut sorted);
        let sign = if groups.preserves(group) { 1.0 } else { -1.0 };
        evaluator.take_terms(&sorted, values.normal_of_group[group]);
        subgroups.set(triangles, &sorted, &membership.derivatives, membership.normal_of_group[group]);
        if subgroups.all_joined() {
            let subgroup = evaluator.subgroup(&[], sign);
            members.iter().for_each(|&member| evaluator.write(member, &subgroup));
        } else {
            evaluator.write_split_group(members, &sorted, &mut subgroups, sign, how.limits);
        }
    }
    RawFrames { of_corner: evaluator.of_corner, mean_of_corner: evaluator.mean_of_corner }
}

struct Evaluator<'a> {
    triangles: &'a Triangles,
    values: &'a GroupInputs,
    shape: &'a WeldedMesh<'a>,
    /// What each member of the current group adds; nothing where it is UV-degenerate.
    running: PrefixSums,
    /// The triangles' own tangents, which count for a repair.
    tangents: Vec<V3>,
    /// Corners that a group has written.
    written: Vec<bool>,
    of_corner: Vec<Frame>,
    mean_of_corner: Vec<V3>,
}

/// One subgroup's frame, whom it leaves out, and the mean of its tangents for when the frame is unusable.
struct Subgroup {
    frame: Frame,
    left_out: Vec<Range<usize>>,
    mean: OnceCell<Option<V3>>,
}

impl Evaluator<'_> {
    /// Computes what every member adds.
    fn take_terms(&mut self, members: &[u32], normal: V3) {
        let derivative = |&member: &u32| &self.values.derivatives[member as usize / 3];
        self.tangents.clear();
        self.tangents.extend(members.iter().map(|member| derivative(member).s));
        self.running.set(members.iter().map(|member| {
            let (triangle, k) = (*member as usize / 3, *member as usize % 3);
            let positions = || self.shape.positions(self.triangles, triangle);
            (!derivative(member).any).then(|| term(derivative(member), positions(), k, normal))
        }));
    }

    /// Sums the terms of all members but those left out, in triangle order.
    fn subgroup(&self, left_out: &[Range<usize>], sign: f32) -> Subgroup {
        let frame = frame(&self.running.sum_without(left_out), sign);
        Subgroup { frame, left_out: left_out.to_vec(), mean: OnceCell::new() }
    }

    /// Evaluates each member's own subgroup. The order of writes shows where both halves of a quad are members and their frames
    /// differ in the sign of a zero only.
    fn write_split_group(
        &mut self,
        members: &[u32],
        sorted: &[u32],
        subgroups: &mut SubgroupFinder,
        sign: f32,
        limits: RunLimits<'_>,
    ) {
        self.running.find_stretches();
        let mut of_members: Vec<Option<Rc<Subgroup>>> = vec![None; sorted.len()];
        let mut of_left_out: InsertionMap<Rc<Subgroup>> = InsertionMap::new();
        let (mut left_out, mut key, mut bytes) = (Vec::new(), Vec::new(), 0);
        for &member in members.iter().take_while(|_| !limits.is_cancelled()) {
            let at = subgroups.first_alike(sorted.partition_point(|&other| other < member));
            if let Some(subgroup) = &of_members[at] {
                self.write(member, subgroup);
                continue;
            }
            subgroups.find_left_out(at, &mut left_out);
            key.clear();
            key.extend(left_out.iter().flat_map(|gap| [gap.start as u32, gap.end as u32]));
            let known = of_left_out.get(&key).map(|subgroup| Rc::clone(subgroup));
            let subgroup = known.unwrap_or_else(|| Rc::new(self.subgroup(&left_out, sign)));
            self.write(member, &subgroup);
            bytes += size_of::<Subgroup>() + 2 * size_of_val(left_out.as_slice());
            if bytes <= REMEMBERED_BYTES {
                of_left_out.first(&key, || Rc::clone(&subgroup));
                of_members[at] = Some(subgroup);
            }
        }
    }

    /// Writes a subgroup's frame to a member's corner. A quad's diagonal corner can be written twice: then it has the average.
    fn write(&mut self, member: u32, subgroup: &Subgroup) {
        let corner = self.triangles.corners.as_flattened()[member as usize];
        let slot = &mut self.of_corner[corner as usize];
        let again = std::mem::replace(&mut self.written[corner as usize], true);
        *slot = if again { average(slot, &subgroup.frame) } else { subgroup.frame };
        if again {
            self.mean_of_corner[corner as usize] = [0.0; 3];
        }
        let normal = self.shape.normal(corner);
        if !is_usable(slot.tangent, normal) {
            let joined =
                || joined(self.tangents.len(), &subgroup.left_out).filter(|&at| self.running.adds(at));
            let tangents = || joined().map(|at| self.tangents[at]);
            if let Some(mean) = subgroup.mean.get_or_init(|| mean_in_plane(tangents(), normal)) {
                self.mean_of_corner[corner as usize] = *mean;
            }
        }
    }
}

/// The first `count` numbers but those of `left_out`, in order.
pub(crate) fn joined(count: usize, left_out: &[Range<usize>]) -> impl Iterator<Item = usize> {
    let starts = [0].into_iter().chain(left_out.iter().map(|gap| gap.end));
    let ends = left_out.iter().map(|gap| gap.start).chain([count]);
    starts.zip(ends).flat_map(|(start, end)| start..end)
}

/// What corner `k` of a triangle adds to the sums at its vertex: its derivatives in the plane of the vertex, times the angle of the
/// corner there.
///
/// TermLanes: s and the angle; t and a zero; the magnitudes and two zeros. So a sum is three additions of four numbers.
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

/// The frame that a sum of terms makes.
fn frame(sum: &TermLanes, sign: f32) -> Frame {
    let [s0, s1, s2, weight, t0, t1, t2, _, m0, m1, _, _] = sum.0;
    let magnitude = if weight > 0.0 { [m0 / weight, m1 / weight] } else { [m0, m1] };
    let (tangent, bitangent) = (normalized_unless_zero([s0, s1, s2]), normalized_unless_zero([t0, t1, t2]));
    Frame { tangent, bitangent, magnitude, sign }
}

/// The mean of two frames, or the first when they are equal. The sign is the second's.
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

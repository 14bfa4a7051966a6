//! The groups around undecided vertices that a plan keeps: which corners each group adds up, and which
//! corners take its tangent. An evaluation adds up the moved triangles again, without finding edges or
//! comparing pairs.

use crate::exec::simd::Width;
use crate::math::{add, normalized_unless_zero};
use crate::tangents::mikktspace::raw_frames::DEFAULT_FRAME;
use crate::tangents::options::Mode;
use crate::topology::triangles::NONE;

use crate::tangents::fast::kernel::TriangleBlock;
use crate::tangents::fast::proof::marks;
use crate::tangents::fast::resolve::{Resolution, needs_no_repair};
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::undecided::{MarkedTerm, doubtful_kind, evaluate, kinds};
use crate::tangents::fast::vertex_record::VertexRecord;

/// The groups of the vertices that the resolution has decided. An *entry* is a corner of one of `triangles`.
#[derive(Debug)]
pub(crate) struct PlannedGroups {
    mode: Mode,
    /// The welded vertex of each vertex here.
    welded: Vec<u32>,
    /// The vertices of the triangles that are added up, in the order of the triangle list.
    triangles: Vec<[u32; 3]>,
    /// The group that each entry is added to, or [`NONE`].
    group_of_entry: Vec<u32>,
    /// The members of groups that share some: group and entry, in the order of the entries within a group.
    shared_members: Vec<[u32; 2]>,
    /// The vertex of each group, or [`NONE`] where no corner takes its tangent.
    vertex_of_group: Vec<u32>,
    /// The corners of the mesh, and the group whose tangent each takes; [`NONE`] for those that keep the
    /// default.
    group_of_corner: Vec<[u32; 2]>,
    /// The vertices with corners that keep the default.
    default_vertices: Vec<u32>,
}

/// The sums of one evaluation. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct PlannedSums {
    records: Vec<VertexRecord>,
    terms: Vec<[MarkedTerm; 3]>,
    sums: Vec<[f32; 3]>,
}

impl PlannedGroups {
    /// The groups of the last resolution, whose mode was `mode`.
    pub fn new(resolution: &Resolution, mode: Mode) -> Self {
        let mut planned = Self {
            mode,
            welded: resolution.triangles.welded.clone(),
            triangles: Vec::new(),
            group_of_entry: Vec::new(),
            shared_members: Vec::new(),
            vertex_of_group: vec![NONE; resolution.fans.groups.len()],
            group_of_corner: Vec::new(),
            default_vertices: Vec::new(),
        };
        planned.list_corners(resolution);
        planned.list_members(resolution);
        planned
    }

    /// Lists the corners of all decided vertices with their groups.
    fn list_corners(&mut self, resolution: &Resolution) {
        for vertex in resolution.decided_vertices() {
            for (entry, group, _) in resolution.groups_at(vertex) {
                match self.vertex_of_group.get_mut(group) {
                    Some(of_group) => *of_group = vertex as u32,
                    None => self.default_vertices.push(vertex as u32),
                }
                self.group_of_corner.push([resolution.triangles.corner(entry), group as u32]);
            }
        }
        self.default_vertices.dedup();
    }

    /// Lists the triangles that the groups of these corners add up.
    fn list_members(&mut self, Resolution { triangles, fans, .. }: &Resolution) {
        let is_kept = |group: u32| self.vertex_of_group.get(group as usize).is_some_and(|&v| v != NONE);
        // Groups that share members come after all others, and list their members.
        let is_summed = |group: u32| is_kept(group) && (group as usize) < fans.first_shared;
        let group_of = |entry: usize| Some(fans.group_of_entry[entry]).filter(|&group| is_summed(group));
        let shared: Vec<[u32; 2]> =
            fans.shared_members.iter().copied().filter(|&[group, _]| is_kept(group)).collect();
        let entries = |at: usize| 3 * at..3 * at + 3;
        let mut is_needed: Vec<bool> =
            (0..triangles.triangles.len()).map(|at| entries(at).any(|e| group_of(e).is_some())).collect();
        shared.iter().for_each(|[_, entry]| is_needed[*entry as usize / 3] = true);
        let mut place = vec![NONE; is_needed.len()];
        for at in (0..is_needed.len()).filter(|&at| is_needed[at] && triangles.kinds[at] & IGNORED == 0) {
            place[at] = self.triangles.len() as u32;
            self.triangles.push(triangles.triangles[at]);
            self.group_of_entry.extend(entries(at).map(|entry| group_of(entry).unwrap_or(NONE)));
        }
        let moved = shared.iter().map(|[group, entry]| (*group, place[*entry as usize / 3], entry % 3));
        let added = moved.filter(|(_, at, _)| *at != NONE);
        self.shared_members = added.map(|(group, at, k)| [group, 3 * at + k]).collect();
    }

    /// Writes the tangents of the groups for a mesh whose vertices have moved, with the signs of `base`.
    /// `list`: its triangles. Returns false where the groups do not suffice: tangents need repair,
    /// derivatives are too small.
    pub fn write(
        &self,
        list: &TriangleList<'_>,
        (width, block): (Width, &mut TriangleBlock),
        base: &[[f32; 4]],
        sums: &mut PlannedSums,
        out: &mut [[f32; 4]],
    ) -> bool {
        sums.records.clear();
        sums.records.extend(self.welded.iter().map(|&vertex| list.record(vertex)));
        sums.terms.resize(self.triangles.len(), [[0.0; 4]; 3]);
        evaluate(width, (&self.triangles, &sums.records), block, &mut sums.terms, &mut []);
        self.add_up(sums);
        if !self.terms_are_exact(sums) || !self.normalize(sums) {
            return false;
        }
        for &[corner, group] in &self.group_of_corner {
            let [x, y, z] = sums.sums.get(group as usize).copied().unwrap_or(DEFAULT_FRAME.tangent);
            out[corner as usize] = [x, y, z, base[corner as usize][3]];
        }
        true
    }

    /// True where the terms of the moved triangles are the reference's.
    fn terms_are_exact(&self, sums: &PlannedSums) -> bool {
        self.triangles.iter().zip(&sums.terms).all(|(triangle, terms)| {
            let found = terms.iter().fold(0, |found, term| found | term[3].to_bits());
            found & marks::NEEDS_GENERAL_PATH == 0 || {
                let (kind, is_exact) = doubtful_kind(triangle.map(|vertex| sums.records[vertex as usize]));
                is_exact && kind & IGNORED == 0
            }
        })
    }

    fn add_up(&self, PlannedSums { terms, sums, .. }: &mut PlannedSums) {
        sums.clear();
        sums.resize(self.vertex_of_group.len(), [0.0; 3]);
        let terms = terms.as_flattened();
        let own = self.group_of_entry.iter().zip(terms).filter(|(group, _)| **group != NONE);
        let shared = self.shared_members.iter().map(|[group, entry]| (group, &terms[*entry as usize]));
        for (&group, &[x, y, z, _]) in own.chain(shared) {
            let sum = &mut sums[group as usize];
            *sum = add(*sum, [x, y, z]);
        }
    }

    /// Turns sums into unit tangents. False where one needs a repair.
    fn normalize(&self, PlannedSums { records, sums, .. }: &mut PlannedSums) -> bool {
        let is_fine = |tangent: [f32; 3], vertex: u32| {
            let [_, _, _, x, y, z, ..] = records[vertex as usize];
            match self.mode {
                Mode::Reference => tangent.iter().all(|x| x.is_finite()),
                Mode::Repaired | Mode::Corrected => needs_no_repair(tangent, [x, y, z]),
            }
        };
        let kept = sums.iter_mut().zip(&self.vertex_of_group).filter(|(_, vertex)| **vertex != NONE);
        for (sum, &vertex) in kept {
            *sum = normalized_unless_zero(*sum);
            if !is_fine(*sum, vertex) {
                return false;
            }
        }
        self.default_vertices.iter().all(|&vertex| is_fine(DEFAULT_FRAME.tangent, vertex))
    }
}

/// The kinds of triangles that add nothing to a group.
const IGNORED: u8 = kinds::JOINS_ANY | kinds::DEGENERATE;

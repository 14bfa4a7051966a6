//! The triangles with undecided vertices, as a mesh of their own: vertices numbered as they occur, what each triangle is to the reference,
//! and what its corners add to their groups.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use crate::exec::limits::RunLimits;
use crate::exec::simd::Task;
use crate::math::dot;
use crate::tangents::mikktspace::derivatives::derivative;
use crate::topology::triangles::NONE;

use crate::tangents::fast::edge_tail::are_degenerate;
use crate::tangents::fast::kernel::{BLOCK_SIZE, TriangleBlock};
use crate::tangents::fast::proof::{UNDECIDED, marks};
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::vertex_record::VertexRecord;

/// What a triangle is, as bits.
pub(crate) mod kinds {
    /// The UV map preserves the orientation; on a triangle without UV area, that of the group which it has joined.
    pub const PRESERVES: u8 = 1;
    /// The triangle has no UV area: it joins groups of either orientation, and adds nothing to tangents.
    pub const JOINS_ANY: u8 = 2;
    /// Two positions are equal: the triangle has no edges and no group.
    pub const DEGENERATE: u8 = 4;
    /// A corner is in a group.
    pub const IS_GROUPED: u8 = 8;
}

/// What a corner adds to its group: the weighted tangent, and the corner's [`marks`] as a fourth number.
pub(crate) type MarkedTerm = [f32; 4];

/// What a corner adds to the frame of its group besides the tangent: the weighted bitangent, the weight, the weighted lengths of dP/du and
/// dP/dv.
pub(crate) type FrameTerm = [f32; 6];

/// The triangles with undecided vertices. An *entry* is a corner of one of these triangles, three per triangle. The memory is reused from
/// mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct UndecidedTriangles {
    /// The number of each triangle in the mesh's triangle list, ascending.
    pub numbers: Vec<u32>,
    /// The vertices of each triangle, numbered in the order of their first entries.
    pub triangles: Vec<[u32; 3]>,
    /// The [`kinds`] of each triangle.
    pub kinds: Vec<u8>,
    /// What the corners of each triangle add.
    pub terms: Vec<[MarkedTerm; 3]>,
    /// What the corners of each triangle add to full frames. Empty where these are not wanted.
    pub frame_terms: Vec<[FrameTerm; 3]>,
    /// The values of each vertex.
    pub records: Vec<VertexRecord>,
    /// True for undecided vertices. All triangles around them are here.
    pub is_undecided: Vec<bool>,
    /// Vertices at which the terms may not be the reference's: some triangle's derivatives are too small to be normalised.
    pub inexact: Vec<u32>,
    /// The welded vertex of each vertex.
    welded: Vec<u32>,
    /// The number of each welded vertex here, or [`NONE`].
    number_of_welded: Vec<u32>,
}

impl UndecidedTriangles {
    /// Collects and evaluates the triangles. `faces`: the first triangles of the faces with undecided corners, ascending. `out`: the
    /// tangents of all corners. `full_frames`: whether full frames are wanted.
    pub fn collect(
        &mut self,
        list: &TriangleList<'_>,
        (faces, vertex_count): (&[u32], usize),
        out: &[[f32; 4]],
        block: &mut TriangleBlock,
        full_frames: bool,
        limits: RunLimits<'_>,
    ) {
        self.number_vertices(list, faces, vertex_count, out);
        self.terms.resize(self.triangles.len(), [[0.0; 4]; 3]);
        self.frame_terms.clear();
        self.frame_terms.resize(if full_frames { self.triangles.len() } else { 0 }, [[0.0; 6]; 3]);
        limits.width.run(EvaluateTriangles {
            triangles: &self.triangles,
            records: &self.records,
            block,
            terms: &mut self.terms,
            frame_terms: &mut self.frame_terms,
        });
        self.find_kinds();
    }

    fn number_vertices(
        &mut self,
        list: &TriangleList<'_>,
        faces: &[u32],
        vertex_count: usize,
        out: &[[f32; 4]],
    ) {
        self.welded.iter().for_each(|&welded| self.number_of_welded[welded as usize] = NONE);
        self.number_of_welded.resize(vertex_count, NONE);
        self.welded.clear();
        self.records.clear();
        self.is_undecided.clear();
        self.numbers.clear();
        self.numbers.extend(faces.iter().flat_map(|&face| list.face_of(face)));
        self.triangles.clear();
        for &triangle in &self.numbers {
            let corners = list.corners(triangle);
            let vertices = corners.map(|corner| {
                let welded = list.vertex(corner);
                let number = &mut self.number_of_welded[welded as usize];
                if *number == NONE {
                    *number = self.welded.len() as u32;
                    self.welded.push(welded);
                    self.records.push(list.record(welded));
                    self.is_undecided.push(out[corner as usize][3] == UNDECIDED);
                }
                *number
            });
            self.triangles.push(vertices);
        }
    }

    fn find_kinds(&mut self) {
        self.kinds.clear();
        self.inexact.clear();
        for (triangle, terms) in self.triangles.iter().zip(&self.terms) {
            let found = terms.iter().fold(0, |found, term| found | term[3].to_bits());
            let mut kind = if found & marks::PRESERVES == 0 { 0 } else { kinds::PRESERVES };
            if found & marks::NEEDS_GENERAL_PATH != 0 {
                let (doubtful, is_exact) =
                    doubtful_kind(triangle.map(|vertex| self.records[vertex as usize]));
                kind = doubtful;
                if !is_exact {
                    self.inexact.extend(triangle);
                }
            }
            self.kinds.push(kind);
        }
    }

    /// The number here of an entry of the mesh's triangle list.
    pub fn entry_of(&self, entry: u32) -> u32 {
        3 * self.numbers.partition_point(|&number| number < entry / 3) as u32 + entry % 3
    }

    /// The corner of the mesh at an entry, where all faces are triangles.
    #[inline(always)]
    pub fn corner(&self, entry: u32) -> u32 {
        3 * self.numbers[entry as usize / 3] + entry % 3
    }

    /// The normal of a vertex.
    #[inline(always)]
    pub fn normal(&self, vertex: u32) -> [f32; 3] {
        let [_, _, _, x, y, z, ..] = self.records[vertex as usize];
        [x, y, z]
    }

    /// The vertex of an entry.
    #[inline(always)]
    pub fn vertex(&self, entry: u32) -> u32 {
        self.triangles[entry as usize / 3][entry as usize % 3]
    }

    /// What an entry adds to its group.
    #[inline(always)]
    pub fn term(&self, entry: u32) -> MarkedTerm {
        self.terms[entry as usize / 3][entry as usize % 3]
    }

    /// What an entry adds to the frame of its group.
    #[inline(always)]
    pub fn frame_term(&self, entry: u32) -> Option<&FrameTerm> {
        self.frame_terms.get(entry as usize / 3).map(|terms| &terms[entry as usize % 3])
    }

    /// The kind of an entry's triangle.
    #[inline(always)]
    pub fn kind(&self, entry: u32) -> u8 {
        self.kinds[entry as usize / 3]
    }
}

/// The kind of a triangle that the kernel does not vouch for, and whether its terms are exact all the same.
#[cold]
fn doubtful_kind(records: [VertexRecord; 3]) -> (u8, bool) {
    let positions = records.map(|[x, y, z, ..]| [x, y, z]);
    if are_degenerate(positions) {
        return (kinds::DEGENERATE, true);
    }
    let derivative = derivative(positions, records.map(|[.., u, v]| [u, v]));
    let orientation = if derivative.preserves { kinds::PRESERVES } else { 0 };
    if derivative.joins_any {
        return (orientation | kinds::JOINS_ANY, true);
    }
    // The kernel divides by every length, the reference by those that are not zero.
    let is_unit = |v| dot(v, v) > 0.5;
    (orientation, is_unit(derivative.s) && is_unit(derivative.t))
}

/// Computes what the corners of triangles add to their groups.
struct EvaluateTriangles<'a> {
    triangles: &'a [[u32; 3]],
    records: &'a [VertexRecord],
    block: &'a mut TriangleBlock,
    terms: &'a mut [[MarkedTerm; 3]],
    /// As many, or none.
    frame_terms: &'a mut [[FrameTerm; 3]],
}

impl Task for EvaluateTriangles<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { block, mut frame_terms, .. } = self;
        for (triangles, terms) in self.triangles.chunks(BLOCK_SIZE).zip(self.terms.chunks_mut(BLOCK_SIZE)) {
            for (i, triangle) in triangles.iter().take(BLOCK_SIZE).enumerate() {
                for k in 0..3 {
                    let [a, b, c, d, e, f, g, h] = self.records[triangle[k] as usize];
                    block.packed[k][0][i] = [a, b, c, d];
                    block.packed[k][1][i] = [e, f, g, h];
                }
            }
            block.evaluate_marked_terms();
            for (i, terms) in terms.iter_mut().take(BLOCK_SIZE).enumerate() {
                for k in 0..3 {
                    let [x, y, z, _] = block.sum[k][i];
                    terms[k] = [x, y, z, f32::from_bits(block.marks[k][i])];
                }
            }
            if frame_terms.is_empty() {
                continue;
            }
            let of_block;
            (of_block, frame_terms) = frame_terms.split_at_mut(triangles.len());
            block.bitangent_terms();
            for (i, terms) in of_block.iter_mut().take(BLOCK_SIZE).enumerate() {
                for k in 0..3 {
                    let ([x, y, z, weight], [s, t]) = (block.sum[k][i], block.magnitude_sum[k][i]);
                    terms[k] = [x, y, z, weight, s, t];
                }
            }
        }
    }
}

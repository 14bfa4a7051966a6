//! The triangles with undecided vertices, as a mesh of their own: vertices numbered as they occur, what each
//! triangle is to the reference, and what its corners add to their groups.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::simd::{Task, Width};
use crate::math::dot;
use crate::tangents::mikktspace::derivatives::{derivative, doubled_area};
use crate::topology::triangles::NONE;

use crate::tangents::fast::edge_tail::are_degenerate;
use crate::tangents::fast::kernel::{BLOCK_SIZE, TriangleBlock};
use crate::tangents::fast::proof::{UNDECIDED, marks};
use crate::tangents::fast::quads::MIN_AREA;
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::vertex_record::VertexRecord;

/// What a triangle is, as bits.
pub(crate) mod kinds {
    /// The UV map preserves the orientation; on a triangle without UV area, that of the group which it has
    /// joined.
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

/// What a corner adds to the frame of its group besides the tangent: the weighted bitangent, the weight, the
/// weighted lengths of dP/du and dP/dv.
pub(crate) type FrameTerm = [f32; 6];

/// The triangles with undecided vertices. An *entry* is a corner of one of these triangles, three per
/// triangle. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct UndecidedTriangles {
    /// The number of each triangle in the mesh's triangle list, ascending.
    pub numbers: Vec<u32>,
    /// The corners of the mesh of each triangle.
    pub corners: Vec<[u32; 3]>,
    /// True for the second half of a quad, whose first half is before it.
    pub is_second: Vec<bool>,
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
    /// Vertices at which the terms or frames may not be the reference's: some triangle's derivatives are too
    /// small to be normalised, or a quad is one that the general path handles.
    pub inexact: Vec<u32>,
    /// The welded vertex of each vertex.
    pub welded: Vec<u32>,
    /// The number of each welded vertex here, or [`NONE`].
    number_of_welded: Vec<u32>,
}

impl UndecidedTriangles {
    /// Collects and evaluates the triangles. `faces`: the first triangles of the faces with undecided
    /// corners, ascending. `out`: the tangents of all corners. `full_frames`: whether full frames are
    /// wanted.
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
        let mesh = (&self.triangles[..], &self.records[..]);
        evaluate(limits.width, mesh, block, &mut self.terms, &mut self.frame_terms);
        self.find_kinds();
        self.unify_quads();
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
        self.corners.clear();
        self.is_second.clear();
        for &triangle in &self.numbers {
            let corners = list.corners(triangle);
            self.corners.push(corners);
            self.is_second.push(list.face_of(triangle).start != triangle);
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

    /// Gives both halves of each quad one orientation, as the reference does. The vertices of quads with a
    /// degenerate half, and those with a half of nearly no UV area, whose derivatives can be infinite,
    /// are listed as inexact.
    fn unify_quads(&mut self) {
        for second in (1..self.kinds.len()).filter(|&at| self.is_second[at]) {
            let halves = [second - 1, second];
            let kinds = halves.map(|half| self.kinds[half]);
            let uvs =
                halves.map(|half| self.triangles[half].map(|vertex| uv_of(&self.records[vertex as usize])));
            let areas = uvs.map(|uvs| doubled_area(uvs).abs());
            let has_any = |kind: u8| (kinds[0] | kinds[1]) & kind != 0;
            let is_small = |at: usize| kinds[at] & kinds::JOINS_ANY == 0 && areas[at] <= MIN_AREA;
            if has_any(kinds::DEGENERATE) || is_small(0) || is_small(1) {
                self.inexact.extend(halves.iter().flat_map(|&half| self.triangles[half]));
            }
            if !has_any(kinds::DEGENERATE) {
                let first_decides = kinds[1] & kinds::JOINS_ANY != 0 || areas[0] >= areas[1];
                let orientation = kinds[if first_decides { 0 } else { 1 }] & kinds::PRESERVES;
                for half in halves {
                    self.kinds[half] = self.kinds[half] & !kinds::PRESERVES | orientation;
                }
            }
        }
    }

    /// The triangles of each face.
    pub fn faces(&self) -> impl Iterator<Item = Range<usize>> {
        let firsts = (0..self.is_second.len()).filter(|&at| !self.is_second[at]);
        firsts.map(|first| first..first + if self.is_second.get(first + 1) == Some(&true) { 2 } else { 1 })
    }

    /// True when the triangles of two entries belong to one face.
    pub fn are_of_one_face(&self, a: u32, b: u32) -> bool {
        let (a, b) = (a.min(b) as usize / 3, a.max(b) as usize / 3);
        a == b || a + 1 == b && self.is_second[b]
    }

    /// The number here of an entry of the mesh's triangle list.
    pub fn entry_of(&self, entry: u32) -> u32 {
        3 * self.numbers.partition_point(|&number| number < entry / 3) as u32 + entry % 3
    }

    /// The corner of the mesh at an entry.
    #[inline(always)]
    pub fn corner(&self, entry: u32) -> u32 {
        self.corners.as_flattened()[entry as usize]
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
        self.triangles.as_flattened()[entry as usize]
    }

    /// What an entry adds to its group.
    #[inline(always)]
    pub fn term(&self, entry: u32) -> MarkedTerm {
        self.terms.as_flattened()[entry as usize]
    }

    /// What an entry adds to the frame of its group.
    #[inline(always)]
    pub fn frame_term(&self, entry: u32) -> Option<&FrameTerm> {
        self.frame_terms.as_flattened().get(entry as usize)
    }

    /// The kind of an entry's triangle.
    #[inline(always)]
    pub fn kind(&self, entry: u32) -> u8 {
        self.kinds[entry as usize / 3]
    }
}

/// The UV in a record.
fn uv_of([.., u, v]: &VertexRecord) -> [f32; 2] {
    [*u, *v]
}

/// The kind of a triangle that the kernel does not vouch for, and whether its terms are exact all the same.
#[cold]
pub(crate) fn doubtful_kind(records: [VertexRecord; 3]) -> (u8, bool) {
    let positions = records.map(|[x, y, z, ..]| [x, y, z]);
    if are_degenerate(positions) {
        return (kinds::DEGENERATE, true);
    }
    let derivative = derivative(positions, records.each_ref().map(uv_of));
    let orientation = if derivative.preserves { kinds::PRESERVES } else { 0 };
    if derivative.joins_any {
        return (orientation | kinds::JOINS_ANY, true);
    }
    // The kernel divides by every length, the reference by those that are not zero.
    let is_unit = |v| dot(v, v) > 0.5;
    (orientation, is_unit(derivative.s) && is_unit(derivative.t))
}

/// Computes what the corners of triangles add to their groups. `frame_terms`: as many as triangles, or none.
pub(crate) fn evaluate(
    width: Width,
    (triangles, records): (&[[u32; 3]], &[VertexRecord]),
    block: &mut TriangleBlock,
    terms: &mut [[MarkedTerm; 3]],
    frame_terms: &mut [[FrameTerm; 3]],
) {
    width.run(EvaluateTriangles { triangles, records, block, terms, frame_terms });
}

/// See [`evaluate`].
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

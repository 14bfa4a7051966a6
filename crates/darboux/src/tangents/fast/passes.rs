//! The two passes over the triangles, and their steps, each compiled for every vector width.
//!
//! Both passes read vertices, add the weighted tangents of triangles to them, finish the vertices and write
//! the corners:
//! - [`Discover`] also collects marks and fingerprints, and decides from them which vertices have one
//!   tangent;
//! - [`Replay`] belongs to a plan, whose vertices have been decided before: it takes their signs as given.
//!
//! `streamed.rs` and `scattered.rs` run the steps in two orders.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::marker::PhantomData;
use std::ops::Range;

use crate::Frame;
use crate::math::{V3, dot, normalized_unless_zero};

use crate::exec::limits::RunLimits;
use crate::exec::simd::Task;
use crate::exec::windows::Window;
use crate::tangents::fast::accumulator::{
    VertexAccumulator, VertexRange, flags, gather, scatter, scatter_sums,
};
use crate::tangents::fast::edge_tail::TailCells;
use crate::tangents::fast::exceptions::Exceptions;
use crate::tangents::fast::kernel::{BLOCK_SIZE, CornerVertices, TriangleBlock};
use crate::tangents::fast::open_rows::OpenRows;
use crate::tangents::fast::proof::{
    Fan, UNDECIDED, fan, first_ray_count, marks as corner_marks, sign_of_marks,
};
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::vertex_quantity::{QuantityRange, VertexQuantity};
use crate::tangents::fast::vertex_record::{VertexSlices, VertexValues};
use crate::tangents::fast::worker::Findings;
use crate::tangents::mikktspace::raw_frames::DEFAULT_FRAME;

/// What all threads of a pass read.
#[derive(Clone, Copy)]
pub(crate) struct PassInput<'a, P> {
    pub list: TriangleList<'a>,
    pub windows: &'a [Window],
    pub pass: P,
    pub limits: RunLimits<'a>,
}

/// What a corner adds to its vertex: the weighted tangent, and a fourth number that the pass defines.
pub(crate) type Term = [f32; 4];

/// What a pass over the triangles computes. The passes are types, so that a program without plans contains no
/// code of [`Replay`].
pub(crate) trait Pass: Copy + Sync {
    /// What a streamed pass adds up besides the tangents.
    type Quantity: VertexQuantity;

    /// Computes what the corners of a block's triangles add to their vertices. `count`: how many of the
    /// triangles are in use.
    fn evaluate(self, block: &mut TriangleBlock, count: usize);

    /// Adds an evaluated block's first `count` triangles to `vertices`, which contain all vertices of these
    /// triangles.
    fn scatter(
        self,
        block: &TriangleBlock,
        count: usize,
        vertices: &mut [VertexAccumulator],
        marks: &mut [u32],
    );

    /// What is stored of corner `k` of triangle `i` of an evaluated block, for [`Pass::scatter_stored`].
    fn stored_term(self, block: &TriangleBlock, k: usize, i: usize) -> Term;

    /// Adds up to [`BLOCK_SIZE`] corners, whose terms were stored before, to their vertices, all of which are
    /// in `range`.
    fn scatter_stored(
        self,
        corners: &[CornerVertices],
        terms: &[Term],
        block: &mut TriangleBlock,
        range: &mut VertexRange<'_>,
    );

    /// Marks vertices of quads that the general path handles whole (see `quads.rs`), after `triangles` have
    /// been added to `range`.
    fn mark_quads(self, list: &TriangleList<'_>, triangles: Range<usize>, range: &mut VertexRange<'_>);

    /// False for vertices with `marks` whose sums the pass does not read when it finishes them.
    fn reads_sums(self, marks: &[u32]) -> bool;

    /// Finishes up to [`BLOCK_SIZE`] vertices: `tangents` holds their normalized sums, if the pass reads
    /// these.
    fn finish(self, range: &mut VertexRange<'_>, tangents: &mut TangentBlock, findings: &mut Findings);
}

/// The pass that decides which vertices have one tangent. `Q`: the further quantity of vertices.
#[derive(Clone, Copy)]
pub(crate) struct Discover<'a, Q> {
    /// The cells that the search for the last edges examines.
    pub tail: &'a TailCells,
    /// True where vertices whose triangles all have no UV area are decided.
    pub decides_flat: bool,
    /// The number of welded vertices.
    pub vertex_count: u32,
    pub quantity: PhantomData<Q>,
}

impl<Q: VertexQuantity> Pass for Discover<'_, Q> {
    type Quantity = Q;

    #[inline(always)]
    fn evaluate(self, block: &mut TriangleBlock, count: usize) {
        block.evaluate();
        block.count_flat(count);
    }

    #[inline(always)]
    fn scatter(
        self,
        block: &TriangleBlock,
        count: usize,
        vertices: &mut [VertexAccumulator],
        marks: &mut [u32],
    ) {
        scatter(block, count, vertices, marks);
    }

    /// The weighted tangent and the marks.
    #[inline(always)]
    fn stored_term(self, block: &TriangleBlock, k: usize, i: usize) -> Term {
        let [x, y, z, _] = block.sum[k][i];
        [x, y, z, f32::from_bits(block.marks[k][i])]
    }

    #[inline(always)]
    fn scatter_stored(
        self,
        corners: &[CornerVertices],
        terms: &[Term],
        block: &mut TriangleBlock,
        range: &mut VertexRange<'_>,
    ) {
        block.corner_fingerprints(corners);
        let VertexRange { first, vertices, marks } = range;
        let marks = &mut marks[..vertices.len()];
        for (i, (corner, term)) in corners.iter().zip(terms).take(BLOCK_SIZE).enumerate() {
            let at = corner[0].wrapping_sub(*first) as usize;
            let [x, y, z, new_marks] = *term;
            let new_marks = new_marks.to_bits();
            vertices[at].add([x, y, z, first_ray_count(new_marks)], &block.fingerprint[0][i]);
            marks[at] |= new_marks;
        }
    }

    fn mark_quads(self, list: &TriangleList<'_>, triangles: Range<usize>, range: &mut VertexRange<'_>) {
        list.mark_doubtful_quads(triangles, range.first, range.marks);
    }

    /// Around vertices without an orientation there is no triangle with UV area.
    #[inline(always)]
    fn reads_sums(self, marks: &[u32]) -> bool {
        let all = marks.iter().fold(0, |all, marks| all | marks);
        all & (corner_marks::PRESERVES | corner_marks::MIRRORS) != 0
    }

    #[inline(always)]
    fn finish(self, range: &mut VertexRange<'_>, tangents: &mut TangentBlock, findings: &mut Findings) {
        tangents.rows.clear();
        let mut signs = [UNDECIDED; BLOCK_SIZE];
        let (mut flat, mut flat_count) = ([0; BLOCK_SIZE], 0);
        for ((sign, &marks), &is_usable) in signs.iter_mut().zip(&*range.marks).zip(&tangents.is_usable) {
            *sign = sign_of_marks(marks, is_usable != 0);
        }
        for (i, (vertex, &marks)) in range.vertices.iter_mut().zip(&*range.marks).enumerate() {
            let mut tangent = tangents.get(i);
            let mut sign = signs[i % BLOCK_SIZE];
            if sign.is_nan() {
                if marks & corner_marks::FLAT == 0 {
                    findings.note_unused(vertex.position());
                } else {
                    (tangent, sign) = self.flat_tangent(vertex);
                    flat[flat_count % BLOCK_SIZE] = range.first + i as u32;
                    flat_count += usize::from(sign != UNDECIDED);
                }
            } else if sign != UNDECIDED {
                match fan(marks, vertex.sum[3], &vertex.fingerprint) {
                    Fan::Loop => {}
                    Fan::Row => tangents.rows.push(i, &vertex.fingerprint),
                    Fan::Several => sign = UNDECIDED,
                }
            }
            let undecided = if sign == UNDECIDED { flags::IS_UNDECIDED } else { 0 };
            let in_tail = if self.tail.contain(&vertex.record) { flags::IN_TAIL } else { 0 };
            vertex.finish(tangent, sign, undecided | in_tail);
        }
        if flat_count > 0 {
            findings.flat_vertices.extend_from_slice(&flat[..flat_count]);
        }
        tangents.rows.for_each_failed(self.vertex_count, |at| range.vertices[at].undecide());
    }
}

impl<Q> Discover<'_, Q> {
    /// The tangent and the sign of a vertex whose triangles all have no UV area: no group starts at it, so
    /// its corners keep the default.
    #[inline(always)]
    fn flat_tangent(self, vertex: &VertexAccumulator) -> ([f32; 3], f32) {
        let Frame { tangent, sign, .. } = DEFAULT_FRAME;
        let is_decided = self.decides_flat && is_clearly_usable(tangent, vertex.normal());
        (tangent, if is_decided { sign } else { UNDECIDED })
    }
}

/// The pass of a plan, which knows the sign of every vertex: [`UNDECIDED`] where other stages compute the
/// tangent.
#[derive(Clone, Copy)]
pub(crate) struct Replay<'a> {
    /// One sign per welded vertex.
    pub signs: &'a [f32],
    /// True where the triangles are halves of quads.
    pub has_quads: bool,
}

impl Pass for Replay<'_> {
    type Quantity = ();

    #[inline(always)]
    fn evaluate(self, block: &mut TriangleBlock, _count: usize) {
        if self.has_quads {
            block.evaluate_terms_of_quads();
        } else {
            block.evaluate_terms();
        }
    }

    #[inline(always)]
    fn scatter(
        self,
        block: &TriangleBlock,
        count: usize,
        vertices: &mut [VertexAccumulator],
        _marks: &mut [u32],
    ) {
        scatter_sums(block, count, vertices);
    }

    #[inline(always)]
    fn stored_term(self, block: &TriangleBlock, k: usize, i: usize) -> Term {
        block.sum[k][i]
    }

    #[inline(always)]
    fn scatter_stored(
        self,
        corners: &[CornerVertices],
        terms: &[Term],
        _block: &mut TriangleBlock,
        range: &mut VertexRange<'_>,
    ) {
        for (corner, term) in corners.iter().zip(terms) {
            range.vertices[corner[0].wrapping_sub(range.first) as usize].add_sum(term);
        }
    }

    fn mark_quads(self, _list: &TriangleList<'_>, _triangles: Range<usize>, _range: &mut VertexRange<'_>) {}

    #[inline(always)]
    fn reads_sums(self, _marks: &[u32]) -> bool {
        true
    }

    /// Notes whether all vertices with a sign have usable tangents.
    #[inline(always)]
    fn finish(self, range: &mut VertexRange<'_>, tangents: &mut TangentBlock, findings: &mut Findings) {
        let mut all_usable = true;
        let signs = &self.signs[range.first as usize..];
        for (i, (vertex, &sign)) in range.vertices.iter_mut().zip(signs).enumerate() {
            all_usable &= (tangents.is_usable[i] != 0) | (sign == UNDECIDED);
            vertex.finish(tangents.get(i), sign, 0);
        }
        findings.all_usable &= all_usable;
    }
}

/// Copies the values of vertices into accumulators whose sums are zero.
pub(crate) struct ReadVertices<'a> {
    pub values: VertexValues<'a>,
    pub vertices: &'a mut [VertexAccumulator],
    pub marks: &'a mut [u32],
}

impl Task for ReadVertices<'_> {
    #[inline(always)]
    fn run(self) {
        match self.values {
            VertexValues::Records(records) => {
                for ((record, vertex), marks) in records.iter().zip(self.vertices).zip(self.marks) {
                    vertex.record = *record;
                    vertex.clear();
                    *marks = 0;
                }
            }
            VertexValues::Slices(VertexSlices { positions, normals, uvs }) => {
                let values = positions.iter().zip(normals).zip(uvs);
                for ((((position, normal), uv), vertex), marks) in values.zip(self.vertices).zip(self.marks) {
                    // Written in three pieces: a record on the stack, written in pieces and read as a whole,
                    // stalls the processor.
                    vertex.record[..3].copy_from_slice(position);
                    vertex.record[3..6].copy_from_slice(normal);
                    vertex.record[6..].copy_from_slice(uv);
                    vertex.clear();
                    *marks = 0;
                }
            }
        }
    }
}

/// Loads up to [`BLOCK_SIZE`] triangles into a block and evaluates them. `first`: the number of the first of
/// `vertices`, which contain all vertices of these triangles.
#[inline(always)]
fn evaluate<P: Pass>(
    pass: P,
    triangles: &[[u32; 3]],
    (first, vertices): (u32, &[VertexAccumulator]),
    block: &mut TriangleBlock,
) {
    block.set(triangles, first);
    gather(block, triangles.len(), vertices);
    pass.evaluate(block, triangles.len());
}

/// Adds triangles to their vertices, all of which are in `range`.
pub(crate) struct AddTriangles<'a, P: Pass> {
    pub pass: P,
    pub triangles: &'a [[u32; 3]],
    pub block: &'a mut TriangleBlock,
    pub range: VertexRange<'a>,
    /// The further quantities of the thread's own vertices.
    pub own: QuantityRange<'a, P::Quantity>,
}

impl<P: Pass> Task for AddTriangles<'_, P> {
    #[inline(always)]
    fn run(mut self) {
        let VertexRange { first, vertices, marks } = self.range;
        for triangles in self.triangles.chunks(BLOCK_SIZE) {
            evaluate(self.pass, triangles, (first, vertices), self.block);
            self.pass.scatter(self.block, triangles.len(), vertices, marks);
            self.own.add(self.block, triangles.len(), first);
        }
    }
}

/// Counts the corners of triangles in every bucket of vertices.
pub(crate) struct CountBuckets<'a> {
    pub triangles: &'a [[u32; 3]],
    pub bucket_bits: u32,
    pub counts: &'a mut [u32],
}

impl Task for CountBuckets<'_> {
    #[inline(always)]
    fn run(self) {
        for vertex in self.triangles.as_flattened() {
            self.counts[(vertex >> self.bucket_bits) as usize] += 1;
        }
    }
}

/// Stores what each corner adds to its vertex, sorted by bucket.
pub(crate) struct StoreTerms<'a, P> {
    pub pass: P,
    pub triangles: &'a [[u32; 3]],
    pub block: &'a mut TriangleBlock,
    /// All vertices of the mesh.
    pub vertices: &'a [VertexAccumulator],
    pub bucket_bits: u32,
    /// Where the next corner of each bucket is stored.
    pub next: &'a mut [u32],
    pub corners: &'a mut [CornerVertices],
    pub terms: &'a mut [Term],
}

impl<P: Pass> Task for StoreTerms<'_, P> {
    #[inline(always)]
    fn run(self) {
        let corners = &mut self.corners[..self.terms.len()];
        for triangles in self.triangles.chunks(BLOCK_SIZE) {
            evaluate(self.pass, triangles, (0, self.vertices), self.block);
            for (i, &[a, b, c]) in triangles.iter().take(BLOCK_SIZE).enumerate() {
                for (k, corner) in [[a, b, c], [b, c, a], [c, a, b]].into_iter().enumerate() {
                    let next = &mut self.next[(corner[0] >> self.bucket_bits) as usize];
                    let at = *next as usize;
                    *next += 1;
                    corners[at] = corner;
                    self.terms[at] = self.pass.stored_term(self.block, k, i);
                }
            }
        }
    }
}

/// Adds the terms that [`StoreTerms`] stored for one bucket.
pub(crate) struct AddStoredTerms<'a, P> {
    pub pass: P,
    pub corners: &'a [CornerVertices],
    pub terms: &'a [Term],
    pub block: &'a mut TriangleBlock,
    pub range: VertexRange<'a>,
}

impl<P: Pass> Task for AddStoredTerms<'_, P> {
    #[inline(always)]
    fn run(mut self) {
        for (corners, terms) in self.corners.chunks(BLOCK_SIZE).zip(self.terms.chunks(BLOCK_SIZE)) {
            self.pass.scatter_stored(corners, terms, self.block, &mut self.range);
        }
    }
}

/// Makes tangents of the sums of vertices to which all triangles have been added.
pub(crate) struct FinishVertices<'a, P> {
    pub pass: P,
    pub range: VertexRange<'a>,
    pub findings: &'a mut Findings,
}

impl<P: Pass> Task for FinishVertices<'_, P> {
    #[inline(always)]
    fn run(self) {
        let mut tangents = TangentBlock::default();
        let VertexRange { mut first, vertices, marks } = self.range;
        for (vertices, marks) in vertices.chunks_mut(BLOCK_SIZE).zip(marks.chunks_mut(BLOCK_SIZE)) {
            if self.pass.reads_sums(marks) {
                tangents.load(vertices);
                tangents.normalize();
            }
            let count = vertices.len() as u32;
            self.pass.finish(&mut VertexRange { first, vertices, marks }, &mut tangents, self.findings);
            first += count;
        }
    }
}

/// The sums and the normals of a block of vertices, one array per component.
pub(crate) struct TangentBlock {
    sum: [[f32; BLOCK_SIZE]; 3],
    normal: [[f32; BLOCK_SIZE]; 3],
    /// 1 where the tangent needs no repair, else 0.
    is_usable: [u32; BLOCK_SIZE],
    /// The vertices that can be one open row.
    rows: OpenRows,
}

impl Default for TangentBlock {
    fn default() -> Self {
        Self {
            sum: [[0.0; BLOCK_SIZE]; 3],
            normal: [[0.0; BLOCK_SIZE]; 3],
            is_usable: [0; BLOCK_SIZE],
            rows: OpenRows::default(),
        }
    }
}

impl TangentBlock {
    #[inline(always)]
    fn load(&mut self, vertices: &[VertexAccumulator]) {
        for (i, vertex) in vertices.iter().take(BLOCK_SIZE).enumerate() {
            for axis in 0..3 {
                self.sum[axis][i] = vertex.sum[axis];
                self.normal[axis][i] = vertex.record[3 + axis];
            }
        }
    }

    /// Turns sums into tangents.
    #[inline(always)]
    fn normalize(&mut self) {
        for i in 0..BLOCK_SIZE {
            let tangent = normalized_unless_zero([self.sum[0][i], self.sum[1][i], self.sum[2][i]]);
            let normal = [self.normal[0][i], self.normal[1][i], self.normal[2][i]];
            let is_usable = is_clearly_usable(tangent, normal);
            for axis in 0..3 {
                self.sum[axis][i] = tangent[axis];
            }
            self.is_usable[i] = if is_usable { 1 } else { 0 };
        }
    }

    #[inline(always)]
    fn get(&self, i: usize) -> [f32; 3] {
        [self.sum[0][i], self.sum[1][i], self.sum[2][i]]
    }
}

/// True for a tangent that is usable in the sense of `repair.rs`, with a margin for rounding.
#[inline(always)]
pub(crate) fn is_clearly_usable(tangent: V3, normal: V3) -> bool {
    let (along, squared) = (dot(tangent, normal), dot(normal, normal));
    let error = (dot(tangent, tangent) - 1.0).abs();
    (error < 1e-3) & (squared > 1e-30) & (squared < 1e30) & (along * along < 0.99 * squared)
}

/// Copies tangents from finished vertices to the corners of faces of `N` corners; with `N` = 1, to single
/// corners.
pub(crate) struct WriteCorners<'a, const N: usize> {
    /// The vertices of each face.
    pub faces: &'a [[u32; N]],
    /// The number of the first face.
    pub first_face: usize,
    pub vertices: &'a [VertexAccumulator],
    /// The number of the first of `vertices`.
    pub first_vertex: u32,
    pub out: &'a mut [[[f32; 4]; N]],
    pub exceptions: &'a mut Exceptions,
}

impl<const N: usize> Task for WriteCorners<'_, N> {
    #[inline(always)]
    fn run(self) {
        let vertex = |number: u32| &self.vertices[number.wrapping_sub(self.first_vertex) as usize];
        let out = &mut self.out[..self.faces.len()];
        for i in 0..self.faces.len() {
            write_face((self.first_face + i) as u32, self.faces[i].map(vertex), self.exceptions, &mut out[i]);
        }
    }
}

/// Copies tangents to the corners of one face, and lists the face where a vertex has flags.
#[inline(always)]
pub(crate) fn write_face<const N: usize>(
    face: u32,
    vertices: [&VertexAccumulator; N],
    exceptions: &mut Exceptions,
    out: &mut [[f32; 4]; N],
) {
    let mut flags = 0;
    for k in 0..N {
        out[k] = vertices[k].tangent();
        flags |= vertices[k].flags();
    }
    if flags != 0 {
        exceptions.note(face, vertices);
    }
}

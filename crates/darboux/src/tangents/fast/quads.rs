//! Faces split into triangles: which three of its face's corners each triangle has.
//!
//! Around a vertex, the halves of a quad count as two triangles. The reference treats them as one face in
//! three places:
//! - Halves of opposite UV orientation are given one orientation (`agree_in_quads`). Such quads are listed
//!   here as doubtful, and the general path handles all their vertices.
//! - The two corners on the diagonal are written twice, and the second time averaged. At a decided vertex
//!   both frames are equal, and so is their average, unless a derivative is infinite. Quads with a half of
//!   nearly no UV area are therefore doubtful, too.
//! - Vertices are named after corners, whose numbers differ from those of the entries of the triangle list
//!   (see `edge_tail.rs`).

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::ops::Range;

use crate::Faces;
use crate::Indices;
use crate::Mesh;
use crate::mesh::MAX_CORNERS;
use crate::topology::triangulate::{is_cut_across, shorter_diagonal};

use crate::exec::simd::{Task, Width};
use crate::exec::threads::{self, split_range, split_slice};
use crate::tangents::mikktspace::derivatives::doubled_area;

/// A triangle of a face: the first corner of the face, and in the two highest bits a row of [`CORNERS`].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FaceTriangle(u32);

/// The corners of a triangle or of the first half of a quad, and of the second half, where corners 0 and 2
/// are joined; the same for the halves of a quad where corners 1 and 3 are joined.
const CORNERS: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]];

/// Corner numbers have at most this many bits.
const CORNER_BITS: u32 = 30;
const _: () = assert!(MAX_CORNERS < 1 << CORNER_BITS);

impl FaceTriangle {
    #[inline(always)]
    fn new(first_corner: usize, row: u32) -> Self {
        Self(first_corner as u32 | row << CORNER_BITS)
    }

    /// The first corner of the face.
    #[inline(always)]
    pub fn first_corner(self) -> u32 {
        self.0 & ((1 << CORNER_BITS) - 1)
    }

    #[inline(always)]
    pub fn corners(self) -> [u32; 3] {
        CORNERS[(self.0 >> CORNER_BITS) as usize].map(|corner| self.first_corner() + corner)
    }

    /// True for the second half of a quad.
    #[inline(always)]
    pub fn is_second(self) -> bool {
        self.0 >> CORNER_BITS & 1 == 1
    }

    /// True for the halves of a quad whose corners 1 and 3 are joined.
    #[inline(always)]
    fn is_across(self) -> bool {
        self.0 >> CORNER_BITS & 2 == 2
    }
}

/// The triangles that faces are split into. The memory is reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct FaceSplit {
    /// Empty where all faces are triangles.
    pub triangles: Vec<FaceTriangle>,
    /// The first halves of doubtful quads, ascending.
    doubtful: Vec<u32>,
    /// The doubtful quads that each thread has found.
    doubtful_of_thread: Vec<Vec<u32>>,
}

impl FaceSplit {
    /// Splits the faces of a mesh. None where a face has other than 3 or 4 corners.
    pub fn split(&mut self, mesh: &Mesh<'_>, width: Width, threads: usize) -> Option<()> {
        self.doubtful.clear();
        let sizes = match mesh.faces() {
            Faces::Triangles => {
                self.triangles.clear();
                return Some(());
            }
            Faces::Quads => None,
            Faces::Mixed(sizes) if sizes.iter().all(|size| matches!(size, 3 | 4)) => Some(sizes),
            Faces::Mixed(_) => return None,
        };
        self.triangles.resize(triangle_count(mesh), FaceTriangle::default());
        self.doubtful_of_thread.resize_with(threads, Vec::new);
        let first_corner = |face: usize| match sizes {
            None => 4 * face,
            Some(sizes) => sizes[..face].iter().sum::<u32>() as usize,
        };
        let first_triangle = |face: usize| first_corner(face) - 2 * face;
        let faces = split_range(0..mesh.face_count(), threads, 1);
        let ranges = faces.clone().map(|faces| first_triangle(faces.start)..first_triangle(faces.end));
        let jobs = faces.zip(split_slice(&mut self.triangles, 0, ranges));
        threads::run(&mut self.doubtful_of_thread, jobs, |doubtful, (faces, triangles)| {
            let (corner, first) = (first_corner(faces.start), first_triangle(faces.start));
            let sizes = sizes.map(|sizes| &sizes[faces]);
            width.run(SplitQuads { mesh, sizes, corner, first, triangles, doubtful });
        });
        self.doubtful_of_thread.iter_mut().for_each(|doubtful| self.doubtful.append(doubtful));
        Some(())
    }

    /// The first halves of doubtful quads among `triangles`.
    pub fn doubtful_among(&self, triangles: Range<usize>) -> &[u32] {
        let place = |triangle: usize| self.doubtful.partition_point(|&other| (other as usize) < triangle);
        &self.doubtful[place(triangles.start)..place(triangles.end)]
    }
}

/// The number of triangles of a mesh whose faces all have 3 or 4 corners.
pub(crate) fn triangle_count(mesh: &Mesh<'_>) -> usize {
    mesh.corner_count().saturating_sub(2 * mesh.face_count())
}

/// Splits faces, [`QUADS_AT_ONCE`] quads together.
struct SplitQuads<'a> {
    mesh: &'a Mesh<'a>,
    /// The number of corners of each face; none where all faces are quads.
    sizes: Option<&'a [u32]>,
    /// The number of the first corner.
    corner: usize,
    /// The number of the first of `triangles`.
    first: usize,
    triangles: &'a mut [FaceTriangle],
    doubtful: &'a mut Vec<u32>,
}

impl Task for SplitQuads<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { mesh, sizes, mut corner, first, triangles, doubtful } = self;
        let (mut quads, mut face, mut triangle) = (QuadBlock::default(), 0, 0);
        let packed = mesh.uvs().packed();
        let uv = |vertex: usize| match packed {
            Some(uvs) => uvs[vertex],
            None => mesh.uvs().get(vertex),
        };
        while triangle < triangles.len() {
            if sizes.is_none_or(|sizes| sizes[face] == 4) {
                let [a, b, c, d] = vertices(mesh, corner);
                quads.push(corner, triangle, [uv(a), uv(b), uv(c), uv(d)]);
                (corner, triangle) = (corner + 4, triangle + 2);
            } else {
                triangles[triangle] = FaceTriangle::new(corner, 0);
                (corner, triangle) = (corner + 3, triangle + 1);
            }
            face += 1;
            if quads.count == QUADS_AT_ONCE || triangle == triangles.len() {
                quads.split(mesh, first, triangles, doubtful);
            }
        }
    }
}

/// Quads that are split together, in lanes.
const QUADS_AT_ONCE: usize = if cfg!(small_limits) { 2 } else { 16 };

#[derive(Default)]
struct QuadBlock {
    count: usize,
    /// The first corner of each quad.
    corner: [usize; QUADS_AT_ONCE],
    /// The index of each quad's first half in the output.
    triangle: [usize; QUADS_AT_ONCE],
    /// The UVs of the four corners.
    u: [[f32; QUADS_AT_ONCE]; 4],
    v: [[f32; QUADS_AT_ONCE]; 4],
}

impl QuadBlock {
    #[inline(always)]
    fn push(&mut self, corner: usize, triangle: usize, uvs: [[f32; 2]; 4]) {
        let i = self.count;
        (self.corner[i], self.triangle[i]) = (corner, triangle);
        for k in 0..4 {
            [self.u[k][i], self.v[k][i]] = uvs[k];
        }
        self.count += 1;
    }

    #[inline(always)]
    fn uvs(&self, i: usize) -> [[f32; 2]; 4] {
        [0, 1, 2, 3].map(|k| [self.u[k][i], self.v[k][i]])
    }

    /// Writes the halves of all quads of the block, lists the doubtful quads, and empties the block.
    #[inline(always)]
    fn split(
        &mut self,
        mesh: &Mesh<'_>,
        first: usize,
        triangles: &mut [FaceTriangle],
        doubtful: &mut Vec<u32>,
    ) {
        let (mut row, mut is_doubtful) = ([0; QUADS_AT_ONCE], [0; QUADS_AT_ONCE]);
        let mut ties = 0;
        for i in 0..QUADS_AT_ONCE {
            let (is_across, is_tie) = shorter_diagonal(self.uvs(i).map(|[u, v]| [u, v, 1.0]));
            row[i] = if is_across { 2 } else { 0 };
            ties |= if is_tie { 1 } else { 0 };
        }
        if ties != 0 {
            for i in 0..self.count {
                let positions = || vertices(mesh, self.corner[i]).map(|vertex| mesh.positions().get(vertex));
                row[i] = if is_cut_across(self.uvs(i), positions) { 2 } else { 0 };
            }
        }
        for i in 0..QUADS_AT_ONCE {
            let [a, b] = halves(self.uvs(i), row[i] == 2).map(doubled_area);
            is_doubtful[i] = if have_one_orientation(a, b) { 0 } else { 1 };
        }
        for i in 0..self.count {
            let (corner, triangle) = (self.corner[i], self.triangle[i]);
            triangles[triangle..triangle + 2]
                .copy_from_slice(&[FaceTriangle::new(corner, row[i]), FaceTriangle::new(corner, row[i] + 1)]);
            if is_doubtful[i] != 0 {
                doubtful.push((first + triangle) as u32);
            }
        }
        self.count = 0;
    }
}

/// The vertices of four consecutive corners.
#[inline(always)]
fn vertices(mesh: &Mesh<'_>, corner: usize) -> [usize; 4] {
    match mesh.indices() {
        Indices::Unindexed => [corner, corner + 1, corner + 2, corner + 3],
        Indices::U16(list) => four(&list[corner..corner + 4]),
        Indices::U32(list) => four(&list[corner..corner + 4]),
    }
}

/// Four indices. Written out, because a closure over an array would stay a call.
#[inline(always)]
fn four<I: Copy + Into<u32>>(list: &[I]) -> [usize; 4] {
    [list[0].into() as usize, list[1].into() as usize, list[2].into() as usize, list[3].into() as usize]
}

/// The values at the corners of both halves of a quad.
#[inline(always)]
fn halves<T: Copy>([a, b, c, d]: [T; 4], is_across: bool) -> [[T; 3]; 2] {
    [[a, b, if is_across { d } else { c }], [if is_across { b } else { a }, c, d]]
}

/// The vertices of triangles, from the vertices of all corners of their faces.
pub(crate) fn split_vertices(
    mut triangles: &[FaceTriangle],
    mut vertices: &[u32],
    vertices_of_triangle: &mut Vec<[u32; 3]>,
) {
    vertices_of_triangle.resize(triangles.len(), [0; 3]);
    let mut out = &mut vertices_of_triangle[..];
    while let Some((triangle, later)) = triangles.split_first() {
        if later.first().is_some_and(|later| later.is_second()) {
            let (&quad, rest) = vertices.split_first_chunk().expect("four corners of a quad");
            let (next, remaining) = out.split_at_mut(2);
            next.copy_from_slice(&halves(quad, triangle.is_across()));
            (triangles, vertices, out) = (&later[1..], rest, remaining);
        } else {
            let (&corners, rest) = vertices.split_first_chunk().expect("three corners of a triangle");
            let (next, remaining) = out.split_at_mut(1);
            next[0] = corners;
            (triangles, vertices, out) = (later, rest, remaining);
        }
    }
}

/// True where the halves of a quad have one orientation and UV areas of at least [`MIN_AREA`]. `a`, `b`:
/// their doubled areas.
#[inline(always)]
fn have_one_orientation(a: f32, b: f32) -> bool {
    (a > MIN_AREA) & (b > MIN_AREA) | (a < -MIN_AREA) & (b < -MIN_AREA)
}

/// No derivative divided by a larger UV area is infinite: derivatives of decided triangles have squares that
/// are finite, so lengths up to 1.9e19.
pub(crate) const MIN_AREA: f32 = 1e-18;

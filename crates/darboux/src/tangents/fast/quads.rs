//! Faces cut into triangles: which corners each has.
//!
//! Around a vertex the halves of a quad are triangles like others. That they are one face shows in three places. Halves of opposite UV
//! orientation agree on one (see `agree_in_quads`): such quads are listed here, and all of their vertices left undecided. A corner
//! that both have is written twice, and the second time averaged: at a decided vertex both frames are one, and so is their average.
//! And vertices are named after corners, which here are not numbered as the list's entries are (see `last_run`).

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::ops::Range;

use crate::Faces;
use crate::Indices;
use crate::Mesh;
use crate::mesh::MAX_CORNERS;
use crate::topology::triangulate::{is_cut_across, shorter_diagonal};

use crate::exec::simd::{Task, Width};
use crate::exec::threads::{self, parts, split};
use crate::tangents::fast::input::Source;
use crate::tangents::fast::kernel::marks;
use crate::tangents::fast::weld_vertices::Refused;
use crate::tangents::fast::worker::Worker;
use crate::tangents::mikktspace::derivatives::doubled_area;

/// A triangle: the first corner of its face, and in the two highest bits which of the face's corners it has.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Piece(u32);

/// Which corners pieces have: a triangle's or a first half's and a second half's where 0 and 2 are joined; the halves' where 1 and 3 are.
const CORNERS: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]];

/// Corners' numbers are below this.
const CORNER_BITS: u32 = 30;
const _: () = assert!(MAX_CORNERS < 1 << CORNER_BITS);

impl Piece {
    #[inline(always)]
    fn new(first_corner: usize, which: u32) -> Self {
        Self(first_corner as u32 | which << CORNER_BITS)
    }

    /// The first corner of its face.
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

/// The triangles that faces are cut into; the memory is kept from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Cut {
    /// None where faces are triangles.
    pub pieces: Vec<Piece>,
    /// The first halves of quads whose halves may have to agree on an orientation, ascending.
    doubtful: Vec<u32>,
}

/// Of meshes of triangles.
pub(crate) static UNCUT: Cut = Cut { pieces: Vec::new(), doubtful: Vec::new() };

impl Cut {
    /// Cuts the faces of a mesh. Refuses those of other than 3 or 4 corners.
    pub fn cut(&mut self, mesh: &Mesh<'_>, width: Width, workers: &mut [Worker]) -> Result<(), Refused> {
        self.doubtful.clear();
        let sizes = match mesh.faces() {
            Faces::Triangles => {
                self.pieces.clear();
                return Ok(());
            }
            Faces::Quads => None,
            Faces::Mixed(sizes) if sizes.iter().all(|size| matches!(size, 3 | 4)) => Some(sizes),
            Faces::Mixed(_) => return Err(Refused),
        };
        self.pieces.resize(triangle_count(mesh), Piece::default());
        let first_corner = |face: usize| match sizes {
            None => 4 * face,
            Some(sizes) => sizes[..face].iter().sum::<u32>() as usize,
        };
        let first_piece = |face: usize| first_corner(face) - 2 * face;
        let faces = split(0..mesh.face_count(), workers.len(), 1);
        let ranges = faces.clone().map(|faces| first_piece(faces.start)..first_piece(faces.end));
        let jobs = faces.zip(parts(&mut self.pieces, 0, ranges));
        threads::run(workers, jobs, |worker, (faces, pieces)| {
            let (corner, first) = (first_corner(faces.start), first_piece(faces.start));
            let (sizes, doubtful) = (sizes.map(|sizes| &sizes[faces]), &mut worker.doubtful);
            width.run(CutAll { mesh, sizes, corner, first, pieces, doubtful });
        });
        workers.iter_mut().for_each(|worker| self.doubtful.append(&mut worker.doubtful));
        Ok(())
    }

    /// The first halves of doubtful quads among some triangles.
    fn doubtful(&self, triangles: Range<usize>) -> &[u32] {
        let place = |triangle: usize| self.doubtful.partition_point(|&other| (other as usize) < triangle);
        &self.doubtful[place(triangles.start)..place(triangles.end)]
    }
}

/// Puts trouble on those vertices of doubtful quads among some triangles that have `marks`; the first of these is vertex `first`'s.
pub(crate) fn mark_doubtful(source: &Source<'_>, triangles: Range<usize>, first: usize, marks: &mut [u32]) {
    for &half in source.cut.doubtful(triangles) {
        for vertex in [half, half + 1].into_iter().flat_map(|half| source.triangle(half)) {
            if let Some(found) = marks.get_mut((vertex as usize).wrapping_sub(first)) {
                *found |= marks::TROUBLE;
            }
        }
    }
}

/// How many triangles there are, where all faces have 3 or 4 corners.
pub(crate) fn triangle_count(mesh: &Mesh<'_>) -> usize {
    mesh.corner_count().saturating_sub(2 * mesh.face_count())
}

/// Cuts faces, [`LANES`] quads at once.
struct CutAll<'a> {
    mesh: &'a Mesh<'a>,
    /// How many corners each face has; none where all have four.
    sizes: Option<&'a [u32]>,
    /// The number of the first corner, and of the first of `pieces`.
    corner: usize,
    first: usize,
    pieces: &'a mut [Piece],
    doubtful: &'a mut Vec<u32>,
}

impl Task for CutAll<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { mesh, sizes, mut corner, first, pieces, doubtful } = self;
        let (mut quads, mut face, mut piece) = (Quads::default(), 0, 0);
        let packed = mesh.uvs().packed();
        let uv = |vertex: usize| match packed {
            Some(uvs) => uvs[vertex],
            None => mesh.uvs().get(vertex),
        };
        while piece < pieces.len() {
            if sizes.is_none_or(|sizes| sizes[face] == 4) {
                let [a, b, c, d] = vertices(mesh, corner);
                quads.take(corner, piece, [uv(a), uv(b), uv(c), uv(d)]);
                (corner, piece) = (corner + 4, piece + 2);
            } else {
                pieces[piece] = Piece::new(corner, 0);
                (corner, piece) = (corner + 3, piece + 1);
            }
            face += 1;
            if quads.count == LANES || piece == pieces.len() {
                quads.cut(mesh, first, pieces, doubtful);
            }
        }
    }
}

/// Quads that are cut at once.
const LANES: usize = if cfg!(small_limits) { 2 } else { 16 };

#[derive(Default)]
struct Quads {
    count: usize,
    /// The first corner of each, and the place of its first half.
    corner: [usize; LANES],
    piece: [usize; LANES],
    /// The UVs of the four corners.
    u: [[f32; LANES]; 4],
    v: [[f32; LANES]; 4],
}

impl Quads {
    #[inline(always)]
    fn take(&mut self, corner: usize, piece: usize, uvs: [[f32; 2]; 4]) {
        let i = self.count;
        (self.corner[i], self.piece[i]) = (corner, piece);
        for k in 0..4 {
            [self.u[k][i], self.v[k][i]] = uvs[k];
        }
        self.count += 1;
    }

    #[inline(always)]
    fn uvs(&self, i: usize) -> [[f32; 2]; 4] {
        [0, 1, 2, 3].map(|k| [self.u[k][i], self.v[k][i]])
    }

    /// Writes the halves of the quads taken, and lists the doubtful ones.
    #[inline(always)]
    fn cut(&mut self, mesh: &Mesh<'_>, first: usize, pieces: &mut [Piece], doubtful: &mut Vec<u32>) {
        let (mut which, mut are_unalike) = ([0; LANES], [0; LANES]);
        let mut ties = 0;
        for i in 0..LANES {
            let (is_across, is_tie) = shorter_diagonal(self.uvs(i).map(|[u, v]| [u, v, 1.0]));
            which[i] = if is_across { 2 } else { 0 };
            ties |= if is_tie { 1 } else { 0 };
        }
        if ties != 0 {
            for i in 0..self.count {
                let positions = || vertices(mesh, self.corner[i]).map(|vertex| mesh.positions().get(vertex));
                which[i] = if is_cut_across(self.uvs(i), positions) { 2 } else { 0 };
            }
        }
        for i in 0..LANES {
            let [a, b] = halves(self.uvs(i), which[i] == 2).map(doubled_area);
            are_unalike[i] = if are_alike(a, b) { 0 } else { 1 };
        }
        for i in 0..self.count {
            let (corner, piece) = (self.corner[i], self.piece[i]);
            pieces[piece..piece + 2]
                .copy_from_slice(&[Piece::new(corner, which[i]), Piece::new(corner, which[i] + 1)]);
            if are_unalike[i] != 0 {
                doubtful.push((first + piece) as u32);
            }
        }
        self.count = 0;
    }
}

/// The vertices of four corners.
#[inline(always)]
fn vertices(mesh: &Mesh<'_>, corner: usize) -> [usize; 4] {
    match mesh.indices() {
        Indices::Unindexed => [corner, corner + 1, corner + 2, corner + 3],
        Indices::U16(list) => four(&list[corner..corner + 4]),
        Indices::U32(list) => four(&list[corner..corner + 4]),
    }
}

/// Written out, as closures over arrays stay calls.
#[inline(always)]
fn four<I: Copy + Into<u32>>(list: &[I]) -> [usize; 4] {
    [list[0].into() as usize, list[1].into() as usize, list[2].into() as usize, list[3].into() as usize]
}

/// What the halves of a quad have of what its corners have.
#[inline(always)]
fn halves<T: Copy>([a, b, c, d]: [T; 4], is_across: bool) -> [[T; 3]; 2] {
    [[a, b, if is_across { d } else { c }], [if is_across { b } else { a }, c, d]]
}

/// Turns the vertices of whole faces' corners into those of their pieces.
pub(crate) fn cut_vertices(mut pieces: &[Piece], mut vertices: &[u32], triangles: &mut Vec<[u32; 3]>) {
    triangles.resize(pieces.len(), [0; 3]);
    let mut out = &mut triangles[..];
    while let Some((piece, later)) = pieces.split_first() {
        if later.first().is_some_and(|later| later.is_second()) {
            let (&quad, rest) = vertices.split_first_chunk().expect("four corners of a quad");
            let (next, room) = out.split_at_mut(2);
            next.copy_from_slice(&halves(quad, piece.is_across()));
            (pieces, vertices, out) = (&later[1..], rest, room);
        } else {
            let (&triangle, rest) = vertices.split_first_chunk().expect("three corners of a triangle");
            let (next, room) = out.split_at_mut(1);
            next[0] = triangle;
            (pieces, vertices, out) = (later, rest, room);
        }
    }
}

/// True where the halves of a quad have one orientation, and UV areas that no derivative divided by them is infinite: else the average of
/// two equal frames could be another.
#[inline(always)]
fn are_alike(a: f32, b: f32) -> bool {
    (a > LEAST_AREA) & (b > LEAST_AREA) | (a < -LEAST_AREA) & (b < -LEAST_AREA)
}

/// ScaledDerivatives that are not in trouble have squares that are floats, so lengths up to 1.9e19.
pub(crate) const LEAST_AREA: f32 = 1e-18;

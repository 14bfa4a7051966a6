//! What all triangles add to their vertices, by all threads: each has vertices of its own and adds to them in the triangles' order, so that
//! no sum depends on how many threads there are.

use std::marker::PhantomData;
use std::ops::Range;

use crate::math::V3;

use crate::exec::simd::{Task, Width};
use crate::exec::threads::{self, parts, split};
use crate::exec::windows::{Share, Window, look_around, overlap, shares, triangles_of, windows_of};
use crate::tangents::angle_area::group_sums::GroupMemory;
use crate::tangents::mesh_slices::{Flat, Slices};
use crate::tangents::report::are_finite;
use crate::tangents::vertex_sums::gather::gather_all;
use crate::tangents::vertex_sums::term_kernel::{BLOCK, Block};
use crate::tangents::vertex_sums::weighting::{
    Derivatives, Orientation, Sum, Weighting, is_degenerate, term,
};

/// The sums of all vertices and what was met on the way.
pub(crate) struct Sums<const N: usize> {
    /// Per orientation and vertex; none of an orientation that no triangle has, but that the first is always there.
    pub of_side: [Vec<Sum<N>>; 2],
    pub orientation_of_face: Vec<Orientation>,
    pub flaws: Flaws,
}

/// Triangles that add nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Flaws {
    pub degenerate: usize,
    pub uv_degenerate: usize,
    /// Others, with a value that is not finite.
    non_finite: usize,
}

impl Flaws {
    pub fn are_none(&self) -> bool {
        self.degenerate + self.uv_degenerate + self.non_finite == 0
    }

    #[cold]
    fn count(&mut self, positions: [&V3; 3], uvs: [&[f32; 2]; 3]) {
        if is_degenerate(positions.map(|position| *position)) {
            self.degenerate += 1;
        } else if !are_finite(positions.map(|position| *position), uvs.map(|uv| *uv)) {
            self.non_finite += 1;
        } else {
            self.uv_degenerate += 1;
        }
    }

    pub fn add(&mut self, other: Self) {
        self.degenerate += other.degenerate;
        self.uv_degenerate += other.uv_degenerate;
        self.non_finite += other.non_finite;
    }
}

/// What a run leaves behind for the next one.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    of_two_rows: [Vec<Sum<2>>; 2],
    of_three_rows: [Vec<Sum<3>>; 2],
    orientation_of_face: Vec<Orientation>,
    pub tangents_of_side: [Vec<[f32; 4]>; 2],
    pub of_groups: GroupMemory,
}

/// Where sums of `N` rows are kept.
pub(crate) trait Keeps<const N: usize> {
    fn of_side(&mut self) -> &mut [Vec<Sum<N>>; 2];
}

impl Keeps<2> for Memory {
    fn of_side(&mut self) -> &mut [Vec<Sum<2>>; 2] {
        &mut self.of_two_rows
    }
}

impl Keeps<3> for Memory {
    fn of_side(&mut self) -> &mut [Vec<Sum<3>>; 2] {
        &mut self.of_three_rows
    }
}

impl<const N: usize> Sums<N> {
    /// Room for sums, in the memory of earlier ones. What the first side holds is anything.
    pub fn new(flat: &Flat<'_>, memory: &mut Memory) -> Self
    where
        Memory: Keeps<N>,
    {
        let mut of_side = std::mem::take(memory.of_side());
        let mut orientation_of_face = std::mem::take(&mut memory.orientation_of_face);
        of_side[0].resize(flat.positions.len(), [[0.0; 4]; N]);
        of_side[1].clear();
        orientation_of_face.resize(flat.triangles().len(), Orientation::None);
        Self { of_side, orientation_of_face, flaws: Flaws::default() }
    }

    /// Leaves the memory for others.
    pub fn keep(self, memory: &mut Memory)
    where
        Memory: Keeps<N>,
    {
        *memory.of_side() = self.of_side;
        memory.orientation_of_face = self.orientation_of_face;
    }
}

/// What one thread has to do.
struct Part {
    /// The triangles that it counts.
    own: Range<usize>,
    /// The triangles that it adds.
    adds: Range<usize>,
    /// The vertices that it adds to.
    vertices: Range<usize>,
}

/// Gives each thread consecutive triangles and the vertices that they meet first; none where vertices lie all over the mesh.
fn parts_of(flat: &Flat<'_>) -> Option<Vec<Part>> {
    let (triangles, vertices) = (flat.triangles(), flat.positions.len());
    let count = triangles.len();
    let threads = threads::count(count);
    if threads == 1 {
        return Some(vec![Part { own: 0..count, adds: 0..count, vertices: 0..vertices }]);
    }
    let windows = windows(triangles);
    let shares: Vec<_> = shares(&windows, vertices, threads).collect();
    let part = |share: &Share| Part {
        own: triangles_of(share.windows.clone(), count),
        adds: triangles_of(share.windows.start..share.until, count),
        vertices: share.vertices.clone(),
    };
    (!overlap(&shares, &windows)).then(|| shares.iter().map(part).collect())
}

fn windows(triangles: &[[u32; 3]]) -> Vec<Window> {
    let window = |range: Range<usize>| {
        let (mut lowest, mut end) = (u32::MAX, 0);
        for &vertex in triangles[range].as_flattened() {
            lowest = vertex.min(lowest);
            end = end.max(vertex + 1);
        }
        Window { lowest, end, ..Window::default() }
    };
    let mut windows: Vec<_> = windows_of(triangles.len()).map(window).collect();
    look_around(&mut windows);
    windows
}

/// What a thread finds out about the triangles that it counts.
pub(crate) struct Count<'a> {
    first: usize,
    orientations: &'a mut [Orientation],
    pub flaws: Flaws,
}

impl<'a> Count<'a> {
    pub fn new(first: usize, orientations: &'a mut [Orientation]) -> Self {
        Self { first, orientations, flaws: Flaws::default() }
    }

    /// Notes the orientations of consecutive triangles, of which any may be another's to count.
    #[inline(always)]
    fn note(&mut self, slices: &Slices<'_>, first: usize, orientations: &[Orientation]) {
        let start = first.max(self.first);
        let end = (first + orientations.len()).min(self.first + self.orientations.len());
        if start >= end {
            return;
        }
        let own = &orientations[start - first..end - first];
        self.orientations[start - self.first..end - self.first].copy_from_slice(own);
        if found(own) & bit(Orientation::None) != 0 {
            self.note_flaws(slices, start, own);
        }
    }

    #[cold]
    fn note_flaws(&mut self, slices: &Slices<'_>, first: usize, orientations: &[Orientation]) {
        for (t, _) in (first..).zip(orientations).filter(|(_, found)| **found == Orientation::None) {
            let (positions, uvs) = slices.refer(slices.triangles[t]);
            self.flaws.count(positions, uvs);
        }
    }
}

/// One bit for each orientation that is found: a loop that runs many lanes at a time.
#[inline(always)]
pub(crate) fn found(orientations: &[Orientation]) -> u8 {
    orientations.iter().fold(0, |found, &orientation| found | bit(orientation))
}

#[inline(always)]
pub(crate) fn bit(orientation: Orientation) -> u8 {
    1 << orientation as u8
}

/// The orientations of faces, where these are not all triangles, and how wide vectors may be.
pub(crate) type How<'a> = (Option<&'a [Orientation]>, Width);

/// Calls `add` with every block of a range: the number of its first triangle, the triangles, and what they add. `add` must be
/// `#[inline(always)]` to be compiled for wide vectors as well, and own its slices, which would be loaded from memory each time.
pub(crate) fn for_each_block<const N: usize, W: Weighting<N>>(
    flat: &Flat<'_>,
    (agreed, width): How<'_>,
    range: Range<usize>,
    count: &mut Count<'_>,
    add: impl FnMut(usize, &[[u32; 3]], &Block<N>),
) {
    width.run(ForEachBlock::<N, W, _> { flat, agreed, range, count, add, weighting: PhantomData });
}

struct ForEachBlock<'a, 'b, const N: usize, W, F> {
    flat: &'a Flat<'a>,
    agreed: Option<&'a [Orientation]>,
    range: Range<usize>,
    count: &'a mut Count<'b>,
    add: F,
    weighting: PhantomData<W>,
}

impl<const N: usize, W, F> Task for ForEachBlock<'_, '_, N, W, F>
where
    W: Weighting<N>,
    F: FnMut(usize, &[[u32; 3]], &Block<N>),
{
    #[inline(always)]
    fn run(self) {
        let Self { flat, agreed, range, count, mut add, .. } = self;
        let slices = flat.slices();
        let mut block = Block::<N>::new();
        for first in range.clone().step_by(BLOCK) {
            let triangles = &slices.triangles[first..range.end.min(first + BLOCK)];
            block.set(&slices, triangles);
            block.evaluate::<W>();
            let orientations = &mut block.orientations[..triangles.len()];
            if let Some(agreed) = agreed {
                agree(orientations, |i| agreed[flat.face(first + i)]);
            }
            count.note(&slices, first, orientations);
            add(first, triangles, &block);
        }
    }
}

/// Gives triangles that add something the orientations of their faces.
fn agree(orientations: &mut [Orientation], of_face: impl Fn(usize) -> Orientation) {
    for (i, orientation) in orientations.iter_mut().enumerate() {
        if *orientation != Orientation::None {
            *orientation = of_face(i);
        }
    }
}

/// Adds what all triangles add.
pub(crate) fn accumulate<const N: usize, W: Weighting<N>>(flat: &Flat<'_>, width: Width, sums: &mut Sums<N>) {
    let agreed = (!flat.is_triangles()).then(|| agreed_orientations::<N, W>(flat));
    let how = (agreed.as_deref(), width);
    match parts_of(flat) {
        Some(list) => scatter_all::<N, W>(flat, how, &list, sums),
        None => gather_all::<N, W>(flat, how, sums),
    }
    if let Some(agreed) = agreed {
        sums.orientation_of_face = agreed;
    }
}

fn scatter_all<const N: usize, W: Weighting<N>>(
    flat: &Flat<'_>,
    how: How<'_>,
    list: &[Part],
    sums: &mut Sums<N>,
) {
    let Sums { of_side: [keeps, mirrors], orientation_of_face, flaws } = sums;
    let keeps = parts(keeps, 0, list.iter().map(|part| part.vertices.clone()));
    let orientations = parts(orientation_of_face, 0, list.iter().map(|part| part.own.clone()));
    let mut found: Vec<(Vec<Sum<N>>, Flaws)> = vec![Default::default(); list.len()];
    found[0].0 = std::mem::take(mirrors);
    let jobs = list.iter().zip(keeps).zip(orientations);
    threads::run(&mut found, jobs, |(mirrors, flaws), ((part, keeps), orientations)| {
        let mut count = Count::new(part.own.start, orientations);
        add_part::<N, W>(flat, how, part, (keeps, mirrors), &mut count);
        *flaws = count.flaws;
    });
    found.iter().for_each(|(_, found)| flaws.add(*found));
    *mirrors = joined(found.into_iter().map(|(mirrors, _)| mirrors), list, flat.positions.len());
}

/// Adds what a thread's triangles add to its vertices, whose sums for mirrored triangles are made when the first comes.
fn add_part<const N: usize, W: Weighting<N>>(
    flat: &Flat<'_>,
    how: How<'_>,
    part: &Part,
    (keeps, mirrors): (&mut [Sum<N>], &mut Vec<Sum<N>>),
    count: &mut Count<'_>,
) {
    keeps.fill([[0.0; 4]; N]);
    let first = part.vertices.start as u32;
    for_each_block::<N, W>(
        flat,
        how,
        part.adds.clone(),
        count,
        #[inline(always)]
        move |_, triangles, block| {
            let orientations = &block.orientations[..triangles.len()];
            let found = found(orientations);
            if W::SPLITS && found & bit(Orientation::Mirrors) != 0 && mirrors.is_empty() {
                mirrors.resize(keeps.len(), [[0.0; 4]; N]);
            }
            let all_add = found & bit(Orientation::None) == 0;
            if all_add && (!W::SPLITS || found == bit(Orientation::Keeps)) {
                for (i, &triangle) in triangles.iter().enumerate() {
                    scatter(keeps, first, triangle, &block.term(i));
                }
                return;
            }
            for (i, (&triangle, orientation)) in triangles.iter().zip(orientations).enumerate() {
                match orientation {
                    Orientation::None => {}
                    Orientation::Mirrors if W::SPLITS => scatter(mirrors, first, triangle, &block.term(i)),
                    _ => scatter(keeps, first, triangle, &block.term(i)),
                }
            }
        },
    );
}

/// Adds a term to the vertices of a triangle, of which the first sum's is `first`, and others may be other threads'.
#[inline(always)]
fn scatter<const N: usize>(sums: &mut [Sum<N>], first: u32, triangle: [u32; 3], term: &Sum<N>) {
    for vertex in triangle {
        if let Some(sum) = sums.get_mut(vertex.wrapping_sub(first) as usize) {
            accumulate_into(sum, term);
        }
    }
}

#[inline(always)]
pub(crate) fn accumulate_into<const N: usize>(sum: &mut Sum<N>, term: &Sum<N>) {
    for (sum, term) in sum.as_flattened_mut().iter_mut().zip(term.as_flattened()) {
        *sum += term;
    }
}

/// The sums of all parts' vertices, of which some parts may have none; none where no part has any.
fn joined<const N: usize>(
    mut of_parts: impl ExactSizeIterator<Item = Vec<Sum<N>>>,
    list: &[Part],
    vertices: usize,
) -> Vec<Sum<N>> {
    if of_parts.len() == 1 {
        return of_parts.next().unwrap_or_default();
    }
    let mut all = Vec::new();
    for (part, of_part) in list.iter().zip(of_parts).filter(|(_, of_part)| !of_part.is_empty()) {
        all.resize(vertices, [[0.0; 4]; N]);
        all[part.vertices.clone()].copy_from_slice(&of_part);
    }
    all
}

/// One orientation for each face: of the halves of a quad that add something the one with the larger UV area decides, the first
/// on a tie.
fn agreed_orientations<const N: usize, W: Weighting<N>>(flat: &Flat<'_>) -> Vec<Orientation> {
    let mut agreed = vec![Orientation::None; flat.face_count()];
    let threads = threads::count(flat.triangles().len());
    let ranges = split(0..agreed.len(), threads, 1);
    let jobs = ranges.clone().zip(parts(&mut agreed, 0, ranges));
    threads::run(&mut vec![(); threads], jobs, |(), (faces, agreed)| agree_in::<N, W>(flat, faces, agreed));
    agreed
}

fn agree_in<const N: usize, W: Weighting<N>>(
    flat: &Flat<'_>,
    faces: Range<usize>,
    agreed: &mut [Orientation],
) {
    let slices = flat.slices();
    let mut last = (0, 0.0);
    for t in flat.triangles_of(faces.clone()) {
        let (positions, uvs) = slices.refer(slices.triangles[t]);
        let derivatives = Derivatives::new(positions, uvs);
        let (face, area) = (flat.face(t) - faces.start, derivatives.area.abs());
        let is_larger = agreed[face] == Orientation::None || last.0 == face && area > last.1;
        if is_larger && term::<N, W>(&derivatives).is_some() {
            (agreed[face], last) = (Orientation::of(derivatives.area), (face, area));
        }
    }
}

//! What all triangles add to their vertices, by all threads: each has vertices of its own and adds to them in the triangles' order, so that
//! no sum depends on how many threads there are.

use std::ops::Range;

use crate::math::V3;

use super::flat::{Flat, Slices};
use super::group_sums::GroupMemory;
use super::sums::{Derivatives, Orientation, Sum, Weighting, is_degenerate, term};
use super::terms::{BLOCK, Block};
use super::threads::{self, parts, split};
use super::width::Width;
use super::windows::{WINDOW, Window, look_around, overlap, shares, triangles_of, windows_of};

/// The sums of all vertices and what was met on the way.
pub(super) struct Sums<const N: usize> {
    /// Per orientation and vertex; none of an orientation that no triangle has, but that the first is always there.
    pub of_side: [Vec<Sum<N>>; 2],
    pub orientation_of_face: Vec<Orientation>,
    pub flaws: Flaws,
}

/// Triangles that add nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Flaws {
    pub degenerate: usize,
    pub uv_degenerate: usize,
}

impl Flaws {
    pub fn are_none(&self) -> bool {
        self.degenerate + self.uv_degenerate == 0
    }

    #[cold]
    fn count(&mut self, positions: [&V3; 3]) {
        if is_degenerate(positions.map(|position| *position)) {
            self.degenerate += 1;
        } else {
            self.uv_degenerate += 1;
        }
    }

    fn add(&mut self, other: Self) {
        self.degenerate += other.degenerate;
        self.uv_degenerate += other.uv_degenerate;
    }
}

/// What a run leaves behind for the next one.
#[derive(Debug, Default)]
pub(super) struct Memory {
    of_two_rows: [Vec<Sum<2>>; 2],
    of_three_rows: [Vec<Sum<3>>; 2],
    orientation_of_face: Vec<Orientation>,
    pub tangents_of_side: [Vec<[f32; 4]>; 2],
    pub of_groups: GroupMemory,
}

/// Where sums of `N` rows are kept.
pub(super) trait Keeps<const N: usize> {
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

/// Gives each thread a part: consecutive triangles and the vertices that they meet first, or, where these lie all over the mesh, an
/// equal part of the vertices and all triangles to add.
fn parts_of(flat: &Flat<'_>) -> Vec<Part> {
    let (triangles, vertices) = (flat.triangles(), flat.positions.len());
    let count = triangles.len();
    let threads = threads::count(count);
    if threads == 1 {
        return vec![Part { own: 0..count, adds: 0..count, vertices: 0..vertices }];
    }
    let windows = windows(triangles);
    let shares: Vec<_> = shares(&windows, vertices, threads).collect();
    let own = |at: usize| triangles_of(shares[at].windows.clone(), count);
    if overlap(&shares, &windows) {
        let ranges = split(0..vertices, threads, 1).enumerate();
        return ranges.map(|(at, vertices)| Part { own: own(at), adds: 0..count, vertices }).collect();
    }
    let part = |at: usize| Part {
        own: own(at),
        adds: triangles_of(shares[at].windows.start..shares[at].until, count),
        vertices: shares[at].vertices.clone(),
    };
    (0..threads).map(part).collect()
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
struct Count<'a> {
    first: usize,
    orientations: &'a mut [Orientation],
    flaws: Flaws,
}

impl<'a> Count<'a> {
    fn new(first: usize, orientations: &'a mut [Orientation]) -> Self {
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
        if found(own) & 1 << Orientation::None as u8 != 0 {
            self.note_flaws(slices, start, own);
        }
    }

    #[cold]
    fn note_flaws(&mut self, slices: &Slices<'_>, first: usize, orientations: &[Orientation]) {
        for (t, _) in (first..).zip(orientations).filter(|(_, found)| **found == Orientation::None) {
            self.flaws.count(slices.refer(slices.triangles[t]).0);
        }
    }
}

/// One bit for each orientation that is found: a loop that runs many lanes at a time.
#[inline(always)]
fn found(orientations: &[Orientation]) -> u8 {
    orientations.iter().fold(0, |found, &orientation| found | 1 << orientation as u8)
}

/// Calls `add` with every block of a range: the number of its first triangle, the triangles, what they add, and their orientations.
///
/// `agreed`: where faces are not all triangles, the orientations of the faces.
#[inline(always)]
fn for_each_block<const N: usize, W: Weighting<N>>(
    flat: &Flat<'_>,
    agreed: Option<&[Orientation]>,
    width: Width,
    range: Range<usize>,
    count: &mut Count<'_>,
    mut add: impl FnMut(usize, &[[u32; 3]], &[Sum<N>], &[Orientation]),
) {
    let slices = flat.slices();
    let mut block = Block::<N>::new();
    for first in range.clone().step_by(BLOCK) {
        let triangles = &slices.triangles[first..range.end.min(first + BLOCK)];
        block.set(&slices, triangles);
        block.evaluate::<W>(width);
        let orientations = &mut block.orientations[..triangles.len()];
        if let Some(agreed) = agreed {
            agree(orientations, |i| agreed[flat.face(first + i)]);
        }
        count.note(&slices, first, orientations);
        add(first, triangles, &block.terms[..triangles.len()], orientations);
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
pub(super) fn accumulate<const N: usize, W: Weighting<N>>(flat: &Flat<'_>, width: Width, sums: &mut Sums<N>) {
    let agreed = (!flat.is_triangles()).then(|| agreed_orientations::<N, W>(flat));
    let agreed_slice = agreed.as_deref();
    let list = parts_of(flat);
    let Sums { of_side: [keeps, mirrors], orientation_of_face, flaws } = sums;
    let keeps = parts(keeps, 0, list.iter().map(|part| part.vertices.clone()));
    let orientations = parts(orientation_of_face, 0, list.iter().map(|part| part.own.clone()));
    let mut found: Vec<(Vec<Sum<N>>, Flaws)> = vec![Default::default(); list.len()];
    found[0].0 = std::mem::take(mirrors);
    let jobs = list.iter().zip(keeps).zip(orientations);
    threads::run(&mut found, jobs, |(mirrors, flaws), ((part, keeps), orientations)| {
        let mut count = Count::new(part.own.start, orientations);
        add_part::<N, W>(flat, agreed_slice, width, part, keeps, mirrors, &mut count);
        *flaws = count.flaws;
    });
    found.iter().for_each(|(_, found)| flaws.add(*found));
    *mirrors = joined(found.into_iter().map(|(mirrors, _)| mirrors), &list, flat.positions.len());
    if let Some(agreed) = agreed {
        *orientation_of_face = agreed;
    }
}

/// Adds what a thread's triangles add to its vertices, whose sums for mirrored triangles are made when the first comes.
fn add_part<const N: usize, W: Weighting<N>>(
    flat: &Flat<'_>,
    agreed: Option<&[Orientation]>,
    width: Width,
    part: &Part,
    keeps: &mut [Sum<N>],
    mirrors: &mut Vec<Sum<N>>,
    count: &mut Count<'_>,
) {
    keeps.fill([[0.0; 4]; N]);
    let first = part.vertices.start as u32;
    for_each_block::<N, W>(
        flat,
        agreed,
        width,
        part.adds.clone(),
        count,
        |_, triangles, terms, orientations| {
            let found = found(orientations);
            let is_one_side = found == 1 || !W::SPLITS && found < 4;
            if is_one_side {
                for (triangle, term) in triangles.iter().zip(terms) {
                    scatter(keeps, first, *triangle, term);
                }
                return;
            }
            if W::SPLITS && found & 2 != 0 && mirrors.is_empty() {
                mirrors.resize(keeps.len(), [[0.0; 4]; N]);
            }
            for ((triangle, term), orientation) in triangles.iter().zip(terms).zip(orientations) {
                match orientation {
                    Orientation::None => {}
                    Orientation::Mirrors if W::SPLITS => scatter(mirrors, first, *triangle, term),
                    _ => scatter(keeps, first, *triangle, term),
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
fn accumulate_into<const N: usize>(sum: &mut Sum<N>, term: &Sum<N>) {
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

/// What the triangles add and the sides that they add it to, in their order, and whether any adds to each side. Also counts the triangles.
pub(super) fn terms<const N: usize, W: Weighting<N>>(
    flat: &Flat<'_>,
    width: Width,
    sums: &mut Sums<N>,
) -> (Vec<(Sum<N>, u8)>, [bool; 2]) {
    let agreed = (!flat.is_triangles()).then(|| agreed_orientations::<N, W>(flat));
    let agreed_slice = agreed.as_deref();
    let count = flat.triangles().len();
    let mut terms = vec![([[0.0; 4]; N], 0); count];
    let threads = threads::count(count);
    let ranges = split(0..count, threads, WINDOW);
    let orientations = parts(&mut sums.orientation_of_face, 0, ranges.clone());
    let jobs = ranges.clone().zip(parts(&mut terms, 0, ranges)).zip(orientations);
    let mut all_found = vec![(Flaws::default(), [false; 2]); threads];
    threads::run(&mut all_found, jobs, |(flaws, used), ((range, terms), orientations)| {
        let start = range.start;
        let mut count = Count::new(start, orientations);
        for_each_block::<N, W>(
            flat,
            agreed_slice,
            width,
            range,
            &mut count,
            |first, _, of_block, orientations| {
                let found = found(orientations);
                *used = [used[0] | (found & 1 != 0), used[1] | (found & 2 != 0)];
                for ((slot, term), orientation) in
                    terms[first - start..].iter_mut().zip(of_block).zip(orientations)
                {
                    if *orientation != Orientation::None {
                        *slot = (*term, *orientation as u8);
                    }
                }
            },
        );
        *flaws = count.flaws;
    });
    let found = all_found;
    found.iter().for_each(|(found, _)| sums.flaws.add(*found));
    if let Some(agreed) = agreed {
        sums.orientation_of_face = agreed;
    }
    (terms, [0, 1].map(|side| found.iter().any(|(_, used)| used[side])))
}

/// Gathers, for every vertex, the terms of the triangles around it, in their order.
///
/// `triangle_of_entry`, `ends`: the triangles at each vertex, vertex after vertex, and where each vertex's part ends.
pub(super) fn gather<const N: usize>(
    (terms, used): (&[(Sum<N>, u8)], [bool; 2]),
    (triangle_of_entry, ends): (&[u32], &[u32]),
    sums: &mut Sums<N>,
) {
    let [keeps, mirrors] = &mut sums.of_side;
    keeps.fill([[0.0; 4]; N]);
    mirrors.resize(if used[1] { keeps.len() } else { 0 }, [[0.0; 4]; N]);
    let threads = threads::count(terms.len());
    let ranges = split(0..ends.len(), threads, 1);
    let mirrors = parts(mirrors, 0, ranges.clone().map(|range| if used[1] { range } else { 0..0 }));
    let jobs = ranges.clone().zip(parts(keeps, 0, ranges)).zip(mirrors);
    threads::run(&mut vec![(); threads], jobs, |(), ((range, keeps), mirrors)| {
        let mut start = if range.start == 0 { 0 } else { ends[range.start - 1] };
        for (at, &end) in ends[range].iter().enumerate() {
            for &t in &triangle_of_entry[start as usize..end as usize] {
                let (term, side) = &terms[t as usize];
                accumulate_into(if *side == 0 { &mut keeps[at] } else { &mut mirrors[at] }, term);
            }
            start = end;
        }
    });
}

/// One orientation for each face: of the halves of a quad that add something the one with the larger UV area decides, the first
/// on a tie.
fn agreed_orientations<const N: usize, W: Weighting<N>>(flat: &Flat<'_>) -> Vec<Orientation> {
    let mut deciding = vec![(Orientation::None, 0.0); flat.face_count()];
    let slices = flat.slices();
    for (t, &triangle) in slices.triangles.iter().enumerate() {
        let (positions, uvs) = slices.refer(triangle);
        let derivatives = Derivatives::new(positions, uvs);
        let slot = &mut deciding[flat.face(t)];
        let is_larger = slot.0 == Orientation::None || derivatives.area.abs() > slot.1;
        if is_larger && term::<N, W>(&derivatives).is_some() {
            *slot = (Orientation::of(derivatives.area), derivatives.area.abs());
        }
    }
    deciding.into_iter().map(|(orientation, _)| orientation).collect()
}

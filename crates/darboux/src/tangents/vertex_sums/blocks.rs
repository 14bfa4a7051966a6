//! Runs the term kernel over a range of triangles, block by block, and records each triangle's orientation.

use std::marker::PhantomData;
use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::simd::Task;
use crate::tangents::mesh_slices::{MeshSlices, TriangleSlices};
use crate::tangents::uv_derivatives::Orientation;
use crate::tangents::vertex_sums::side_sums::SkippedTriangles;
use crate::tangents::vertex_sums::term_kernel::{TERM_BLOCK, TermBlock};
use crate::tangents::vertex_sums::weighting::{SumRows, Weighting};

/// What a thread finds out about the triangles that it counts.
pub(crate) struct OrientationRecorder<'a> {
    first: usize,
    orientations: &'a mut [Orientation],
    pub flaws: SkippedTriangles,
}

impl<'a> OrientationRecorder<'a> {
    pub fn new(first: usize, orientations: &'a mut [Orientation]) -> Self {
        Self { first, orientations, flaws: SkippedTriangles::default() }
    }

    /// Notes the orientations of consecutive triangles, of which any may be another's to count.
    #[inline(always)]
    fn note(&mut self, slices: &TriangleSlices<'_>, first: usize, orientations: &[Orientation]) {
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
    fn note_flaws(&mut self, slices: &TriangleSlices<'_>, first: usize, orientations: &[Orientation]) {
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
pub(crate) type BlockOptions<'a> = (Option<&'a [Orientation]>, RunLimits<'a>);

/// Calls `add` with every block of a range: the number of its first triangle, the triangles, and what they add. `add` must be
/// `#[inline(always)]` to be compiled for wide vectors as well, and own its slices, which would be loaded from memory each time.
pub(crate) fn for_each_block<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    (agreed, limits): BlockOptions<'_>,
    range: Range<usize>,
    count: &mut OrientationRecorder<'_>,
    add: impl FnMut(usize, &[[u32; 3]], &TermBlock<N>),
) {
    limits.width.run(ForEachBlock::<N, W, _> { flat, agreed, range, count, add, weighting: PhantomData });
}

struct ForEachBlock<'a, 'b, const N: usize, W, F> {
    flat: &'a MeshSlices<'a>,
    agreed: Option<&'a [Orientation]>,
    range: Range<usize>,
    count: &'a mut OrientationRecorder<'b>,
    add: F,
    weighting: PhantomData<W>,
}

impl<const N: usize, W, F> Task for ForEachBlock<'_, '_, N, W, F>
where
    W: Weighting<N>,
    F: FnMut(usize, &[[u32; 3]], &TermBlock<N>),
{
    #[inline(always)]
    fn run(self) {
        let Self { flat, agreed, range, count, mut add, .. } = self;
        let slices = flat.slices();
        let mut block = TermBlock::<N>::new();
        for first in range.clone().step_by(TERM_BLOCK) {
            let triangles = &slices.triangles[first..range.end.min(first + TERM_BLOCK)];
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

#[inline(always)]
pub(crate) fn accumulate_into<const N: usize>(sum: &mut SumRows<N>, term: &SumRows<N>) {
    for (sum, term) in sum.as_flattened_mut().iter_mut().zip(term.as_flattened()) {
        *sum += term;
    }
}

//! Runs the term kernel over a range of triangles, block by block, and records each triangle's orientation.

use std::marker::PhantomData;
use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::simd::Task;
use crate::tangents::methods::mesh_slices::{MeshSlices, TriangleInputs};
use crate::tangents::methods::uv_derivatives::Orientation;
use crate::tangents::methods::vertex_sums::side_sums::SkippedTriangles;
use crate::tangents::methods::vertex_sums::term_kernel::{TERM_BLOCK, TermBlock};
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting};

/// Records the orientations of the triangles that one thread owns, and counts those that are skipped.
pub(crate) struct OrientationRecorder<'a> {
    /// The first owned triangle.
    first: usize,
    orientations: &'a mut [Orientation],
    pub skipped: SkippedTriangles,
}

impl<'a> OrientationRecorder<'a> {
    pub fn new(first: usize, orientations: &'a mut [Orientation]) -> Self {
        Self { first, orientations, skipped: SkippedTriangles::default() }
    }

    /// Records the orientations of consecutive triangles from `first` on. Triangles of other threads are
    /// ignored.
    #[inline(always)]
    fn record(&mut self, inputs: &TriangleInputs<'_>, first: usize, orientations: &[Orientation]) {
        let start = first.max(self.first);
        let end = (first + orientations.len()).min(self.first + self.orientations.len());
        if start >= end {
            return;
        }
        let own = &orientations[start - first..end - first];
        self.orientations[start - self.first..end - self.first].copy_from_slice(own);
        if orientation_set(own) & orientation_bit(Orientation::None) != 0 {
            self.record_skipped(inputs, start, own);
        }
    }

    #[cold]
    fn record_skipped(&mut self, inputs: &TriangleInputs<'_>, first: usize, orientations: &[Orientation]) {
        for (t, _) in (first..).zip(orientations).filter(|(_, found)| **found == Orientation::None) {
            let (positions, uvs) = inputs.values_of(inputs.triangles[t]);
            self.skipped.count(positions, uvs);
        }
    }
}

/// The bitmask of the orientations that occur. The loop vectorises.
#[inline(always)]
pub(crate) fn orientation_set(orientations: &[Orientation]) -> u8 {
    orientations.iter().fold(0, |found, &orientation| found | orientation_bit(orientation))
}

/// The bit of an orientation in [`orientation_set`].
#[inline(always)]
pub(crate) fn orientation_bit(orientation: Orientation) -> u8 {
    1 << orientation as u8
}

/// The orientation of each face, where not all faces are triangles, and the limits of the run.
#[derive(Clone, Copy)]
pub(crate) struct BlockOptions<'a> {
    pub orientation_of_face: Option<&'a [Orientation]>,
    pub limits: RunLimits<'a>,
}

/// Runs the term kernel on every block of a range of triangles. Returns early after cancellation.
///
/// `add`: called per block with its first triangle, its triangles and its terms. The closure must be
/// `#[inline(always)]`, so that it is compiled for wide vectors, and must own its slices, so that their
/// addresses stay in registers.
pub(crate) fn for_each_block<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    options: BlockOptions<'_>,
    range: Range<usize>,
    recorder: &mut OrientationRecorder<'_>,
    add: impl FnMut(usize, &[[u32; 3]], &TermBlock<N>),
) {
    let BlockOptions { orientation_of_face, limits } = options;
    let weighting = PhantomData::<W>;
    limits.width.run(ForEachBlock { slices, orientation_of_face, range, limits, recorder, add, weighting });
}

struct ForEachBlock<'a, 'b, const N: usize, W, F> {
    slices: &'a MeshSlices<'a>,
    orientation_of_face: Option<&'a [Orientation]>,
    range: Range<usize>,
    limits: RunLimits<'a>,
    recorder: &'a mut OrientationRecorder<'b>,
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
        let Self { slices, orientation_of_face, range, limits, recorder, mut add, .. } = self;
        let inputs = slices.triangle_inputs();
        let mut block = TermBlock::<N>::new();
        for first in range.clone().step_by(TERM_BLOCK) {
            if limits.is_cancelled() {
                return;
            }
            let triangles = &inputs.triangles[first..range.end.min(first + TERM_BLOCK)];
            block.set(&inputs, triangles);
            block.evaluate::<W>();
            let orientations = &mut block.orientations[..triangles.len()];
            if let Some(of_face) = orientation_of_face {
                set_face_orientations(orientations, |i| of_face[slices.face(first + i)]);
            }
            recorder.record(&inputs, first, orientations);
            add(first, triangles, &block);
        }
    }
}

/// Replaces the orientations of triangles that are not skipped by those of their faces.
fn set_face_orientations(orientations: &mut [Orientation], of_face: impl Fn(usize) -> Orientation) {
    for (i, orientation) in orientations.iter_mut().enumerate() {
        if *orientation != Orientation::None {
            *orientation = of_face(i);
        }
    }
}

/// Adds a term to a sum.
#[inline(always)]
pub(crate) fn accumulate_into<const N: usize>(sum: &mut SumRows<N>, term: &SumRows<N>) {
    for (sum, term) in sum.as_flattened_mut().iter_mut().zip(term.as_flattened()) {
        *sum += term;
    }
}

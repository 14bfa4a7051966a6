//! Accumulation vertex by vertex, for meshes whose triangles around a vertex are far apart in the list.
//!
//! First every thread computes the terms of its triangles. Then every thread sums the terms around its
//! vertices. The adjacency is a compressed sparse row array: the triangles of all vertices, vertex after
//! vertex, and the end of each vertex's list. Lists ascend, so that the bits are those of scattering.

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_range, split_slice};
use crate::exec::windows::WINDOW;
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::uv_derivatives::Orientation;
use crate::tangents::methods::vertex_sums::blocks::{
    BlockOptions, OrientationRecorder, accumulate_into, for_each_block, orientation_bit, orientation_set,
};
use crate::tangents::methods::vertex_sums::side_sums::{SideSums, SkippedTriangles};
use crate::tangents::methods::vertex_sums::term_kernel::TermBlock;
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting};

/// Computes all sums and records all orientations.
pub(crate) fn gather_all<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    options: BlockOptions<'_>,
    sums: &mut SideSums<N>,
) {
    let (terms, has_mirrored) = terms::<N, W>(slices, options, sums);
    let (triangle_of_entry, ends) = adjacency(slices);
    if options.limits.is_cancelled() {
        return;
    }
    gather((&terms, has_mirrored), (&triangle_of_entry, &ends), options.limits, sums);
}

/// Returns the term of each triangle with a flag for mirrored triangles, and whether any triangle is
/// mirrored. Records orientations.
fn terms<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    options: BlockOptions<'_>,
    sums: &mut SideSums<N>,
) -> (Vec<(SumRows<N>, bool)>, bool) {
    let count = slices.triangles().len();
    let mut terms = vec![([[0.0; 4]; N], false); count];
    let threads = options.limits.thread_count(count);
    let ranges = split_range(0..count, threads, WINDOW);
    let orientations = split_slice(&mut sums.orientation_of_face, 0, ranges.clone());
    let jobs = ranges.clone().zip(split_slice(&mut terms, 0, ranges)).zip(orientations);
    let mut of_threads = vec![(SkippedTriangles::default(), 0); threads];
    threads::run(&mut of_threads, jobs, |(skipped, all_orientations), ((range, terms), orientations)| {
        let start = range.start;
        let mut recorder = OrientationRecorder::new(start, orientations);
        for_each_block::<N, W>(
            slices,
            options,
            range,
            &mut recorder,
            #[inline(always)]
            |first: usize, triangles: &[[u32; 3]], block: &TermBlock<N>| {
                let orientations = &block.orientations[..triangles.len()];
                *all_orientations |= orientation_set(orientations);
                for (i, (slot, &orientation)) in
                    terms[first - start..].iter_mut().zip(orientations).enumerate()
                {
                    if orientation != Orientation::None {
                        *slot = (block.term(i), W::SPLITS && orientation == Orientation::Mirrors);
                    }
                }
            },
        );
        *skipped = recorder.skipped;
    });
    of_threads.iter().for_each(|(skipped, _)| sums.skipped.add(*skipped));
    let has_mirrored = of_threads.iter().any(|(_, set)| set & orientation_bit(Orientation::Mirrors) != 0);
    (terms, W::SPLITS && has_mirrored)
}

/// The adjacency: the triangles around each vertex, vertex after vertex, each list ascending; and the end of
/// each list.
fn adjacency(slices: &MeshSlices<'_>) -> (Vec<u32>, Vec<u32>) {
    let vertices = slices.triangles().as_flattened();
    let mut ends = vec![0u32; slices.positions.len()];
    for &v in vertices {
        ends[v as usize] += 1;
    }
    let mut sum = 0;
    for end in &mut ends {
        // The start of the list; filling advances it to the end.
        sum += std::mem::replace(end, sum);
    }
    let mut triangle_of_entry = vec![0; vertices.len()];
    for (corner, &v) in vertices.iter().enumerate() {
        let slot = &mut ends[v as usize];
        triangle_of_entry[*slot as usize] = (corner / 3) as u32;
        *slot += 1;
    }
    (triangle_of_entry, ends)
}

/// Sums, for every vertex, the terms of the triangles around it, ascending.
///
/// `triangle_of_entry`, `ends`: the result of [`adjacency`].
fn gather<const N: usize>(
    (terms, has_mirrored): (&[(SumRows<N>, bool)], bool),
    (triangle_of_entry, ends): (&[u32], &[u32]),
    limits: RunLimits<'_>,
    sums: &mut SideSums<N>,
) {
    let [preserved, mirrored] = &mut sums.sums_of_side;
    preserved.fill([[0.0; 4]; N]);
    mirrored.resize(if has_mirrored { preserved.len() } else { 0 }, [[0.0; 4]; N]);
    let threads = limits.thread_count(terms.len());
    let ranges = split_range(0..ends.len(), threads, 1);
    let mirrored =
        split_slice(mirrored, 0, ranges.clone().map(|range| if has_mirrored { range } else { 0..0 }));
    let jobs = ranges.clone().zip(split_slice(preserved, 0, ranges)).zip(mirrored);
    threads::run(&mut vec![(); threads], jobs, |(), ((range, preserved), mirrored)| {
        let mut start = if range.start == 0 { 0 } else { ends[range.start - 1] };
        for (at, &end) in ends[range].iter().enumerate() {
            if limits.check_at(at).is_err() {
                return;
            }
            for &t in &triangle_of_entry[start as usize..end as usize] {
                let (term, is_mirrored) = &terms[t as usize];
                accumulate_into(if *is_mirrored { &mut mirrored[at] } else { &mut preserved[at] }, term);
            }
            start = end;
        }
    });
}

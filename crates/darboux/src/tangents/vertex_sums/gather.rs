//! SideSums gathered per vertex, by all threads, where the triangles around a vertex lie all over the list: no thread could add them without
//! walking through all of it.
//!
//! First what every triangle adds, then each vertex reads the terms of the triangles around it and writes once, the form that parallel
//! hardware wants. The adjacency is compressed: one array of triangles, ordered by vertex, and one of running sums that says where each
//! vertex's part ends. Triangles come in their order, so that the bits are those of adding one by one.

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_range, split_slice};
use crate::exec::windows::WINDOW;
use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::uv_derivatives::Orientation;
use crate::tangents::vertex_sums::blocks::{
    BlockOptions, OrientationRecorder, accumulate_into, bit, for_each_block, found,
};
use crate::tangents::vertex_sums::side_sums::{SideSums, SkippedTriangles};
use crate::tangents::vertex_sums::term_kernel::TermBlock;
use crate::tangents::vertex_sums::weighting::{SumRows, Weighting};

/// What [`crate::tangents::vertex_sums::scatter::accumulate`] does, vertex by vertex.
pub(crate) fn gather_all<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    how: BlockOptions<'_>,
    sums: &mut SideSums<N>,
) {
    let (terms, uses_mirrors) = terms::<N, W>(flat, how, sums);
    let (triangle_of_entry, ends) = adjacency(flat);
    gather((&terms, uses_mirrors), (&triangle_of_entry, &ends), how.1, sums);
}

/// What each triangle adds, and whether to the sums of mirrored triangles; and whether any does. Also counts the triangles.
fn terms<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    how: BlockOptions<'_>,
    sums: &mut SideSums<N>,
) -> (Vec<(SumRows<N>, bool)>, bool) {
    let count = flat.triangles().len();
    let mut terms = vec![([[0.0; 4]; N], false); count];
    let threads = how.1.thread_count(count);
    let ranges = split_range(0..count, threads, WINDOW);
    let orientations = split_slice(&mut sums.orientation_of_face, 0, ranges.clone());
    let jobs = ranges.clone().zip(split_slice(&mut terms, 0, ranges)).zip(orientations);
    let mut of_threads = vec![(SkippedTriangles::default(), 0); threads];
    threads::run(&mut of_threads, jobs, |(flaws, all_found), ((range, terms), orientations)| {
        let start = range.start;
        let mut count = OrientationRecorder::new(start, orientations);
        for_each_block::<N, W>(
            flat,
            how,
            range,
            &mut count,
            #[inline(always)]
            |first: usize, triangles: &[[u32; 3]], block: &TermBlock<N>| {
                let orientations = &block.orientations[..triangles.len()];
                *all_found |= found(orientations);
                for (i, (slot, &orientation)) in
                    terms[first - start..].iter_mut().zip(orientations).enumerate()
                {
                    if orientation != Orientation::None {
                        *slot = (block.term(i), W::SPLITS && orientation == Orientation::Mirrors);
                    }
                }
            },
        );
        *flaws = count.flaws;
    });
    of_threads.iter().for_each(|(flaws, _)| sums.flaws.add(*flaws));
    let uses_mirrors = of_threads.iter().any(|(_, found)| found & bit(Orientation::Mirrors) != 0);
    (terms, W::SPLITS && uses_mirrors)
}

/// The triangles at each vertex, ascending, vertex after vertex, and where each vertex's part ends.
fn adjacency(flat: &MeshSlices<'_>) -> (Vec<u32>, Vec<u32>) {
    let vertices = flat.triangles().as_flattened();
    let mut ends = vec![0u32; flat.positions.len()];
    for &v in vertices {
        ends[v as usize] += 1;
    }
    let mut sum = 0;
    for end in &mut ends {
        // For now the start; filling moves it to the end.
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

/// Adds, for every vertex, the terms of the triangles around it, in their order.
///
/// `triangle_of_entry`, `ends`: the triangles at each vertex, vertex after vertex, and where each vertex's part ends.
fn gather<const N: usize>(
    (terms, uses_mirrors): (&[(SumRows<N>, bool)], bool),
    (triangle_of_entry, ends): (&[u32], &[u32]),
    limits: RunLimits<'_>,
    sums: &mut SideSums<N>,
) {
    let [keeps, mirrors] = &mut sums.of_side;
    keeps.fill([[0.0; 4]; N]);
    mirrors.resize(if uses_mirrors { keeps.len() } else { 0 }, [[0.0; 4]; N]);
    let threads = limits.thread_count(terms.len());
    let ranges = split_range(0..ends.len(), threads, 1);
    let mirrors =
        split_slice(mirrors, 0, ranges.clone().map(|range| if uses_mirrors { range } else { 0..0 }));
    let jobs = ranges.clone().zip(split_slice(keeps, 0, ranges)).zip(mirrors);
    threads::run(&mut vec![(); threads], jobs, |(), ((range, keeps), mirrors)| {
        let mut start = if range.start == 0 { 0 } else { ends[range.start - 1] };
        for (at, &end) in ends[range].iter().enumerate() {
            for &t in &triangle_of_entry[start as usize..end as usize] {
                let (term, is_mirrored) = &terms[t as usize];
                accumulate_into(if *is_mirrored { &mut mirrors[at] } else { &mut keeps[at] }, term);
            }
            start = end;
        }
    });
}

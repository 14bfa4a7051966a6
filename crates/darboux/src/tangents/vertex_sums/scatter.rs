//! What all triangles add to their vertices, by all threads: each has vertices of its own and adds to them in the triangles' order, so that
//! no sum depends on how many threads there are.

use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_slice};
use crate::exec::windows::{
    Partition, Window, accumulate_bounds, overlap_too_much, partitions, triangles_of, windows_of,
};
use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::uv_derivatives::Orientation;
use crate::tangents::vertex_sums::blocks::{
    BlockOptions, OrientationRecorder, accumulate_into, bit, for_each_block, found,
};
use crate::tangents::vertex_sums::side_sums::{SideSums, SkippedTriangles};
use crate::tangents::vertex_sums::weighting::{SumRows, Weighting};

/// What one thread has to do.
pub(crate) struct ThreadWork {
    /// The triangles that it counts.
    own: Range<usize>,
    /// The triangles that it adds.
    adds: Range<usize>,
    /// The vertices that it adds to.
    vertices: Range<usize>,
}

/// Gives each thread consecutive triangles and the vertices that they meet first; none where vertices lie all over the mesh.
pub(crate) fn thread_ranges(flat: &MeshSlices<'_>, limits: RunLimits<'_>) -> Option<Vec<ThreadWork>> {
    let (triangles, vertices) = (flat.triangles(), flat.positions.len());
    let count = triangles.len();
    let threads = limits.thread_count(count);
    if threads == 1 {
        return Some(vec![ThreadWork { own: 0..count, adds: 0..count, vertices: 0..vertices }]);
    }
    let windows = windows(triangles);
    let partitions: Vec<_> = partitions(&windows, vertices, threads).collect();
    let work = |partition: &Partition| ThreadWork {
        own: triangles_of(partition.windows.clone(), count),
        adds: triangles_of(partition.windows.start..partition.end_window, count),
        vertices: partition.vertices.clone(),
    };
    (!overlap_too_much(&partitions, &windows)).then(|| partitions.iter().map(work).collect())
}

fn windows(triangles: &[[u32; 3]]) -> Vec<Window> {
    let window = |range: Range<usize>| {
        let (mut lowest, mut end) = (u32::MAX, 0);
        for &vertex in triangles[range].as_flattened() {
            lowest = vertex.min(lowest);
            end = end.max(vertex + 1);
        }
        Window { vertices: lowest..end, ..Window::default() }
    };
    let mut windows: Vec<_> = windows_of(triangles.len()).map(window).collect();
    accumulate_bounds(&mut windows);
    windows
}

pub(crate) fn scatter_all<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    how: BlockOptions<'_>,
    list: &[ThreadWork],
    sums: &mut SideSums<N>,
) {
    let SideSums { of_side: [keeps, mirrors], orientation_of_face, flaws } = sums;
    let keeps = split_slice(keeps, 0, list.iter().map(|part| part.vertices.clone()));
    let orientations = split_slice(orientation_of_face, 0, list.iter().map(|part| part.own.clone()));
    let mut found: Vec<(Vec<SumRows<N>>, SkippedTriangles)> = vec![Default::default(); list.len()];
    found[0].0 = std::mem::take(mirrors);
    let jobs = list.iter().zip(keeps).zip(orientations);
    threads::run(&mut found, jobs, |(mirrors, flaws), ((part, keeps), orientations)| {
        let mut count = OrientationRecorder::new(part.own.start, orientations);
        add_part::<N, W>(flat, how, part, (keeps, mirrors), &mut count);
        *flaws = count.flaws;
    });
    found.iter().for_each(|(_, found)| flaws.add(*found));
    *mirrors = joined(found.into_iter().map(|(mirrors, _)| mirrors), list, flat.positions.len());
}

/// Adds what a thread's triangles add to its vertices, whose sums for mirrored triangles are made when the first comes.
fn add_part<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    how: BlockOptions<'_>,
    part: &ThreadWork,
    (keeps, mirrors): (&mut [SumRows<N>], &mut Vec<SumRows<N>>),
    count: &mut OrientationRecorder<'_>,
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
            if all_add && (!W::SPLITS || found == bit(Orientation::Preserves)) {
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
fn scatter<const N: usize>(sums: &mut [SumRows<N>], first: u32, triangle: [u32; 3], term: &SumRows<N>) {
    for vertex in triangle {
        if let Some(sum) = sums.get_mut(vertex.wrapping_sub(first) as usize) {
            accumulate_into(sum, term);
        }
    }
}

/// The sums of all parts' vertices, of which some parts may have none; none where no part has any.
fn joined<const N: usize>(
    mut of_parts: impl ExactSizeIterator<Item = Vec<SumRows<N>>>,
    list: &[ThreadWork],
    vertices: usize,
) -> Vec<SumRows<N>> {
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

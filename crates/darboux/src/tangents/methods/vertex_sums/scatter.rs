//! Accumulation triangle by triangle.
//!
//! Each thread owns consecutive triangles and the vertices that first occur in them. It adds, in triangle
//! order, to its vertices only, and continues past its triangles while later ones use its vertices. So a few
//! triangles are computed by two threads, no two threads write one sum, and the bits do not depend on the
//! number of threads. Where the triangles around a vertex are far apart in the list, so that many triangles
//! would be computed twice, one thread does all.

use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_slice};
use crate::exec::windows::{
    Partition, Window, accumulate_bounds, overlap_too_much, partitions, triangles_of, windows_of,
};
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::uv_derivatives::Orientation;
use crate::tangents::methods::vertex_sums::blocks::{
    BlockOptions, OrientationRecorder, accumulate_into, for_each_block, orientation_bit, orientation_set,
};
use crate::tangents::methods::vertex_sums::side_sums::{SideSums, SkippedTriangles};
use crate::tangents::methods::vertex_sums::weighting::{SumRows, Weighting};

/// The share of one thread.
pub(crate) struct ThreadWork {
    /// The triangles whose orientations it records.
    own: Range<usize>,
    /// The triangles whose terms it computes.
    adds: Range<usize>,
    /// The vertices whose sums it owns.
    vertices: Range<usize>,
}

/// Divides the mesh among threads.
pub(crate) fn thread_ranges(slices: &MeshSlices<'_>, limits: RunLimits<'_>) -> Vec<ThreadWork> {
    let (triangles, vertices) = (slices.triangles(), slices.positions.len());
    let count = triangles.len();
    let threads = limits.thread_count(count);
    let alone = || vec![ThreadWork { own: 0..count, adds: 0..count, vertices: 0..vertices }];
    if threads == 1 {
        return alone();
    }
    let windows = windows(triangles);
    let partitions: Vec<_> = partitions(&windows, vertices, threads).collect();
    let work = |partition: &Partition| ThreadWork {
        own: triangles_of(partition.windows.clone(), count),
        adds: triangles_of(partition.windows.start..partition.end_window, count),
        vertices: partition.vertices.clone(),
    };
    if overlap_too_much(&partitions, &windows) {
        return alone();
    }
    partitions.iter().map(work).collect()
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
    slices: &MeshSlices<'_>,
    options: BlockOptions<'_>,
    list: &[ThreadWork],
    sums: &mut SideSums<N>,
) {
    let SideSums { sums_of_side: [preserved, mirrored], orientation_of_face, skipped } = sums;
    let preserved = split_slice(preserved, 0, list.iter().map(|part| part.vertices.clone()));
    let orientations = split_slice(orientation_of_face, 0, list.iter().map(|part| part.own.clone()));
    let mut found: Vec<(Vec<SumRows<N>>, SkippedTriangles)> = vec![Default::default(); list.len()];
    found[0].0 = std::mem::take(mirrored);
    let jobs = list.iter().zip(preserved).zip(orientations);
    threads::run(&mut found, jobs, |(mirrored, skipped), ((part, preserved), orientations)| {
        let mut recorder = OrientationRecorder::new(part.own.start, orientations);
        add_part::<N, W>(slices, options, part, (preserved, mirrored), &mut recorder);
        *skipped = recorder.skipped;
    });
    found.iter().for_each(|(_, found)| skipped.add(*found));
    *mirrored = concatenated(found.into_iter().map(|(mirrored, _)| mirrored), list, slices.positions.len());
}

/// Runs one thread's share. The mirrored sums are allocated at the first mirrored triangle.
fn add_part<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    options: BlockOptions<'_>,
    part: &ThreadWork,
    (preserved, mirrored): (&mut [SumRows<N>], &mut Vec<SumRows<N>>),
    recorder: &mut OrientationRecorder<'_>,
) {
    preserved.fill([[0.0; 4]; N]);
    let first = part.vertices.start as u32;
    for_each_block::<N, W>(
        slices,
        options,
        part.adds.clone(),
        recorder,
        #[inline(always)]
        move |_, triangles, block| {
            let orientations = &block.orientations[..triangles.len()];
            let found = orientation_set(orientations);
            if W::SPLITS && found & orientation_bit(Orientation::Mirrors) != 0 && mirrored.is_empty() {
                mirrored.resize(preserved.len(), [[0.0; 4]; N]);
            }
            let all_add = found & orientation_bit(Orientation::None) == 0;
            if all_add && (!W::SPLITS || found == orientation_bit(Orientation::Preserves)) {
                for (i, &triangle) in triangles.iter().enumerate() {
                    scatter(preserved, first, triangle, &block.term(i));
                }
                return;
            }
            for (i, (&triangle, orientation)) in triangles.iter().zip(orientations).enumerate() {
                match orientation {
                    Orientation::None => {}
                    Orientation::Mirrors if W::SPLITS => scatter(mirrored, first, triangle, &block.term(i)),
                    _ => scatter(preserved, first, triangle, &block.term(i)),
                }
            }
        },
    );
}

/// Adds a term to those vertices of a triangle that this thread owns; `sums[0]` is vertex `first`.
#[inline(always)]
fn scatter<const N: usize>(sums: &mut [SumRows<N>], first: u32, triangle: [u32; 3], term: &SumRows<N>) {
    for vertex in triangle {
        if let Some(sum) = sums.get_mut(vertex.wrapping_sub(first) as usize) {
            accumulate_into(sum, term);
        }
    }
}

/// Concatenates the mirrored sums of all threads. Threads without mirrored triangles have none; empty where
/// no thread has any.
fn concatenated<const N: usize>(
    mut of_threads: impl ExactSizeIterator<Item = Vec<SumRows<N>>>,
    list: &[ThreadWork],
    vertices: usize,
) -> Vec<SumRows<N>> {
    if of_threads.len() == 1 {
        return of_threads.next().unwrap_or_default();
    }
    let mut all = Vec::new();
    for (work, of_thread) in list.iter().zip(of_threads).filter(|(_, of_thread)| !of_thread.is_empty()) {
        all.resize(vertices, [[0.0; 4]; N]);
        all[work.vertices.clone()].copy_from_slice(&of_thread);
    }
    all
}

//! A pass in which all threads work on all windows, for meshes whose triangles that share vertices are far apart in the list.
//!
//! Each thread stores what its part of the triangles adds. It does so in the output array, where this has one element per entry of
//! the triangle list. Then each thread adds all stored terms to its part of the vertices, in triangle order, and at last writes its part
//! of the corners.

use std::ops::Range;

use crate::exec::threads::{self, split_range, split_slice};
use crate::exec::windows::WINDOW;
use crate::tangents::fast::accumulator::{VertexAccumulator, VertexRange};
use crate::tangents::fast::passes::{
    AddStoredTerms, FinishVertices, Pass, PassInput, ReadVertices, StoreTerms, TriangleTerms,
};
use crate::tangents::fast::streamed;
use crate::tangents::fast::worker::Worker;

/// Windows per thread whose terms are stored before they are added.
const WINDOWS_AT_ONCE: usize = if cfg!(small_limits) { 2 } else { 64 };

/// Runs a pass over a mesh of `vertex_count` welded vertices.
///
/// `terms`: memory for terms that do not fit into `out`. `out`: all corners.
pub(crate) fn run<P: Pass>(
    input: &PassInput<'_, P>,
    vertex_count: usize,
    workers: &mut [Worker],
    terms: &mut Vec<TriangleTerms>,
    out: &mut [[f32; 4]],
) {
    workers.iter_mut().for_each(|worker| worker.begin(0..0));
    let (mut vertices, mut marks) =
        (std::mem::take(&mut workers[0].vertices), std::mem::take(&mut workers[0].marks));
    vertices.resize(vertex_count, VertexAccumulator::default());
    marks.resize(vertex_count, 0);
    read(input, workers, &mut vertices, &mut marks);
    let at_once = workers.len() * WINDOWS_AT_ONCE;
    for first in (0..input.windows.len()).step_by(at_once) {
        let windows = first..(first + at_once).min(input.windows.len());
        let triangles = input.list.triangles_of(windows.clone());
        let terms = if input.list.is_split() {
            terms.resize(triangles.len(), TriangleTerms::default());
            &mut terms[..]
        } else {
            &mut out.as_chunks_mut().0[triangles]
        };
        store(input, windows.clone(), workers, &vertices, terms);
        add_stored(input, windows, workers, terms, &mut vertices, &mut marks);
    }
    finish(input, workers, &mut vertices, &mut marks);
    write(input, workers, &vertices, out);
    (workers[0].vertices, workers[0].marks) = (vertices, marks);
}

/// The vertices in one range per thread.
fn ranges_of<'a>(
    vertices: &'a mut [VertexAccumulator],
    marks: &'a mut [u32],
    threads: usize,
) -> impl Iterator<Item = VertexRange<'a>> {
    let ranges = split_range(0..vertices.len(), threads, 1);
    let parts = split_slice(vertices, 0, ranges.clone()).zip(split_slice(marks, 0, ranges.clone()));
    let range = |(range, (vertices, marks)): (Range<usize>, _)| VertexRange {
        first: range.start as u32,
        vertices,
        marks,
    };
    ranges.zip(parts).map(range)
}

fn read<P: Pass>(
    input: &PassInput<'_, P>,
    workers: &mut [Worker],
    vertices: &mut [VertexAccumulator],
    marks: &mut [u32],
) {
    let jobs = ranges_of(vertices, marks, workers.len());
    threads::run(workers, jobs, |worker, VertexRange { first, vertices, marks }| {
        let chunks = vertices.chunks_mut(WINDOW).zip(marks.chunks_mut(WINDOW));
        for (first, (vertices, marks)) in (first as usize..).step_by(WINDOW).zip(chunks) {
            let values = input.list.values(first..first + vertices.len(), &mut worker.slices);
            input.limits.width.run(ReadVertices { values, vertices, marks });
        }
    });
}

/// Stores what the triangles of `windows` add to their vertices.
fn store<P: Pass>(
    input: &PassInput<'_, P>,
    windows: Range<usize>,
    workers: &mut [Worker],
    vertices: &[VertexAccumulator],
    terms: &mut [TriangleTerms],
) {
    let list = &input.list;
    let first = list.triangles_of(windows.clone()).start;
    let ranges = split_range(windows, workers.len(), 1);
    let triangles = ranges.clone().map(|windows| list.triangles_of(windows));
    threads::run(workers, ranges.zip(split_slice(terms, first, triangles)), |worker, (windows, mut rest)| {
        for at in windows {
            let range = list.window(at);
            let out;
            (out, rest) = std::mem::take(&mut rest).split_at_mut(range.len());
            let triangles = list.triangles(range, &mut worker.triangles);
            let block = &mut worker.block;
            input.limits.width.run(StoreTerms { pass: input.pass, triangles, block, vertices, out });
        }
    });
}

/// Adds the stored terms to the vertices, in triangle order.
fn add_stored<P: Pass>(
    input: &PassInput<'_, P>,
    windows: Range<usize>,
    workers: &mut [Worker],
    terms: &[TriangleTerms],
    vertices: &mut [VertexAccumulator],
    marks: &mut [u32],
) {
    let jobs = ranges_of(vertices, marks, workers.len());
    threads::run(workers, jobs, |worker, VertexRange { first, vertices, marks }| {
        let mut rest = terms;
        for at in windows.clone() {
            let range = input.list.window(at);
            let terms;
            (terms, rest) = rest.split_at(range.len());
            let triangles = input.list.triangles(range.clone(), &mut worker.triangles);
            let block = &mut worker.block;
            let own = VertexRange { first, vertices: &mut *vertices, marks: &mut *marks };
            input.limits.width.run(AddStoredTerms { pass: input.pass, triangles, terms, block, range: own });
            let own = &mut VertexRange { first, vertices: &mut *vertices, marks: &mut *marks };
            input.pass.mark_quads(&input.list, range, own);
        }
    });
}

fn finish<P: Pass>(
    input: &PassInput<'_, P>,
    workers: &mut [Worker],
    vertices: &mut [VertexAccumulator],
    marks: &mut [u32],
) {
    let jobs = ranges_of(vertices, marks, workers.len());
    threads::run(workers, jobs, |worker, range| {
        input.limits.width.run(FinishVertices { pass: input.pass, range, findings: &mut worker.findings });
    });
}

fn write<P: Pass>(
    input: &PassInput<'_, P>,
    workers: &mut [Worker],
    vertices: &[VertexAccumulator],
    out: &mut [[f32; 4]],
) {
    let ranges = split_range(0..input.windows.len(), workers.len(), 1);
    let corners = ranges.clone().map(|windows| input.list.corners_of(windows));
    threads::run(workers, ranges.zip(split_slice(out, 0, corners)), |worker, (windows, mut rest)| {
        let Worker { corner_vertices, exceptions, .. } = worker;
        for at in windows {
            let out;
            (out, rest) = std::mem::take(&mut rest).split_at_mut(input.list.corners_of(at..at + 1).len());
            streamed::write(input, at, (vertices, 0), corner_vertices, exceptions, out);
        }
    });
}

//! All threads on all windows, where triangles that share vertices are far from each other in the list.
//!
//! Each thread writes what its part of the triangles adds to the output array, then adds to its part of the vertices what is there,
//! in triangle order, and at last writes its part of the triangles.

use std::ops::Range;

use super::super::threads::{self, parts, split};
use super::super::windows::{WINDOW, triangles_of, window};
use super::source::{rows, triangles};
use super::steps::{Collect, Evaluate, Finish, Read, Write};
use super::stream::Stream;
use super::vertices::Vertex;
use super::workers::Worker;

/// Windows per thread that are added up at once.
const WINDOWS_AT_ONCE: usize = if cfg!(small_limits) { 2 } else { 64 };

/// Does what `Stream::run` does for one thread.
pub(super) fn run(stream: &Stream<'_>, count: usize, workers: &mut [Worker], out: &mut [[[f32; 4]; 3]]) {
    workers.iter_mut().for_each(|worker| worker.begin(0..0));
    let (mut vertices, mut marks) =
        (std::mem::take(&mut workers[0].vertices), std::mem::take(&mut workers[0].marks));
    vertices.resize(count, Vertex::default());
    marks.resize(count, 0);
    read(stream, workers, &mut vertices, &mut marks);
    let at_once = workers.len() * WINDOWS_AT_ONCE;
    for first in (0..stream.windows.len()).step_by(at_once) {
        let windows = first..(first + at_once).min(stream.windows.len());
        evaluate(stream, windows.clone(), workers, &vertices, out);
        collect(stream, windows, workers, out, &mut vertices, &mut marks);
    }
    finish(stream, workers, &mut vertices, &marks);
    write(stream, workers, &vertices, out);
    (workers[0].vertices, workers[0].marks) = (vertices, marks);
}

fn read(stream: &Stream<'_>, workers: &mut [Worker], vertices: &mut [Vertex], marks: &mut [u32]) {
    let ranges = split(0..vertices.len(), workers.len(), 1);
    let jobs = ranges.clone().zip(parts(vertices, 0, ranges.clone())).zip(parts(marks, 0, ranges));
    threads::run(workers, jobs, |worker, ((range, vertices), marks)| {
        let stretches = range.step_by(WINDOW).zip(vertices.chunks_mut(WINDOW)).zip(marks.chunks_mut(WINDOW));
        for ((first, vertices), marks) in stretches {
            let rows = rows(stream.mesh, stream.identity, first..first + vertices.len(), &mut worker.rows);
            stream.width.run(Read { rows, tail: stream.tail, vertices, marks });
        }
    });
}

/// Writes what corners add to their vertices to the corners' place in `out`.
fn evaluate(
    stream: &Stream<'_>,
    windows: Range<usize>,
    workers: &mut [Worker],
    vertices: &[Vertex],
    out: &mut [[[f32; 4]; 3]],
) {
    let ranges = split(triangles_of(windows, stream.mesh.face_count()), workers.len(), WINDOW);
    threads::run(workers, ranges.clone().zip(parts(out, 0, ranges)), |worker, (range, out)| {
        for (first, out) in range.step_by(WINDOW).zip(out.chunks_mut(WINDOW)) {
            let range = first..first + out.len();
            let triangles = triangles(stream.mesh, stream.identity, range, &mut worker.triangles);
            stream.width.run(Evaluate { triangles, block: &mut worker.block, vertices, out });
        }
    });
}

/// Adds what was written to `out` to the vertices, in triangle order.
fn collect(
    stream: &Stream<'_>,
    windows: Range<usize>,
    workers: &mut [Worker],
    terms: &[[[f32; 4]; 3]],
    vertices: &mut [Vertex],
    marks: &mut [u32],
) {
    let ranges = split(0..vertices.len(), workers.len(), 1);
    let jobs = ranges.clone().zip(parts(vertices, 0, ranges.clone())).zip(parts(marks, 0, ranges));
    threads::run(workers, jobs, |worker, ((range, vertices), marks)| {
        for at in windows.clone() {
            let of_window = window(at, stream.mesh.face_count());
            let terms = &terms[of_window.clone()];
            let triangles = triangles(stream.mesh, stream.identity, of_window, &mut worker.triangles);
            let (vertices, marks) = (&mut *vertices, &mut *marks);
            let first = range.start as u32;
            stream.width.run(Collect { triangles, terms, first, block: &mut worker.block, vertices, marks });
        }
    });
}

fn finish(stream: &Stream<'_>, workers: &mut [Worker], vertices: &mut [Vertex], marks: &[u32]) {
    let ranges = split(0..vertices.len(), workers.len(), 1);
    let jobs = parts(vertices, 0, ranges.clone()).zip(ranges.map(|range| &marks[range]));
    threads::run(workers, jobs, |worker, (vertices, marks)| {
        stream.width.run(Finish { vertices, marks, unused: &mut worker.unused });
    });
}

fn write(stream: &Stream<'_>, workers: &mut [Worker], vertices: &[Vertex], out: &mut [[[f32; 4]; 3]]) {
    let ranges = split(0..out.len(), workers.len(), WINDOW);
    threads::run(workers, ranges.clone().zip(parts(out, 0, ranges)), |worker, (range, out)| {
        for (first, out) in range.step_by(WINDOW).zip(out.chunks_mut(WINDOW)) {
            let range = first..first + out.len();
            let triangles = triangles(stream.mesh, stream.identity, range, &mut worker.triangles);
            let special = &mut worker.special;
            stream.width.run(Write { triangles, first, vertices, first_vertex: 0, out, special });
        }
    });
}

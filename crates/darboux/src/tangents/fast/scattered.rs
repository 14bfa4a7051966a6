//! All threads on all windows, where triangles that share vertices are far from each other in the list.
//!
//! Each thread writes down what its part of the triangles adds, to the output array where that has a place for it, then adds to its
//! part of the vertices what is there, in triangle order, and at last writes its part of the faces.

use std::ops::Range;

use crate::exec::threads::{self, parts, split};
use crate::exec::windows::WINDOW;
use crate::tangents::fast::accumulator::Vertex;
use crate::tangents::fast::passes::{Collect, CollectTerms, Evaluate, Finish, FinishPlanned, Read};
use crate::tangents::fast::quads::mark_doubtful;
use crate::tangents::fast::streamed::{Signs, Stream};
use crate::tangents::fast::worker::Worker;

/// Windows per thread that are added up at once.
const WINDOWS_AT_ONCE: usize = if cfg!(small_limits) { 2 } else { 64 };

/// What the corners of a triangle add to their vertices.
pub(crate) type Terms = [[f32; 4]; 3];

/// Does what `Stream::run` does for one thread.
pub(crate) fn run<S: Signs>(
    stream: &Stream<'_, S>,
    count: usize,
    workers: &mut [Worker],
    memory: &mut Vec<Terms>,
    out: &mut [[f32; 4]],
) {
    workers.iter_mut().for_each(|worker| worker.begin(0..0));
    let (mut vertices, mut marks) =
        (std::mem::take(&mut workers[0].vertices), std::mem::take(&mut workers[0].marks));
    vertices.resize(count, Vertex::default());
    marks.resize(count, 0);
    read(stream, workers, &mut vertices, &mut marks);
    let at_once = workers.len() * WINDOWS_AT_ONCE;
    for first in (0..stream.windows.len()).step_by(at_once) {
        let windows = first..(first + at_once).min(stream.windows.len());
        let triangles = stream.source.triangles_of(windows.clone());
        let terms = if stream.source.is_cut() {
            memory.resize(triangles.len(), Terms::default());
            &mut memory[..]
        } else {
            &mut out.as_chunks_mut().0[triangles]
        };
        evaluate(stream, windows.clone(), workers, &vertices, terms);
        collect(stream, windows, workers, terms, &mut vertices, &mut marks);
    }
    finish(stream, workers, &mut vertices, &marks);
    write(stream, workers, &vertices, out);
    (workers[0].vertices, workers[0].marks) = (vertices, marks);
}

fn read<S: Signs>(
    stream: &Stream<'_, S>,
    workers: &mut [Worker],
    vertices: &mut [Vertex],
    marks: &mut [u32],
) {
    let ranges = split(0..vertices.len(), workers.len(), 1);
    let jobs = ranges.clone().zip(parts(vertices, 0, ranges.clone())).zip(parts(marks, 0, ranges));
    threads::run(workers, jobs, |worker, ((range, vertices), marks)| {
        let stretches = range.step_by(WINDOW).zip(vertices.chunks_mut(WINDOW)).zip(marks.chunks_mut(WINDOW));
        for ((first, vertices), marks) in stretches {
            let rows = stream.source.rows(first..first + vertices.len(), &mut worker.rows);
            stream.limits.width.run(Read { rows, tail: stream.tail, vertices, marks });
        }
    });
}

/// Writes down what the triangles of `windows` add to their vertices.
fn evaluate<S: Signs>(
    stream: &Stream<'_, S>,
    windows: Range<usize>,
    workers: &mut [Worker],
    vertices: &[Vertex],
    terms: &mut [Terms],
) {
    let source = &stream.source;
    let first = source.triangles_of(windows.clone()).start;
    let ranges = split(windows, workers.len(), 1);
    let triangles = ranges.clone().map(|windows| source.triangles_of(windows));
    threads::run(workers, ranges.zip(parts(terms, first, triangles)), |worker, (windows, mut terms)| {
        for at in windows {
            let range = source.window(at);
            let out;
            (out, terms) = std::mem::take(&mut terms).split_at_mut(range.len());
            let triangles = source.triangles(range, &mut worker.triangles);
            let block = &mut worker.block;
            match stream.signs.known() {
                None => stream.limits.width.run(Evaluate::<true> { triangles, block, vertices, out }),
                Some(_) => stream.limits.width.run(Evaluate::<false> { triangles, block, vertices, out }),
            }
        }
    });
}

/// Adds the terms to the vertices, in triangle order.
fn collect<S: Signs>(
    stream: &Stream<'_, S>,
    windows: Range<usize>,
    workers: &mut [Worker],
    terms: &[Terms],
    vertices: &mut [Vertex],
    marks: &mut [u32],
) {
    let ranges = split(0..vertices.len(), workers.len(), 1);
    let jobs = ranges.clone().zip(parts(vertices, 0, ranges.clone())).zip(parts(marks, 0, ranges));
    threads::run(workers, jobs, |worker, ((own, vertices), marks)| {
        let mut rest = terms;
        for at in windows.clone() {
            let range = stream.source.window(at);
            let terms;
            (terms, rest) = rest.split_at(range.len());
            let triangles = stream.source.triangles(range.clone(), &mut worker.triangles);
            let first = own.start as u32;
            let (vertices, marks, block) = (&mut *vertices, &mut *marks, &mut worker.block);
            match stream.signs.known() {
                None => {
                    stream.limits.width.run(Collect { triangles, terms, first, block, vertices, marks });
                    mark_doubtful(&stream.source, range, own.start, marks);
                }
                Some(_) => stream.limits.width.run(CollectTerms { triangles, terms, first, vertices }),
            }
        }
    });
}

fn finish<S: Signs>(stream: &Stream<'_, S>, workers: &mut [Worker], vertices: &mut [Vertex], marks: &[u32]) {
    let ranges = split(0..vertices.len(), workers.len(), 1);
    let jobs = parts(vertices, 0, ranges.clone()).zip(ranges);
    threads::run(workers, jobs, |worker, (vertices, range)| match stream.signs.known() {
        None => {
            stream.limits.width.run(Finish { vertices, marks: &marks[range], unused: &mut worker.unused });
        }
        Some(signs) => {
            let (signs, all_usable) = (&signs[range], &mut worker.all_usable);
            stream.limits.width.run(FinishPlanned { vertices, signs, all_usable });
        }
    });
}

fn write<S: Signs>(
    stream: &Stream<'_, S>,
    workers: &mut [Worker],
    vertices: &[Vertex],
    out: &mut [[f32; 4]],
) {
    let ranges = split(0..stream.windows.len(), workers.len(), 1);
    let corners = ranges.clone().map(|windows| stream.source.corners_of(windows));
    threads::run(workers, ranges.zip(parts(out, 0, corners)), |worker, (windows, mut rest)| {
        let Worker { corners, special, .. } = worker;
        for at in windows {
            let out;
            (out, rest) = std::mem::take(&mut rest).split_at_mut(stream.source.corners_of(at..at + 1).len());
            stream.write(at, (vertices, 0), corners, special, out);
        }
    });
}

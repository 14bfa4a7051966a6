//! A pass in which all threads work on all windows, for meshes whose triangles that share vertices are far
//! apart in the list.
//!
//! The vertices are divided into buckets of consecutive numbers that fit into a core's cache. Threads take
//! parts of the triangle list, and store what every corner adds to its vertex, sorted by bucket; then they
//! take buckets, and add what all parts have stored for them. Parts are added in the order of the triangle
//! list, so the sums do not depend on the number of threads. At last threads write the corners.

use std::ops::Range;

use crate::exec::threads::{self, split_range, split_slice};
use crate::exec::windows::WINDOW;
use crate::tangents::fast::accumulator::{VertexAccumulator, VertexRange};
use crate::tangents::fast::kernel::CornerVertices;
use crate::tangents::fast::passes::{
    AddStoredTerms, CountBuckets, FinishVertices, Pass, PassInput, ReadVertices, StoreTerms, Term,
};
use crate::tangents::fast::streamed;
use crate::tangents::fast::worker::Worker;

/// The most windows in a part.
const PART_WINDOWS: usize = if cfg!(small_limits) { 2 } else { 64 };

/// Windows whose terms are stored before they are added, at least.
const BATCH_WINDOWS: usize = if cfg!(small_limits) { 4 } else { 1024 };

/// Parts, or buckets, per thread: threads that come late, or are disturbed, take fewer.
const PARTS_PER_THREAD: usize = 4;

/// The logarithm of the most vertices in a bucket: accumulators and marks of 1.1 MB.
const MOST_BUCKET_BITS: u32 = if cfg!(small_limits) { 2 } else { 14 };

/// The memory of scattered passes, reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct ScatteredBuffers {
    parts: Vec<Part>,
    /// The terms of all parts, where the output array does not have one element per entry of the triangle
    /// list.
    terms: Vec<Term>,
}

/// The corners of consecutive windows.
#[derive(Debug, Default)]
struct Part {
    windows: Range<usize>,
    /// Sorted by bucket, and in the order of the triangle list within each bucket.
    corners: Vec<CornerVertices>,
    /// The end of each bucket in `corners`.
    ends: Vec<u32>,
}

/// Runs a pass over a mesh of `vertex_count` welded vertices. `out`: all corners.
pub(crate) fn run<P: Pass>(
    input: &PassInput<'_, P>,
    vertex_count: usize,
    workers: &mut [Worker],
    buffers: &mut ScatteredBuffers,
    out: &mut [[f32; 4]],
) {
    workers.iter_mut().for_each(|worker| worker.begin(0..0, 0));
    let (mut vertices, mut marks) =
        (std::mem::take(&mut workers[0].vertices), std::mem::take(&mut workers[0].marks));
    vertices.resize(vertex_count, VertexAccumulator::default());
    marks.resize(vertex_count, 0);
    read(input, workers, &mut vertices, &mut marks);
    let bits = bucket_bits(vertex_count, workers.len());
    let at_once = BATCH_WINDOWS.max(PARTS_PER_THREAD * PART_WINDOWS * workers.len());
    for first in (0..input.windows.len()).step_by(at_once) {
        if input.limits.is_cancelled() {
            break;
        }
        let windows = first..(first + at_once).min(input.windows.len());
        let entries = 3 * input.list.triangles_of(windows.clone()).len();
        let ScatteredBuffers { parts, terms } = buffers;
        let terms = if input.list.is_split() {
            terms.resize(entries, Term::default());
            &mut terms[..]
        } else {
            &mut out[input.list.corners_of(windows.clone())]
        };
        divide(windows, workers.len(), parts);
        store(input, bits, workers, &vertices, parts, terms);
        add_stored(input, bits, workers, parts, terms, &mut vertices, &mut marks);
    }
    finish(input, workers, &mut vertices, &mut marks);
    write(input, workers, &vertices, out);
    (workers[0].vertices, workers[0].marks) = (vertices, marks);
}

/// The logarithm of the number of vertices in a bucket.
fn bucket_bits(vertex_count: usize, threads: usize) -> u32 {
    (vertex_count / (PARTS_PER_THREAD * threads)).max(1).ilog2().min(MOST_BUCKET_BITS)
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

/// Divides windows into parts.
fn divide(windows: Range<usize>, threads: usize, parts: &mut Vec<Part>) {
    let size = windows.len().div_ceil(PARTS_PER_THREAD * threads).min(PART_WINDOWS);
    let count = windows.len().div_ceil(size.max(1));
    parts.resize_with(count, Part::default);
    for (part, windows) in parts.iter_mut().zip(split_range(windows, count, 1)) {
        part.windows = windows;
    }
}

/// Stores what the corners of all parts add to their vertices. `bits`: the logarithm of the bucket size.
/// `terms`: of all parts.
fn store<P: Pass>(
    input: &PassInput<'_, P>,
    bits: u32,
    workers: &mut [Worker],
    vertices: &[VertexAccumulator],
    parts: &mut [Part],
    mut terms: &mut [Term],
) {
    let parts = parts.iter_mut().map(|part| {
        let entries = 3 * input.list.triangles_of(part.windows.clone()).len();
        (part, terms.split_off_mut(..entries).expect("the terms are those of all parts"))
    });
    threads::for_each_with(workers, parts, |worker, (part, terms)| {
        part.count(input, bits, vertices.len(), worker);
        let Part { windows, corners, ends } = part;
        corners.resize(terms.len(), CornerVertices::default());
        for at in windows.clone() {
            let triangles = input.list.triangles(input.list.window(at), &mut worker.triangles);
            input.limits.width.run(StoreTerms {
                pass: input.pass,
                triangles,
                block: &mut worker.block,
                vertices,
                bucket_bits: bits,
                next: ends,
                corners,
                terms,
            });
        }
    });
}

impl Part {
    /// Sets `ends` to the start of every bucket.
    fn count<P>(&mut self, input: &PassInput<'_, P>, bits: u32, vertex_count: usize, worker: &mut Worker) {
        self.ends.clear();
        self.ends.resize(vertex_count.div_ceil(1 << bits), 0);
        for at in self.windows.clone() {
            let triangles = input.list.triangles(input.list.window(at), &mut worker.triangles);
            input.limits.width.run(CountBuckets { triangles, bucket_bits: bits, counts: &mut self.ends });
        }
        let mut start = 0;
        for count in &mut self.ends {
            start += std::mem::replace(count, start);
        }
    }

    /// The places of a bucket in `corners`.
    fn bucket(&self, at: usize) -> Range<usize> {
        let start = if at == 0 { 0 } else { self.ends[at - 1] };
        start as usize..self.ends[at] as usize
    }
}

/// Adds what all parts have stored to the vertices, in triangle order.
fn add_stored<P: Pass>(
    input: &PassInput<'_, P>,
    bits: u32,
    workers: &mut [Worker],
    parts: &[Part],
    terms: &[Term],
    vertices: &mut [VertexAccumulator],
    marks: &mut [u32],
) {
    let size = 1 << bits;
    let buckets = vertices.chunks_mut(size).zip(marks.chunks_mut(size)).enumerate();
    threads::for_each_with(workers, buckets, |worker, (bucket, (vertices, marks))| {
        let first = (bucket << bits) as u32;
        let mut rest = terms;
        for part in parts {
            let (terms, range) = (rest, part.bucket(bucket));
            rest = &rest[part.corners.len()..];
            input.limits.width.run(AddStoredTerms {
                pass: input.pass,
                corners: &part.corners[range.clone()],
                terms: &terms[range],
                block: &mut worker.block,
                range: VertexRange { first, vertices: &mut *vertices, marks: &mut *marks },
            });
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
    threads::run(workers, jobs, |worker, mut range| {
        input.pass.mark_quads(&input.list, 0..input.list.count(), &mut range);
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

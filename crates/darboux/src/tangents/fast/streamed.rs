//! A pass in which every thread streams its own windows: each vertex is read before the first window that
//! uses it, finished after the last, and dropped, so that it stays in the cache in between and its memory
//! serves others.

use std::ops::Range;

use crate::exec::simd::Width;
use crate::exec::windows::{Partition, WINDOW, Window};
use crate::tangents::fast::accumulator::{VertexAccumulator, VertexRange};
use crate::tangents::fast::exceptions::Exceptions;
use crate::tangents::fast::passes::{
    AddTriangles, FinishVertices, Pass, PassInput, ReadVertices, WriteCorners, write_face,
};
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::vertex_quantity::{QuantityRange, VertexQuantity};
use crate::tangents::fast::worker::Worker;

/// Streams the windows of one partition: reads the vertices that each window needs first, adds the window's
/// triangles, finishes vertices that no later window needs, writes the corners of windows whose vertices are
/// finished. Windows with vertices of other partitions stay pending.
///
/// `quantities`: those of the partition's vertices. `out`: the corners of its windows.
pub(crate) fn run<P: Pass>(
    input: &PassInput<'_, P>,
    partition: &Partition,
    worker: &mut Worker,
    quantities: &mut [P::Quantity],
    out: &mut [[f32; 4]],
) {
    let Range { start: first_window, end: end_window } = partition.windows;
    let own = partition.vertices.clone();
    let corner = |window: usize| input.list.corners_of(first_window..window).len();
    let vertices = vertices_to_read(input.windows, partition);
    worker.begin(vertices.clone(), own.start.max(vertices.start));
    let (mut finished, mut written) = (own.start.max(worker.first), first_window);
    worker.findings.unread = finished - own.start;
    for at in first_window..partition.end_window {
        if input.limits.is_cancelled() {
            break;
        }
        let unwritten =
            input.windows.get(written).map_or(finished, |window| window.lowest_from_here as usize);
        worker.make_room(unwritten.min(finished), input.windows[at].vertices.end as usize);
        read(&input.list, input.limits.width, worker, input.windows[at].vertices.end as usize);
        let flat_triangles = worker.block.flat_triangles;
        add(input, worker, at, QuantityRange { first: own.start as u32, quantities });
        if at >= end_window {
            // Another thread counts them.
            worker.block.flat_triangles = flat_triangles;
        }
        let unfinished = match input.windows.get(at + 1) {
            Some(next) if at + 1 < partition.end_window => next.lowest_from_here as usize,
            _ => own.end,
        };
        let end = unfinished.min(own.end).min(worker.end()).max(finished);
        finish(input, worker, finished..end, QuantityRange { first: own.start as u32, quantities });
        finished = end;
        while written <= at && written < end_window {
            let Window { vertices: Range { start, end }, .. } = &input.windows[written];
            if (*start as usize) < own.start || *end as usize > own.end {
                worker.list_pending(written, *end as usize);
            } else if *end as usize <= finished {
                let Worker { vertices, first, exceptions, corner_vertices, .. } = &mut *worker;
                let out = &mut out[corner(written)..corner(written + 1)];
                write(input, written, (vertices, *first as u32), corner_vertices, exceptions, out);
            } else {
                break;
            }
            written += 1;
        }
    }
    worker.findings.unread += own.end.saturating_sub(finished);
}

/// The vertices of all windows that a partition adds.
pub(crate) fn vertices_to_read(windows: &[Window], partition: &Partition) -> Range<usize> {
    let windows = &windows[partition.windows.start..partition.end_window];
    let lowest = windows.iter().map(|window| window.vertices.start).min().unwrap_or(0);
    let end = windows.iter().map(|window| window.vertices.end).max().unwrap_or(0);
    lowest as usize..end as usize
}

/// Reads all vertices below `end` that have not been read yet. There is room for them.
pub(crate) fn read(list: &TriangleList<'_>, width: Width, worker: &mut Worker, end: usize) {
    let mut start = worker.end();
    while start < end {
        let range = start..(start + WINDOW).min(end);
        start = range.end;
        worker.read = start - worker.first;
        let Worker { first, vertices, marks, slices, .. } = worker;
        let VertexRange { vertices, marks, .. } = VertexRange::new(range.clone(), *first, vertices, marks);
        let values = list.values(range, slices);
        width.run(ReadVertices { values, vertices, marks });
    }
}

/// Adds the triangles of a window to their vertices. `own`: the quantities of the thread's own vertices.
fn add<P: Pass>(
    input: &PassInput<'_, P>,
    worker: &mut Worker,
    at: usize,
    own: QuantityRange<'_, P::Quantity>,
) {
    let range = input.list.window(at);
    let Worker { block, first, vertices, marks, triangles, .. } = worker;
    let triangles = input.list.triangles(range.clone(), triangles);
    let first = *first as u32;
    input.limits.width.run(AddTriangles {
        pass: input.pass,
        triangles,
        block,
        range: VertexRange { first, vertices, marks },
        own,
    });
    input.pass.mark_quads(&input.list, range, &mut VertexRange { first, vertices, marks });
}

/// Finishes vertices that no later triangle uses. `own`: the quantities of the thread's own vertices.
fn finish<P: Pass>(
    input: &PassInput<'_, P>,
    worker: &mut Worker,
    range: Range<usize>,
    own: QuantityRange<'_, P::Quantity>,
) {
    if range.is_empty() {
        // The vertices that a partition reads can end below its own vertices, when it has none.
        return;
    }
    let place = range.start - own.first as usize..range.end - own.first as usize;
    P::Quantity::finish(input.limits.width, &mut own.quantities[place]);
    let Worker { first, vertices, marks, findings, .. } = worker;
    let range = VertexRange::new(range, *first, vertices, marks);
    input.limits.width.run(FinishVertices { pass: input.pass, range, findings });
}

/// Writes the corners of a window. `vertices`: consecutive finished vertices, and the number of the first.
pub(crate) fn write<P>(
    input: &PassInput<'_, P>,
    at: usize,
    vertices: (&[VertexAccumulator], u32),
    buffer: &mut Vec<u32>,
    exceptions: &mut Exceptions,
    out: &mut [[f32; 4]],
) {
    let corners = input.list.corners_of(at..at + 1);
    let vertex_of_corner = input.list.vertices(corners.clone(), buffer);
    if input.list.is_split() {
        write_faces::<1, P>(input, vertex_of_corner, corners.start, vertices, exceptions, out);
    } else {
        write_faces::<3, P>(input, vertex_of_corner, corners.start, vertices, exceptions, out);
    }
}

fn write_faces<const N: usize, P>(
    input: &PassInput<'_, P>,
    vertex_of_corner: &[u32],
    first_corner: usize,
    (vertices, first_vertex): (&[VertexAccumulator], u32),
    exceptions: &mut Exceptions,
    out: &mut [[f32; 4]],
) {
    let (faces, out) = (vertex_of_corner.as_chunks::<N>().0, out.as_chunks_mut().0);
    let first_face = first_corner / N;
    input.limits.width.run(WriteCorners { faces, first_face, vertices, first_vertex, out, exceptions });
}

/// Writes the windows whose vertices several threads have finished.
pub(crate) fn write_pending<P>(
    input: &PassInput<'_, P>,
    partitions: &[Partition],
    workers: &mut [Worker],
    out: &mut [[f32; 4]],
) {
    if input.limits.is_cancelled() {
        return;
    }
    let mut exceptions = Exceptions::default();
    let mut buffer = Vec::new();
    for &at in workers.iter().flat_map(|worker| &worker.pending) {
        let vertex = |number: u32| {
            let owner = partitions.partition_point(|partition| partition.vertices.end <= number as usize);
            workers[owner].pending_vertex(number)
        };
        let corners = input.list.corners_of(at..at + 1);
        let vertex_of_corner = input.list.vertices(corners.clone(), &mut buffer);
        let out = &mut out[corners.clone()];
        if input.list.is_split() {
            write_pending_faces::<1>(vertex_of_corner, corners.start, &vertex, &mut exceptions, out);
        } else {
            write_pending_faces::<3>(vertex_of_corner, corners.start, &vertex, &mut exceptions, out);
        }
    }
    workers[0].exceptions.append(&mut exceptions);
}

fn write_pending_faces<'a, const N: usize>(
    vertex_of_corner: &[u32],
    first_corner: usize,
    vertex: &impl Fn(u32) -> &'a VertexAccumulator,
    exceptions: &mut Exceptions,
    out: &mut [[f32; 4]],
) {
    let faces = vertex_of_corner.as_chunks::<N>().0.iter().zip(out.as_chunks_mut().0);
    for ((vertices, out), face) in faces.zip((first_corner / N) as u32..) {
        write_face(face, vertices.map(vertex), exceptions, out);
    }
}

#[cfg(test)]
mod tests {
    use crate::tangents::fast::state::FastPath;
    use crate::{Context, Mesh, MikkTSpaceOptions};

    /// Right results would hide it if vertices lost their sums: the general path computes undecided ones.
    #[test]
    fn vertices_that_move_in_memory_stay_decided() {
        let side = if cfg!(small_limits) { 20 } else { 150 };
        let places = (0..=side).flat_map(|y| (0..=side).map(move |x| [x as f32, y as f32]));
        let uvs: Vec<[f32; 2]> = places.collect();
        let positions: Vec<[f32; 3]> = uvs.iter().map(|&[x, y]| [x, y, 0.1 * (x * y).sin()]).collect();
        let normals = vec![[0.0, 0.0, 1.0]; uvs.len()];
        let corners = (0..side * side).map(|cell| cell / side * (side + 1) + cell % side);
        let indices: Vec<u32> = corners
            .flat_map(|at| [at, at + 1, at + side + 1, at + 1, at + side + 2, at + side + 1])
            .collect();
        let mesh = Mesh::triangles(&positions, &normals, &uvs, &indices).expect("a valid mesh");
        let mut out = vec![[0.0; 4]; indices.len()];
        for threads in [1, 2, 3] {
            let context = Context::new().with_max_threads(threads);
            let mut path = FastPath::default();
            assert!(path.run(&mesh, &MikkTSpaceOptions::new(), context.limits(), &mut out));
            assert!(
                path.exceptions.undecided.len() < 10,
                "{} are undecided",
                path.exceptions.undecided.len()
            );
        }
    }
}

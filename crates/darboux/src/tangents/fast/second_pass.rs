//! A second pass over the triangles, after the tangents are decided: it adds up other quantities per vertex.

use crate::exec::limits::RunLimits;
use crate::exec::simd::Task;
use crate::exec::threads::{self, split_slice};
use crate::exec::windows::{Partition, Window};
use crate::tangents::fast::accumulator::{VertexAccumulator, gather};
use crate::tangents::fast::kernel::{BLOCK_SIZE, TriangleBlock};
use crate::tangents::fast::schedule::Schedule;
use crate::tangents::fast::streamed::{self, vertices_to_read};
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::vertex_quantity::{QuantityRange, VertexQuantity};
use crate::tangents::fast::worker::Worker;

/// The mesh of the last run.
pub(crate) struct SecondPass<'a> {
    pub list: TriangleList<'a>,
    pub windows: &'a [Window],
    pub schedule: &'a Schedule,
    pub workers: &'a mut [Worker],
    /// The number of welded vertices.
    pub vertex_count: usize,
    pub limits: RunLimits<'a>,
}

impl SecondPass<'_> {
    /// Adds up a quantity of all vertices. `out`: receives one element per welded vertex.
    pub fn run<Q: VertexQuantity>(self, out: &mut Vec<Q>) {
        let Self { list, windows, schedule, workers, vertex_count, limits } = self;
        out.clear();
        out.resize(vertex_count, Q::default());
        let all =
            Partition { windows: 0..windows.len(), end_window: windows.len(), vertices: 0..vertex_count };
        let is_scattered = schedule.is_scattered(windows);
        let partitions = if is_scattered { std::slice::from_ref(&all) } else { &schedule.partitions[..] };
        let vertices = partitions.iter().map(|partition| partition.vertices.clone());
        let jobs = partitions.iter().zip(split_slice(out, 0, vertices));
        threads::run(workers, jobs, |worker, (partition, quantities)| {
            worker.begin(vertices_to_read(windows, partition), 0);
            let numbers = partition.windows.start..partition.end_window;
            for at in numbers.take_while(|_| !limits.is_cancelled()) {
                let end = windows[at].vertices.end as usize;
                worker.make_room(windows[at].lowest_from_here as usize, end);
                streamed::read(&list, limits.width, worker, end);
                let Worker { block, vertices, triangles: buffer, first, .. } = worker;
                let triangles = list.triangles(list.window(at), buffer);
                let own =
                    QuantityRange { first: partition.vertices.start as u32, quantities: &mut *quantities };
                limits.width.run(AddQuantities { triangles, first: *first as u32, block, vertices, own });
            }
            Q::finish(limits.width, quantities);
        });
    }
}

/// Adds triangles to the quantities of their vertices.
struct AddQuantities<'a, Q> {
    triangles: &'a [[u32; 3]],
    /// The number of the first of `vertices`.
    first: u32,
    block: &'a mut TriangleBlock,
    vertices: &'a [VertexAccumulator],
    own: QuantityRange<'a, Q>,
}

impl<Q: VertexQuantity> Task for AddQuantities<'_, Q> {
    #[inline(always)]
    fn run(self) {
        let Self { triangles, first, block, vertices, mut own } = self;
        for triangles in triangles.chunks(BLOCK_SIZE) {
            block.set(triangles, first);
            gather(block, triangles.len(), vertices);
            if Q::NEEDS_ANGLES {
                block.evaluate_derivatives_and_angles();
            } else {
                block.evaluate_derivatives();
            }
            own.add(block, triangles.len(), first);
        }
    }
}

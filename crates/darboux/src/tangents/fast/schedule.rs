//! Runs a pass on all threads: streamed where triangles that share vertices are near each other in the list,
//! else scattered.

use crate::exec::simd::{Task, Width};
use crate::exec::threads::{self, split_range, split_slice};
use crate::exec::windows::{Partition, Window, accumulate_bounds, overlap_too_much, partitions};
use crate::tangents::fast::passes::{Pass, PassInput};
use crate::tangents::fast::scattered::ScatteredBuffers;
use crate::tangents::fast::triangle_list::TriangleList;
use crate::tangents::fast::worker::Worker;
use crate::tangents::fast::{scattered, streamed};

/// The memory of a schedule, reused from mesh to mesh.
#[derive(Debug, Default)]
pub(crate) struct Schedule {
    /// What each thread does in a streamed pass.
    pub partitions: Vec<Partition>,
    /// The memory of scattered passes.
    scattered: ScatteredBuffers,
}

impl Schedule {
    /// Runs a pass with one thread per worker. `quantities`: one per vertex, all zero; a scattered pass
    /// leaves them. `out`: all corners.
    pub fn run<P: Pass>(
        &mut self,
        input: &PassInput<'_, P>,
        workers: &mut [Worker],
        quantities: &mut [P::Quantity],
        out: &mut [[f32; 4]],
    ) {
        self.partitions.clear();
        self.partitions.extend(partitions(input.windows, quantities.len(), workers.len()));
        if self.is_scattered(input.windows) {
            return scattered::run(input, quantities.len(), workers, &mut self.scattered, out);
        }
        let ranges = self.partitions.iter().map(|partition| input.list.corners_of(partition.windows.clone()));
        let vertices = self.partitions.iter().map(|partition| partition.vertices.clone());
        let parts = split_slice(quantities, 0, vertices).zip(split_slice(&mut *out, 0, ranges));
        threads::run(workers, self.partitions.iter().zip(parts), |worker, (partition, (quantities, out))| {
            streamed::run(input, partition, worker, quantities, out);
        });
        streamed::write_pending(input, &self.partitions, workers, out);
    }

    /// True when the last pass was scattered: the first worker then has all vertices.
    pub fn is_scattered(&self, windows: &[Window]) -> bool {
        overlap_too_much(&self.partitions, windows)
    }
}

/// Finds which vertices each window of the triangle list uses.
pub(crate) fn find_windows(
    list: &TriangleList<'_>,
    width: Width,
    workers: &mut [Worker],
    windows: &mut Vec<Window>,
) {
    windows.clear();
    windows.resize(list.window_count(), Window::default());
    let ranges = split_range(0..windows.len(), workers.len(), 1);
    let jobs = ranges.clone().zip(split_slice(windows, 0, ranges));
    threads::run(workers, jobs, |worker, (range, windows)| {
        for (at, window) in range.zip(windows) {
            let vertices = list.vertices(list.corners_of(at..at + 1), &mut worker.corner_vertices);
            width.run(FindVertexBounds { vertices, window });
        }
    });
    accumulate_bounds(windows);
}

/// Finds the lowest and the highest vertex of a window.
struct FindVertexBounds<'a> {
    vertices: &'a [u32],
    window: &'a mut Window,
}

impl Task for FindVertexBounds<'_> {
    #[inline(always)]
    fn run(self) {
        let (mut lowest, mut highest) = (u32::MAX, 0);
        for &vertex in self.vertices {
            lowest = vertex.min(lowest);
            highest = vertex.max(highest);
        }
        self.window.vertices = lowest..highest + 1;
    }
}

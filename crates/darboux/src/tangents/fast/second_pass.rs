//! A second pass over the triangles: what corners add to their vertices once these are decided.

use std::ops::Range;

use crate::Mesh;

use crate::exec::limits::RunLimits;
use crate::exec::simd::{Task, Width};
use crate::exec::threads::{self, parts};
use crate::exec::windows::{Share, overlap};
use crate::tangents::fast::Fans;
use crate::tangents::fast::accumulator::{Vertex, gather};
use crate::tangents::fast::kernel::{BLOCK, Block};
use crate::tangents::fast::source;
use crate::tangents::fast::worker::Worker;

/// What the corners of a vertex add up to.
pub(crate) trait OfVertex: Copy + Default + Send {
    /// Makes what the corners of a block add.
    fn evaluate(block: &mut Block);

    /// Adds what corner `k` of triangle `i` has.
    fn add(&mut self, block: &Block, k: usize, i: usize);

    /// Finishes vertices all of whose corners have been added.
    fn finish(_width: Width, _of_vertices: &mut [Self]) {}
}

impl Fans {
    /// Adds up all vertices of the mesh that this has just run on. `out`: one per welded vertex.
    pub(crate) fn add_again<V: OfVertex>(
        &mut self,
        mesh: &Mesh<'_>,
        limits: RunLimits<'_>,
        out: &mut Vec<V>,
    ) {
        out.clear();
        out.resize(self.weld.count, V::default());
        let all =
            Share { windows: 0..self.windows.len(), until: self.windows.len(), vertices: 0..self.weld.count };
        // Where shares overlap too much, the first worker has the vertices of all.
        let one = overlap(&self.shares, &self.windows);
        let shares = if one { std::slice::from_ref(&all) } else { &self.shares[..] };
        let vertices = shares.iter().map(|share| share.vertices.clone());
        let jobs = shares.iter().zip(parts(out, 0, vertices));
        let source = source(mesh, &self.weld, &self.cut);
        threads::run(&mut self.workers, jobs, |worker, (share, of_vertices)| {
            let Worker { block, vertices, triangles: buffer, first, .. } = worker;
            for at in (share.windows.start..share.until).take_while(|_| !limits.is_cancelled()) {
                let triangles = source.triangles(source.window(at), buffer);
                let (first, own, of_vertices) = (*first as u32, share.vertices.clone(), &mut *of_vertices);
                limits.width.run(Add { triangles, first, block, vertices, own, of_vertices });
            }
            V::finish(limits.width, of_vertices);
        });
    }
}

/// Adds triangles to those of their vertices that are in `own`.
struct Add<'a, V> {
    triangles: &'a [[u32; 3]],
    /// The number of the first of `vertices`.
    first: u32,
    block: &'a mut Block,
    vertices: &'a [Vertex],
    own: Range<usize>,
    of_vertices: &'a mut [V],
}

impl<V: OfVertex> Task for Add<'_, V> {
    #[inline(always)]
    fn run(self) {
        let Self { triangles, first, block, vertices, own, of_vertices } = self;
        let before = (own.start as u32).wrapping_sub(first);
        for triangles in triangles.chunks(BLOCK) {
            block.set(triangles, first);
            gather(block, triangles.len(), vertices);
            V::evaluate(block);
            for i in 0..triangles.len() {
                for k in 0..3 {
                    let at = block.vertex[k][i].wrapping_sub(before) as usize;
                    if let Some(of_vertex) = of_vertices.get_mut(at) {
                        of_vertex.add(block, k, i);
                    }
                }
            }
        }
    }
}

//! Whole frames: the bitangents and magnitudes that go with tangents, once these are decided.

#![allow(clippy::needless_range_loop, reason = "loops over lanes vectorise as they are written")]

use std::ops::Range;

use crate::cancel::Stop;
use crate::math::normalized_unless_zero;
use crate::{Frame, Mesh};

use super::super::threads::{self, parts};
use super::super::width::{Task, Width};
use super::super::windows::{Share, overlap};
use super::block::{BLOCK, Block};
use super::source::Source;
use super::vertices::{Vertex, gather};
use super::workers::Worker;
use super::{Fans, source};

/// What the corners of a vertex add up to: the bitangent and the weight; the magnitudes of both directions.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    bitangent: [f32; 4],
    magnitude: [f32; 2],
}

impl Fans {
    /// Adds up the bitangents and magnitudes of all vertices of the mesh that this has just run on.
    pub fn add_frames(&mut self, mesh: &Mesh<'_>, width: Width, stop: &Stop) {
        if stop.is_asked() {
            return;
        }
        self.sums.clear();
        self.sums.resize(self.weld.count, Sums::default());
        let all =
            Share { windows: 0..self.windows.len(), until: self.windows.len(), vertices: 0..self.weld.count };
        // Where shares overlap too much, the first worker has the vertices of all.
        let one = overlap(&self.shares, &self.windows);
        let shares = if one { std::slice::from_ref(&all) } else { &self.shares[..] };
        let vertices = shares.iter().map(|share| share.vertices.clone());
        let jobs = shares.iter().zip(parts(&mut self.sums, 0, vertices));
        let source = source(mesh, &self.weld, &self.cut);
        threads::run(&mut self.workers, jobs, |worker, (share, sums)| {
            add_share(&source, share, (width, stop), worker, sums);
        });
    }

    /// Writes the bitangents and the magnitudes at the corners from number `first` on, as many as `out` has. Anything where the tangent is
    /// not decided.
    pub fn write_rest(&self, mesh: &Mesh<'_>, first: usize, out: &mut [Frame]) {
        let corners = first..first + out.len();
        let mut out = out.iter_mut();
        self.source(mesh).visit(corners, |vertex| {
            let Sums { bitangent: [x, y, z, _], magnitude } = self.sums[vertex as usize];
            if let Some(out) = out.next() {
                (out.bitangent, out.magnitude) = ([x, y, z], magnitude);
            }
        });
    }
}

/// Adds the windows of a share to the vertices that are its own, and finishes these.
fn add_share(
    source: &Source<'_>,
    share: &Share,
    (width, stop): (Width, &Stop),
    worker: &mut Worker,
    sums: &mut [Sums],
) {
    let Worker { block, vertices, triangles: buffer, first, .. } = worker;
    for at in (share.windows.start..share.until).take_while(|_| !stop.is_asked()) {
        let triangles = source.triangles(source.window(at), buffer);
        let (first, own) = (*first as u32, share.vertices.clone());
        width.run(AddFrames { triangles, first, block, vertices, own, sums });
    }
    width.run(FinishFrames(sums));
}

/// From sums to directions and means.
struct FinishFrames<'a>(&'a mut [Sums]);

impl Task for FinishFrames<'_> {
    #[inline(always)]
    fn run(self) {
        let mut lanes = [[0.0; BLOCK]; 6];
        for sums in self.0.chunks_mut(BLOCK) {
            for (i, &Sums { bitangent: [x, y, z, weight], magnitude: [s, t] }) in sums.iter().enumerate() {
                [x, y, z, weight, s, t].into_iter().zip(&mut lanes).for_each(|(value, lane)| lane[i] = value);
            }
            for i in 0..BLOCK {
                let [x, y, z] = normalized_unless_zero([lanes[0][i], lanes[1][i], lanes[2][i]]);
                let weight = if lanes[3][i] > 0.0 { lanes[3][i] } else { 1.0 };
                (lanes[0][i], lanes[1][i], lanes[2][i]) = (x, y, z);
                (lanes[4][i], lanes[5][i]) = (lanes[4][i] / weight, lanes[5][i] / weight);
            }
            for (i, sums) in sums.iter_mut().enumerate() {
                let [x, y, z, weight, s, t] = lanes.each_ref().map(|lane| lane[i]);
                *sums = Sums { bitangent: [x, y, z, weight], magnitude: [s, t] };
            }
        }
    }
}

/// Adds triangles to those of their vertices that are in `own`.
struct AddFrames<'a> {
    triangles: &'a [[u32; 3]],
    /// The number of the first of `vertices`.
    first: u32,
    block: &'a mut Block,
    vertices: &'a [Vertex],
    own: Range<usize>,
    sums: &'a mut [Sums],
}

impl Task for AddFrames<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { triangles, first, block, vertices, own, sums } = self;
        let before = (own.start as u32).wrapping_sub(first);
        for triangles in triangles.chunks(BLOCK) {
            block.set(triangles, first);
            gather(block, triangles.len(), vertices);
            block.evaluate_bitangents();
            for i in 0..triangles.len() {
                for k in 0..3 {
                    let at = block.vertex[k][i].wrapping_sub(before) as usize;
                    let Some(sums) = sums.get_mut(at) else { continue };
                    let (bitangent, magnitude) = (block.sum[k][i], block.magnitude_sum[k][i]);
                    (0..4).for_each(|lane| sums.bitangent[lane] += bitangent[lane]);
                    (0..2).for_each(|lane| sums.magnitude[lane] += magnitude[lane]);
                }
            }
        }
    }
}

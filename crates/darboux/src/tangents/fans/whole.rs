//! Whole frames: the bitangents and magnitudes that go with tangents, once these are decided.

use crate::math::normalized_unless_zero;
use crate::{Frame, Mesh};

use super::super::width::{Task, Width};
use super::super::windows::windows_of;
use super::block::{BLOCK, Block};
use super::source::{Identity, triangles};
use super::{Fans, UNDECIDED};

/// What the corners of a vertex add up to: the bitangent and the weight; the magnitudes of both directions.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    bitangent: [f32; 4],
    magnitude: [f32; 2],
}

impl Fans {
    /// Writes the frames of the decided corners of the mesh that this has just run on. `tangents`: what it wrote.
    pub fn write_frames(&self, mesh: &Mesh<'_>, width: Width, tangents: &[[f32; 4]], out: &mut [Frame]) {
        let identity = self.weld.identity();
        let mut sums = vec![Sums::default(); self.weld.count];
        let (mut block, mut buffer) = (Box::<Block>::default(), Vec::new());
        for range in windows_of(mesh.face_count()) {
            let triangles = triangles(mesh, identity, range, &mut buffer);
            width.run(AddFrames { mesh, identity, triangles, block: &mut block, sums: &mut sums });
        }
        sums.iter_mut().for_each(Sums::finish);
        let corners = (0..).zip(tangents).zip(out).filter(|((_, tangent), _)| tangent[3] != UNDECIDED);
        for ((corner, &[x, y, z, sign]), out) in corners {
            let Sums { bitangent: [a, b, c, _], magnitude } = sums[identity.vertex(mesh, corner) as usize];
            *out = Frame { tangent: [x, y, z], bitangent: [a, b, c], magnitude, sign };
        }
    }
}

impl Sums {
    /// From sums to the frame's.
    fn finish(&mut self) {
        let [x, y, z, weight] = self.bitangent;
        let [x, y, z] = normalized_unless_zero([x, y, z]);
        self.bitangent = [x, y, z, weight];
        if weight > 0.0 {
            self.magnitude = self.magnitude.map(|sum| sum / weight);
        }
    }
}

/// Adds triangles to their vertices.
struct AddFrames<'a> {
    mesh: &'a Mesh<'a>,
    identity: Identity<'a>,
    triangles: &'a [[u32; 3]],
    block: &'a mut Block,
    sums: &'a mut [Sums],
}

impl Task for AddFrames<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { mesh, identity, triangles, block, sums } = self;
        for triangles in triangles.chunks(BLOCK) {
            for (i, triangle) in triangles.iter().enumerate() {
                block.put(i, triangle.map(|vertex| identity.record(mesh, vertex)));
            }
            block.evaluate_bitangents();
            for (i, triangle) in triangles.iter().enumerate() {
                for (k, &vertex) in triangle.iter().enumerate() {
                    let sums = &mut sums[vertex as usize];
                    let (bitangent, magnitude) = (block.sum[k][i], block.magnitude_sum[k][i]);
                    (0..4).for_each(|lane| sums.bitangent[lane] += bitangent[lane]);
                    (0..2).for_each(|lane| sums.magnitude[lane] += magnitude[lane]);
                }
            }
        }
    }
}

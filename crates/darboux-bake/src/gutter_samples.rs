//! Samples in the gutters of charts: stages 3 to 5 for texels that filters mix with those of a chart.

use crate::band::{Bake, Scratch};
use crate::bvh::Sides;
use crate::coverage::TEXELS;
use crate::face::Face;
use crate::gutter::Gutter;
use crate::layout::BLOCK;
use crate::rays::ray_of;
use crate::samples::STEPS;
use crate::texel::Sample;

/// The least z of a normal in the gutter of a chart. Where the surface turns away further than 60 degrees, the chart does not continue.
const LEAST_Z: f64 = 0.5;

impl Bake<'_> {
    /// Follows the rays of a block's samples that no triangle covers, on the nearest triangle, continued. What does not continue the chart is
    /// left to padding.
    ///
    /// `gutter`: of the block; it is made when the first sample needs it.
    pub fn sample_gutter(
        &self,
        block: [usize; 2],
        sample: [i64; 2],
        gutter: &mut Option<Gutter>,
        scratch: &mut Scratch,
    ) {
        let first = block.map(|at| at * BLOCK);
        let is_in_image = |texel: &usize| {
            let at = [first[0] + texel % BLOCK, first[1] + texel / BLOCK];
            at[0] < self.layout.size[0] && at[1] < self.layout.size[1]
        };
        if self.options.padding == Some(0) {
            return;
        }
        let mut last: Option<Face> = None;
        for texel in (0..TEXELS).filter(is_in_image) {
            if scratch.coverage.owners[texel].is_some() {
                continue;
            }
            let gutter = gutter.get_or_insert_with(|| Gutter::of_block(self.layout, self.low, block));
            let Some(placed) = gutter.nearest(texel) else { continue };
            if last.as_ref().is_none_or(|face| face.placed != placed) {
                last = Some(Face::new(self.layout, self.low, placed));
            }
            let Some(face) = &last else { continue };
            let at = [first[0] + texel % BLOCK, first[1] + texel / BLOCK];
            if let Some(found) = self.continued(face, at, sample, scratch) {
                scratch.sums[texel].add(&found);
            }
        }
    }

    /// What the ray of a sample finds, if it continues the chart.
    fn continued(
        &self,
        face: &Face,
        at: [usize; 2],
        sample: [i64; 2],
        scratch: &mut Scratch,
    ) -> Option<Sample> {
        let place = [0, 1].map(|i| at[i] as f64 + sample[i] as f64 / STEPS as f64);
        let point = face.continued_point(place)?;
        let ray = ray_of(&point, self.options.distance)?;
        let group = &self.groups[face.group];
        let sides = if self.options.back_faces { Sides::Both } else { Sides::Front };
        scratch.rays += 1;
        let hit = group.bvh.nearest(&ray.ray, sides, &mut scratch.stack)?;
        let found = self.found(group, &point, &ray, &hit, self.seed(at, sample), &mut scratch.stack)?;
        let continues = found.normal.is_some_and(|normal| normal[2] > LEAST_Z);
        continues.then_some(Sample { is_extended: true, ..found })
    }
}

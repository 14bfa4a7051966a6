//! Samples in the gutters of charts: stages 3 to 5 for texels that filters mix with a chart's texels.

use crate::band::{Bake, Scratch};
use crate::bvh::Sides;
use crate::coverage::TEXELS;
use crate::found::LowSample;
use crate::gutter::Gutter;
use crate::layout::{BLOCK, TileTriangle};
use crate::samples::STEPS;

/// The least z of a normal in the gutter of a chart. Where the surface turns away further than 60 degrees,
/// the chart does not continue.
const LEAST_Z: f64 = 0.5;

impl<'a> Bake<'a> {
    /// Follows the rays of a block's samples that no triangle covers, on the nearest triangle, continued.
    /// What does not continue the chart is left to padding.
    ///
    /// `gutter`: of the block; it is made when the first sample needs it.
    pub fn sample_gutter(
        &self,
        block: [usize; 2],
        sample: [i64; 2],
        gutter: &mut Option<Gutter>,
        scratch: &mut Scratch<'a>,
    ) {
        let first = block.map(|at| at * BLOCK);
        let is_in_image = |texel: &usize| {
            let at = [first[0] + texel % BLOCK, first[1] + texel / BLOCK];
            at[0] < self.layout.size[0] && at[1] < self.layout.size[1]
        };
        if self.options.padding == Some(0) {
            return;
        }
        for texel in (0..TEXELS).filter(is_in_image) {
            if scratch.coverage.owners[texel].is_some() {
                continue;
            }
            let gutter = gutter.get_or_insert_with(|| Gutter::of_block(self.layout, self.low, block));
            let Some(triangle) = gutter.nearest(texel) else { continue };
            let at = [first[0] + texel % BLOCK, first[1] + texel / BLOCK];
            self.sample_continued(triangle, at, texel, sample, scratch);
        }
    }

    /// Adds what the ray of a sample finds, if it continues the chart. `at`: the texel in the image; `texel`:
    /// in the block.
    fn sample_continued(
        &self,
        triangle: TileTriangle,
        at: [usize; 2],
        texel: usize,
        sample: [i64; 2],
        scratch: &mut Scratch<'a>,
    ) {
        let Scratch { faces, sums, numbers, stack, rays, .. } = scratch;
        let face = faces.get(self.layout, self.low, triangle);
        let place = [0, 1].map(|i| at[i] as f64 + sample[i] as f64 / STEPS as f64);
        let Some(point) = face.continued_point(place) else { return };
        let Some(low) = self.low_ray(face, &point) else { return };
        let group = &self.groups[face.group];
        let sides = if self.options.back_faces { Sides::Both } else { Sides::Front };
        *rays += 1;
        let Some(hit) = group.bvh.nearest(&low.ray.ray, sides, stack) else { return };
        let Some(found) = self.found(group, &low, &hit, self.seed(at, sample)) else { return };
        if found.normal.is_some_and(|normal| normal[2] > LEAST_Z) {
            sums[texel].add(&found.sample(true));
            self.add_high(&found, texel, numbers, stack);
            let sample =
                LowSample { face, point: &point, place, charts: &self.charts, options: self.options };
            self.add_low(&sample, texel, numbers);
        }
    }
}

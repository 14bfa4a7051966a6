//! Stages 2 to 6 for a band of the image: coverage, rays, hits, frames, texels.

use darboux::Conversion;

use crate::bvh::{Hit, PreparedRay, Shaft, Sides, Stack};
use crate::common_box::CommonBox;
use crate::coverage::{Coverage, TEXELS};
use crate::face::Face;
use crate::frame::ShadingFrame;
use crate::high::HighGroup;
use crate::images::Band;
use crate::layout::{BLOCK, Layout};
use crate::occlusion::Opening;
use crate::point::SurfacePoint;
use crate::rays::{SampleRay, point_at, ray_of};
use crate::samples::STEPS;
use crate::texel::{Sample, TexelSums};
use crate::vector::{narrow, unit};
use crate::{BakeOptions, BakeReport, LowSurface, MapKind};

/// What all bands share.
pub struct Bake<'a> {
    pub low: &'a [LowSurface<'a>],
    pub groups: &'a [HighGroup<'a>],
    pub layout: &'a Layout,
    pub options: &'a BakeOptions,
    pub conversion: Conversion,
    /// The box in which rays are followed; heights and positions leave it again.
    pub space: CommonBox,
    /// The places of samples within a texel.
    pub samples: Vec<[i64; 2]>,
}

/// The memory of one band.
pub struct Scratch {
    pub coverage: Coverage,
    pub sums: Vec<TexelSums>,
    pub stack: Stack,
    pub rays: u64,
    rays_of_tile: Vec<TexelRay>,
}

/// Texels per side of a tile, whose rays begin at one cut of the tree.
const TILE: usize = 8;

/// Tiles per side of a block.
const TILES: usize = BLOCK / TILE;

/// The ray of a sample.
struct TexelRay {
    /// Its place in the block.
    texel: usize,
    point: SurfacePoint,
    ray: SampleRay,
    prepared: PreparedRay,
    group: usize,
}

impl Bake<'_> {
    /// Bakes a band; returns the counts of its texels.
    pub fn band(&self, band: &mut Band<'_>) -> BakeReport {
        let mut scratch = Scratch {
            coverage: Coverage::new(),
            sums: vec![TexelSums::default(); TEXELS],
            stack: Stack::new(),
            rays: 0,
            rays_of_tile: Vec::with_capacity(TILE * TILE),
        };
        let mut report = BakeReport::default();
        for column in 0..self.layout.blocks_per_row() {
            scratch.sums.fill(TexelSums::default());
            let mut gutter = None;
            for &sample in &self.samples {
                self.cover([column, band.row / BLOCK], sample, &mut scratch.coverage);
                self.sample([column * BLOCK, band.row], sample, &mut scratch);
                self.sample_gutter([column, band.row / BLOCK], sample, &mut gutter, &mut scratch);
            }
            self.store(column * BLOCK, &scratch.sums, band, &mut report);
        }
        report.rays = scratch.rays;
        report
    }

    /// Stage 2: finds the triangle of every sample of a block.
    fn cover(&self, [column, row]: [usize; 2], sample: [i64; 2], coverage: &mut Coverage) {
        coverage.clear();
        for placed in self.layout.block(column, row) {
            let low = &self.low[placed.surface as usize];
            coverage.add(*placed, self.layout.steps_in_block(low, placed, [column, row]), sample);
        }
    }

    /// Stages 3 to 5: follows the rays of a block's samples, tile by tile.
    fn sample(&self, first: [usize; 2], sample: [i64; 2], scratch: &mut Scratch) {
        for tile in 0..TILES * TILES {
            let from = [tile % TILES * TILE, tile / TILES * TILE];
            self.find_rays(first, from, sample, scratch);
            self.follow_rays(first, sample, scratch);
        }
    }

    /// Stage 3: the rays of the samples of a tile. `first`: the upper left texel of the block; `from`: that of the tile in the block.
    fn find_rays(&self, first: [usize; 2], from: [usize; 2], sample: [i64; 2], scratch: &mut Scratch) {
        scratch.rays_of_tile.clear();
        let mut last: Option<Face> = None;
        for at_tile in 0..TILE * TILE {
            let in_block = [from[0] + at_tile % TILE, from[1] + at_tile / TILE];
            let texel = in_block[1] * BLOCK + in_block[0];
            let Some(placed) = scratch.coverage.owners[texel] else { continue };
            if last.as_ref().is_none_or(|face| face.placed != placed) {
                last = Some(Face::new(self.layout, self.low, placed));
            }
            let Some(face) = &last else { continue };
            let sums = &mut scratch.sums[texel];
            sums.is_charted = true;
            sums.is_overlapped |= scratch.coverage.overlaps[texel];
            let place = [0, 1].map(|i| (first[i] + in_block[i]) as f64 + sample[i] as f64 / STEPS as f64);
            let point = face.point(place);
            let Some(ray) = ray_of(&point, self.options.distance) else { continue };
            let prepared = self.groups[face.group].bvh.prepare(&ray.ray);
            scratch.rays_of_tile.push(TexelRay { texel, point, ray, prepared, group: face.group });
        }
        scratch.rays += scratch.rays_of_tile.len() as u64;
    }

    /// Stages 4 and 5: the hits of a tile's rays, all of which begin at the cut of their shaft.
    fn follow_rays(&self, first: [usize; 2], sample: [i64; 2], scratch: &mut Scratch) {
        let Scratch { rays_of_tile, sums, stack, .. } = scratch;
        for rays in rays_of_tile.chunk_by(|a, b| a.group == b.group) {
            let group = &self.groups[rays[0].group];
            let Some(shaft) = Shaft::of(rays.iter().map(|ray| &ray.prepared)) else { continue };
            let cut = group.bvh.cut(&shaft);
            let sides = if self.options.back_faces { Sides::Both } else { Sides::Front };
            for TexelRay { texel, point, ray, prepared, .. } in rays {
                let sums = &mut sums[*texel];
                match group.bvh.nearest_of_cut(&cut, prepared, sides, stack) {
                    Some(hit) => {
                        let at = [first[0] + texel % BLOCK, first[1] + texel / BLOCK];
                        if let Some(found) = self.found(group, point, ray, &hit, self.seed(at, sample), stack)
                        {
                            sums.add(&found);
                        }
                    }
                    None if sides == Sides::Front => {
                        sums.hits_back |=
                            group.bvh.nearest_of_cut(&cut, prepared, Sides::Both, stack).is_some();
                    }
                    None => {}
                }
            }
        }
    }

    /// A number for the random choices of a sample of a texel.
    pub fn seed(&self, at: [usize; 2], sample: [i64; 2]) -> u64 {
        let texel = (at[1] * self.layout.size[0] + at[0]) as i64;
        ((texel * STEPS + sample[1]) * STEPS + sample[0]) as u64
    }

    /// What a hit adds to its texel.
    pub fn found(
        &self,
        group: &HighGroup<'_>,
        point: &SurfacePoint,
        ray: &SampleRay,
        hit: &Hit,
        seed: u64,
        stack: &mut Stack,
    ) -> Option<Sample> {
        let BakeOptions { maps, bitangent, occlusion_rays, occlusion_distance, .. } = *self.options;
        let high = group.point(hit)?;
        let position = point_at(&ray.ray, hit.distance);
        let opening = || {
            let face_normal = unit(high.face_normal).unwrap_or(high.normal);
            Opening { position, normal: high.normal, face_normal, seed }
        };
        Some(Sample {
            normal: ShadingFrame::new(point, bitangent).to_tangent_space(high.normal),
            object_normal: high.normal,
            height: ray.surface - f64::from(hit.distance),
            occlusion: match maps.has(MapKind::Occlusion) {
                true => opening().share(&group.bvh, occlusion_rays, occlusion_distance, stack),
                false => 1.0,
            },
            position,
            is_inverted: high.is_inverted,
            is_extended: false,
        })
    }

    /// Stage 6: stores the texels of a block.
    fn store(&self, first: usize, sums: &[TexelSums], band: &mut Band<'_>, report: &mut BakeReport) {
        let width = self.layout.size[0];
        let rows = band.states.len() / width;
        for row in 0..rows.min(BLOCK) {
            for column in first..width.min(first + BLOCK) {
                let sums = &sums[row * BLOCK + column - first];
                let at = row * width + column;
                band.states[at] = sums.state();
                count(sums, report);
                if sums.state().has_content() {
                    self.store_texel(at, sums, band, report);
                }
            }
        }
    }

    fn store_texel(&self, at: usize, sums: &TexelSums, band: &mut Band<'_>, report: &mut BakeReport) {
        let texel = sums.resolve();
        report.below_horizon_texels += u64::from(texel.normal[2] < 0.0);
        if let Some(image) = &mut band.normal {
            let sign = |inverts| if inverts { -1.0 } else { 1.0 };
            let [x, y, z] = narrow(texel.normal);
            image[at] =
                [sign(self.conversion.inverts_red()) * x, sign(self.conversion.inverts_green()) * y, z];
        }
        if let Some(image) = &mut band.object_normal {
            image[at] = self.conversion.vector(narrow(texel.object_normal));
        }
        if let Some(image) = &mut band.height {
            image[at] = self.space.restored(texel.height) as f32;
        }
        if let Some(image) = &mut band.occlusion {
            image[at] = texel.occlusion as f32;
        }
        if let Some(image) = &mut band.position {
            let position = texel.position.map(|x| self.space.restored(x));
            image[at] = self.conversion.vector(narrow(position));
        }
    }
}

fn count(sums: &TexelSums, report: &mut BakeReport) {
    let is_missed = sums.state().is_missed();
    report.texels += 1;
    report.charted_texels += u64::from(sums.is_charted);
    report.missed_texels += u64::from(is_missed);
    report.back_facing_texels += u64::from(is_missed && sums.hits_back);
    report.overlapping_texels += u64::from(sums.is_overlapped);
    report.inverted_texels += u64::from(sums.is_inverted);
    report.frameless_texels += u64::from(sums.is_frameless);
}

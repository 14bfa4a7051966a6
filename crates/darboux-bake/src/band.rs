//! Stages 2 to 6 for a band of the image: coverage, rays, hits, frames, texels.

use crate::bvh::{Hit, PreparedRay, Shaft, Sides, Stack};
use crate::charts::Charts;
use crate::coverage::{Coverage, TEXELS};
use crate::face::{Face, Faces};
use crate::found::{Found, LowRay, LowSample};
use crate::frame::ShadingFrame;
use crate::high::HighGroup;
use crate::images::Band;
use crate::layout::{BLOCK, Layout};
use crate::maps::{MapList, Units};
use crate::point::SurfacePoint;
use crate::rays::{point_at, ray_of};
use crate::samples::STEPS;
use crate::texel::TexelSums;
use crate::vector::{Vector, scale};
use crate::{BakeOptions, BakeReport, LowSurface};

/// What all bands share.
pub struct Bake<'a> {
    pub low: &'a [LowSurface<'a>],
    pub groups: &'a [HighGroup<'a>],
    pub layout: &'a Layout,
    pub options: &'a BakeOptions,
    pub maps: MapList,
    /// The charts of the low surfaces; empty unless a map shows them.
    pub charts: Charts,
    /// What heights, positions and directions become.
    pub units: Units,
    /// The places of samples within a texel.
    pub samples: Vec<[i64; 2]>,
}

/// The memory of one band.
pub struct Scratch<'a> {
    pub coverage: Coverage,
    pub faces: Faces<'a>,
    pub sums: Vec<TexelSums>,
    /// The numbers of all maps, texel after texel.
    pub numbers: Vec<f64>,
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
    low: LowRay,
    prepared: PreparedRay,
    group: usize,
}

impl<'a> Bake<'a> {
    /// Bakes a band; returns the counts of its texels.
    pub fn band(&self, band: &mut Band<'_>) -> BakeReport {
        let mut scratch = Scratch {
            coverage: Coverage::new(),
            faces: Faces::new(),
            sums: vec![TexelSums::default(); TEXELS],
            numbers: vec![0.0; TEXELS * self.maps.len],
            stack: Stack::new(),
            rays: 0,
            rays_of_tile: Vec::with_capacity(TILE * TILE),
        };
        let mut report = BakeReport::default();
        for column in 0..self.layout.blocks_per_row() {
            scratch.sums.fill(TexelSums::default());
            scratch.numbers.fill(0.0);
            let mut gutter = None;
            for &sample in &self.samples {
                self.cover([column, band.row / BLOCK], sample, &mut scratch.coverage);
                self.sample([column * BLOCK, band.row], sample, &mut scratch);
                self.sample_gutter([column, band.row / BLOCK], sample, &mut gutter, &mut scratch);
            }
            self.store(column * BLOCK, &scratch, band, &mut report);
        }
        report.rays = scratch.rays;
        report
    }

    /// Stage 2: finds the triangle of every sample of a block.
    fn cover(&self, [column, row]: [usize; 2], sample: [i64; 2], coverage: &mut Coverage) {
        coverage.clear();
        for triangle in self.layout.block(column, row) {
            let low = &self.low[triangle.surface as usize];
            coverage.add(*triangle, self.layout.steps_in_block(low, triangle, [column, row]), sample);
        }
    }

    /// Stages 3 to 5: follows the rays of a block's samples, tile by tile.
    fn sample(&self, first: [usize; 2], sample: [i64; 2], scratch: &mut Scratch<'a>) {
        for tile in 0..TILES * TILES {
            let from = [tile % TILES * TILE, tile / TILES * TILE];
            self.find_rays(first, from, sample, scratch);
            self.follow_rays(first, sample, scratch);
        }
    }

    /// Stage 3: the rays of the samples of a tile. `first`: the upper left texel of the block; `from`: that
    /// of the tile in the block.
    fn find_rays(&self, first: [usize; 2], from: [usize; 2], sample: [i64; 2], scratch: &mut Scratch<'a>) {
        let Scratch { coverage, faces, sums, numbers, rays, rays_of_tile, .. } = scratch;
        rays_of_tile.clear();
        for at_tile in 0..TILE * TILE {
            let in_block = [from[0] + at_tile % TILE, from[1] + at_tile / TILE];
            let texel = in_block[1] * BLOCK + in_block[0];
            let Some(triangle) = coverage.owners[texel] else { continue };
            let face = faces.get(self.layout, self.low, triangle);
            let sums = &mut sums[texel];
            sums.charted += 1;
            sums.is_overlapped |= coverage.overlaps[texel];
            let place = [0, 1].map(|i| (first[i] + in_block[i]) as f64 + sample[i] as f64 / STEPS as f64);
            let point = face.point(place);
            if self.maps.has_low() {
                let sample =
                    LowSample { face, point: &point, place, charts: &self.charts, options: self.options };
                self.add_low(&sample, texel, numbers);
            }
            let Some(low) = self.low_ray(face, &point) else { continue };
            let prepared = self.groups[face.group].bvh.prepare(&low.ray.ray);
            rays_of_tile.push(TexelRay { texel, low, prepared, group: face.group });
        }
        *rays += rays_of_tile.len() as u64;
    }

    /// Stages 4 and 5: the hits of a tile's rays. All rays begin at the cut of their shaft.
    fn follow_rays(&self, first: [usize; 2], sample: [i64; 2], scratch: &mut Scratch<'a>) {
        let Scratch { rays_of_tile, sums, numbers, stack, .. } = scratch;
        for rays in rays_of_tile.chunk_by(|a, b| a.group == b.group) {
            let group = &self.groups[rays[0].group];
            let Some(shaft) = Shaft::of(rays.iter().map(|ray| &ray.prepared)) else { continue };
            let cut = group.bvh.cut(&shaft);
            let sides = if self.options.back_faces { Sides::Both } else { Sides::Front };
            for ray in rays {
                let (sums, prepared) = (&mut sums[ray.texel], &ray.prepared);
                match group.bvh.nearest_of_cut(&cut, prepared, sides, stack) {
                    Some(hit) => {
                        let at = [first[0] + ray.texel % BLOCK, first[1] + ray.texel / BLOCK];
                        if let Some(found) = self.found(group, &ray.low, &hit, self.seed(at, sample)) {
                            sums.add(&found.sample(false));
                            self.add_high(&found, ray.texel, numbers, stack);
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

    /// The ray of a sample at a point of a triangle; none where nothing gives a direction.
    pub fn low_ray(&self, face: &Face<'_>, point: &SurfacePoint) -> Option<LowRay> {
        Some(LowRay {
            ray: ray_of(point, self.options.distance)?,
            position: point.position,
            frame: ShadingFrame::new(point, self.options.bitangent),
            sides: self.sides_of_sample(face),
        })
    }

    /// The sides of a sample's area on a triangle; zeros where no map needs them.
    fn sides_of_sample(&self, face: &Face<'_>) -> [Vector; 2] {
        if !self.maps.needs_sides {
            return [[0.0; 3]; 2];
        }
        let share = 1.0 / f64::from(self.options.samples_per_axis);
        face.sides_of_texel().map(|side| scale(share, side))
    }

    /// What a ray has found; `None` where the high triangle has no area.
    pub fn found<'f>(
        &'f self,
        group: &'f HighGroup<'f>,
        low: &'f LowRay,
        hit: &'f Hit,
        seed: u64,
    ) -> Option<Found<'f>> {
        let high = group.point(hit)?;
        Some(Found {
            low,
            group,
            hit,
            high,
            position: point_at(&low.ray.ray, hit.distance),
            height: low.ray.surface - f64::from(hit.distance),
            normal: low.frame.to_tangent_space(high.normal),
            options: self.options,
            seed,
        })
    }

    /// Adds what the maps of the high surfaces show at a hit to a texel of a block.
    pub fn add_high(&self, found: &Found<'_>, texel: usize, numbers: &mut [f64], stack: &mut Stack) {
        self.maps.add_high(found, stack, &mut numbers[self.maps.len * texel..][..self.maps.len]);
    }

    /// Adds what the maps of the low surface show at a sample to a texel of a block.
    pub fn add_low(&self, sample: &LowSample<'_>, texel: usize, numbers: &mut [f64]) {
        self.maps.add_low(sample, &mut numbers[self.maps.len * texel..][..self.maps.len]);
    }

    /// Stage 6: stores the texels of a block.
    fn store(&self, first: usize, scratch: &Scratch<'_>, band: &mut Band<'_>, report: &mut BakeReport) {
        let width = self.layout.size[0];
        let rows = band.states.len() / width;
        for row in 0..rows.min(BLOCK) {
            for column in first..width.min(first + BLOCK) {
                let in_block = row * BLOCK + column - first;
                let sums = &scratch.sums[in_block];
                let numbers = &scratch.numbers[self.maps.len * in_block..][..self.maps.len];
                let at = row * width + column;
                band.states[at] = sums.state();
                count(sums, report);
                self.maps.resolve(numbers, sums.shares(), at, &mut band.images, &self.units);
            }
        }
    }
}

fn count(sums: &TexelSums, report: &mut BakeReport) {
    let state = sums.state();
    report.texels += 1;
    report.charted_texels += u64::from(sums.charted > 0);
    report.missed_texels += u64::from(state.is_missed());
    report.back_facing_texels += u64::from(state.is_missed() && sums.hits_back);
    report.overlapping_texels += u64::from(sums.is_overlapped);
    report.inverted_texels += u64::from(sums.is_inverted);
    report.frameless_texels += u64::from(sums.is_frameless);
    report.below_horizon_texels += u64::from(state.has_content() && sums.is_below_horizon());
}

//! The points of a verification and their errors.

use super::places::{Mistake, VerifiedPlace};
use crate::bvh::{Sides, Stack};
use crate::coverage::{Coverage, Open, TEXELS};
use crate::face::Face;
use crate::frame::ShadingFrame;
use crate::high::HighGroup;
use crate::images::TexelState;
use crate::layout::{BLOCK, Layout, TileTriangle};
use crate::maps::turn_of;
use crate::normal_texture::filter_texels;
use crate::point::SurfacePoint;
use crate::rays::ray_of;
use crate::samples::STEPS;
use crate::vector::{Place, Vector, cross, dot, length};
use crate::{BakeOptions, Bitangent, LowSurface, NormalTexture};

/// The largest side of the picture of errors; of larger maps one texel in each cell is compared.
const MAX_HEAT_SIDE: usize = 2048;

/// The most points that are expected. Where charts cover the image more often than twice at its largest side,
/// as with repeated textures, one texel in larger cells is compared.
const MAX_POINTS: f64 = (2 * MAX_HEAT_SIDE * MAX_HEAT_SIDE) as f64;

/// The most triangles that are compared at a texel: the first ones, in the order of surfaces and triangles.
/// Trim sheets and tiled parts may lie over each other by the thousand.
const MAX_TRIANGLES_PER_TEXEL: u8 = 64;

/// What all bands share.
pub struct Points<'a> {
    pub low: &'a [LowSurface<'a>],
    pub groups: &'a [HighGroup<'a>],
    pub layout: &'a Layout,
    pub options: &'a BakeOptions,
    pub states: &'a [TexelState],
    pub written: &'a NormalTexture,
    pub unrounded: &'a NormalTexture,
    /// Texels per side of a cell, in which one texel is compared.
    pub cell_side: usize,
}

/// The least side of cells, in texels, with which the picture of errors has no more than [`MAX_HEAT_SIDE`]
/// rows and columns, and about [`MAX_POINTS`] points at most are compared.
pub fn cell_side(layout: &Layout, low: &[LowSurface<'_>]) -> usize {
    let by_picture = layout.size[0].max(layout.size[1]).div_ceil(MAX_HEAT_SIDE);
    let by_points = (layout.charted_area(low) / MAX_POINTS).sqrt().ceil();
    by_picture.max(by_points as usize)
}

/// The errors at a point, in degrees.
#[derive(Clone, Copy, Debug)]
pub struct PointErrors {
    pub place: VerifiedPlace,
    /// The low surface.
    pub surface: u32,
    /// The cell in the picture of errors.
    pub cell: u32,
    pub shown: f32,
    pub rounding: f32,
    /// In the order of [`Mistake::ALL`].
    pub mistakes: [f32; Mistake::ALL.len()],
}

/// The most bytes that an error takes: lists grow by doubling, and one statistic at a time has a list of its
/// own.
pub const BYTES_PER_POINT: u64 = 2 * size_of::<PointErrors>() as u64 + 8;

/// The points of a row of blocks.
#[derive(Debug, Default)]
pub struct BandPoints {
    pub points: Vec<PointErrors>,
    pub without_hit: u64,
    pub without_frame: u64,
}

impl Points<'_> {
    /// The number of rows of blocks.
    pub fn band_count(&self) -> usize {
        self.layout.size[1].div_ceil(BLOCK)
    }

    /// The cells per row, and their rows.
    pub fn heat_size(&self) -> [u32; 2] {
        self.layout.size.map(|side| side.div_ceil(self.cell_side) as u32)
    }

    /// Compares the points of a row of blocks.
    pub fn band(&self, row: usize) -> BandPoints {
        let mut band = BandPoints::default();
        let mut stack = Stack::new();
        let mut coverage = Coverage::new();
        for column in 0..self.layout.blocks_per_row() {
            let random = |i: u64| turn_of(3 * (row * self.layout.blocks_per_row() + column) as u64 + i);
            let sample = [0, 1].map(|i| (random(i) * STEPS as f64) as i64);
            let side = self.cell_side;
            let of_cell = (random(2) * (side * side) as f64) as usize;
            coverage.clear();
            for triangle in self.layout.block(column, row) {
                let low = &self.low[triangle.surface as usize];
                coverage.add(*triangle, self.layout.steps_in_block(low, triangle, [column, row]), sample);
            }
            let (mut open, mut compared) = (Open::ALL, [0; TEXELS]);
            for triangle in self.layout.block(column, row) {
                let low = &self.low[triangle.surface as usize];
                let mut face = None;
                open.visit_covered(
                    self.layout.steps_in_block(low, triangle, [column, row]),
                    sample,
                    |texel| {
                        let [x, y] = [column * BLOCK + texel % BLOCK, row * BLOCK + texel / BLOCK];
                        let is_chosen = y % side * side + x % side == of_cell;
                        if !is_chosen || x >= self.layout.size[0] || y >= self.layout.size[1] {
                            return true;
                        }
                        let face = face.get_or_insert_with(|| Face::new(self.layout, self.low, *triangle));
                        let place = [0, 1].map(|i| [x, y][i] as f64 + sample[i] as f64 / STEPS as f64);
                        let owner = coverage.owners[texel.min(TEXELS - 1)];
                        self.compare(face, place, owner, &mut stack, &mut band);
                        compared[texel] += 1;
                        compared[texel] == MAX_TRIANGLES_PER_TEXEL
                    },
                );
            }
        }
        band
    }

    fn compare(
        &self,
        face: &Face<'_>,
        place: Place,
        owner: Option<TileTriangle>,
        stack: &mut Stack,
        band: &mut BandPoints,
    ) {
        let point = face.point(place);
        let Some(truth) = self.truth(face, &point, stack) else {
            band.without_hit += 1;
            return;
        };
        let bitangent = self.options.bitangent;
        let frame = ShadingFrame::new(&point, bitangent);
        let texel = self.written.at_place(place);
        let (shown, unrounded) = (frame.shade(texel), frame.shade(self.unrounded.at_place(place)));
        let (Some(shown), Some(unrounded), Some(_)) = (shown, unrounded, frame.to_tangent_space(truth))
        else {
            band.without_frame += 1;
            return;
        };
        let error = |shown: Option<Vector>| shown.map_or(180.0, |shown| degrees(shown, truth));
        band.points.push(PointErrors {
            place: self.kind(place, owner == Some(face.triangle)),
            surface: face.triangle.surface,
            cell: self.cell(place),
            shown: degrees(shown, truth),
            rounding: degrees(shown, unrounded),
            mistakes: Mistake::ALL.map(|mistake| error(shown_with(mistake, &point, bitangent, texel))),
        });
    }

    /// The normal of the high surfaces at a point.
    fn truth(&self, face: &Face<'_>, point: &SurfacePoint, stack: &mut Stack) -> Option<Vector> {
        let ray = ray_of(point, self.options.distance)?;
        let group = &self.groups[face.group];
        let sides = if self.options.back_faces { Sides::Both } else { Sides::Front };
        let hit = group.bvh.nearest(&ray.ray, sides, stack)?;
        Some(group.point(&hit)?.normal)
    }

    fn kind(&self, place: Place, is_owner: bool) -> VerifiedPlace {
        let states = filter_texels(place, self.layout.size).map(|texel| self.states[texel]);
        if !is_owner {
            VerifiedPlace::Overlap
        } else if states.iter().any(|state| state.is_missed()) {
            VerifiedPlace::Missed
        } else if states.iter().any(|&state| state != TexelState::Baked) {
            VerifiedPlace::Border
        } else {
            VerifiedPlace::Inside
        }
    }

    fn cell(&self, place: Place) -> u32 {
        let [x, y] = place.map(|x| x as usize / self.cell_side);
        (y * self.heat_size()[0] as usize + x) as u32
    }
}

/// What a renderer with a mistake shows.
fn shown_with(
    mistake: Mistake,
    point: &SurfacePoint,
    bitangent: Bitangent,
    [x, y, z]: Vector,
) -> Option<Vector> {
    let other = match bitangent {
        Bitangent::PerPixel => Bitangent::PerVertex,
        Bitangent::PerVertex => Bitangent::PerPixel,
    };
    match mistake {
        Mistake::OtherBitangent => ShadingFrame::new(point, other).shade([x, y, z]),
        Mistake::OtherGreen => ShadingFrame::new(point, bitangent).shade([x, -y, z]),
        Mistake::NormalisedFrame => ShadingFrame::normalised(point)?.shade([x, y, z]),
    }
}

/// The angle between two unit vectors in degrees, exact also for small angles.
fn degrees(a: Vector, b: Vector) -> f32 {
    length(cross(a, b)).atan2(dot(a, b)).to_degrees() as f32
}

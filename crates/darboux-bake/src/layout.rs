//! Stage 1: where the triangles of the low surfaces lie in the image, and which triangles each block of
//! texels needs.

use std::collections::BTreeSet;

use darboux::{Convention, UvOrigin};

use crate::budget::Budget;
use crate::samples::STEPS;
use crate::udim::Udim;
use crate::{BakeError, LowSurface};

/// Texels per side of a block.
pub const BLOCK: usize = 32;

/// The most tiles of the UV plane that a triangle may touch along an axis. Places in steps then stay below
/// 2^27, and their products below 2^55.
const MAX_TILES: i64 = 16;

/// The distance in texels up to which a block's list has triangles outside it.
const MARGIN: f64 = 2.0;

/// A triangle of a low surface in one tile of the UV plane. Triangles in other tiles than the first are moved
/// into it, as a repeated texture shows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileTriangle {
    pub surface: u32,
    pub index: u32,
    /// The tile, whose upper left corner becomes that of the image.
    pub tile: [i32; 2],
}

/// Why a triangle has no place in the image.
enum LeftOut {
    /// It has no area, or its UVs are not finite.
    Degenerate,
    /// Its positions or normals are not finite.
    NonFinite,
    /// It touches too many tiles, or lies too far away.
    Oversized,
    /// It does not touch the tile that is baked.
    Elsewhere,
}

/// The triangles of every block of the image.
#[derive(Debug)]
pub struct Layout {
    pub size: [usize; 2],
    uv_origin: UvOrigin,
    /// The only tile that is baked; none where all are.
    only: Option<[i32; 2]>,
    triangles: Vec<TileTriangle>,
    /// Where the list of each block begins in `lists`, and the end of the last one.
    starts: Vec<u64>,
    /// The indices into `triangles`, in the order of surfaces and triangles.
    lists: Vec<u32>,
    pub degenerate: usize,
    pub oversized: usize,
    pub non_finite: usize,
}

impl Layout {
    /// Lays out all triangles, or the triangles of a tile. Triangles without an area, not finite or across
    /// too many tiles are left out and counted.
    ///
    /// `budget`: the lists of the layout are added to it. Errors: they exceed it.
    pub fn new(
        low: &[LowSurface<'_>],
        [width, height]: [u32; 2],
        convention: Convention,
        udim: Option<Udim>,
        budget: &mut Budget,
    ) -> Result<Self, BakeError> {
        let mut layout = Self {
            size: [width as usize, height as usize],
            uv_origin: convention.uv_origin,
            only: udim.map(Udim::tile),
            triangles: Vec::new(),
            starts: Vec::new(),
            lists: Vec::new(),
            degenerate: 0,
            oversized: 0,
            non_finite: 0,
        };
        layout.add_all(low, budget)?;
        layout.fill_blocks(low, budget)?;
        Ok(layout)
    }

    /// Adds every triangle once for each of its tiles, and counts those that are left out.
    fn add_all(&mut self, low: &[LowSurface<'_>], budget: &mut Budget) -> Result<(), BakeError> {
        let mut count = 0;
        for triangle in triangles(low) {
            match self.tiles(low, triangle) {
                Ok([first, last]) => {
                    count += (0..2).map(|i| (last[i] - first[i] + 1) as u64).product::<u64>()
                }
                Err(LeftOut::Degenerate) => self.degenerate += 1,
                Err(LeftOut::Oversized) => self.oversized += 1,
                Err(LeftOut::NonFinite) => self.non_finite += 1,
                Err(LeftOut::Elsewhere) => {}
            }
        }
        budget.add(count * size_of::<TileTriangle>() as u64)?;
        let mut list = Vec::with_capacity(count as usize);
        for triangle in triangles(low) {
            let Ok([first, last]) = self.tiles(low, triangle) else { continue };
            let tiles = (first[1]..=last[1]).flat_map(|y| (first[0]..=last[0]).map(move |x| [x, y]));
            list.extend(tiles.map(|tile| TileTriangle { tile, ..triangle }));
        }
        self.triangles = list;
        Ok(())
    }

    /// The first and the last tile, by column and row, that the bounding box of a triangle touches.
    fn tiles(&self, low: &[LowSurface<'_>], triangle: TileTriangle) -> Result<[[i32; 2]; 2], LeftOut> {
        let low = &low[triangle.surface as usize];
        if !is_finite(low, triangle.index) {
            return Err(LeftOut::NonFinite);
        }
        let texels = self.texels(low, &triangle);
        if !texels.as_flattened().iter().all(|x| x.is_finite()) {
            return Err(LeftOut::Degenerate);
        }
        let [from, to] = bounds(texels);
        let first = [0, 1].map(|i| (from[i] / self.size[i] as f64).floor());
        // A triangle that ends at the border of a tile does not touch the next one.
        let last = [0, 1].map(|i| ((to[i] / self.size[i] as f64).ceil() - 1.0).max(first[i]));
        let is_near = |x: &f64| x.abs() < f64::from(1 << 24);
        if !first.iter().chain(&last).all(is_near) || (0..2).any(|i| last[i] - first[i] >= MAX_TILES as f64) {
            return Err(LeftOut::Oversized);
        }
        let at_first = TileTriangle { tile: first.map(|x| x as i32), ..triangle };
        if area(steps(self.texels(low, &at_first))) == 0 {
            return Err(LeftOut::Degenerate);
        }
        let [first, last] = [first, last].map(|tile| tile.map(|x| x as i32));
        match self.only {
            None => Ok([first, last]),
            Some(tile) if (0..2).all(|i| (first[i]..=last[i]).contains(&tile[i])) => Ok([tile; 2]),
            Some(_) => Err(LeftOut::Elsewhere),
        }
    }

    /// The corners of a triangle in texels from the upper left corner of the image.
    pub fn texels(&self, low: &LowSurface<'_>, triangle: &TileTriangle) -> [[f64; 2]; 3] {
        let size = self.size.map(|side| side as f64);
        [0, 1, 2].map(|corner| {
            let vertex = low.mesh.vertex_of_corner(3 * triangle.index as usize + corner);
            let [u, v] = low.mesh.uvs().get(vertex).map(f64::from);
            let v = if self.uv_origin == UvOrigin::BottomLeft { 1.0 - v } else { v };
            [0, 1].map(|i| ([u, v][i] - f64::from(triangle.tile[i])) * size[i])
        })
    }

    /// The corners of a triangle in steps from the upper left corner of a block, given by its column and row.
    pub fn steps_in_block(
        &self,
        low: &LowSurface<'_>,
        triangle: &TileTriangle,
        block: [usize; 2],
    ) -> [[i64; 2]; 3] {
        let first = block.map(|at| (at * BLOCK) as i64 * STEPS);
        steps(self.texels(low, triangle)).map(|corner| [corner[0] - first[0], corner[1] - first[1]])
    }

    /// Sorts the triangles into blocks: counts, starts, lists.
    fn fill_blocks(&mut self, low: &[LowSurface<'_>], budget: &mut Budget) -> Result<(), BakeError> {
        let mut counts = vec![0u64; self.block_count() + 1];
        for triangle in &self.triangles {
            self.visit_blocks(&low[triangle.surface as usize], triangle, |block| counts[block] += 1);
        }
        let mut sum = 0;
        for count in &mut counts {
            sum += std::mem::replace(count, sum);
        }
        budget.add(4 * sum)?;
        let mut lists = vec![0; sum as usize];
        let mut ends = counts.clone();
        for (index, triangle) in self.triangles.iter().enumerate() {
            self.visit_blocks(&low[triangle.surface as usize], triangle, |block| {
                lists[ends[block] as usize] = index as u32;
                ends[block] += 1;
            });
        }
        (self.starts, self.lists) = (counts, lists);
        Ok(())
    }

    /// Visits the blocks that the bounding box of a triangle touches, with a margin for texels near charts.
    fn visit_blocks(&self, low: &LowSurface<'_>, triangle: &TileTriangle, mut visit: impl FnMut(usize)) {
        let [from, to] = bounds(self.texels(low, triangle));
        let range = |i: usize| {
            let last = self.size[i] - 1;
            let texel = |x: f64| (x.max(0.0) as usize).min(last);
            texel(from[i].floor() - MARGIN) / BLOCK..texel(to[i].ceil() + MARGIN) / BLOCK + 1
        };
        for y in range(1) {
            for x in range(0) {
                visit(y * self.blocks_per_row() + x);
            }
        }
    }

    /// The area of all triangles in square texels, in all their tiles: the number of pairs of a texel and a
    /// triangle that covers it, on average.
    pub fn charted_area(&self, low: &[LowSurface<'_>]) -> f64 {
        let is_first =
            |pair: &[TileTriangle]| (pair[0].surface, pair[0].index) != (pair[1].surface, pair[1].index);
        let firsts = self.triangles.first().into_iter();
        let firsts =
            firsts.chain(self.triangles.windows(2).filter(|pair| is_first(pair)).map(|pair| &pair[1]));
        let twice_in_steps = firsts.map(|triangle| {
            area(steps(self.texels(&low[triangle.surface as usize], triangle))).unsigned_abs() as f64
        });
        twice_in_steps.sum::<f64>() / (2 * STEPS * STEPS) as f64
    }

    /// The tiles that triangles cover, where all tiles are baked.
    pub fn covered_tiles(&self, low: &[LowSurface<'_>]) -> BTreeSet<[i32; 2]> {
        let mut tiles = BTreeSet::new();
        for triangle in &self.triangles {
            if !tiles.contains(&triangle.tile) && self.covers_image(&low[triangle.surface as usize], triangle)
            {
                tiles.insert(triangle.tile);
            }
        }
        tiles
    }

    /// Whether a triangle has an area in the image: no line along one of its edges separates both.
    fn covers_image(&self, low: &LowSurface<'_>, triangle: &TileTriangle) -> bool {
        let corners = self.texels(low, triangle);
        let [from, to] = bounds(corners);
        let [width, height] = self.size.map(|side| side as f64);
        let image = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
        let is_near = from[0] < width && from[1] < height && to[0] > 0.0 && to[1] > 0.0;
        is_near
            && (0..3).all(|i| {
                let [from, to, opposite] = [0, 1, 2].map(|next| corners[(i + next) % 3]);
                let side = |at: [f64; 2]| {
                    (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0])
                };
                image.iter().any(|&corner| side(corner) * side(opposite) > 0.0)
            })
    }

    pub fn blocks_per_row(&self) -> usize {
        self.size[0].div_ceil(BLOCK)
    }

    fn block_count(&self) -> usize {
        self.blocks_per_row() * self.size[1].div_ceil(BLOCK)
    }

    /// The triangles of a block, in the order of surfaces and triangles. Some may not cover any of its
    /// texels.
    pub fn block(&self, column: usize, row: usize) -> impl Iterator<Item = &TileTriangle> {
        let block = row * self.blocks_per_row() + column;
        let range = self.starts[block] as usize..self.starts[block + 1] as usize;
        self.lists[range].iter().map(|&index| &self.triangles[index as usize])
    }
}

/// All triangles, each in the first tile.
fn triangles(low: &[LowSurface<'_>]) -> impl Iterator<Item = TileTriangle> {
    low.iter().enumerate().flat_map(|(surface, low)| {
        let in_first_tile =
            move |index| TileTriangle { surface: surface as u32, index: index as u32, tile: [0; 2] };
        (0..low.triangle_count()).map(in_first_tile)
    })
}

/// True where the positions and normals of a triangle's corners are finite.
fn is_finite(low: &LowSurface<'_>, triangle: u32) -> bool {
    (0..3).map(|corner| low.mesh.vertex_of_corner(3 * triangle as usize + corner)).all(|vertex| {
        let (position, normal) = (low.mesh.positions().get(vertex), low.mesh.normals().get(vertex));
        position.iter().chain(&normal).all(|x| x.is_finite())
    })
}

/// The corners in steps: multiples of 1 / [`STEPS`] texel.
pub fn steps(texels: [[f64; 2]; 3]) -> [[i64; 2]; 3] {
    texels.map(|corner| corner.map(|x| (x * STEPS as f64).round() as i64))
}

/// Twice the area, positive where the corners turn from x to y.
pub fn area([a, b, c]: [[i64; 2]; 3]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The least and the greatest coordinates.
fn bounds([a, b, c]: [[f64; 2]; 3]) -> [[f64; 2]; 2] {
    [[0, 1].map(|i| a[i].min(b[i]).min(c[i])), [0, 1].map(|i| a[i].max(b[i]).max(c[i]))]
}

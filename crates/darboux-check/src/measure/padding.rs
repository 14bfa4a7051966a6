//! What the texels beside charts do to the borders of the charts in smaller mip levels.
//!
//! A texel of a mip level is the mean of a block of texels. A block at the border of a chart also has texels
//! of the background or of another chart. Where a baker went on with the chart's own normals there, the
//! padding, both means agree; where the background has a colour that is no normal, as black, the border is
//! lit from another side. So the mean over the chart's texels in such blocks is compared with that over all.
//!
//! Detail differs within a block, too: the same masks on blocks inside of charts say how much. Measured on
//! real maps: borders with a flat background lean no more than padded ones, and charts that are cut through a
//! bevel by up to 35 degrees.

use darboux_io::image::RgbaImage;

use crate::measure::facet::MapUse;
use crate::measure::values::median;
use crate::model_area::area_of;
use crate::surface::{Surface, uv_area};

/// Borders that are lit wrongly in a mip level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Padding {
    /// The texels along the side of a block, at the level that renderers take at [`Padding::PIXELS`].
    pub wanted: usize,
    /// The smallest side of blocks whose borders are wrong: there are fewer texels of padding.
    pub fewer_than: usize,
    /// How far the borders lean, and the same masks inside of charts: the medians, in degrees.
    pub degrees: f64,
    pub inside: f64,
}

/// From how many degrees on a background is no normal, and how many times what detail makes that has to be.
const SEEN: f64 = 40.0;
const OVER_DETAIL: f64 = 2.5;

/// More texels are not looked at: of larger maps, every second one along both axes, or fewer.
const MOST_SAMPLES: usize = 1 << 20;

/// More texels are not filled: charts that lie on each other so often share their texels on purpose.
const MOST_FILLED: usize = 1 << 23;

/// The blocks with borders that decide.
const MIN_BLOCKS: usize = 64;

/// Blocks of more texels mix what no padding can hold apart.
const MOST_LEVEL: u32 = 5;

impl Padding {
    /// How large the surfaces with the map are on the screen: a quarter of the height of 1920 x 1080 pixels.
    pub const PIXELS: f64 = 270.0;

    /// None where borders are right, and for maps that tile.
    pub fn of(uses: &[MapUse<'_>], image: &RgbaImage) -> Option<Self> {
        let charts = Charts::of(uses, image)?;
        let level = (charts.across / Self::PIXELS).log2().round().clamp(1.0, f64::from(MOST_LEVEL)) as u32;
        let level = level.max(charts.stride.ilog2() + 1);
        let lean = charts.lean(level, image).filter(Lean::is_seen)?;
        let is_wrong = |level: &u32| charts.lean(*level, image).is_some_and(|lean| lean.is_seen());
        let wrong = (charts.stride.ilog2() + 1..level).find(is_wrong).unwrap_or(level);
        Some(Self { wanted: 1 << level, fewer_than: 1 << wrong, degrees: lean.border, inside: lean.inside })
    }
}

/// The medians of what the means of blocks lean, in degrees.
struct Lean {
    border: f64,
    inside: f64,
}

impl Lean {
    fn is_seen(&self) -> bool {
        self.border >= SEEN && self.border >= OVER_DETAIL * self.inside
    }
}

/// The charts of a map.
struct Charts {
    /// The distance of samples in texels, a power of two.
    stride: usize,
    /// The samples along both axes.
    size: [usize; 2],
    /// The chart of every sample by number, from 1 on; 0 for the background.
    of_sample: Vec<u32>,
    /// The texels along the largest extent of the surfaces.
    across: f64,
}

impl Charts {
    /// None for UVs outside of the image, which tile, or without an area.
    fn of(uses: &[MapUse<'_>], image: &RgbaImage) -> Option<Self> {
        let texels = [image.width as usize, image.height as usize];
        let mut stride = 1;
        while texels[0] / stride * (texels[1] / stride) > MOST_SAMPLES {
            stride *= 2;
        }
        let size = texels.map(|side| side / stride);
        let mut charts = Self { stride, size, of_sample: vec![0; size[0] * size[1]], across: 0.0 };
        let (mut first, mut filled) = (1, 0);
        let (mut area, mut in_uvs, mut extent) = (0.0, 0.0, 0.0f64);
        for (surface, texture) in uses {
            let uv_set = texture.map_or(surface.uv_set, |texture| texture.uv_set);
            let stored = surface.uv_sets.get(&uv_set)?;
            let uvs: Vec<[f32; 2]> = match texture {
                Some(texture) => stored.iter().map(|uv| texture.transform_uv(*uv)).collect(),
                None => stored.to_vec(),
            };
            let is_inside = |uv: &[f32; 2]| uv.iter().all(|x| (-0.01..=1.01).contains(x));
            if !surface.vertex_of_corner.iter().all(|&vertex| is_inside(&uvs[vertex as usize])) {
                return None;
            }
            let parts = surface.parts(|vertex| uvs[vertex].map(|x| (x + 0.0).to_bits()));
            for triangle in surface.triangles() {
                area += area_of(triangle.map(|vertex| surface.positions[vertex]));
                in_uvs += uv_area(&uvs, triangle).abs() / 2.0;
                let corners = triangle
                    .map(|vertex| [0, 1].map(|axis| f64::from(uvs[vertex][axis]) * size[axis] as f64 - 0.5));
                filled += charts.fill(corners, first + parts[triangle[0]]);
                if filled > MOST_FILLED {
                    return None;
                }
            }
            first += parts.len() as u32;
            extent = extent.max(extent_of(surface));
        }
        charts.across = extent * (in_uvs * (texels[0] * texels[1]) as f64 / area).sqrt();
        charts.across.is_finite().then_some(charts)
    }

    /// Gives the samples in a triangle to a chart, and returns the rows and samples that were visited.
    fn fill(&mut self, corners: [[f64; 2]; 3], chart: u32) -> usize {
        let [width, height] = self.size;
        let rows = corners.map(|[_, y]| y);
        let (low, high) = bounds(rows);
        let mut visited = 0;
        for row in low.ceil().max(0.0) as usize..((high.floor() + 1.0).max(0.0) as usize).min(height) {
            let y = row as f64;
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let ([xa, ya], [xb, yb]) = (corners[a], corners[b]);
                if (ya.min(yb)..=ya.max(yb)).contains(&y) {
                    let at = if ya == yb { [xa, xb] } else { [xa + (y - ya) / (yb - ya) * (xb - xa); 2] };
                    (left, right) = (left.min(at[0].min(at[1])), right.max(at[0].max(at[1])));
                }
            }
            let first = left.ceil().max(0.0) as usize;
            let end = ((right.floor() + 1.0).max(0.0) as usize).min(width);
            if first < end {
                self.of_sample[row * width + first..row * width + end].fill(chart);
            }
            visited += 1 + end.saturating_sub(first);
        }
        visited
    }

    /// What the borders of charts lean at a mip level; none where too few blocks have borders.
    fn lean(&self, level: u32, image: &RgbaImage) -> Option<Lean> {
        let side = (1usize << level) / self.stride;
        let [width, height] = self.size.map(|samples| samples / side);
        let (mut border, mut inside) = (Vec::new(), Vec::new());
        let mut last_inside = None;
        let mut mask = vec![false; side * side];
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            let block = [column * side, row * side];
            let chart_at =
                |i: usize| self.of_sample[(block[1] + i / side) * self.size[0] + block[0] + i % side];
            let first = chart_at(0);
            if (1..side * side).all(|i| chart_at(i) == first) {
                last_inside = if first == 0 { last_inside } else { Some(block) };
                continue;
            }
            let own = (0..side * side).map(chart_at).max()?;
            (0..side * side).for_each(|i| mask[i] = chart_at(i) == own);
            // A corner of a chart hardly shows.
            if 4 * mask.iter().filter(|is_own| **is_own).count() < side * side {
                continue;
            }
            if let Some(other) = last_inside {
                border.extend(self.angle(image, block, side, &mask));
                inside.extend(self.angle(image, other, side, &mask));
            }
        }
        if border.len() < MIN_BLOCKS || inside.len() < MIN_BLOCKS {
            return None;
        }
        Some(Lean { border: median(&mut border), inside: median(&mut inside) })
    }

    /// The angle between the mean vector of a block and that of the samples of a mask, in degrees.
    fn angle(&self, image: &RgbaImage, [left, top]: [usize; 2], side: usize, mask: &[bool]) -> Option<f64> {
        let (mut own, mut all) = ([0i64; 3], [0i64; 3]);
        for (i, is_own) in mask.iter().enumerate() {
            let [x, y] = [left + i % side, top + i / side].map(|place| place * self.stride);
            let texel = image.texels[y * image.width as usize + x];
            for channel in 0..3 {
                let value = 2 * i64::from(texel[channel]) - 255;
                all[channel] += value;
                own[channel] += if *is_own { value } else { 0 };
            }
        }
        let [own, all] = [own, all].map(|sum| sum.map(|x| x as f64));
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let cosine = dot(own, all) / (dot(own, own) * dot(all, all)).sqrt();
        cosine.is_finite().then(|| cosine.clamp(-1.0, 1.0).acos().to_degrees())
    }
}

/// The diagonal of the bounding box of what a surface draws.
fn extent_of(surface: &Surface) -> f64 {
    let axis = |axis: usize| {
        let drawn = surface
            .vertex_of_corner
            .iter()
            .map(|&vertex| f64::from(surface.positions[vertex as usize][axis]));
        let (low, high) = bounds(drawn);
        high - low
    };
    [0, 1, 2].map(axis).into_iter().map(|length| length * length).sum::<f64>().sqrt()
}

fn bounds(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let widen = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
    values.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), widen)
}

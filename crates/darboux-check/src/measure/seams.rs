//! Whether a map was made for the UV layout of a mesh, by the seams.
//!
//! At a seam the surface goes on, and the map does not: its two sides lie in different charts, turned in
//! different ways. In a map that was baked for this layout, the lean of the normals in space is nearly the
//! same on both sides, or, where the seam lies on an edge that the mesh rounds and the map makes sharp,
//! nearly the opposite. In another map the two leans have nothing to do with each other. The correlation of
//! the two sides, over all seams of smooth normals, is compared with the correlation in the same map moved by
//! other offsets, which has the same details, the same repetitions and the same shared UVs: a null from the
//! data. Points that read the same two texels count once.
//!
//! The map is also read as if its layout were mirrored or turned by 180 degrees. If it fits so, and not as it
//! is, the UVs or the image were turned.

use std::collections::{BTreeMap, BTreeSet};

use darboux::TexelLayout;
use darboux_io::image::RgbaImage;

use crate::measure::facet::{Facet, Facets, MapUse, texel_at};
use crate::surface::{CornerOfTriangle, dot};

/// How a map lies on the UVs of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// As it is.
    Same,
    /// The UVs were mirrored after the bake: their u, their v or both, which is a turn by 180 degrees.
    TurnedUvs([bool; 2]),
    /// The UVs were turned by a right angle after the bake: (u, v) was (v, 1 - u), or (1 - v, u).
    QuarterTurnedUvs { was_back: bool },
    /// The rows or the columns of the image were reversed, or both.
    TurnedImage([bool; 2]),
}

/// The layouts that a map is compared with that does not fit as it is.
const OTHER_LAYOUTS: [Layout; 8] = [
    Layout::TurnedUvs([false, true]),
    Layout::TurnedUvs([true, false]),
    Layout::TurnedUvs([true, true]),
    Layout::QuarterTurnedUvs { was_back: false },
    Layout::QuarterTurnedUvs { was_back: true },
    Layout::TurnedImage([false, true]),
    Layout::TurnedImage([true, false]),
    Layout::TurnedImage([true, true]),
];

/// How well a map fits the seams.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamFit {
    /// The correlation of both sides, from -1 to 1.
    pub correlation: f64,
    /// By how many standard deviations the correlation differs from the map's at other offsets.
    pub z_score: f64,
}

/// What the seams of the meshes say about a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamFits {
    /// The number of points that were compared.
    pub points: usize,
    /// As the map lies now.
    pub as_it_is: SeamFit,
    /// The other layout that the map fits, where it does not fit as it is.
    pub other_layout: Option<(Layout, SeamFit)>,
}

/// From these on, a map was made for a layout; up to these, it was not.
const FITS: SeamFit = SeamFit { correlation: 0.3, z_score: 6.0 };
const FITS_NOT: SeamFit = SeamFit { correlation: 0.15, z_score: 3.0 };

/// Fewer points decide nothing.
const MIN_POINTS: usize = 60;

/// More triangles of a surface are not searched for seams, and more points are not compared.
const MAX_TRIANGLES: usize = 200_000;
const MAX_POINTS: usize = 20_000;

/// Points per edge, and their distance from it in texels, so that no filter or padding matters.
const POINTS: usize = 4;
const INSET: f32 = 1.5;

/// The smallest cosine between the normals of both sides of a smooth seam.
const SMOOTH: f64 = 0.98;

/// The number of offsets.
const OFFSETS: usize = 24;

/// The smallest mean squared lean of texels that say something: two codes of 8 bits.
const SMALLEST: f64 = 2.5e-4;

/// A point of a side: where its texel is, and the directions of red and green in space.
#[derive(Clone, Copy)]
struct Side {
    texel: [usize; 2],
    tangent: [f32; 3],
    bitangent: [f32; 3],
}

impl SeamFits {
    /// None where the meshes have too few seams, or the map hardly leans there.
    pub fn of(uses: &[MapUse<'_>], image: &RgbaImage) -> Option<Self> {
        let mut points = Vec::new();
        for facets in uses.iter().filter_map(|map_use| Facets::new(*map_use)) {
            if facets.surface.vertex_of_corner.len() / 3 <= MAX_TRIANGLES {
                add_points(&facets, image, &mut points);
            }
        }
        let mut seen = BTreeSet::new();
        points.retain(|[a, b]: &[Side; 2]| seen.insert([a.texel, b.texel]));
        let step = 1 + points.len() / MAX_POINTS;
        let points: Vec<[Side; 2]> = points.into_iter().step_by(step).collect();
        if points.len() < MIN_POINTS {
            return None;
        }
        let as_it_is = SeamFit::of(&points, image, Layout::Same, 0.0)?;
        let others = || {
            let fits = OTHER_LAYOUTS
                .into_iter()
                .filter_map(|layout| Some((layout, SeamFit::of(&points, image, layout, FITS.correlation)?)));
            let fits = fits.filter(|(_, fit)| fit.z_score.abs() >= FITS.z_score);
            fits.max_by(|(_, a), (_, b)| a.z_score.abs().total_cmp(&b.z_score.abs()))
        };
        let other_layout = if as_it_is.is_below(&FITS_NOT) { others() } else { None };
        Some(Self { points: points.len(), as_it_is, other_layout })
    }
}

impl SeamFit {
    fn is_below(&self, other: &Self) -> bool {
        self.correlation.abs() < other.correlation && self.z_score.abs() < other.z_score
    }

    /// None where the map hardly leans, or correlates by less than `at_least`.
    fn of(points: &[[Side; 2]], image: &RgbaImage, layout: Layout, at_least: f64) -> Option<Self> {
        let size = [image.width, image.height].map(|side| side as usize);
        let correlation = correlation(points, image, layout, [0; 2])?;
        if correlation.abs() < at_least {
            return None;
        }
        // The additive sequence of the plastic number spreads points evenly over a square (Roberts 2018).
        let offset = |number: usize| {
            let place = [0.754_877_666_246_693, 0.569_840_290_998_053_3].map(|step| step * number as f64);
            [0, 1].map(|i| (place[i].fract() * size[i] as f64) as usize)
        };
        let moved: Vec<f64> = (1..=OFFSETS)
            .filter_map(|number| self::correlation(points, image, layout, offset(number)))
            .collect();
        let count = moved.len() as f64;
        let mean = moved.iter().sum::<f64>() / count;
        let variance = moved.iter().map(|other| (other - mean).powi(2)).sum::<f64>() / (count - 1.0);
        // A map whose copies all agree alike has no null; then the standard deviation is that of independent
        // points.
        let deviation = variance.sqrt().max(1.0 / (points.len() as f64).sqrt());
        (moved.len() > OFFSETS / 2).then(|| Self { correlation, z_score: (correlation - mean) / deviation })
    }
}

/// The correlation of the leans on both sides; none where the texels hardly lean.
fn correlation(points: &[[Side; 2]], image: &RgbaImage, layout: Layout, offset: [usize; 2]) -> Option<f64> {
    let (mut product, mut squares, mut count) = (0.0, [0.0; 2], 0);
    for sides in points {
        let [Some(a), Some(b)] = sides.map(|side| lean(&side, image, layout, offset)) else { continue };
        product += dot(a, b);
        squares[0] += dot(a, a);
        squares[1] += dot(b, b);
        count += 1;
    }
    let does_lean = squares.iter().all(|sum| *sum >= SMALLEST * f64::from(count));
    (does_lean && count as usize >= MIN_POINTS).then(|| product / (squares[0] * squares[1]).sqrt())
}

/// The lean of the normal in space that the texel of a side gives; none for a texel without a normal.
fn lean(side: &Side, image: &RgbaImage, layout: Layout, offset: [usize; 2]) -> Option<[f32; 3]> {
    let size = [image.width, image.height].map(|side| side as usize);
    let [u, v] = side.texel;
    let (texel, turned) = match layout {
        Layout::Same => ([u, v], [false; 2]),
        Layout::TurnedUvs(turned) | Layout::TurnedImage(turned) => ([u, v], turned),
        Layout::QuarterTurnedUvs { was_back } => {
            ([v * size[0] / size[1], u * size[1] / size[0]], [was_back, !was_back])
        }
    };
    let at = |i: usize| {
        let own = if turned[i] { size[i] - 1 - texel[i] } else { texel[i] };
        (own + offset[i]) % size[i]
    };
    let texel = image.texels[at(1) * size[0] + at(0)];
    if !TexelLayout::RGBA.holds_normal(texel) {
        return None;
    }
    let [x, y, _] = TexelLayout::RGBA.vector(texel);
    let sign = |inverts: bool| if inverts { -1.0 } else { 1.0 };
    let (x, y) = match layout {
        Layout::Same | Layout::TurnedImage(_) => (x, y),
        Layout::TurnedUvs([u, v]) => (sign(u) * x, sign(v) * y),
        // The bake's directions of red and green, in the file's directions.
        Layout::QuarterTurnedUvs { was_back } => (sign(was_back) * y, sign(!was_back) * x),
    };
    Some([0, 1, 2].map(|i| x * side.tangent[i] + y * side.bitangent[i]))
}

/// Adds the points on both sides of all smooth seams.
fn add_points(facets: &Facets<'_>, image: &RgbaImage, points: &mut Vec<[Side; 2]>) {
    let seams = facets.smooth_seams(|| smooth_seams(facets));
    for &[(first, a), (second, b)] in &*seams {
        let (Some(first), Some(second)) = (facets.at(first), facets.at(second)) else { continue };
        for number in 0..POINTS {
            let along = (number as f32 + 0.5) / POINTS as f32;
            let first = side(&first, a.into(), along, facets, image);
            let second = side(&second, b.into(), 1.0 - along, facets, image);
            points.extend(first.zip(second).map(<[Side; 2]>::from));
        }
    }
}

/// The edges where the normals go on smoothly and the UVs do not.
fn smooth_seams(facets: &Facets<'_>) -> Vec<[CornerOfTriangle; 2]> {
    let all: Vec<(u32, Facet)> = facets.numbered().collect();
    let mut edges: BTreeMap<[[u32; 3]; 2], Vec<(usize, usize)>> = BTreeMap::new();
    // Zeros of both signs are one place.
    let bits = |position: [f32; 3]| position.map(|x| (x + 0.0).to_bits());
    for (index, (_, facet)) in all.iter().enumerate() {
        for corner in 0..3 {
            let ends = [corner, (corner + 1) % 3].map(|end| bits(facet.corners[end].position));
            let key = if ends[0] <= ends[1] { ends } else { [ends[1], ends[0]] };
            edges.entry(key).or_default().push((index, corner));
        }
    }
    let mut seams = Vec::new();
    for sides in edges.values() {
        let [(first, a), (second, b)] = sides[..] else { continue };
        let [(number_of_first, first), (number_of_second, second)] = [&all[first], &all[second]];
        // Neighbours with one winding run along their edge in opposite directions.
        let [a0, a1] = [a, (a + 1) % 3].map(|end| &first.corners[end]);
        let [b1, b0] = [b, (b + 1) % 3].map(|end| &second.corners[end]);
        let is_smooth = |x: [f32; 3], y: [f32; 3]| dot(x, y) >= SMOOTH;
        let is_place = bits(a0.position) == bits(b0.position);
        let is_seam = a0.uv != b0.uv && a1.uv != b1.uv;
        if is_place && is_seam && is_smooth(a0.normal, b0.normal) && is_smooth(a1.normal, b1.normal) {
            seams.push([(*number_of_first, a as u8), (*number_of_second, b as u8)]);
        }
    }
    seams
}

/// A point beside an edge of a facet. `along`: from the corner, 0, to the next one, 1.
fn side(facet: &Facet, corner: usize, along: f32, facets: &Facets<'_>, image: &RgbaImage) -> Option<Side> {
    let size = [image.width as f32, image.height as f32];
    let uv = |at: usize| [0, 1].map(|i| facet.corners[at % 3].uv[i] * size[i]);
    let [a, b, c] = [uv(corner), uv(corner + 1), uv(corner + 2)];
    let edge = [b[0] - a[0], b[1] - a[1]];
    let area = (edge[0] * (c[1] - a[1]) - edge[1] * (c[0] - a[0])).abs();
    let height = area / edge[0].hypot(edge[1]);
    let inset = INSET / height;
    // A facet that is thinner than a few texels has no inside.
    if !(inset.is_finite() && inset < 0.4) {
        return None;
    }
    let mut weights = [0.0; 3];
    weights[corner] = (1.0 - along) * (1.0 - inset);
    weights[(corner + 1) % 3] = along * (1.0 - inset);
    weights[(corner + 2) % 3] = inset;
    let [tangent, bitangent] = facet.frame(facet.normal_at(weights)?)?;
    Some(Side { texel: texel_at(image, facets.wrap(), facet.uv_at(weights)), tangent, bitangent })
}

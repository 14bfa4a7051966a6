//! The triangles of a surface in the tangent space of its normals, and the texels on them.

use std::sync::Arc;

use darboux::TexelLayout;
use darboux_io::gltf::{TextureUse, Wrap};
use darboux_io::image::RgbaImage;

use crate::measure::other_axes::OtherAxes;
use crate::measure::reversal::Sides;
use crate::once_per::reading;
use crate::surface::{CornerOfTriangle, Surface, cross, dot, length, sub};
use crate::tilts::{Tilt, Tilts};

/// Samples per edge of a triangle.
const SAMPLES: usize = 4;

/// Blocks along each side of the map.
pub const BLOCKS: usize = 16;

/// More ways in which materials read maps of one surface are not remembered.
const MOST_READINGS: usize = 4;

/// A surface on which an image is the normal map, and how its material uses the map; none for the UVs that
/// its tangents follow, repeated.
pub type MapUse<'a> = (&'a Surface, Option<&'a TextureUse>);

/// The triangles of a surface.
pub struct Facets<'a> {
    pub surface: &'a Surface,
    normals: &'a [[f32; 3]],
    uvs: &'a [[f32; 2]],
    texture: Option<&'a TextureUse>,
}

impl<'a> Facets<'a> {
    /// None where the surface has no votes: reversed normals lean the other way in both directions, as those
    /// of a map with red and green inverted.
    pub fn new((surface, texture): MapUse<'a>) -> Option<Self> {
        let has_none = || Sides::of(surface).are_mostly_against() || OtherAxes::of(surface).is_some();
        if *surface.has_no_votes.get_or_init(has_none) {
            return None;
        }
        let uv_set = texture.map_or(surface.uv_set, |texture| texture.uv_set);
        let (normals, uvs) = (surface.normals.as_ref()?, surface.uv_sets.get(&uv_set)?);
        Some(Self { surface, normals, uvs, texture })
    }

    /// How at most about `limit` of the facets lean.
    pub fn tilts(&self, limit: usize) -> Arc<Tilts> {
        /// For each use of [`Facets::tilts`].
        const MOST: usize = 3;
        let step = 1 + (self.surface.vertex_of_corner.len() / 3) / limit;
        let tilts = || {
            let mut tilts = Tilts::default();
            for (number, triangle) in (0..).zip(self.surface.triangles()).step_by(step) {
                if let Some(facet) = self.facet(triangle) {
                    tilts.add(number, facet.uv_area(), facet.tilts());
                }
            }
            tilts
        };
        match self.surface.keeps_tilts {
            true => self.surface.tilts.get((reading(self.texture), step), MOST, tilts),
            false => Arc::new(tilts()),
        }
    }

    /// The edges where maps are cut and the normals are not.
    pub fn smooth_seams(
        &self,
        seams: impl FnOnce() -> Vec<[CornerOfTriangle; 2]>,
    ) -> Arc<Vec<[CornerOfTriangle; 2]>> {
        self.surface.smooth_seams.get(reading(self.texture), MOST_READINGS, seams)
    }

    /// The face of each triangle, named by the number of its first one.
    pub fn face_of_triangle(&self, faces: impl FnOnce() -> Vec<u32>) -> Arc<Vec<u32>> {
        self.surface.face_of_triangle.get(reading(self.texture), MOST_READINGS, faces)
    }

    /// All facets, each with the number of its triangle.
    pub fn numbered(&self) -> impl Iterator<Item = (u32, Facet)> {
        let numbered = (0u32..).zip(self.surface.triangles());
        numbered.filter_map(|(number, triangle)| Some((number, self.facet(triangle)?)))
    }

    /// The facet of a triangle by its number.
    pub fn at(&self, number: u32) -> Option<Facet> {
        let triangle = self.surface.vertex_of_corner.as_chunks::<3>().0.get(number as usize)?;
        self.facet(triangle.map(|vertex| vertex as usize))
    }

    fn facet(&self, triangle: [usize; 3]) -> Option<Facet> {
        let place = |uv| self.texture.map_or(uv, |texture| texture.transform_uv(uv));
        Facet::new(triangle.map(|vertex| Corner {
            position: self.surface.positions[vertex],
            normal: self.normals[vertex],
            uv: place(self.uvs[vertex]),
        }))
    }

    pub fn wrap(&self) -> [Wrap; 2] {
        self.texture.map_or([Wrap::Repeat; 2], |texture| texture.wrap)
    }
}

/// A corner of a facet.
pub struct Corner {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub uv: [f32; 2],
}

/// A triangle, the normal of its plane on the side of the corners' normals, and the directions of u and of v
/// upwards in it.
pub struct Facet {
    pub corners: [Corner; 3],
    pub normal: [f32; 3],
    along_u: [f32; 3],
    along_v: [f32; 3],
}

/// A point of a triangle: x and y of the face normal in the tangent space of the smoothed one, and the place
/// of its texel.
#[derive(Clone, Copy)]
pub struct Sample {
    pub tilt: [f64; 2],
    pub texel: [usize; 2],
}

/// Sums over the samples of one face or several.
#[derive(Clone, Copy, Debug, Default)]
pub struct Means {
    /// x and y of the face normals.
    pub tilt: [f64; 2],
    /// x and y of the texels.
    pub texel: [f64; 2],
    pub count: f64,
    /// The block of the map that the last face lies in.
    pub block: usize,
}

impl Means {
    pub fn add(&mut self, other: &Self) {
        for i in 0..2 {
            self.tilt[i] += other.tilt[i];
            self.texel[i] += other.texel[i];
        }
        self.count += other.count;
        self.block = other.block;
    }

    pub fn mean_tilt(&self) -> [f64; 2] {
        self.tilt.map(|sum| sum / self.count)
    }

    pub fn mean_texel(&self) -> [f64; 2] {
        self.texel.map(|sum| sum / self.count)
    }
}

/// The sums over the points of a triangle, weighted by its area in the map, so that the faces of a plane
/// count as one.
pub fn means(uv_area: f64, tilts: &[Tilt], wrap: [Wrap; 2], image: &RgbaImage) -> Means {
    let size = [image.width, image.height].map(|side| side as usize);
    let mut means = Means::default();
    for Sample { tilt, texel: [column, row] } in samples(tilts, wrap, image) {
        let texel = image.texels[row * size[0] + column];
        if TexelLayout::RGBA.holds_normal(texel) {
            let [x, y, _] = TexelLayout::RGBA.vector(texel).map(f64::from);
            let block = row * BLOCKS / size[1] * BLOCKS + column * BLOCKS / size[0];
            let tilt = tilt.map(|lean| uv_area * lean);
            means.add(&Means { tilt, texel: [uv_area * x, uv_area * y], count: uv_area, block });
        }
    }
    means
}

/// The points of a triangle with their texels.
pub fn samples(tilts: &[Tilt], wrap: [Wrap; 2], image: &RgbaImage) -> impl Iterator<Item = Sample> {
    tilts.iter().map(move |&Tilt { tilt, uv }| Sample { tilt, texel: texel_at(image, wrap, uv) })
}

impl Facet {
    /// None for a triangle without area, in space or in UV space, and for numbers that are not finite.
    fn new(corners: [Corner; 3]) -> Option<Self> {
        let [a, b, c] = &corners;
        let edges = [sub(b.position, a.position), sub(c.position, a.position)];
        let [[u1, v1], [u2, v2]] = [b, c].map(|end| [end.uv[0] - a.uv[0], end.uv[1] - a.uv[1]]);
        let area = u1 * v2 - u2 * v1;
        let combine = |p: f32, q: f32| [0, 1, 2].map(|i| (p * edges[0][i] + q * edges[1][i]) * area.signum());
        let front = unit(cross(edges[0], edges[1]))?;
        let outwards: f64 = corners.iter().map(|corner| dot(front, corner.normal)).sum();
        (area.is_finite() && area != 0.0 && outwards.is_finite()).then_some(())?;
        let normal = if outwards < 0.0 { front.map(|x| -x) } else { front };
        // glTF's v points down.
        let (along_u, along_v) = (combine(v2, -v1), combine(u2, -u1));
        Some(Self { corners, normal, along_u, along_v })
    }

    /// Twice its area in UV space.
    fn uv_area(&self) -> f64 {
        let [a, b, c] = self.corners.each_ref().map(|corner| corner.uv.map(f64::from));
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    }

    /// Points without a smoothed normal are left out.
    fn tilts(&self) -> impl Iterator<Item = Tilt> {
        let weights = (0..SAMPLES).flat_map(|i| (0..SAMPLES - i).map(move |j| [i, j]));
        weights.filter_map(|weights| {
            let [b, c] = weights.map(|i| (i as f32 + 1.0 / 3.0) / SAMPLES as f32);
            let weights = [1.0 - b - c, b, c];
            Some(Tilt { tilt: self.tilt(self.normal_at(weights)?)?, uv: self.uv_at(weights) })
        })
    }

    /// x and y of the face normal in the tangent space of a smoothed normal.
    fn tilt(&self, normal: [f32; 3]) -> Option<[f64; 2]> {
        Some(self.frame(normal)?.map(|direction| dot(self.normal, direction)))
    }

    /// The tangent and the bitangent at a smoothed normal.
    pub fn frame(&self, normal: [f32; 3]) -> Option<[[f32; 3]; 2]> {
        let lean = dot(normal, self.along_u) as f32;
        let tangent = unit([0, 1, 2].map(|i| self.along_u[i] - normal[i] * lean))?;
        let bitangent = cross(normal, tangent);
        let sign = dot(bitangent, self.along_v).signum() as f32;
        Some([tangent, bitangent.map(|x| sign * x)])
    }

    /// The smoothed normal at a point; none where it has no direction. `weights`: of the corners.
    pub fn normal_at(&self, weights: [f32; 3]) -> Option<[f32; 3]> {
        unit(interpolated(weights, &self.corners, |corner| corner.normal))
    }

    pub fn uv_at(&self, weights: [f32; 3]) -> [f32; 2] {
        interpolated(weights, &self.corners, |corner| corner.uv)
    }
}

fn interpolated<const N: usize>(
    weights: [f32; 3],
    corners: &[Corner; 3],
    value: impl Fn(&Corner) -> [f32; N],
) -> [f32; N] {
    let values = corners.each_ref().map(value);
    std::array::from_fn(|i| (0..3).map(|corner| weights[corner] * values[corner][i]).sum())
}

fn unit(vector: [f32; 3]) -> Option<[f32; 3]> {
    let length = length(vector);
    (length.is_finite() && length > 0.0).then(|| vector.map(|x| (f64::from(x) / length) as f32))
}

/// Column and row of the nearest texel. The first row is v = 0.
pub fn texel_at(image: &RgbaImage, wrap: [Wrap; 2], uv: [f32; 2]) -> [usize; 2] {
    let size = [image.width, image.height];
    [0, 1].map(|i| {
        let at = match wrap[i] {
            Wrap::Repeat => uv[i].rem_euclid(1.0),
            Wrap::Mirror => 1.0 - (uv[i].rem_euclid(2.0) - 1.0).abs(),
            Wrap::Clamp => uv[i].clamp(0.0, 1.0),
        };
        ((at * size[i] as f32) as usize).min(size[i] as usize - 1)
    })
}

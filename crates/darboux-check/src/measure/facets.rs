//! Compares a normal map with the facets of the mesh that it was baked for. This tells inverted red from inverted green, and bumps from dents.
//!
//! A baker writes the difference between the smoothed normals of the mesh and the normals of the detailed model. Where the detailed model
//! has flat parts, or hard edges with bevels, that difference points to the normal of the mesh's face. So the x and y of the texels correlate with
//! those of the face normals in tangent space, and never with their negation. A map that tiles, or that was made for another mesh, shows no correlation.
//!
//! Every triangle votes with the correlation over a few of its texels. The z score is the sum of the votes over the root of the sum of their squares.

use darboux::TexelLayout;
use darboux_io::gltf::{TextureUse, Wrap};
use darboux_io::image::RgbaImage;

use crate::measure::other_axes::OtherAxes;
use crate::measure::reversal::Sides;
use crate::surface::{Surface, cross, dot, length, sub};

/// The smallest z score of a decision. Neighbouring triangles are not independent, so it is larger than that of a normal distribution.
const DECIDED: f64 = 6.0;

/// More triangles of a surface are not asked.
const TRIANGLES: usize = 50_000;

/// Samples per edge of a triangle.
const SAMPLES: usize = 4;

/// The smallest root of the mean squared tilt that votes, of face normals and of texels: two codes of 8 bits.
const SMALLEST: f64 = 4.0 / 255.0;

/// How the channels of a map are arranged, as far as its derivatives tell: the facets decide between two possibilities, of which one has the
/// negated x and y of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrangement {
    /// Green up; or red and green inverted.
    Same,
    /// Green down; or green up and red inverted.
    GreenInverted,
    /// Red and green exchanged; or also both inverted.
    Exchanged,
    /// Red and green exchanged and then the second channel inverted; or the first one.
    ExchangedAndInverted,
}

/// The votes of triangles on the arrangements, in the order of their declaration.
#[derive(Clone, Copy, Debug, Default)]
pub struct FacetVotes {
    sums: [f64; 4],
    squares: [f64; 4],
    count: usize,
}

impl FacetVotes {
    /// Adds the votes of a surface on which the image is the normal map. `texture`: how its material uses the map; none for the UVs that
    /// its tangents follow, repeated. A surface that is wound against its normals, or whose normals are in other axes, has no votes.
    pub fn add(&mut self, surface: &Surface, texture: Option<&TextureUse>, image: &RgbaImage) {
        if Sides::of(surface).are_mostly_against() || OtherAxes::of(surface).is_some() {
            // Reversed normals lean the other way in both directions, as those of a map with red and green inverted.
            return;
        }
        let uv_set = texture.map_or(surface.uv_set, |texture| texture.uv_set);
        let (Some(normals), Some(uvs)) = (&surface.normals, surface.uv_sets.get(&uv_set)) else { return };
        let wrap = texture.map_or([Wrap::Repeat; 2], |texture| texture.wrap);
        let place = |uv| texture.map_or(uv, |texture| texture.transform_uv(uv));
        let step = 1 + surface.vertex_of_corner.len() / 3 / TRIANGLES;
        for triangle in surface.triangles().step_by(step) {
            let corners = triangle.map(|vertex| Corner {
                position: surface.positions[vertex],
                normal: normals[vertex],
                uv: place(uvs[vertex]),
            });
            if let Some(facet) = Facet::new(corners) {
                self.vote(facet.products(wrap, image));
            }
        }
    }

    /// True where the first of the two possibilities of an arrangement is decided, false for the second one; none without a decision.
    pub fn decide(&self, arrangement: Arrangement) -> Option<bool> {
        let z_score = self.z_score(arrangement);
        (z_score.abs() >= DECIDED).then_some(z_score > 0.0)
    }

    /// The z score of an arrangement.
    pub fn z_score(&self, arrangement: Arrangement) -> f64 {
        let index = arrangement as usize;
        if self.squares[index] > 0.0 { self.sums[index] / self.squares[index].sqrt() } else { 0.0 }
    }

    /// The number of triangles that voted.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Votes with this z score of one arrangement, and none of the others.
    #[cfg(test)]
    pub fn only(arrangement: Arrangement, z_score: f64) -> Self {
        let mut votes = Self::default();
        (votes.sums[arrangement as usize], votes.squares[arrangement as usize]) = (z_score, 1.0);
        votes
    }

    fn vote(&mut self, products: Products) {
        let Products { facet, texel, products: [[xx, xy], [yx, yy]], count } = products;
        let least = SMALLEST * SMALLEST * f64::from(count);
        if facet < least || texel < least {
            return;
        }
        self.count += 1;
        let scale = 1.0 / (facet * texel).sqrt();
        for (index, product) in [xx + yy, xx - yy, yx + xy, yx - xy].into_iter().enumerate() {
            self.sums[index] += product * scale;
            self.squares[index] += (product * scale).powi(2);
        }
    }
}

struct Corner {
    position: [f32; 3],
    normal: [f32; 3],
    uv: [f32; 2],
}

/// A triangle, the normal of its plane on the side of the corners' normals, and the directions of u and of v upwards in it.
struct Facet {
    corners: [Corner; 3],
    normal: [f32; 3],
    along_u: [f32; 3],
    along_v: [f32; 3],
}

/// Sums over the samples of a triangle.
#[derive(Default)]
struct Products {
    /// The squares of x and y of the face normal.
    facet: f64,
    /// The squares of x and y of the texels.
    texel: f64,
    /// x and y of the face normal times x and y of the texels.
    products: [[f64; 2]; 2],
    count: u32,
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

    fn products(&self, wrap: [Wrap; 2], image: &RgbaImage) -> Products {
        let mut products = Products::default();
        let weights = (0..SAMPLES).flat_map(|i| (0..SAMPLES - i).map(move |j| [i, j]));
        for weights in weights {
            let [b, c] = weights.map(|i| (i as f32 + 1.0 / 3.0) / SAMPLES as f32);
            let weights = [1.0 - b - c, b, c];
            let texel = texel_at(image, wrap, interpolated(weights, &self.corners, |corner| corner.uv));
            let is_normal = TexelLayout::RGBA.holds_normal(texel);
            let normal = unit(interpolated(weights, &self.corners, |corner| corner.normal));
            let Some(facet) = normal.filter(|_| is_normal).and_then(|normal| self.tilt(normal)) else {
                continue;
            };
            let [x, y, _] = TexelLayout::RGBA.vector(texel).map(f64::from);
            products.count += 1;
            products.facet += facet[0] * facet[0] + facet[1] * facet[1];
            products.texel += x * x + y * y;
            products.products[0][0] += facet[0] * x;
            products.products[0][1] += facet[0] * y;
            products.products[1][0] += facet[1] * x;
            products.products[1][1] += facet[1] * y;
        }
        products
    }

    /// x and y of the face normal in the tangent space of a smoothed normal.
    fn tilt(&self, normal: [f32; 3]) -> Option<[f64; 2]> {
        let lean = dot(normal, self.along_u) as f32;
        let tangent = unit([0, 1, 2].map(|i| self.along_u[i] - normal[i] * lean))?;
        let bitangent = cross(normal, tangent);
        let sign = dot(bitangent, self.along_v).signum();
        Some([dot(self.normal, tangent), sign * dot(self.normal, bitangent)])
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

/// The nearest texel. The first row is v = 0.
fn texel_at(image: &RgbaImage, wrap: [Wrap; 2], uv: [f32; 2]) -> [u8; 4] {
    let size = [image.width, image.height];
    let [x, y] = [0, 1].map(|i| {
        let at = match wrap[i] {
            Wrap::Repeat => uv[i].rem_euclid(1.0),
            Wrap::Mirror => 1.0 - (uv[i].rem_euclid(2.0) - 1.0).abs(),
            Wrap::Clamp => uv[i].clamp(0.0, 1.0),
        };
        ((at * size[i] as f32) as usize).min(size[i] as usize - 1)
    });
    image.texels[y * image.width as usize + x]
}

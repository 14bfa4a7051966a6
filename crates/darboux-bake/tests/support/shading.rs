//! Shades the low mesh of a pair at random points as a renderer does, and knows the true normals there.
//!
//! The truth at a point of the low mesh is the normal where the line along its interpolated normal meets the
//! analytic surface, found by Newton's method: neither the high mesh nor a ray is part of it.

use darboux::{Channel, Convention, TexelLayout};
use darboux_dice::Dice;

use super::{Pair, Shape, Vector, cross, degrees, dot, is_in_second_half, normal, unit};

/// Points per measurement.
pub const POINTS: usize = 20_000;

/// A point of the low mesh, as a fragment shader sees it, and the true normal.
pub struct Fragment {
    uv: [f64; 2],
    normal: Vector,
    tangent: Vector,
    sign: f64,
    truth: Vector,
    /// The distance to the nearest border of a chart, in units of UVs.
    pub to_border: f64,
}

/// Points at random places of the charts. `cells`: those of the low mesh per side.
pub fn fragments(pair: &Pair, low: &Shape, cells: usize) -> Vec<Fragment> {
    let conversion = Convention::GLTF.generated().to(Convention::GLTF);
    let tangents: Vec<_> = low.tangents().into_iter().map(|tangent| conversion.tangent(tangent)).collect();
    let mut dice = Dice::from_seed(1);
    let mut random = || (f64::from(dice.word()) + 0.5) / 4_294_967_296.0;
    let fragment = |_| {
        let place = [random(), random()];
        let cell = place.map(|x| (x * cells as f64) as usize);
        let [x, y] = [0, 1].map(|i| place[i] * cells as f64 - cell[i] as f64);
        // The triangles of a cell, and the weights of their corners, in the order of `Shape::grid`.
        let is_turned = pair.is_mirrored && is_in_second_half(cell[0], cells);
        let (triangle, weights) = match is_turned {
            false if y > x => (0, [1.0 - y, y - x, x]),
            false => (1, [1.0 - x, y, x - y]),
            true if x + y < 1.0 => (0, [1.0 - x - y, y, x]),
            true => (1, [1.0 - y, 1.0 - x, x + y - 1.0]),
        };
        let first = 6 * (cell[1] * cells + cell[0]) + 3 * triangle;
        let corners = [first, first + 1, first + 2];
        let vertices = corners.map(|corner| low.indices[corner] as usize);
        let position = mixed(weights, vertices.map(|vertex| low.positions[vertex]));
        let normal = mixed(weights, vertices.map(|vertex| low.normals[vertex]));
        let [tx, ty, tz, sign] = mixed(weights, corners.map(|corner| tangents[corner]));
        Fragment {
            uv: mixed(weights, vertices.map(|vertex| low.uvs[vertex])),
            normal,
            tangent: [tx, ty, tz],
            sign,
            truth: true_normal(pair, place, position, unit(normal)),
            to_border: border_distance(pair, place),
        }
    };
    (0..POINTS).map(fragment).collect()
}

fn mixed<const N: usize>(weights: [f64; 3], corners: [[f32; N]; 3]) -> [f64; N] {
    std::array::from_fn(|i| (0..3).map(|k| weights[k] * f64::from(corners[k][i])).sum())
}

fn border_distance(pair: &Pair, [u, v]: [f64; 2]) -> f64 {
    let (seam, along) = if pair.is_mirrored { ((2.0 * u - 1.0).abs(), 0.94) } else { (u, 0.94) };
    along * seam.min(1.0 - seam).min(v).min(1.0 - v)
}

/// The normal where the line through `position` along `direction` meets the surface.
fn true_normal(pair: &Pair, start: [f64; 2], position: Vector, direction: Vector) -> Vector {
    const STEP: f64 = 1e-6;
    let [mut u, mut v] = start;
    let mut t = 0.0;
    let surface = |u: f64, v: f64| pair.point(u, v);
    for _ in 0..12 {
        let at = surface(u, v);
        let miss = [0, 1, 2].map(|i| position[i] + t * direction[i] - at[i]);
        let derivative = |a: Vector, b: Vector| [0, 1, 2].map(|i| (a[i] - b[i]) / (2.0 * STEP));
        let along_u = derivative(surface(u + STEP, v), surface(u - STEP, v));
        let along_v = derivative(surface(u, v + STEP), surface(u, v - STEP));
        let back = direction.map(|x| -x);
        // Cramer's rule for du * along_u + dv * along_v + dt * back = miss.
        let volume = dot(along_u, cross(along_v, back));
        u += dot(miss, cross(along_v, back)) / volume;
        v += dot(along_u, cross(miss, back)) / volume;
        t += dot(along_u, cross(along_v, miss)) / volume;
    }
    normal(surface, u, v)
}

/// The map, filtered as a GPU does.
pub struct Texture {
    size: usize,
    texels: Vec<[f32; 3]>,
}

impl Texture {
    /// Normals, rounded to the codes of a channel type.
    pub fn rounded<C: Channel>(normals: &[[f32; 3]], size: usize) -> Self {
        let layout = TexelLayout::<3>::RGB;
        let texels = normals.iter().map(|&normal| layout.vector(layout.texel::<C>(normal))).collect();
        Self { size, texels }
    }

    fn bilinear(&self, uv: [f64; 2]) -> Vector {
        let last = self.size as f64 - 1.0;
        let place = uv.map(|x| (x * self.size as f64 - 0.5).clamp(0.0, last));
        let first = place.map(|x| x.floor().min(last - 1.0) as usize);
        let [x, y] = [0, 1].map(|i| place[i] - first[i] as f64);
        let texel = |dx: usize, dy: usize| self.texels[(first[1] + dy) * self.size + first[0] + dx];
        let rows = [[texel(0, 0), texel(1, 0)], [texel(0, 1), texel(1, 1)]];
        std::array::from_fn(|i| {
            let row = |[a, b]: [[f32; 3]; 2]| (1.0 - x) * f64::from(a[i]) + x * f64::from(b[i]);
            (1.0 - y) * row(rows[0]) + y * row(rows[1])
        })
    }
}

/// The normal that a glTF renderer computes.
fn shaded(fragment: &Fragment, texture: &Texture) -> Vector {
    let Fragment { normal, tangent, sign, .. } = fragment;
    let bitangent = cross(*normal, *tangent).map(|x| sign * x);
    let [x, y, z] = texture.bilinear(fragment.uv);
    unit([0, 1, 2].map(|i| x * tangent[i] + y * bitangent[i] + z * normal[i]))
}

/// The errors in degrees, sorted.
pub fn errors<'a>(fragments: impl IntoIterator<Item = &'a Fragment>, texture: &Texture) -> Vec<f64> {
    let mut errors: Vec<f64> =
        fragments.into_iter().map(|fragment| degrees(shaded(fragment, texture), fragment.truth)).collect();
    errors.sort_by(f64::total_cmp);
    errors
}

pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share) as usize]
}

//! Bounds of the rounding errors of frames of the methods `Average` and `Lengyel`, derived from the
//! guarantees of WGSL.
//!
//! With u = 2^-24, sums and products have relative errors of u, quotients of 2.5 ulp (5 u), and square roots,
//! which WGSL defines as reciprocals of reciprocal roots, of 4.5 ulp (9 u). Fused operations have smaller
//! errors. dP/du times the UV area, dv2 e1 - dv1 e2, has four roundings and an error of 4 u M, where M =
//! |dv2| |e1| + |dv1| |e2|. Normalising a vector at most doubles its relative error and adds less than 20 u.
//!
//! `Lengyel` divides by the UV area instead: the product with 1 / area has a relative error of 6 u. With an
//! area that is off by the share d, the error of a term T is at most ((d + 7 u) |T| + 5 u M / |area|) / (1 -
//! d).

use darboux::Method;
pub use darboux::internal::vectors::double::{dot, length, sub};
use darboux_tests::OwnedMesh;

pub const U: f64 = 1.0 / (1 << 24) as f64;
/// The error of normalising a vector.
const UNIT: f64 = 20.0 * U;
/// Above this, and below its reciprocal, squares and cross products may overflow or underflow.
const LARGEST: f64 = 1e15;
/// Larger bounds are useless.
pub const MAX_USEFUL_BOUND: f64 = 0.1;

type V3 = [f64; 3];

/// What the exact computation determines about the frame of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KnownFrame {
    /// The sign, and bounds for tangent and bitangent.
    Frame { sign: f32, tangent: f64, bitangent: f64 },
    /// The vertex has no triangle with a direction.
    Without,
    /// Nothing, because rounding may change a decision or a direction.
    Unsure,
}

/// A sum of terms, and the bound of its error.
#[derive(Clone, Copy, Default)]
struct Sum {
    value: V3,
    error: f64,
}

#[derive(Clone, Copy, Default)]
struct Side {
    tangent: Sum,
    bitangent: Sum,
    /// The sum of the sizes of the tangents.
    size: f64,
    count: f64,
}

#[derive(Clone, Default)]
struct Vertex {
    sides: [Side; 2],
    is_unsure: bool,
}

enum Triangle {
    Nothing,
    Unsure,
    Adds { side: usize, tangent: (V3, f64), bitangent: (V3, f64), size: f64 },
}

/// The determined frame of every vertex of a triangle mesh. `method`: `Average` or `Lengyel`.
pub fn known(mesh: &OwnedMesh, method: Method) -> Vec<KnownFrame> {
    let mut vertices = vec![Vertex::default(); mesh.positions.len()];
    for face in mesh.face_list() {
        let [a, b, c] = [face[0] as usize, face[1] as usize, face[2] as usize];
        match triangle(mesh, [a, b, c], method) {
            Triangle::Nothing => {}
            Triangle::Unsure => [a, b, c].iter().for_each(|&v| vertices[v].is_unsure = true),
            Triangle::Adds { side, tangent, bitangent, size } => {
                for v in [a, b, c] {
                    let side = &mut vertices[v].sides[side];
                    side.tangent.add(tangent);
                    side.bitangent.add(bitangent);
                    side.size += size;
                    side.count += 1.0;
                }
            }
        }
    }
    vertices.iter().zip(&mesh.normals).map(|(vertex, normal)| vertex.known(normal.map(f64::from))).collect()
}

impl Sum {
    fn add(&mut self, (term, error): (V3, f64)) {
        self.value = [0, 1, 2].map(|i| self.value[i] + term[i]);
        self.error += error + U * length(self.value);
    }

    /// The error of the direction in the plane of `normal`, which itself has an error of [`UNIT`].
    fn in_plane(&self, normal: V3) -> f64 {
        let along = dot(self.value, normal);
        let rest = [0, 1, 2].map(|i| self.value[i] - along * normal[i]);
        2.0 * (self.error + 3.0 * UNIT * length(self.value)) / length(rest) + UNIT
    }
}

impl Vertex {
    fn known(&self, normal: V3) -> KnownFrame {
        let [keeps, mirrors] = &self.sides;
        let (side, sign) = if mirrors.count > keeps.count { (mirrors, -1.0) } else { (keeps, 1.0) };
        if self.is_unsure {
            return KnownFrame::Unsure;
        }
        if side.count == 0.0 {
            return KnownFrame::Without;
        }
        let normal_size = length(normal);
        let is_plain = normal_size == 0.0 || (1.0 / LARGEST..LARGEST).contains(&normal_size);
        // Without a normal the sum is not projected.
        let normal = if normal_size > 0.0 { normal.map(|x| x / normal_size) } else { [0.0; 3] };
        let [tangent, bitangent] = [&side.tangent, &side.bitangent].map(|sum| sum.in_plane(normal));
        let cancels = length(side.tangent.value) < 3e-5 * side.size;
        let is_plain = is_plain && side.size < LARGEST;
        if is_plain && !cancels && tangent < MAX_USEFUL_BOUND && bitangent < MAX_USEFUL_BOUND {
            KnownFrame::Frame { sign, tangent, bitangent }
        } else {
            KnownFrame::Unsure
        }
    }
}

fn triangle(mesh: &OwnedMesh, vertices: [usize; 3], method: Method) -> Triangle {
    let [a, b, c] = vertices.map(|v| mesh.positions[v].map(f64::from));
    let [ta, tb, tc] = vertices.map(|v| mesh.uvs[v].map(f64::from));
    let values = [&a[..], &b, &c, &ta, &tb, &tc].concat();
    if !values.iter().all(|value| value.is_finite()) || a == b || b == c || a == c {
        return Triangle::Nothing;
    }
    let edges = [sub(b, a), sub(c, a), sub(c, b)];
    let [d1, d2] = [tb, tc].map(|t| [t[0] - ta[0], t[1] - ta[1]]);
    let area = d1[0] * d2[1] - d1[1] * d2[0];
    if area == 0.0 && area_in_floats(vertices.map(|v| mesh.uvs[v])) == 0.0 {
        return Triangle::Nothing;
    }
    let area_error = 8.0 * U * ((d1[0] * d2[1]).abs() + (d1[1] * d2[0]).abs());
    let sign = area.signum();
    let s = Scaled::new([sign * d2[1], sign * d1[1]], edges[0], edges[1]);
    let t = Scaled::new([sign * d1[0], sign * d2[0]], edges[1], edges[0]);
    let magnitudes = [s.size(), t.size()].map(|size| size / area.abs());
    let lengths = [s.size(), t.size(), length(edges[0]), length(edges[1]), length(edges[2])];
    let sizes = [&lengths[..], &magnitudes].concat();
    let are_plain = sizes.iter().all(|size| (1.0 / LARGEST..LARGEST).contains(size))
        && (LARGEST.powi(-2)..LARGEST * LARGEST).contains(&area.abs());
    let is_useful = |(term, error): (V3, f64)| error <= MAX_USEFUL_BOUND * length(term);
    if !are_plain || area.abs() <= area_error {
        return Triangle::Unsure;
    }
    let [tangent, bitangent] = match method {
        Method::Lengyel => [s, t].map(|scaled| scaled.over(area.abs(), area_error)),
        _ => [s, t].map(|scaled| scaled.direction()),
    };
    if !is_useful(tangent) || !is_useful(bitangent) {
        return Triangle::Unsure;
    }
    let size = tangent.0.iter().map(|x| x.abs()).sum();
    Triangle::Adds { side: usize::from(area < 0.0), tangent, bitangent, size }
}

/// The area as the shader computes it, without fused operations, so that it is exactly 0 for collinear UVs.
fn area_in_floats([a, b, c]: [[f32; 2]; 3]) -> f32 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A derivative times the UV area, and M.
#[derive(Clone, Copy)]
struct Scaled {
    value: V3,
    products: f64,
}

impl Scaled {
    /// x a - y b.
    fn new([x, y]: [f64; 2], a: V3, b: V3) -> Self {
        let value = [0, 1, 2].map(|i| x * a[i] - y * b[i]);
        Self { value, products: x.abs() * length(a) + y.abs() * length(b) }
    }

    fn size(&self) -> f64 {
        length(self.value)
    }

    /// Its direction, and the error of that in floats.
    fn direction(&self) -> (V3, f64) {
        let size = self.size();
        (self.value.map(|x| x / size), 8.0 * U * self.products / size + UNIT)
    }

    /// Its quotient by the area, and the error of that in floats.
    fn over(&self, area: f64, area_error: f64) -> (V3, f64) {
        let share = area_error / area;
        let error = ((share + 7.0 * U) * self.size() + 5.0 * U * self.products) / area;
        (self.value.map(|x| x / area), error / (1.0 - share))
    }
}

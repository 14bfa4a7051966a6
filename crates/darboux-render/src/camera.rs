//! From the scene to the picture.

use crate::algebra::Matrix;

/// Degrees from the lower to the upper edge.
const FIELD: f64 = 35.0;
/// The part of the picture that stays empty around the model.
const MARGIN: f64 = 0.04;

type V3 = [f64; 3];

/// Where a model is seen from. The default is three quarters from the front, a little from above, all in view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Degrees around the model: 0 sees its front, from +z, 90 its left, from +x.
    pub yaw: f64,
    /// Degrees above the horizon, from -90 to 90.
    pub pitch: f64,
    /// How many times nearer than where all is in view; above 0.
    pub zoom: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self { yaw: 30.0, pitch: 20.0, zoom: 1.0 }
    }
}

/// The least and greatest coordinates of what is to be seen.
pub type Bounds = [V3; 2];

/// How the picture is seen: a point of the scene comes to the eye's space by `scale * turn * (point - center)`, and to the picture by
/// `projection`.
pub struct Sight {
    /// What becomes the origin of the eye's space.
    pub center: V3,
    /// Makes the model's size about 1, so that no coordinates of files are too large or too small.
    pub scale: f64,
    /// The rows of a rotation: right, up, towards the eye.
    pub turn: [V3; 3],
    /// How far the eye is from the origin, along the third row of the rotation.
    pub distance: f64,
    /// The columns of a matrix to clip space.
    pub projection: [[f32; 4]; 4],
}

impl Camera {
    /// The sight that frames the corners of a box. `aspect`: width by height.
    pub fn facing(&self, bounds: Bounds, aspect: f64) -> Sight {
        let (center, scale) = middle(bounds);
        let turn = self.turn();
        let up = (0.5 * FIELD).to_radians().tan();
        let slopes = [up * aspect, up].map(|slope| slope * (1.0 - MARGIN));
        let corners = corners(bounds).map(|corner| turned(turn, scaled(minus(corner, center), scale)));
        // Along x, and along y, two planes through the eye touch the box: x + slope z and -x + slope z are greatest there.
        let touch = |axis: usize, side: f64| {
            corners
                .iter()
                .map(|corner| side * corner[axis] + slopes[axis] * corner[2])
                .fold(f64::MIN, f64::max)
        };
        let [x, y] = [0, 1].map(|axis| [touch(axis, 1.0), touch(axis, -1.0)]);
        let needed = (0.5 * (x[0] + x[1]) / slopes[0]).max(0.5 * (y[0] + y[1]) / slopes[1]);
        let distance = needed.max(1e-3) / self.zoom;
        let aside = [0.5 * (x[0] - x[1]), 0.5 * (y[0] - y[1])];
        let center = [0, 1, 2].map(|i| center[i] + (aside[0] * turn[0][i] + aside[1] * turn[1][i]) / scale);
        let depth = |f: fn(f64, f64) -> f64| corners.map(|corner| distance - corner[2]).into_iter().reduce(f);
        let far = depth(f64::max).unwrap_or(1.0).max(1e-3) * 1.01;
        let near = (depth(f64::min).unwrap_or(0.0) * 0.99).max(far * 1e-3);
        Sight { center, scale, turn, distance, projection: perspective(up, aspect, near, far, distance) }
    }

    fn turn(&self) -> [V3; 3] {
        let ([sy, cy], [sp, cp]) = (sine_cosine(self.yaw), sine_cosine(self.pitch));
        [[cy, 0.0, -sy], [-sp * sy, cp, -sp * cy], [cp * sy, sp, cp * cy]]
    }
}

/// The sight of a UV layout, straight on.
pub fn flat(bounds: Bounds, aspect: f64) -> Sight {
    let (center, scale) = middle(bounds);
    let half = [0, 1].map(|i| 0.5 * scale * (bounds[1][i] - bounds[0][i]) / (1.0 - MARGIN));
    let up = half[1].max(half[0] / aspect).max(1e-6);
    let mut projection = [[0.0; 4]; 4];
    [projection[0][0], projection[1][1]] = [1.0 / (up * aspect), 1.0 / up].map(|x| x as f32);
    // All at one depth.
    (projection[3][2], projection[3][3]) = (0.5, 1.0);
    let turn = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Sight { center, scale, turn, distance: 1.0, projection }
}

/// From the eye's space, whose origin is `distance` before the eye, to clip space with depths from 0 to 1.
fn perspective(up: f64, aspect: f64, near: f64, far: f64, distance: f64) -> [[f32; 4]; 4] {
    let a = far / (far - near);
    let columns = [
        [1.0 / (up * aspect), 0.0, 0.0, 0.0],
        [0.0, 1.0 / up, 0.0, 0.0],
        [0.0, 0.0, -a, -1.0],
        [0.0, 0.0, a * (distance - near), distance],
    ];
    columns.map(|column| column.map(|x| x as f32))
}

/// The centre of a box, and what makes half of its diagonal 1.
fn middle([least, most]: Bounds) -> (V3, f64) {
    let center = [0, 1, 2].map(|i| 0.5 * (least[i] + most[i]));
    let radius = minus(most, center).map(|x| x * x).iter().sum::<f64>().sqrt();
    (center, if radius > 0.0 { 1.0 / radius } else { 1.0 })
}

fn corners([least, most]: Bounds) -> [V3; 8] {
    [0, 1, 2, 3, 4, 5, 6, 7]
        .map(|bits: usize| [0, 1, 2].map(|i| if bits >> i & 1 == 0 { least[i] } else { most[i] }))
}

/// Exact at right angles.
fn sine_cosine(degrees: f64) -> [f64; 2] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    [sine, cosine].map(|x| if x.abs() < 1e-15 { 0.0 } else { x })
}

fn minus(a: V3, b: V3) -> V3 {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn scaled(v: V3, by: f64) -> V3 {
    v.map(|x| x * by)
}

fn turned(turn: [V3; 3], v: V3) -> V3 {
    turn.map(|row| (0..3).map(|i| row[i] * v[i]).sum())
}

impl Sight {
    /// Where a mesh's point comes to in the eye's space; `matrix` goes from the mesh to the scene.
    pub fn place(&self, [a, b, c, d]: &Matrix, point: [f32; 3]) -> V3 {
        let [x, y, z] = point.map(f64::from);
        let in_scene = [0, 1, 2].map(|i| a[i] * x + b[i] * y + c[i] * z + d[i]);
        turned(self.turn, scaled(minus(in_scene, self.center), self.scale))
    }

    /// The direction in the eye's space.
    pub fn turned(&self, direction: V3) -> V3 {
        turned(self.turn, direction)
    }

    /// The columns of the matrix from a mesh to the eye's space, where `matrix` goes from the mesh to the scene.
    pub fn to_eye(&self, matrix: &Matrix) -> [[f32; 4]; 4] {
        let mut eye = matrix.map(|[x, y, z, w]| {
            let [x, y, z] = turned(self.turn, scaled([x, y, z], self.scale));
            [x, y, z, w]
        });
        let center = turned(self.turn, scaled(self.center, self.scale));
        (0..3).for_each(|i| eye[3][i] -= center[i]);
        eye.map(|column| column.map(|x| x as f32))
    }
}

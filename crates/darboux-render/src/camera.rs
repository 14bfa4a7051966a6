//! The camera: computes the transform from the scene to the picture that brings the whole model into view.

use darboux::internal::vectors::double::{D3 as V3, length, sub};

use crate::algebra::Matrix;

/// The vertical field of view in degrees.
const FIELD_OF_VIEW: f64 = 35.0;
/// The fraction of the picture that stays empty around the model.
const MARGIN: f64 = 0.04;
/// The iterations that centre the model. Each visits all points.
const CENTERING_STEPS: usize = 4;

/// The position of the camera, which looks at the model. The default sees the whole model from its front
/// left, slightly from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Degrees around the model: 0 looks from +z at its front, 90 from +x at its left side.
    pub yaw: f64,
    /// Degrees above the horizon, from -90 to 90.
    pub pitch: f64,
    /// The distance at which the whole model is in view, divided by the distance of the camera. It is above
    /// 0.
    pub zoom: f64,
}

/// A camera at a point of the scene, as links of the viewer have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The position of the camera.
    pub eye: [f64; 3],
    /// The point in the middle of the picture, at another place than the eye.
    pub target: [f64; 3],
}

impl Look {
    /// The transform of this camera. `aspect`: width divided by height.
    pub fn transform(&self, bounds: Bounds, aspect: f64) -> ViewTransform {
        let (_, scale) = center_and_scale(bounds);
        let rotation = rotation_towards(sub(self.eye, self.target));
        let up = (0.5 * FIELD_OF_VIEW).to_radians().tan();
        let distance = length(sub(self.eye, self.target)) * scale;
        let projection =
            projection([self.target, bounds[0], bounds[1]], scale, rotation, distance, [up, aspect]);
        ViewTransform { center: self.target, scale, rotation, distance, projection }
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self { yaw: 30.0, pitch: 20.0, zoom: 1.0 }
    }
}

/// The smallest and largest coordinates of the subject.
pub type Bounds = [V3; 2];

/// The transform from the scene to eye space, `scale * rotation * (point - center)`, and from there to clip
/// space, `projection`.
pub struct ViewTransform {
    /// The point of the scene that is the origin of eye space.
    pub center: V3,
    /// Scales the model to a size of about 1, so that coordinates of any size fit floats.
    pub scale: f64,
    /// The rows of the rotation: right, up, towards the eye.
    pub rotation: [V3; 3],
    /// The distance of the eye from the origin of eye space, along its z axis.
    pub distance: f64,
    /// The columns of the projection matrix.
    pub projection: [[f32; 4]; 4],
}

impl Camera {
    /// The transform in which all points are in view, with equal margins at opposite edges. `aspect`: width
    /// divided by height.
    ///
    /// `bounds`: the box around the points. `visit_points`: calls its argument with every point.
    pub fn frame(
        &self,
        bounds: Bounds,
        aspect: f64,
        visit_points: impl Fn(&mut dyn FnMut(V3)),
    ) -> ViewTransform {
        let (center, scale) = center_and_scale(bounds);
        let rotation = self.rotation();
        let up = (0.5 * FIELD_OF_VIEW).to_radians().tan();
        let slopes = [up * aspect, up].map(|slope| slope * (1.0 - MARGIN));
        // For each axis, two planes through the eye touch the points where x + slope z and -x + slope z are
        // largest. The sum of these distances determines how far the eye has to be away to see
        // between slopes -slope and slope, the difference its shift.
        let touch = |slopes: [f64; 2]| {
            let mut touch = [[f64::MIN; 2]; 2];
            visit_points(&mut |point| {
                let point = rotated(rotation, scaled(sub(point, center), scale));
                for (axis, touch) in touch.iter_mut().enumerate() {
                    let along_slope = slopes[axis] * point[2];
                    touch[0] = touch[0].max(point[axis] + along_slope);
                    touch[1] = touch[1].max(along_slope - point[axis]);
                }
            });
            touch.map(|[right, left]| [0.5 * (right + left), 0.5 * (right - left)])
        };
        let mut touched = touch(slopes);
        let distance = (touched[0][0] / slopes[0]).max(touched[1][0] / slopes[1]).max(1e-3);
        // The other axis has wider margins. Iterate its slopes to make both margins equal.
        for _ in 0..CENTERING_STEPS {
            touched = touch(touched.map(|[half_sum, _]| half_sum / distance));
        }
        let shift = touched.map(|[_, half_difference]| half_difference);
        let distance = distance / self.zoom;
        let center =
            [0, 1, 2].map(|i| center[i] + (shift[0] * rotation[0][i] + shift[1] * rotation[1][i]) / scale);
        let projection = projection([center, bounds[0], bounds[1]], scale, rotation, distance, [up, aspect]);
        ViewTransform { center, scale, rotation, distance, projection }
    }

    fn rotation(&self) -> [V3; 3] {
        let ([sy, cy], [sp, cp]) = (sine_cosine(self.yaw), sine_cosine(self.pitch));
        [[cy, 0.0, -sy], [-sp * sy, cp, -sp * cy], [cp * sy, sp, cp * cy]]
    }
}

/// The projection in which the depths of a box are in view. `points`: the origin of eye space and the box's
/// least and largest coordinates.
fn projection(
    [center, least, most]: [V3; 3],
    scale: f64,
    rotation: [V3; 3],
    distance: f64,
    [up, aspect]: [f64; 2],
) -> [[f32; 4]; 4] {
    let corners = corners([least, most]).map(|corner| rotated(rotation, scaled(sub(corner, center), scale)));
    let depth = |f: fn(f64, f64) -> f64| corners.map(|corner| distance - corner[2]).into_iter().reduce(f);
    let far = depth(f64::max).unwrap_or(1.0).max(1e-3) * 1.01;
    let near = (depth(f64::min).unwrap_or(0.0) * 0.99).max(far * 1e-3);
    perspective(up, aspect, near, far, distance)
}

/// The rows right, up and towards the eye. `towards`: the direction to the eye, which is not zero.
fn rotation_towards(towards: V3) -> [V3; 3] {
    let towards = unit(towards);
    let [x, y, z] = towards;
    // Seen from straight above or below, any direction is right.
    let right = if x == 0.0 && z == 0.0 { [1.0, 0.0, 0.0] } else { unit([z, 0.0, -x]) };
    let up = [y * right[2] - z * right[1], z * right[0] - x * right[2], x * right[1] - y * right[0]];
    [right, up, towards]
}

fn unit(v: V3) -> V3 {
    let size = length(v);
    v.map(|x| x / size)
}

/// The orthographic transform of a UV layout.
pub fn flat(bounds: Bounds, aspect: f64) -> ViewTransform {
    let (center, scale) = center_and_scale(bounds);
    let half = [0, 1].map(|i| 0.5 * scale * (bounds[1][i] - bounds[0][i]) / (1.0 - MARGIN));
    let up = half[1].max(half[0] / aspect).max(1e-6);
    let mut projection = [[0.0; 4]; 4];
    [projection[0][0], projection[1][1]] = [1.0 / (up * aspect), 1.0 / up].map(|x| x as f32);
    // All points have the same depth.
    (projection[3][2], projection[3][3]) = (0.5, 1.0);
    let rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    ViewTransform { center, scale, rotation, distance: 1.0, projection }
}

/// The projection from eye space, whose origin is at `distance` from the eye, to clip space with depths from
/// 0 to 1.
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

/// The centre of a box, and the scale that makes half of its diagonal 1.
fn center_and_scale([min, max]: Bounds) -> (V3, f64) {
    let center = [0, 1, 2].map(|i| 0.5 * (min[i] + max[i]));
    let radius = length(sub(max, center));
    (center, if radius > 0.0 { 1.0 / radius } else { 1.0 })
}

fn corners([min, max]: Bounds) -> [V3; 8] {
    [0, 1, 2, 3, 4, 5, 6, 7]
        .map(|bits: usize| [0, 1, 2].map(|i| if bits >> i & 1 == 0 { min[i] } else { max[i] }))
}

/// The sine and cosine, exactly 0 or 1 at multiples of 90 degrees.
fn sine_cosine(degrees: f64) -> [f64; 2] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    [sine, cosine].map(|x| if x.abs() < 1e-15 { 0.0 } else { x })
}

fn scaled(v: V3, by: f64) -> V3 {
    v.map(|x| x * by)
}

fn rotated(rotation: [V3; 3], v: V3) -> V3 {
    rotation.map(|row| (0..3).map(|i| row[i] * v[i]).sum())
}

impl ViewTransform {
    /// A point of a mesh in eye space. `matrix`: from the mesh to the scene.
    pub fn point(&self, [a, b, c, d]: &Matrix, point: [f32; 3]) -> V3 {
        let [x, y, z] = point.map(f64::from);
        let in_scene = [0, 1, 2].map(|i| a[i] * x + b[i] * y + c[i] * z + d[i]);
        rotated(self.rotation, scaled(sub(in_scene, self.center), self.scale))
    }

    /// A direction of the scene in eye space.
    pub fn direction(&self, direction: V3) -> V3 {
        rotated(self.rotation, direction)
    }

    /// The columns of the matrix from a mesh to eye space. `matrix`: from the mesh to the scene.
    pub fn to_eye(&self, matrix: &Matrix) -> [[f32; 4]; 4] {
        let mut eye = matrix.map(|[x, y, z, w]| {
            let [x, y, z] = rotated(self.rotation, scaled([x, y, z], self.scale));
            [x, y, z, w]
        });
        let center = rotated(self.rotation, scaled(self.center, self.scale));
        (0..3).for_each(|i| eye[3][i] -= center[i]);
        eye.map(|column| column.map(|x| x as f32))
    }
}

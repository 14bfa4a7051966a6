//! Frames under transforms, against finite differences on the transformed surface.

use darboux::Transform;
use darboux::internal::vectors::double::{cross, dot, sub};
use darboux_tests::Dice;

type D3 = [f64; 3];

fn unit(v: D3) -> D3 {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

fn distance(a: D3, b: D3) -> f64 {
    let d = sub(a, b);
    dot(d, d).sqrt()
}

/// A bumpy torus whose UV lines are not perpendicular.
fn surface([u, v]: [f64; 2]) -> D3 {
    let (a, b) = (u + 0.3 * v, v);
    let radius = 2.0 + (0.7 + 0.1 * (3.0 * u).sin()) * b.cos();
    [radius * a.cos(), radius * a.sin(), 0.7 * b.sin() + 0.2 * (2.0 * u).cos()]
}

/// The derivatives of a surface by central differences.
fn derivatives(of: impl Fn([f64; 2]) -> D3, [u, v]: [f64; 2]) -> [D3; 2] {
    let step = 1e-5;
    let difference = |a, b| sub(of(a), of(b)).map(|x| x / (2.0 * step));
    [difference([u + step, v], [u - step, v]), difference([u, v + step], [u, v - step])]
}

/// The outward unit normal, the tangent perpendicular to it, and the sign.
fn frame([du, dv]: [D3; 2], outward: D3) -> (D3, [f64; 4]) {
    let normal = unit(cross(du, dv));
    let normal = if dot(normal, outward) < 0.0 { normal.map(|x| -x) } else { normal };
    let [x, y, z] = unit(du);
    let w = dot(cross(normal, du), dv).signum();
    (normal, [x, y, z, w])
}

struct Random(Dice<'static>);

impl Random {
    fn vector(&mut self) -> D3 {
        [self.0.uniform_f64(), self.0.uniform_f64(), self.0.uniform_f64()]
    }

    /// The columns of a random matrix that scales by 0.1 to 10, shears, and mirrors every other time.
    fn matrix(&mut self, mirrors: bool) -> [D3; 3] {
        loop {
            let columns = [self.vector(), self.vector(), self.vector()].map(|column| {
                let factor = 10f64.powf(self.0.uniform_f64());
                column.map(|x| factor * x)
            });
            let determinant = dot(columns[0], cross(columns[1], columns[2]));
            let sizes: f64 = columns.iter().map(|&column| dot(column, column).sqrt()).product();
            if determinant.abs() > 0.05 * sizes && (determinant < 0.0) == mirrors {
                return columns;
            }
        }
    }
}

fn product([x, y, z]: [D3; 3], v: D3) -> D3 {
    [0, 1, 2].map(|i| x[i] * v[0] + y[i] * v[1] + z[i] * v[2])
}

fn single<const N: usize>(v: [f64; N]) -> [f32; N] {
    v.map(|x| x as f32)
}

/// Transforms the frame of a random point and compares it with that of the transformed surface.
fn check(random: &mut Random, transform: &Transform, matrix: [D3; 3]) {
    let uv = [4.0 * random.0.uniform_f64(), 4.0 * random.0.uniform_f64()];
    // Outwards: towards the side of du x dv, whatever the transform does to it.
    let before = derivatives(surface, uv);
    let outward = cross(before[0], before[1]);
    let flipped = random.0.uniform_f64() < 0.0;
    let outward = if flipped { outward.map(|x| -x) } else { outward };
    let (normal, tangent) = frame(before, outward);

    let after = derivatives(|uv| product(matrix, surface(uv)), uv);
    let (expected_normal, expected_tangent) = frame(after, product(matrix, outward));

    let (normal, [x, y, z, w]) = transform.frame(single(normal), single(tangent));
    let [tx, ty, tz, tw] = expected_tangent;
    assert!(distance(normal.map(f64::from), expected_normal) < 1e-4, "{normal:?} {expected_normal:?}");
    assert!(distance([x, y, z].map(f64::from), [tx, ty, tz]) < 1e-4, "{x} {y} {z} {expected_tangent:?}");
    assert_eq!(f64::from(w), tw);
}

#[test]
fn frames_follow_the_transformed_surface() {
    let mut random = Random(Dice::from_seed(1));
    for step in 0..20_000 {
        let matrix = random.matrix(step % 2 == 0);
        let transform = Transform::new(matrix.map(single));
        assert_eq!(transform.orientation(), if step % 2 == 0 { -1.0 } else { 1.0 });
        check(&mut random, &transform, matrix);
    }
}

#[test]
fn frames_follow_a_skin() {
    let mut random = Random(Dice::from_seed(2));
    for _ in 0..5_000 {
        let bones = [random.matrix(false), random.matrix(false), random.matrix(true), random.matrix(false)];
        let weights = [0.6, 0.2, 0.05, 0.15];
        let mut blend = [[0.0; 3]; 3];
        for (bone, weight) in bones.iter().zip(weights) {
            for (total, x) in blend.iter_mut().flatten().zip(bone.iter().flatten()) {
                *total += weight * x;
            }
        }
        let sizes: f64 = blend.iter().map(|&column| dot(column, column).sqrt()).product();
        if dot(blend[0], cross(blend[1], blend[2])).abs() > 0.05 * sizes {
            let bones = bones.map(|bone| bone.map(single)).into_iter().zip(weights.map(|x| x as f32));
            check(&mut random, &Transform::blended(bones), blend);
        }
    }
}

#[test]
fn uniform_scale_does_not_matter_however_far() {
    let columns = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
    let (normal, tangent) = ([0.0, 0.6, 0.8], [1.0, 0.0, 0.0, -1.0]);
    let expected = Transform::new(columns).frame(normal, tangent);
    for exponent in [-120, -60, 60, 120] {
        let factor = 2f32.powi(exponent);
        let scaled = columns.map(|column| column.map(|x| factor * x));
        assert_eq!(Transform::new(scaled).frame(normal, tangent), expected, "2^{exponent}");
    }
}

#[test]
fn what_a_transform_flattens_keeps_a_frame() {
    let (normal, tangent) = ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]);
    let flat = Transform::new([[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]]);
    assert_eq!(flat.frame(normal, tangent), (normal, tangent));
    for columns in [[[0.0; 3]; 3], [[f32::NAN; 3]; 3], [[0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]] {
        let (normal, [x, y, z, w]) = Transform::new(columns).frame(normal, tangent);
        assert_eq!((normal, w), ([0.0, 0.0, 1.0], 1.0));
        assert_eq!(x * x + y * y, 1.0);
        assert_eq!(z, 0.0);
    }
}

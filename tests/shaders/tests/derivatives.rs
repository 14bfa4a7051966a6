//! Compares frames from screen-space derivatives with the exact frames of surfaces that are linear on the
//! screen.

use darboux::encode::tangent_from_diamond;
use darboux_shader_tests::samples::{Random, ULP, bits, floats, many};
use darboux_shader_tests::vector::{D3, cross, dot, doubles, length, scale, unit};
use darboux_shader_tests::{Case, check_in_quads};

const COUNT: usize = 1 << 13;
const TANGENT: &str = "got4(0u, tangent_from_derivatives(given3(0u), spread3(3u), spread2(9u)));";
const FRAME: &str = "got_frame(0u, cotangent_frame_from_derivatives(given3(0u), spread3(3u), spread2(9u)));";

/// A normal, the steps of position and UV per pixel to the right and down, and bounds of the products of
/// these steps.
struct Screen {
    normal: D3,
    position: [D3; 2],
    uv: [[f64; 2]; 2],
    largest: f64,
}

impl Screen {
    fn new(sample: &[u32]) -> Self {
        let position = [3, 6].map(|start| doubles(floats(sample, start)));
        let uv = [9, 11].map(|start| doubles(floats(sample, start)));
        let largest = |numbers: &[f64]| numbers.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let largest = largest(&position.concat()) * largest(&uv.concat());
        Self { normal: doubles(floats(sample, 0)), position, uv, largest }
    }

    fn determinant(&self) -> f64 {
        self.uv[0][0] * self.uv[1][1] - self.uv[0][1] * self.uv[1][0]
    }

    /// The derivatives of position by u and by v.
    fn along(&self) -> [D3; 2] {
        let ([x, y], [[ux, vx], [uy, vy]]) = (self.position, self.uv);
        let combine = |a: f64, b: f64| [0, 1, 2].map(|k| (a * x[k] + b * y[k]) / self.determinant());
        [combine(vy, -vx), combine(-uy, ux)]
    }

    /// The vector in the plane of the normal whose dot products with the steps are `gains`, by Cramer's rule.
    fn gradient(&self, gains: [f64; 2]) -> D3 {
        let [x, y] = self.position;
        let volume = dot(x, cross(y, self.normal));
        let (by_x, by_y) = (cross(y, self.normal), cross(self.normal, x));
        [0, 1, 2].map(|k| (gains[0] * by_x[k] + gains[1] * by_y[k]) / volume)
    }
}

/// Random steps of any size, skew and handedness on the screen and in UVs, on a surface that is not
/// perpendicular to its normal.
fn sample(random: &mut Random) -> Vec<f32> {
    loop {
        let factor = 10f32.powf(3.0 * random.number());
        let steps = [(); 2].map(|()| random.direction().map(|x| factor * x));
        let uv = [(); 4].map(|()| 0.01 * random.number());
        let sample = [random.direction(), steps[0], steps[1]].concat();
        let screen = Screen::new(&bits(&[&sample[..], &uv].concat()));
        let [x, y] = screen.position;
        let volume = dot(screen.normal, cross(x, y)).abs();
        if volume > 0.2 * length(x) * length(y) && screen.determinant().abs() > 1e-5 {
            return [&sample[..], &uv].concat();
        }
    }
}

/// Bound: derivatives have an error of 2 ulp of the larger step, so the difference of two products has 16 ulp
/// of the largest product.
#[test]
fn tangents_of_triangles() {
    check_in_quads(Case {
        name: "tangent_from_derivatives",
        body: TANGENT,
        samples: many(COUNT, 1, sample),
        expected: &|sample| {
            let screen = Screen::new(sample);
            let [along_u, along_v] = screen.along();
            let normal = screen.normal;
            let flat = dot(normal, along_u);
            let rest = [0, 1, 2].map(|k| along_u[k] - flat * normal[k]);
            let tangent = unit(rest);
            let sign = dot(cross(normal, tangent), along_v).signum();
            let size = screen.determinant().abs() * length(rest);
            let error = 16.0 * screen.largest + 6.0 * screen.determinant().abs() * length(along_u);
            ([&tangent[..], &[sign]].concat(), (2.0 * 3f64.sqrt() * error / size + 10.0) * ULP)
        },
    });
}

/// Bound: as above, plus a cross product.
#[test]
fn gradients_of_triangles() {
    check_in_quads(Case {
        name: "cotangent_frame_from_derivatives",
        body: FRAME,
        samples: many(COUNT, 2, sample),
        expected: &|sample| {
            let screen = Screen::new(sample);
            let gradients = [0, 1].map(|k| screen.gradient(screen.uv.map(|gain| gain[k])));
            let longer = length(gradients[0]).max(length(gradients[1]));
            let [tangent, bitangent] = gradients.map(|gradient| scale(1.0 / longer, gradient));
            let [x, y] = screen.position;
            let size = longer * dot(screen.normal, cross(x, y)).abs();
            let bound = (2.0 * 3f64.sqrt() * 24.0 * screen.largest / size + 10.0) * ULP;
            ([tangent, bitangent, screen.normal].concat(), bound)
        },
    });
}

#[test]
fn without_uvs_there_is_some_frame() {
    let mut random = Random::new(3);
    let samples: Vec<_> = (0..256).map(|_| bits(&[&sample(&mut random)[..9], &[0.0; 4]].concat())).collect();
    let place = |sample: &[u32], code: u16| {
        let [x, y, z, _] = tangent_from_diamond(floats(sample, 0), code);
        doubles([x, y, z])
    };
    check_in_quads(Case {
        name: "tangent_from_derivatives of nothing",
        body: TANGENT,
        samples: samples.clone(),
        expected: &|sample| ([&place(sample, 0)[..], &[1.0]].concat(), 52.0 * ULP),
    });
    check_in_quads(Case {
        name: "cotangent_frame_from_derivatives of nothing",
        body: FRAME,
        samples,
        expected: &|sample| {
            let normal = doubles(floats(sample, 0));
            ([place(sample, 0), place(sample, 1 << 14), normal].concat(), 52.0 * ULP)
        },
    });
}

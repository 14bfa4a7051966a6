//! Compares transformed frames, by matrices and skins, with darboux::Transform.

use darboux::Transform;
use darboux_shader_tests::samples::{Random, ULP, bits, floats, many};
use darboux_shader_tests::vector::{D3, cross, dot, doubles, length, product, scale, unit};
use darboux_shader_tests::{Case, check};

const FRAME: &str =
    "got_vertex_frame(0u, transformed_frame(frame_transform(given_map(0u)), given_vertex_frame(9u)));";

/// A matrix that scales by 0.1 to 10 along random axes and shears. Every other one mirrors.
fn matrix(random: &mut Random) -> Vec<f32> {
    loop {
        let columns = [(); 3].map(|()| {
            let factor = 10f32.powf(random.number());
            random.direction().map(|x| factor * x)
        });
        let [x, y, z] = columns.map(doubles);
        if dot(x, cross(y, z)).abs() > 0.05 * length(x) * length(y) * length(z) {
            return columns.concat();
        }
    }
}

fn frame(random: &mut Random) -> Vec<f32> {
    let (normal, tangent) = random.frame();
    [&normal[..], &tangent].concat()
}

fn singles(sample: &[u32], start: usize) -> [[f32; 3]; 3] {
    [0, 3, 6].map(|k| floats(sample, start + k))
}

/// The frame at `start`, transformed by the core, with a bound. The elements of the matrix, at most 1, have
/// an error of `of_matrix`; a cofactor has four times that plus 4 ulp, an image 3 of either; a normalised
/// vector has twice its error divided by its length.
fn answer(
    transform: &Transform,
    columns: [D3; 3],
    sample: &[u32],
    start: usize,
    of_matrix: f64,
) -> (Vec<f64>, f64) {
    let (normal, tangent) = (floats(sample, start), floats(sample, start + 3));
    let (n, t) = transform.frame(normal, tangent);

    let largest = columns.iter().flatten().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let [x, y, z] = columns.map(|column| scale(1.0 / largest, column));
    let image = product([cross(y, z), cross(z, x), cross(x, y)], doubles(normal));
    let of_normal = 2.0 * 3.0 * (4.0 * of_matrix + 4.0 + 4.0) / length(image) + 10.0;
    let image = product([x, y, z], doubles([tangent[0], tangent[1], tangent[2]]));
    let of_image = 3.0 * (of_matrix + 4.0);
    let of_rest = of_image + 2.0 * length(image) * (of_normal + 4.0);
    let rest = length(cross(image, doubles(n)));
    let of_tangent = 2.0 * of_rest / rest + 10.0;
    ([doubles(n).to_vec(), doubles(t).to_vec()].concat(), of_normal.max(of_tangent) * ULP)
}

#[test]
fn frames_under_matrices() {
    check(&Case {
        name: "transformed_frame",
        body: FRAME,
        samples: many(1 << 15, 1, |random| [matrix(random), frame(random)].concat()),
        expected: &|sample| {
            let columns = singles(sample, 0);
            answer(&Transform::new(columns), columns.map(doubles), sample, 9, 4.0)
        },
    });
    check(&Case {
        name: "transformed_normal",
        body: "got3(0u, transformed_normal(frame_transform(given_map(0u)), given3(9u)));",
        samples: many(1 << 15, 2, |random| [matrix(random), frame(random)].concat()),
        expected: &|sample| {
            let columns = singles(sample, 0);
            let (frame, bound) = answer(&Transform::new(columns), columns.map(doubles), sample, 9, 4.0);
            (frame[..3].to_vec(), bound)
        },
    });
    check(&Case {
        name: "orientation",
        body: "got1(0u, frame_transform(given_map(0u)).orientation);",
        samples: many(1 << 12, 3, matrix),
        expected: &|sample| (vec![Transform::new(singles(sample, 0)).orientation().into()], 0.0),
    });
}

/// The mean of three bones, each of which may mirror, if it is at least a quarter of their size.
#[test]
fn frames_under_skins() {
    let weights = [0.5f32, 0.3, 0.2];
    let blend = |sample: &[u32]| {
        let bones = [0, 9, 18].map(|start| singles(sample, start).map(doubles));
        let mix = |column: usize, k: usize| {
            (0..3).map(|bone| f64::from(weights[bone]) * bones[bone][column][k]).sum()
        };
        [0, 1, 2].map(|column| [0, 1, 2].map(|k| mix(column, k)))
    };
    let is_fair = |sample: &Vec<u32>| {
        let [x, y, z]: [D3; 3] = blend(sample);
        let largest =
            |components: &[f64]| components.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let bones = doubles(floats::<27>(sample, 0));
        largest(&[x, y, z].concat()) > 0.25 * largest(&bones)
            && dot(x, cross(y, z)).abs() > 0.05 * length(x) * length(y) * length(z)
    };
    let sample = |random: &mut Random| {
        [matrix(random), matrix(random), matrix(random), frame(random), weights.to_vec()].concat()
    };
    let mut samples = many(1 << 15, 4, sample);
    samples.retain(is_fair);
    assert!(samples.len() > 1 << 13);
    check(&Case {
        name: "with_bone",
        body: "got_vertex_frame(0u, transformed_frame(frame_transform(with_bone(with_bone(with_bone(linear_map_of_no_bones(), \
               given_map(0u), given1(34u)), given_map(9u), given1(35u)), given_map(18u), given1(36u))), given_vertex_frame(27u)));",
        samples,
        expected: &|sample| {
            let bones = [0, 9, 18].map(|start| singles(sample, start)).into_iter().zip(weights);
            // Three products, each at most four times the largest element of the blend, and their sums.
            answer(&Transform::blended(bones), blend(sample), sample, 27, 4.0 * 6.0 + 4.0)
        },
    });
}

#[test]
fn what_a_transform_flattens_keeps_a_frame() {
    let frame = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, -1.0];
    let flat = [2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    let without_x = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    check(&Case {
        name: "flattened",
        body: FRAME,
        samples: [flat, without_x, [0.0; 9]].map(|columns| bits(&[&columns[..], &frame].concat())).to_vec(),
        expected: &|sample| {
            let (normal, tangent) =
                Transform::new(singles(sample, 0)).frame(floats(sample, 9), floats(sample, 12));
            ([&doubles(normal)[..], &doubles(tangent)].concat(), 4.0 * ULP)
        },
    });
}

#[test]
fn uniform_scale_does_not_matter_however_far() {
    let (normal, [x, y, z, w]) = ([0.0, 0.6, 0.8], [1.0, 0.0, 0.0, -1.0]);
    let sample = |factor: f32| {
        let columns = [0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0].map(|component| factor * component);
        bits(&[&columns[..], &normal, &[x, y, z, w]].concat())
    };
    let factors = [-120, -60, 0, 60, 120].map(|exponent| 2f32.powi(exponent));
    let turned = |[x, y, z]: D3| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z];
    let (normal, tangent) = (turned(unit(doubles(normal))), turned([1.0, 0.0, 0.0]));
    check(&Case {
        name: "scaled far",
        body: FRAME,
        samples: factors.map(sample).to_vec(),
        expected: &|_| ([&normal[..], &tangent, &[-1.0]].concat(), 16.0 * ULP),
    });
    check(&Case {
        name: "scaled far through the origin",
        body: FRAME,
        samples: factors.map(|factor| sample(-factor)).to_vec(),
        expected: &|_| {
            ([scale(-1.0, normal), scale(-1.0, tangent), [1.0; 3]].concat()[..7].to_vec(), 16.0 * ULP)
        },
    });
}

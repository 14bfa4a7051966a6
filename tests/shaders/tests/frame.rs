//! Compares frames at vertices and pixels with double precision.

use darboux::encode::tangent_from_diamond;
use darboux_shader_tests::samples::{Random, ULP, bits, columns, floats, many};
use darboux_shader_tests::vector::{D3, cross, dot, doubles, length, product, scale, unit};
use darboux_shader_tests::{Case, check};

const COUNT: usize = 1 << 15;

/// A normal and a tangent, interpolated between two vertices with one sign.
fn interpolated(random: &mut Random) -> Vec<f32> {
    let t = random.fraction();
    let ((n, a), (m, b)) = (random.frame(), random.frame());
    let pairs = n.iter().zip(&m).chain(a[..3].iter().zip(&b));
    pairs.map(|(a, b)| (1.0 - t) * a + t * b).chain([a[3]]).collect()
}

/// Three vectors of length at most 1, far from coplanar.
fn skewed(random: &mut Random) -> Vec<f32> {
    loop {
        let size = 0.2 + 0.8 * random.fraction();
        let v = [(); 3].map(|()| random.direction().map(|x| size * x));
        let [a, b, c] = v.map(doubles);
        if dot(a, cross(b, c)).abs() > 0.1 * length(a) * length(b) * length(c) {
            return v.concat();
        }
    }
}

fn bitangent(sample: &[u32]) -> D3 {
    let [normal, tangent] = [0, 3].map(|start| doubles(floats(sample, start)));
    scale(f32::from_bits(sample[6]).into(), cross(normal, tangent))
}

/// Bound: two products of at most 1, and their difference.
#[test]
fn bitangents() {
    check(&Case {
        name: "bitangent_of",
        body: "got3(0u, bitangent_of(given3(0u), given4(3u)));",
        samples: many(COUNT, 1, interpolated),
        expected: &|sample| (bitangent(sample).to_vec(), 4.0 * ULP),
    });
    check(&Case {
        name: "tangent_frame",
        body: "got_frame(0u, tangent_frame(given3(0u), given4(3u)));",
        samples: many(COUNT, 2, interpolated),
        expected: &|sample| {
            let [normal, tangent] = [0, 3].map(|start| doubles(floats(sample, start)));
            ([tangent, bitangent(sample), normal].concat(), 4.0 * ULP)
        },
    });
}

#[test]
fn columns_keep_their_places() {
    check(&Case {
        name: "tangent_frame_with_bitangent",
        body: "got_frame(0u, tangent_frame_with_bitangent(given3(6u), given3(0u), given3(3u)));",
        samples: many(COUNT, 3, skewed),
        expected: &|sample| (columns(sample, 0).concat(), 0.0),
    });
}

/// The perpendicular vectors are the positions 0 and 1 of the diamond encoding, with its bound.
#[test]
fn perpendiculars() {
    check(&Case {
        name: "tangent_frame_of_normal",
        body: "got_frame(0u, tangent_frame_of_normal(given3(0u)));",
        samples: many(COUNT, 4, |random| random.direction().to_vec()),
        expected: &|sample| {
            let normal = floats(sample, 0);
            let [first, second] = [0, 1 << 14].map(|code| {
                let [x, y, z, _] = tangent_from_diamond(normal, code);
                doubles([x, y, z])
            });
            ([first, second, doubles(normal)].concat(), 52.0 * ULP)
        },
    });
}

/// Bound: 3 ulp for the sum of squares, halved by the square root, plus 4.5, 2.5 and 1.
#[test]
fn unit_vectors() {
    let mut samples =
        many(COUNT, 5, |random| [random.direction().map(|x| 3.0 * x), [1.0, 2.0, 3.0]].concat());
    samples.push(bits(&[0.0, -0.0, 0.0, 1.0, 2.0, 3.0]));
    check(&Case {
        name: "unit_or",
        body: "got3(0u, unit_or(given3(0u), given3(3u)));",
        samples,
        expected: &|sample| {
            let v = doubles(floats(sample, 0));
            if length(v) > 0.0 { (unit(v).to_vec(), 10.0 * ULP) } else { (vec![1.0, 2.0, 3.0], 0.0) }
        },
    });
    check(&Case {
        name: "normalized_frame",
        body: "got_frame(0u, normalized_frame(given_frame(0u)));",
        samples: many(COUNT, 6, skewed),
        expected: &|sample| (columns(sample, 0).map(unit).concat(), 10.0 * ULP),
    });
}

fn in_plane(normal: D3, v: D3) -> D3 {
    let along = dot(normal, v);
    [0, 1, 2].map(|k| v[k] - along * normal[k])
}

/// Bound: each component of the projected unit vector has an error up to 6 ulp.
#[test]
fn directions_in_the_plane() {
    check(&Case {
        name: "unit_in_plane",
        body: "got3(0u, unit_in_plane(given3(0u), given3(3u)));",
        samples: many(COUNT, 7, |random| [random.direction(), random.direction()].concat()),
        expected: &|sample| {
            let [normal, v] = [0, 3].map(|start| doubles(floats(sample, start)));
            let rest = in_plane(normal, v);
            (unit(rest).to_vec(), (2.0 * 3f64.sqrt() * 6.0 / length(rest) + 10.0) * ULP)
        },
    });
    check(&Case {
        name: "unit_in_plane of nothing",
        body: "got3(0u, unit_in_plane(given3(0u), given1(3u) * given3(0u)));",
        samples: many(COUNT, 8, |random| {
            [&random.direction()[..], &[5.0 * random.number().round()]].concat()
        }),
        expected: &|sample| {
            let [x, y, z, _] = tangent_from_diamond(floats(sample, 0), 0);
            (doubles([x, y, z]).to_vec(), 52.0 * ULP)
        },
    });
}

/// Bound: the normal has an error of 10 ulp, so a vector in its plane has twice that plus 6.
#[test]
fn orthonormal_frames() {
    check(&Case {
        name: "orthonormal_frame",
        body: "got_frame(0u, orthonormal_frame(given_frame(0u)));",
        samples: many(COUNT, 9, skewed),
        expected: &|sample| {
            let [t, b, n] = columns(sample, 0);
            let normal = unit(n);
            let rest = in_plane(normal, unit(t));
            let tangent = unit(rest);
            let bitangent = cross(normal, tangent);
            let side = dot(bitangent, b).signum();
            let bound = 2.0 * 3f64.sqrt() * 26.0 / length(rest) + 24.0;
            ([tangent, scale(side, bitangent), normal].concat(), bound * ULP)
        },
    });
}

/// Bound: a sum of three products has an error of 5 ulp of its largest possible value.
#[test]
fn into_tangent_space_and_out() {
    let samples = || many(COUNT, 10, |random| [skewed(random), random.direction().to_vec()].concat());
    let v = |sample: &[u32]| doubles(floats(sample, 9));
    check(&Case {
        name: "from_tangent_space",
        body: "got3(0u, from_tangent_space(given_frame(0u), given3(9u)));",
        samples: samples(),
        expected: &|sample| (product(columns(sample, 0), v(sample)).to_vec(), 5.0 * 3f64.sqrt() * ULP),
    });
    check(&Case {
        name: "normal_to_surface",
        body: "got3(0u, normal_to_surface(given_frame(0u), given3(9u)));",
        samples: samples(),
        expected: &|sample| {
            let normal = product(columns(sample, 0), v(sample));
            (unit(normal).to_vec(), (2.0 * 3f64.sqrt() * 5.0 * 3f64.sqrt() / length(normal) + 10.0) * ULP)
        },
    });
    check(&Case {
        name: "to_tangent_space",
        body: "got3(0u, to_tangent_space(given_frame(0u), given3(9u)));",
        samples: samples(),
        expected: &|sample| (columns(sample, 0).map(|column| dot(column, v(sample))).to_vec(), 5.0 * ULP),
    });
}

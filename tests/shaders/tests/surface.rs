//! Compares anisotropy, triplanar mapping, parallax mapping and displacement with geometry in double
//! precision.

use darboux_shader_tests::samples::{Random, ULP, bits, columns, floats, many};
use darboux_shader_tests::vector::{D3, cross, dot, doubles, length, product, scale, unit};
use darboux_shader_tests::{Case, check};

const COUNT: usize = 1 << 14;

/// An orthonormal frame with either sign, as columns.
fn orthonormal(random: &mut Random) -> Vec<f32> {
    let (normal, [x, y, z, w]) = random.frame();
    let bitangent = scale(w.into(), cross(doubles(normal), doubles([x, y, z])));
    [&[x, y, z][..], &bitangent.map(|x| x as f32), &normal].concat()
}

/// The direction at the sum of two angles. Bound: 2 ulp for the rounded sines and cosines of the samples, 10
/// for sums and vectors, 10 for normalising, 4 for the bitangent, and the error of the normal.
#[test]
fn anisotropy() {
    let sample = |random: &mut Random| {
        let angles = [random.number(), random.number()].map(|x| 3.0 * x);
        let turn = angles.map(|angle| [angle.cos(), angle.sin()]);
        [orthonormal(random), turn.concat(), angles.to_vec()].concat()
    };
    check(&Case {
        name: "anisotropic_frame",
        body: "got_frame(0u, anisotropic_frame(given_frame(0u), given2(9u), given2(11u)));",
        samples: many(COUNT, 1, sample),
        expected: &|sample| {
            let [tangent, bitangent, normal] = columns(sample, 0);
            let [first, second]: [f64; 2] = doubles(floats(sample, 13));
            let (sine, cosine) = (first + second).sin_cos();
            let along = [0, 1, 2].map(|k| cosine * tangent[k] + sine * bitangent[k]);
            ([along, cross(normal, along), normal].concat(), 64.0 * ULP)
        },
    });
}

#[test]
fn projections_are_upright_on_every_side_and_none_is_mirrored() {
    // Seen from outside, u points right and v up. On the top up is -z, on the bottom z.
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let minus = |v: D3| v.map(|component| 0.0 - component);
    let sides = [("x", minus(z), y), ("y", x, minus(z)), ("z", x, y)];
    let far_sides = [("x", z, y), ("y", x, z), ("z", minus(x), y)];
    let all = sides.map(|side| (1.0, side)).into_iter().chain(far_sides.map(|side| (-1.0, side)));
    for (sign, (axis, right, up)) in all {
        let frame = format!("projection_frame_{axis}(given3(0u))");
        let normal = [0.3, 0.4, 0.5].map(|component: f32| sign * component);
        check(&Case {
            name: &frame,
            body: &format!("got_frame(0u, {frame});"),
            samples: vec![bits(&normal)],
            expected: &|_| ([right, up, cross(right, up)].concat(), 0.0),
        });
        check(&Case {
            name: "projected_uv",
            body: &format!("got2(0u, projected_uv({frame}, given3(3u)));"),
            samples: vec![bits(&[&normal[..], &[2.0, 3.0, 5.0]].concat())],
            expected: &|_| (vec![dot(right, [2.0, 3.0, 5.0]), dot(up, [2.0, 3.0, 5.0])], 0.0),
        });
    }
}

/// Bound: a power x^s has errors of 5 |s log2 x| x^s from its logarithm and 3 x^s, or 4 s x^s near 1; then a
/// sum and a quotient.
#[test]
fn triplanar_weights() {
    check(&Case {
        name: "triplanar_weights",
        body: "got3(0u, triplanar_weights(given3(0u), given1(3u)));",
        // Sharpness up to 8, and one for which all powers would underflow.
        samples: many(COUNT, 2, |random| {
            let sharpness = if random.number() < 0.0 { 1.0 + 7.0 * random.fraction() } else { 1000.0 };
            [&random.direction()[..], &[sharpness]].concat()
        }),
        expected: &|sample| {
            let sharpness = f64::from(f32::from_bits(sample[3]));
            let powers = doubles(floats::<3>(sample, 0)).map(|x| x.abs().powf(sharpness));
            let sum: f64 = powers.iter().sum();
            (powers.map(|power| power / sum).to_vec(), 3.0 * (4.0 * sharpness + 8.0) * ULP)
        },
    });
}

/// The whiteout blend in its usual form with swizzles.
fn whiteout_on_sides(n: D3, [x, y, z]: [D3; 3]) -> [D3; 3] {
    let side = n.map(|component| if component < 0.0 { -1.0 } else { 1.0 });
    [
        [x[2] * n[0], n[1] + x[1], n[2] - side[0] * x[0]],
        [n[0] + y[0], y[2] * n[1], n[2] - side[1] * y[1]],
        [n[0] + side[2] * z[0], n[1] + z[1], z[2] * n[2]],
    ]
}

#[test]
fn triplanar_normals() {
    let sample = |random: &mut Random| {
        let weights = [random.fraction(), random.fraction(), random.fraction()];
        let sum: f32 = weights.iter().sum();
        let texels = [(); 3].map(|()| {
            let [x, y, z] = random.direction();
            [0.5 * x, 0.5 * y, 0.5 + 0.5 * z.abs()]
        });
        [&random.direction()[..], &weights.map(|weight| weight / sum), &texels.concat()].concat()
    };
    check(&Case {
        name: "triplanar_normal",
        body: "got3(0u, triplanar_normal(given3(0u), given3(3u), given3(6u), given3(9u), given3(12u)));",
        samples: many(COUNT, 3, sample),
        expected: &|sample| {
            let [normal, weights] = [0, 3].map(|start| doubles(floats(sample, start)));
            let sum = product(whiteout_on_sides(normal, columns(sample, 6)), weights);
            // Each term is at most 1.5, with an error of 6 ulp.
            (unit(sum).to_vec(), (2.0 * 3f64.sqrt() * 12.0 / length(sum) + 10.0) * ULP)
        },
    });
    check(&Case {
        name: "triplanar_normal of flat texels",
        body: "got3(0u, triplanar_normal(given3(0u), triplanar_weights(given3(0u), 4.0), given3(3u), given3(3u), given3(3u)));",
        samples: many(COUNT, 4, |random| [random.direction(), [0.0, 0.0, 1.0]].concat()),
        expected: &|sample| (doubles(floats::<3>(sample, 0)).to_vec(), 64.0 * ULP),
    });
}

/// A view direction above the surface, and the UVs per length along both axes.
fn view(random: &mut Random) -> Vec<f32> {
    loop {
        let [x, y, z] = random.direction();
        if z > 0.07 {
            break vec![x, y, z, 2.0 * random.number(), 2.0 * random.number()];
        }
    }
}

/// The view ray, which passes through the origin of the surface and continues below it.
#[test]
fn parallax_follows_the_ray() {
    check(&Case {
        name: "parallax_shift",
        body: "got2(0u, parallax_shift(given3(0u), given1(5u), given2(3u)));",
        samples: many(COUNT, 5, |random| [view(random), vec![random.fraction()]].concat()),
        expected: &|sample| {
            let [x, y, z, u, v, depth] = doubles(floats(sample, 0));
            let time = depth / z;
            let [along, across] = [-time * x, -time * y];
            (vec![along * u, across * v], 2.0 * 6.0 * time * ULP)
        },
    });
    check(&Case {
        name: "parallax_offset",
        body: "got2(0u, parallax_offset(given3(0u), given1(5u), given2(3u)));",
        samples: many(COUNT, 6, |random| [view(random), vec![random.number()]].concat()),
        expected: &|sample| {
            let [x, y, _, u, v, height] = doubles(floats(sample, 0));
            (vec![height * x * u, height * y * v], 2.0 * 2.0 * ULP)
        },
    });
    check(&Case {
        name: "parallax_shift of a flat view",
        body: "got2(0u, parallax_shift(given3(0u), 1.0, given2(3u)));",
        samples: vec![bits(&[1.0, 0.0, 0.0, 1.0, 1.0]), bits(&[0.0, 1.0, -0.5, 1.0, -2.0])],
        expected: &|sample| (if sample[0] == 0 { vec![0.0, 32.0] } else { vec![-16.0, 0.0] }, 0.0),
    });
    check(&Case {
        name: "parallax_steps",
        body: "got1(0u, parallax_steps(given3(0u), 8.0, 32.0));",
        samples: vec![bits(&[0.0, 0.0, 1.0]), bits(&[1.0, 0.0, 0.0]), bits(&[0.8, 0.0, 0.5])],
        expected: &|sample| (vec![32.0 - 24.0 * f64::from(f32::from_bits(sample[2]))], 64.0 * ULP),
    });
}

/// On a linear slope, one interpolation finds the exact intersection.
#[test]
fn parallax_hits_a_slope() {
    let sample = |random: &mut Random| {
        let (at, slope) = (random.fraction(), 1.0 + 4.0 * random.fraction());
        let (t, next) = (at * random.fraction(), at + (1.0 - at) * random.fraction());
        vec![t, (at - t) * slope, next, (at - next) * slope, at]
    };
    check(&Case {
        name: "parallax_hit",
        body: "got1(0u, parallax_hit(given1(0u), given1(1u), given1(2u), given1(3u)));",
        samples: many(COUNT, 7, sample),
        expected: &|sample| {
            let [t, gap, next, next_gap, at] = doubles(floats(sample, 0));
            // The gaps are rounded by up to 5 ulp. If the step is too short to distinguish its ends, either
            // end is correct.
            let rounding = (next - t) * 5.0 / (gap - next_gap);
            (vec![at], if gap - next_gap > 1e-4 { (8.0 + 2.0 * rounding) * ULP } else { next - t + ULP })
        },
    });
    check(&Case {
        name: "parallax_hit at once",
        body: "got1(0u, parallax_hit(given1(0u), given1(1u), given1(2u), given1(3u)));",
        samples: vec![bits(&[0.25, 0.0, 0.5, 0.0]), bits(&[0.25, 0.0, 0.5, -1.0])],
        expected: &|_| (vec![0.25], 0.0),
    });
}

/// A plane with waves along both axes of its frame, compared with the differences of displaced points.
#[test]
fn displacement_of_a_plane() {
    let sample = |random: &mut Random| {
        [orthonormal(random), vec![2.0 * random.number(), 2.0 * random.number()]].concat()
    };
    check(&Case {
        name: "displaced_frame",
        body: "got_frame(0u, displaced_frame(given_frame(0u), given2(9u)));",
        samples: many(COUNT, 8, sample),
        expected: &|sample| {
            let frame = columns(sample, 0);
            let [along, across] = doubles(floats::<2>(sample, 9));
            let point = |s: f64, t: f64| product(frame, [s, t, along * s + across * t]);
            let [tangent, bitangent] = [point(1.0, 0.0), point(0.0, 1.0)];
            let normal = unit(cross(tangent, bitangent));
            let side = dot(normal, frame[2]).signum();
            // The columns of the frame are rounded: 2 ulp for each of the three terms of the normal.
            ([tangent, bitangent, scale(side, normal)].concat(), 64.0 * ULP)
        },
    });
    check(&Case {
        name: "displaced_position",
        body: "got3(0u, displaced_position(given3(9u), given_frame(0u), given3(12u)));",
        samples: many(COUNT, 9, |random| {
            [orthonormal(random), random.direction().to_vec(), random.direction().to_vec()].concat()
        }),
        expected: &|sample| {
            let [position, by] = [9, 12].map(|start| doubles(floats(sample, start)));
            let moved = product(columns(sample, 0), by);
            ([0, 1, 2].map(|k| position[k] + moved[k]).to_vec(), 12.0 * ULP)
        },
    });
}

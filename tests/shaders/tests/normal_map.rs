//! Compares decoded texels with the core, and blends with rotations and sums of slopes in double precision.

use darboux::TexelLayout;
use darboux_shader_tests::samples::{Random, ULP, bits, floats, many};
use darboux_shader_tests::vector::{D3, cross, dot, doubles, unit};
use darboux_shader_tests::{Case, check};

/// 8-bit texels with all values of each channel.
fn bytes() -> impl Iterator<Item = [u8; 3]> {
    (0..=255).map(|c: u8| [c, c.wrapping_mul(77).wrapping_add(5), 255 - c])
}

/// Texels as a sampler returns them: the nearest floats.
fn sampled<T: Copy + Into<f64>>(texel: &[T], largest: T) -> Vec<u32> {
    bits(&texel.iter().map(|&c| (c.into() / largest.into()) as f32).collect::<Vec<_>>())
}

fn texel<const N: usize>(sample: &[u32], largest: f32) -> [u16; N] {
    floats(sample, 0).map(|c: f32| (c * largest).round() as u16)
}

/// Bound: two roundings of values up to 2.
#[test]
fn three_channels() {
    check(&Case {
        name: "normal_from_texel",
        body: "got3(0u, normal_from_texel(given3(0u)));",
        samples: bytes().map(|texel| sampled(&texel, 255)).collect(),
        expected: &|sample| {
            let texel = texel::<3>(sample, 255.0).map(|c| c as u8);
            (doubles(TexelLayout::RGB.vector(texel)).to_vec(), 2.0 * ULP)
        },
    });
    check(&Case {
        name: "normal_from_texel_around_128",
        body: "got3(0u, normal_from_texel_around_128(given3(0u)));",
        samples: bytes().map(|texel| sampled(&texel, 255)).collect(),
        expected: &|sample| {
            let texel = texel::<3>(sample, 255.0).map(|c| ((f64::from(c) - 128.0) / 127.0).max(-1.0));
            (texel.to_vec(), 6.0 * ULP)
        },
    });
}

/// Bound: the square of z has an error of 10 ulp, so z has that divided by 2 z, or its square root.
#[test]
fn two_channels() {
    let mut random = Random::new(1);
    let samples = |random: &mut Random| {
        let texel = [random.word() as u16, random.word() as u16];
        sampled(&texel, u16::MAX)
    };
    let mut samples: Vec<_> = (0..1 << 15).map(|_| samples(&mut random)).collect();
    samples.extend([[0, 0], [0, 65535], [32768, 0], [65535, 32767]].map(|texel| sampled(&texel, u16::MAX)));
    check(&Case {
        name: "normal_from_two_channels",
        body: "got3(0u, normal_from_two_channels(given2(0u)));",
        samples,
        expected: &|sample| {
            let normal = doubles(TexelLayout::RG.vector(texel::<2>(sample, 65535.0)));
            let of_z = (10.0 * ULP).sqrt().min(10.0 * ULP / normal[2]);
            (normal.to_vec(), of_z + 5.0 * ULP)
        },
    });
}

#[test]
fn intensity() {
    check(&Case {
        name: "scaled_normal",
        body: "got3(0u, scaled_normal(given3(0u), given2(3u)));",
        samples: many(1 << 10, 2, |random| {
            [random.direction().to_vec(), vec![2.0 * random.number(), -random.number()]].concat()
        }),
        expected: &|sample| {
            let [x, y, z, u, v] = doubles(floats(sample, 0));
            (vec![u * x, v * y, z], 2.0 * ULP)
        },
    });
}

/// A base and a detail normal, both pointing away from the surface.
fn pair(random: &mut Random) -> Vec<f32> {
    let facing_out = |[x, y, z]: [f32; 3]| [x, y, z.abs()];
    [facing_out(random.direction()), facing_out(random.direction())].concat()
}

/// Rotates `v` by the shortest rotation from (0, 0, 1) to the unit vector `to` (O. Rodrigues, 1840).
fn turned(to: D3, v: D3) -> D3 {
    let up = [0.0, 0.0, 1.0];
    let axis = cross(up, to);
    if dot(axis, axis) == 0.0 {
        return v;
    }
    let (axis, cosine) = (unit(axis), to[2]);
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let across = cross(axis, v);
    let along = dot(axis, v) * (1.0 - cosine);
    [0, 1, 2].map(|k| cosine * v[k] + sine * across[k] + along * axis[k])
}

/// Bound: the dot product is at most 2 with an error of 6 ulp, the quotient 3, the last product of at most 4
/// and the difference 12.
#[test]
fn reoriented_detail() {
    check(&Case {
        name: "blended_normals_reoriented",
        body: "got3(0u, blended_normals_reoriented(given3(0u), given3(3u)));",
        samples: many(1 << 15, 3, pair),
        expected: &|sample| {
            let [base, detail] = [0, 3].map(|start| unit(doubles(floats(sample, start))));
            (turned(base, detail).to_vec(), 32.0 * ULP)
        },
    });
}

/// The slopes of flat normals add up. UDN uses only the z of the base.
#[test]
fn added_slopes() {
    let [x, y, z] = [0, 1, 2]
        .map(|k| move |sample: &[u32]| [sample[k], sample[k + 3]].map(f32::from_bits).map(f64::from));
    check(&Case {
        name: "blended_normals_whiteout",
        body: "got3(0u, blended_normals_whiteout(given3(0u), given3(3u)));",
        samples: many(1 << 12, 4, pair),
        expected: &|sample| {
            let sum = |[a, b]: [f64; 2]| a + b;
            let [base, detail] = z(sample);
            (vec![sum(x(sample)), sum(y(sample)), base * detail], 2.0 * ULP)
        },
    });
    check(&Case {
        name: "blended_normals_udn",
        body: "got3(0u, blended_normals_udn(given3(0u), given3(3u)));",
        samples: many(1 << 12, 5, pair),
        expected: &|sample| {
            let sum = |[a, b]: [f64; 2]| a + b;
            (vec![sum(x(sample)), sum(y(sample)), z(sample)[0]], 2.0 * ULP)
        },
    });
}

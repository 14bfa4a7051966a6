//! Compares the decoders of the shader library with darboux::encode.

use darboux::encode::{
    frame_from_quaternion, frame_to_quaternion, normal_from_octahedral, tangent_from_diamond,
    tangent_from_octahedral, tangent_from_snorm8, tangent_from_snorm10, tangent_from_snorm16,
};
use darboux_shader_tests::samples::{Random, ULP, bits, floats, integers};
use darboux_shader_tests::vector::doubles;
use darboux_shader_tests::{Case, check};

/// The words of integers.
fn words(codes: impl IntoIterator<Item = i32>) -> Vec<u32> {
    codes.into_iter().map(|code| code as u32).collect()
}

fn shorts<const N: usize>(sample: &[u32]) -> [i16; N] {
    integers(sample).map(|code| code.try_into().expect("16 bits"))
}

#[test]
fn words_come_apart() {
    let mut random = Random::new(1);
    let special = [0, 0x8080_8080, 0x8000_7fff, 0x7fff_8000, u32::MAX];
    let samples: Vec<_> = (0..4096).map(|_| random.word()).chain(special).map(|word| vec![word]).collect();
    check(&Case {
        name: "bytes_of_word",
        body: "got_int4(0u, bytes_of_word(given_word(0u)));",
        samples: samples.clone(),
        expected: &|word| (word[0].to_le_bytes().map(|byte| f64::from(byte as i8)).to_vec(), 0.0),
    });
    check(&Case {
        name: "shorts_of_word",
        body: "got_int2(0u, shorts_of_word(given_word(0u)));",
        samples,
        expected: &|word| (vec![f64::from(word[0] as i16), f64::from((word[0] >> 16) as i16)], 0.0),
    });
}

/// Bound: a quotient.
#[test]
fn snorm() {
    let codes = |range: std::ops::RangeInclusive<i32>| {
        range.clone().zip(range.rev()).map(|(x, y)| words([x, y, y, x])).collect()
    };
    check(&Case {
        name: "tangent_from_snorm8",
        body: "got4(0u, tangent_from_snorm8(given_int4(0u)));",
        samples: codes(-128..=127),
        expected: &|code| {
            (doubles(tangent_from_snorm8(shorts(code).map(|code| code as i8))).to_vec(), 3.0 * ULP)
        },
    });
    check(&Case {
        name: "tangent_from_snorm16",
        body: "got4(0u, tangent_from_snorm16(given_int4(0u)));",
        samples: codes(-32768..=32767),
        expected: &|code| (doubles(tangent_from_snorm16(shorts(code))).to_vec(), 3.0 * ULP),
    });
    check(&Case {
        name: "tangent_from_snorm10",
        body: "got4(0u, tangent_from_snorm10(given_word(0u)));",
        samples: (0..1 << 16).map(|k: u32| vec![k.wrapping_mul(0x9e37_79b1)]).collect(),
        expected: &|code| (doubles(tangent_from_snorm10(code[0])).to_vec(), 3.0 * ULP),
    });
}

/// Bound: exact integers, 3 ulp for the sum of squares, halved by the square root, plus 4.5, plus 2.5 and 1
/// to normalise, plus 2.5 on the CPU.
#[test]
fn octahedral() {
    let grid = |largest: i32| {
        let steps = move || (-largest..=largest).step_by(117).chain([-1, 0, 1, largest]);
        steps().flat_map(move |x| steps().map(move |y| words([x, y]))).collect()
    };
    check(&Case {
        name: "normal_from_octahedral",
        body: "got3(0u, normal_from_octahedral(given_int2(0u)));",
        samples: grid(32767),
        expected: &|code| (doubles(normal_from_octahedral(shorts(code))).to_vec(), 12.0 * ULP),
    });
    check(&Case {
        name: "tangent_from_octahedral",
        body: "got4(0u, tangent_from_octahedral(given_int2(0u)));",
        samples: grid(32766),
        expected: &|code| (doubles(tangent_from_octahedral(shorts(code))).to_vec(), 12.0 * ULP),
    });
}

/// Bound: the components of the perpendicular vectors have errors up to 6.5 ulp, their sum 8.5. Its length is
/// at least 1 / sqrt(2), so normalising gives 2 sqrt(3) sqrt(2) 8.5 + 9.
#[test]
fn diamond() {
    let mut random = Random::new(2);
    let sample = |normal: [f32; 3], code: u32| [bits(&normal), vec![code]].concat();
    let mut samples: Vec<_> = (0..1 << 16).map(|code| sample(random.direction(), code)).collect();
    for normal in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, -0.0], [0.6, 0.0, -0.8]] {
        samples.extend((0..1 << 16).step_by(13).map(|code| sample(normal, code)));
    }
    check(&Case {
        name: "tangent_from_diamond",
        body: "got4(0u, tangent_from_diamond(given3(0u), given_word(3u)));",
        samples,
        expected: &|sample| {
            (doubles(tangent_from_diamond(floats(sample, 0), sample[3] as u16)).to_vec(), 52.0 * ULP)
        },
    });
}

/// Bound: 4 ulp for the sum of squares and 2.5 for the quotient; the sums that it multiplies are at most half
/// of that sum, with an error of 2 ulp; 2 for the last product and sum; half of the total for the CPU.
#[test]
fn quaternion() {
    let mut random = Random::new(3);
    let mut samples = Vec::new();
    for _ in 0..1 << 17 {
        let (normal, tangent) = random.frame();
        samples.push(words(frame_to_quaternion(normal, tangent).map(i32::from)));
    }
    check(&Case {
        name: "frame_from_quaternion",
        body: "got_vertex_frame(0u, frame_from_quaternion(given_int4(0u)));",
        samples,
        expected: &|code| {
            let (normal, tangent) = frame_from_quaternion(shorts(code));
            ([&doubles(normal)[..], &doubles(tangent)].concat(), 16.0 * ULP)
        },
    });
}

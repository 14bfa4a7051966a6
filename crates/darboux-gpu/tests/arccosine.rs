//! Compares the arccosine of the shaders with that of the platform in double precision, rounded to floats,
//! which is that of the core.

mod common;

use common::gpus;
use common::scalar::map;

const FILES: &[&str] = &[
    include_str!("../shaders/precision/device_floats.wgsl"),
    include_str!("../shaders/precision/correct_rounding.wgsl"),
    include_str!("../shaders/precision/uint64.wgsl"),
    include_str!("../shaders/precision/arccosine.wgsl"),
];
/// The short and the long computation. The short one calls the long one if its rounding is undecided.
const BODY: &str = "let x = bitcast<f32>(given[at]);
    got[into] = bitcast<u32>(arccosine(x));
    got[into + 1u] = bitcast<u32>(long_arccosine(x));";
const ONE: u32 = 0x3f80_0000;

fn check(sizes: impl Iterator<Item = u32>) {
    let samples: Vec<[u32; 1]> = sizes.flat_map(|size| [[size], [size | 1 << 31]]).collect();
    for gpu in gpus() {
        let answers: Vec<[u32; 2]> = map(gpu, FILES, BODY, &samples);
        for (&[word], &[found, long]) in samples.iter().zip(&answers) {
            let x = f32::from_bits(word);
            let right = f64::from(x).acos() as f32;
            let [found, long] = [found, long].map(f32::from_bits);
            let is_right = found.to_bits() == right.to_bits() && long.to_bits() == right.to_bits();
            assert!(is_right, "acos({x:e}): {found:e}, {long:e}, not {right:e}");
        }
    }
    println!("{} arccosines are those of the CPU", samples.len());
}

#[test]
fn arccosines_are_those_of_the_cpu() {
    // A sample of all floats, the float that is rounded twice, and all floats next to 1, to 1/2 and to where
    // asin x is half an ulp of pi/2.
    let around = |x: f32| x.to_bits() - 30_000..(x.to_bits() + 30_000).min(ONE + 1);
    let sample = (0..=ONE).step_by(1_999);
    check(
        sample.chain(around(1.0)).chain(around(0.5)).chain(around(6e-8)).chain(0..100).chain([0x3288_85a3]),
    );
}

#[test]
#[ignore = "minutes"]
fn all_arccosines_are_those_of_the_cpu() {
    // Below 2^-27 the result is constant.
    for start in (0x3200_0000..=ONE).step_by(1 << 22) {
        check(start..(start + (1 << 22)).min(ONE + 1));
    }
}

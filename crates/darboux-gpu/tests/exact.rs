//! Compares the corrected and the emulated float arithmetic of the shaders with Rust, bit by bit.

mod common;

use common::gpus;
use common::scalar::map;

const FILES: &[&str] = &[
    include_str!("../shaders/precision/device_floats.wgsl"),
    include_str!("../shaders/precision/correct_rounding.wgsl"),
    include_str!("../shaders/precision/uint64.wgsl"),
    include_str!("../shaders/precision/soft_float.wgsl"),
];
const STEPS: usize = 1_500_000;

/// The splitmix64 sequence.
struct Random(u64);

impl Random {
    fn word(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 32) as u32
    }
}

/// Words for which rounding is hard: the ends of all ranges, and neighbours of powers of two and of ties.
fn hard() -> Vec<u32> {
    let mut words = Vec::new();
    for exponent in
        [0, 1, 2, 60, 63, 64, 103, 104, 125, 126, 127, 128, 129, 150, 151, 190, 191, 192, 252, 253, 254, 255]
    {
        for fraction in [
            0, 1, 2, 3, 0x3f_ffff, 0x40_0000, 0x40_0001, 0x2a_aaaa, 0x55_5555, 0x35_04f3, 0x35_04f4,
            0x7f_fffe, 0x7f_ffff,
        ] {
            words.extend([exponent << 23 | fraction, 1 << 31 | exponent << 23 | fraction]);
        }
    }
    words
}

/// Factors whose product is above half of the smallest subnormal number by less than 256 / 2^47 of it.
fn just_above_half() -> impl Iterator<Item = [u32; 3]> {
    let product = 1u64 << 47;
    (1 << 23..1 << 24).filter_map(move |a: u64| {
        let b = product.div_ceil(a);
        let is_near = (1..256).contains(&(a * b - product));
        is_near
            .then_some([a, b].map(|significand| significand as u32 & 0x7f_ffff))
            .map(|[a, b]| [52 << 23 | a, 51 << 23 | b, 0])
    })
}

/// All pairs of hard words, and pairs of random words, of random words of similar size and of small ones.
/// Each has a third word from 0 to 8.
fn pairs() -> Vec<[u32; 3]> {
    let hard = hard();
    let mut pairs: Vec<[u32; 3]> =
        hard.iter().flat_map(|&a| hard.iter().map(move |&b| [a, b, (a ^ b) % 9])).collect();
    pairs.extend(just_above_half());
    let mut random = Random(5);
    for step in 0..STEPS {
        let (a, b) = (random.word(), random.word());
        // The exponents differ by less than 32.
        let near = a.wrapping_add((b & 0x0fff_ffff).wrapping_sub(0x0800_0000)) ^ (b & 1 << 31);
        let third = random.word() % 9;
        pairs.push(match step % 3 {
            0 => [a, b, third],
            1 => [a, near, third],
            // The exponents are 0 to 31: subnormal numbers, and numbers that make them normal.
            _ => [a & 0x8fff_ffff, b & 0x8fff_ffff, third],
        });
    }
    pairs
}

fn is_plain(x: f32) -> bool {
    x.is_normal() || x == 0.0
}

/// Checks that every result has the bits of Rust if operands and result are normal or zero. Zeros may have
/// any sign.
fn check(name: &str, body: &str, exact: impl Fn(f32, f32) -> f32, is_defined: impl Fn(f32, f32) -> bool) {
    let pairs = pairs();
    for (device, gpu) in DEVICES.iter().flat_map(|device| gpus().iter().map(move |gpu| (device, gpu))) {
        let files = [&[*device], &FILES[1..]].concat();
        let answers: Vec<[u32; 1]> = map(gpu, &files, body, &pairs);
        let mut compared = 0;
        for (&[a, b, third], &[found]) in pairs.iter().zip(&answers) {
            let [a, b, found] = [a, b, found].map(f32::from_bits);
            let right = exact(a, b);
            if [a, b, right].into_iter().all(is_plain) && is_defined(a, b) {
                let is_right = found.to_bits() == right.to_bits() || (found == 0.0 && right == 0.0);
                assert!(is_right, "{name} of {a:e}, {b:e}, {third}: {found:e}, not {right:e}");
                compared += 1;
            }
        }
        println!("{name} on {}: {compared} results are those of Rust", gpu.name);
    }
}

/// The floats of the device, and those of the simulated hostile device.
const DEVICES: &[&str] = &[FILES[0], include_str!("../shaders/precision/hostile_floats.wgsl")];

/// A body that applies `call` to floats a and b. `near`: an error in ulp.
fn body(call: &str) -> String {
    format!(
        "let a = bitcast<f32>(given[at]);
        let b = bitcast<f32>(given[at + 1u]);
        let near = (i32(given[at + 2u]) - 4) * 6;
        got[into] = bitcast<u32>({call});"
    )
}

/// The quotient from a reciprocal with an error of `near` ulp.
const ROUGH_QUOTIENT: &str = "quotient_near(a, b, bitcast<f32>(u32(i32(bitcast<u32>(\
    1.0 / bitcast<f32>(bitcast<u32>(b) & 0x7fffffu | ONE))) + near)))";
/// The square root from a reciprocal root with an error of `near` ulp.
const ROUGH_ROOT: &str = "root_and_reciprocal_near(a, from_one_to_four(bitcast<u32>(a)), bitcast<f32>(u32(i32(\
    bitcast<u32>(inverseSqrt(from_one_to_four(bitcast<u32>(a))))) + near)))";

/// Whether the product is exact zero or does not underflow.
fn lasts(a: f32, b: f32) -> bool {
    is_plain(a * b) && (a * b != 0.0 || a == 0.0 || b == 0.0)
}

#[test]
fn products_are_rounded() {
    check("product", &body("product(a, b)"), |a, b| a * b, lasts);
}

#[test]
fn sums_are_rounded() {
    check("sum", &body("sum(a, b)"), |a, b| a + b, |_, _| true);
    check("difference", &body("difference(a, b)"), |a, b| a - b, |_, _| true);
}

#[test]
fn products_are_rounded_before_they_are_added() {
    check("sum of products", &body("sum(product(a, b), product(a, -b))"), |_, _| 0.0, lasts);
    check("product less one", &body("difference(product(a, b), 1.0)"), |a, b| a * b - 1.0, lasts);
}

#[test]
fn quotients_are_rounded() {
    // A quotient that rounds to the smallest normal number may be subnormal.
    let is_defined = |a: f32, b: f32| b != 0.0 && (a == 0.0 || (a / b).abs() > f32::MIN_POSITIVE);
    check("quotient", &body("quotient(a, b)"), |a, b| a / b, is_defined);
    check("quotient from an estimate", &body(ROUGH_QUOTIENT), |a, b| a / b, is_defined);
}

#[test]
fn roots_are_rounded() {
    let is_defined = |a: f32, _| a >= 0.0;
    // The reciprocal root of zero is unspecified.
    let inverse = |a: f32, _| if a == 0.0 { 0.0 } else { 1.0 / a.sqrt() };
    for call in ["root_and_reciprocal(a)", ROUGH_ROOT] {
        check("root", &body(&format!("{call}.x")), |a, _| a.sqrt(), is_defined);
        let call = format!("select({call}.y, 0.0, a == 0.0)");
        check("one over a root", &body(&call), inverse, is_defined);
    }
    check("one over a root alone", &body("select(reciprocal_root(a), 0.0, a == 0.0)"), inverse, is_defined);
}

/// Checks that every result has the bits of Rust, for all operands. Any NaN equals any NaN.
fn check_soft(name: &str, call: &str, exact: impl Fn(f32, f32) -> f32) {
    let body = format!("let a = given[at]; let b = given[at + 1u]; got[into] = {call};");
    let samples: Vec<[u32; 2]> = pairs().into_iter().map(|[a, b, _]| [a, b]).collect();
    for gpu in gpus() {
        let answers: Vec<[u32; 1]> = map(gpu, FILES, &body, &samples);
        for (&[a, b], &[found]) in samples.iter().zip(&answers) {
            let [a, b, found] = [a, b, found].map(f32::from_bits);
            let right = exact(a, b);
            let is_right = found.to_bits() == right.to_bits() || (found.is_nan() && right.is_nan());
            assert!(is_right, "{name} of {a:e} and {b:e}: {found:e}, not {right:e}");
        }
        println!("{name} on {}: {} results are those of Rust", gpu.name, samples.len());
    }
}

#[test]
fn soft_arithmetic_is_that_of_all_floats() {
    check_soft("soft sum", "soft_sum(a, b)", |a, b| a + b);
    check_soft("soft product", "soft_product(a, b)", |a, b| a * b);
    check_soft("soft quotient", "soft_quotient(a, b)", |a, b| a / b);
    check_soft("soft root", "soft_root(a)", |a, _| a.sqrt());
}

#[test]
fn comparisons_are_those_of_all_floats() {
    let call = "bitcast<f32>(u32(is_less(a, b)) | u32(is_equal(a, b)) << 1u)";
    let pairs = pairs();
    for gpu in gpus() {
        let answers: Vec<[u32; 1]> = map(gpu, FILES, &body(call), &pairs);
        for (&[a, b, _], &[found]) in pairs.iter().zip(&answers) {
            let [a, b] = [a, b].map(f32::from_bits);
            assert_eq!(found, u32::from(a < b) | u32::from(a == b) << 1, "{a:e} and {b:e}");
        }
    }
}

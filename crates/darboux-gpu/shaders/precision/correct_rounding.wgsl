// IEEE 754 rounding on devices that do not guarantee it. WGSL lets a device fuse multiplications and additions, be wrong by several ulp in
// quotients and roots, flush subnormal numbers to zero, and ignore infinities, NaN and the sign of zero.
//
// The functions are correct for normal numbers with normal results, and for zeros except for their signs. The caller has to exclude all
// other values (real_exact.wgsl does). Requires device_floats.wgsl and `fn opaque_zero() -> u32`, a zero that is unknown to the compiler.

const SIGN: u32 = 0x80000000u;
const ONE: u32 = 0x3f800000u;
// The implicit leading bit of a significand.
const HIDDEN: u32 = 0x800000u;

// Returns the value. The compiler cannot see through it, so it cannot fuse a product with a following addition.
fn rounded(value: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(value) ^ opaque_zero());
}

fn exponent_of(word: u32) -> i32 {
    return i32((word >> 23u) & 0xffu);
}

fn significand_of(word: u32) -> u32 {
    return (word & 0x7fffffu) | HIDDEN;
}

fn is_zero(word: u32) -> bool {
    return (word & ~SIGN) == 0u;
}

fn product(a: f32, b: f32) -> f32 {
    return rounded(device_product(a, b));
}

fn sum(a: f32, b: f32) -> f32 {
    return rounded(device_sum(a, b));
}

fn difference(a: f32, b: f32) -> f32 {
    return rounded(device_sum(a, -b));
}

// The nearest integer to a correction, or the one below it. Corrections are computed to a thousandth.
fn nearly_rounded(correction: f32) -> i32 {
    return i32(floor(correction + 0.499));
}

fn quotient(a: f32, b: f32) -> f32 {
    return quotient_near(a, b, device_reciprocal(bitcast<f32>((bitcast<u32>(b) & 0x7fffffu) | ONE)));
}

// a / b from an estimate of the reciprocal of b's significand, with an error of at most 25 ulp. The integer remainder of the division is far
// below 2^31, so wrapping 32-bit arithmetic computes it, although the two products that it is the difference of overflow.
fn quotient_near(a: f32, b: f32, reciprocal: f32) -> f32 {
    let words = bitcast<vec2u>(vec2f(a, b));
    let x = significand_of(words.x);
    let y = significand_of(words.y);
    // The quotient of the significands has 23 or 24 fraction bits.
    let shift = select(23u, 24u, x < y);
    let estimate = i32(f32(x << (shift - 23u)) * reciprocal);
    let remainder = i32((x << shift) - u32(estimate) * y);
    let near = nearly_rounded(f32(remainder) * reciprocal * 1.1920929e-7);
    // A tie is impossible: no float times an odd multiple of half a unit is a float.
    let quotient = estimate + near + i32(2 * (remainder - near * i32(y)) > i32(y));
    let exponent = exponent_of(words.x) - exponent_of(words.y) + 150 - i32(shift);
    let result = u32((exponent << 23u) + quotient - i32(HIDDEN)) | ((words.x ^ words.y) & SIGN);
    return bitcast<f32>(select(result, 0u, is_zero(words.x)));
}

// The significand times 2 if the exponent is odd: in [1, 4).
fn from_one_to_four(word: u32) -> f32 {
    return bitcast<f32>(ONE + (word & 0x7fffffu) + ((word & HIDDEN) ^ HIDDEN));
}

// The biased exponent of the square root of a positive number.
fn exponent_of_root(word: u32) -> u32 {
    return ((word >> 23u) + 127u) >> 1u;
}

fn root_and_reciprocal(a: f32) -> vec2f {
    let x = from_one_to_four(bitcast<u32>(a));
    return root_and_reciprocal_near(a, x, device_reciprocal_root(x));
}

// The square root of `a` and its reciprocal, which is unspecified for zero. `estimate`: of 1 / sqrt(x), with an error of at most 25 ulp, where
// x = from_one_to_four(a).
fn root_and_reciprocal_near(a: f32, x: f32, estimate: f32) -> vec2f {
    let word = bitcast<u32>(a);
    let exponent = exponent_of_root(word);
    let found = significands_of_root(x, estimate);
    let root = select(((exponent - 1u) << 23u) + found.x, 0u, is_zero(word));
    return bitcast<vec2f>(vec2u(root, ((252u - exponent) << 23u) + found.y));
}

// 1 / sqrt(a), for `a` that is not zero.
fn reciprocal_root(a: f32) -> f32 {
    let word = bitcast<u32>(a);
    let x = from_one_to_four(word);
    let found = significands_of_root(x, device_reciprocal_root(x));
    return bitcast<f32>(((252u - exponent_of_root(word)) << 23u) + found.y);
}

// sqrt(x) 2^23 and 2^24 / sqrt(x), rounded to integers, for x in [1, 4). The remainders fit 32 bits, as for quotients.
fn significands_of_root(x: f32, reciprocal: f32) -> vec2u {
    let scaled = x * 8388608.0;
    let square = i32(scaled) << 23u;
    let estimate = i32(scaled * reciprocal);
    let near = estimate + nearly_rounded(f32(square - estimate * estimate) * reciprocal * 5.9604645e-8);
    // A tie is impossible: (n + 1/2)^2 is not an integer.
    let root = near + i32(square - near * near > near);
    // 2^47 / root is in [2^23, 2^24]. A tie is impossible: only powers of two divide 2^48.
    let inverse = i32(reciprocal * 16777216.0);
    let remainder = -(inverse * root);
    let whole = nearly_rounded(f32(remainder) * reciprocal * 1.1920929e-7);
    return bitcast<vec2u>(vec2i(root, inverse + whole + i32(2 * (remainder - whole * root) > root)));
}

// The integer square root n, in [2^23, 2^24), of a number whose low 32 bits are `square`, and the remainder. `estimate`: of n, within 50.
// `half_inverse`: of 1 / 2n, to a thousandth.
fn integer_sqrt(square: i32, estimate: i32, half_inverse: f32) -> vec2i {
    var root = estimate + i32(round(f32(square - estimate * estimate) * half_inverse));
    var rest = square - root * root;
    if rest < 0 {
        root -= 1;
        rest += 2 * root + 1;
    } else if rest > 2 * root {
        rest -= 2 * root + 1;
        root += 1;
    }
    return vec2i(root, rest);
}

// Maps the bits of floats to integers of the same order. Both zeros give 0.
fn order(word: u32) -> i32 {
    let size = i32(word & ~SIGN);
    return select(size, -size, (word & SIGN) != 0u);
}

fn is_nan(word: u32) -> bool {
    return (word & ~SIGN) > 0x7f800000u;
}

fn is_less(a: f32, b: f32) -> bool {
    let words = bitcast<vec2u>(vec2f(a, b));
    return order(words.x) < order(words.y) && !is_nan(words.x) && !is_nan(words.y);
}

fn is_equal(a: f32, b: f32) -> bool {
    let words = bitcast<vec2u>(vec2f(a, b));
    return order(words.x) == order(words.y) && !is_nan(words.x) && !is_nan(words.y);
}

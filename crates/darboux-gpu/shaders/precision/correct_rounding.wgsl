// Floats rounded as IEEE 754 asks, on devices that need not: WGSL lets a device contract products and sums, be off by units in quotients
// and roots, take subnormal numbers for zero, and not care about infinities, NaN and the sign of zero.
//
// Whoever includes this has `fn zero() -> u32`, a zero that compilers do not know, and device_floats.wgsl. Everything here is right for normal numbers
// with normal results, and for zeros but for their signs; who calls it watches that there are no others (real_exact.wgsl).

const SIGN: u32 = 0x80000000u;
const ONE: u32 = 0x3f800000u;
// The bit of a significand that floats do not store.
const HIDDEN: u32 = 0x800000u;

// The value itself: no compiler sees through this to a product that it could add to something without rounding it first.
fn rounded(value: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(value) ^ zero());
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

// The nearest whole number to a correction, or the one below it: estimates of corrections are right to a thousandth.
fn nearly_rounded(correction: f32) -> i32 {
    return i32(floor(correction + 0.499));
}

fn quotient(a: f32, b: f32) -> f32 {
    return quotient_near(a, b, device_reciprocal(bitcast<f32>((bitcast<u32>(b) & 0x7fffffu) | ONE)));
}

// a / b from an estimate of the reciprocal of b's significand, off by 25 units at most. The remainder of the division in whole numbers is far
// smaller than 2^31, so that 32 bits hold it although they hold neither of its two parts.
fn quotient_near(a: f32, b: f32, reciprocal: f32) -> f32 {
    let words = bitcast<vec2u>(vec2f(a, b));
    let x = significand_of(words.x);
    let y = significand_of(words.y);
    // Of the quotient's significand 23 or 24 bits lie behind the point.
    let shift = select(23u, 24u, x < y);
    let estimate = i32(f32(x << (shift - 23u)) * reciprocal);
    let remainder = i32((x << shift) - u32(estimate) * y);
    let near = nearly_rounded(f32(remainder) * reciprocal * 1.1920929e-7);
    // Never exactly one half: no float times an odd multiple of half a unit is a float.
    let quotient = estimate + near + i32(2 * (remainder - near * i32(y)) > i32(y));
    let exponent = exponent_of(words.x) - exponent_of(words.y) + 150 - i32(shift);
    let result = u32((exponent << 23u) + quotient - i32(HIDDEN)) | ((words.x ^ words.y) & SIGN);
    return bitcast<f32>(select(result, 0u, is_zero(words.x)));
}

// A significand with the last bit of its exponent: in [1, 4).
fn from_one_to_four(word: u32) -> f32 {
    return bitcast<f32>(ONE + (word & 0x7fffffu) + ((word & HIDDEN) ^ HIDDEN));
}

// The exponent of the root of a positive number.
fn exponent_of_root(word: u32) -> u32 {
    return ((word >> 23u) + 127u) >> 1u;
}

fn root_and_reciprocal(a: f32) -> vec2f {
    let x = from_one_to_four(bitcast<u32>(a));
    return root_and_reciprocal_near(a, x, device_reciprocal_root(x));
}

// The root of a number, and for one that is not zero one over the root, from an estimate of the reciprocal root of its significand x, off by
// 25 units at most.
fn root_and_reciprocal_near(a: f32, x: f32, estimate: f32) -> vec2f {
    let word = bitcast<u32>(a);
    let exponent = exponent_of_root(word);
    let found = significands_of_root(x, estimate);
    let root = select(((exponent - 1u) << 23u) + found.x, 0u, is_zero(word));
    return bitcast<vec2f>(vec2u(root, ((252u - exponent) << 23u) + found.y));
}

// One over the root of a number that is not zero, where the root itself is not asked for.
fn reciprocal_root(a: f32) -> f32 {
    let word = bitcast<u32>(a);
    let x = from_one_to_four(word);
    let found = significands_of_root(x, device_reciprocal_root(x));
    return bitcast<f32>(((252u - exponent_of_root(word)) << 23u) + found.y);
}

// The root of x in [1, 4) times 2^23 and one over that root times 2^24, as whole numbers. As for quotients, 32 bits hold what is left.
fn significands_of_root(x: f32, reciprocal: f32) -> vec2u {
    let scaled = x * 8388608.0;
    let square = i32(scaled) << 23u;
    let estimate = i32(scaled * reciprocal);
    let near = estimate + nearly_rounded(f32(square - estimate * estimate) * reciprocal * 5.9604645e-8);
    // Never exactly one half: (n + 1/2)^2 is no whole number.
    let root = near + i32(square - near * near > near);
    // 2^47 over the root is in [2^23, 2^24], and never exactly one half either: only powers of two divide 2^48.
    let inverse = i32(reciprocal * 16777216.0);
    let remainder = -(inverse * root);
    let whole = nearly_rounded(f32(remainder) * reciprocal * 1.1920929e-7);
    return bitcast<vec2u>(vec2i(root, inverse + whole + i32(2 * (remainder - whole * root) > root)));
}

// The largest n whose square is not above that of which `square` is the last 32 bits, and what is left of it. `estimate`: of n, within 50;
// n in [2^23, 2^24). `half_inverse`: of 1 / 2 n, by a thousandth.
fn whole_root(square: i32, estimate: i32, half_inverse: f32) -> vec2i {
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

// Orders words as their floats are ordered; both zeros are one.
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

// Floats rounded as IEEE 754 asks, on devices that need not: WGSL lets a device contract products and sums, be off by units in quotients
// and roots, take subnormal numbers for zero, and not care about infinities, NaN and the sign of zero.
//
// Whoever includes this has `fn zero() -> u32`, a zero that compilers do not know, and device.wgsl. Everything here is right for normal numbers
// with normal results, and for zeros but for their signs; who calls it watches that there are no others (reals/exact.wgsl).

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
    var quotient = i32(f32(x << (shift - 23u)) * reciprocal);
    var remainder = i32((x << shift) - u32(quotient) * y);
    let whole = i32(round(f32(remainder) * reciprocal * 1.1920929e-7));
    quotient += whole;
    remainder -= whole * i32(y);
    // Never exactly one half: no float times an odd multiple of half a unit is a float.
    quotient += i32(2 * remainder > i32(y)) - i32(2 * remainder < -i32(y));
    let exponent = exponent_of(words.x) - exponent_of(words.y) + 150 - i32(shift);
    let result = u32((exponent << 23u) + quotient - i32(HIDDEN)) | ((words.x ^ words.y) & SIGN);
    return bitcast<f32>(select(result, 0u, is_zero(words.x)));
}

fn root(a: f32) -> f32 {
    let word = bitcast<u32>(a);
    // In [1, 4): with the last bit of the exponent.
    let x = bitcast<f32>((word & 0x7fffffu) | select(ONE, 0x40000000u, (exponent_of(word) & 1) == 0));
    return root_near(a, device_reciprocal_root(x));
}

// The root of a from an estimate of the reciprocal root of its significand in [1, 4), off by 25 units at most, as quotients.
fn root_near(a: f32, reciprocal: f32) -> f32 {
    let word = bitcast<u32>(a);
    let exponent = exponent_of(word);
    let square = significand_of(word) << select(23u, 24u, (exponent & 1) == 0);
    var root = i32(f32(significand_of(word) << select(0u, 1u, (exponent & 1) == 0)) * reciprocal);
    let rest = f32(i32(square - u32(root) * u32(root)));
    root += i32(round(rest * reciprocal * 5.9604645e-8));
    let left = i32(square - u32(root) * u32(root));
    // Never exactly one half: (n + 1/2)^2 is no whole number.
    root += i32(left > root) - i32(left <= -root);
    let result = u32((((exponent + 127) >> 1u) << 23u) + root - i32(HIDDEN));
    return bitcast<f32>(select(result, 0u, is_zero(word)));
}

// The largest n whose square is not above that of which `square` is the last 32 bits, and what is left of it. `estimate`: of n, within 50;
// n in [2^23, 2^24).
fn whole_root(square: u32, estimate: i32) -> vec2i {
    var root = estimate;
    root += i32(round(f32(i32(square - u32(root) * u32(root))) * (0.5 / f32(root))));
    var rest = i32(square - u32(root) * u32(root));
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

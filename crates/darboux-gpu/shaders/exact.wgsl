// Floats rounded as IEEE 754 asks, on devices that need not: WGSL lets a device contract products and sums, be off by units in quotients
// and roots, take subnormal numbers for zero, and not care about infinities, NaN and the sign of zero.
//
// Whoever includes this has `fn zero() -> u32`, a zero that compilers do not know. Where an operand or a result is subnormal,
// infinite or not a number, `is_unsure` is set, and the result may be anything.

var<private> is_unsure: bool;

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

// Zero or a normal number.
fn is_plain(word: u32) -> bool {
    let exponent = exponent_of(word);
    return (exponent > 0 && exponent < 255) || is_zero(word);
}

fn product(a: f32, b: f32) -> f32 {
    let words = bitcast<vec2u>(vec2f(a, b));
    let result = bitcast<u32>(rounded(a * b));
    let has_zero = is_zero(words.x) || is_zero(words.y);
    let vanishes = is_zero(result) && !has_zero;
    is_unsure = is_unsure || vanishes || !(is_plain(words.x) && is_plain(words.y) && is_plain(result));
    return bitcast<f32>(select(result, (words.x ^ words.y) & SIGN, has_zero));
}

fn sum(a: f32, b: f32) -> f32 {
    let words = bitcast<vec2u>(vec2f(a, b));
    let result = bitcast<u32>(rounded(a + b));
    let cancels = words.x == (words.y ^ SIGN);
    let has_only_zeros = is_zero(words.x) && is_zero(words.y);
    let vanishes = is_zero(result) && !cancels && !has_only_zeros;
    is_unsure = is_unsure || vanishes || !(is_plain(words.x) && is_plain(words.y) && is_plain(result));
    let zeros = select(words.x & words.y, 0u, cancels);
    return bitcast<f32>(select(result, zeros, cancels || has_only_zeros));
}

fn difference(a: f32, b: f32) -> f32 {
    return sum(a, bitcast<f32>(bitcast<u32>(b) ^ SIGN));
}

fn quotient(a: f32, b: f32) -> f32 {
    let x = bitcast<f32>((bitcast<u32>(a) & 0x7fffffu) | ONE);
    let y = bitcast<f32>((bitcast<u32>(b) & 0x7fffffu) | ONE);
    return quotient_near(a, b, x / y);
}

// a / b from an estimate of the quotient of their significands, off by 50 units of 2^-23 at most. The remainder of the division in integers
// is far smaller than 2^31, so that 32 bits hold it although they hold neither of its two parts.
fn quotient_near(a: f32, b: f32, estimate: f32) -> f32 {
    let words = bitcast<vec2u>(vec2f(a, b));
    let x = significand_of(words.x);
    let y = significand_of(words.y);
    // Of the quotient's significand 23 or 24 bits lie behind the point.
    let shift = select(23u, 24u, x < y);
    var quotient = i32(estimate * f32(1u << shift));
    var remainder = i32((x << shift) - u32(quotient) * y);
    let whole = remainder / i32(y);
    quotient += whole;
    remainder -= whole * i32(y);
    if remainder < 0 {
        quotient -= 1;
        remainder += i32(y);
    }
    // Never exactly one half: no float times an odd multiple of half a unit is a float.
    quotient += i32(2 * remainder > i32(y));
    let sign = (words.x ^ words.y) & SIGN;
    let exponent = exponent_of(words.x) - exponent_of(words.y) + 150 - i32(shift);
    let result = (exponent << 23u) + quotient - i32(HIDDEN);
    let is_normal = exponent > 0 && exponent < 255 && result < 0x7f800000;
    let has_zero = is_zero(words.x);
    let is_defined = is_plain(words.x) && is_plain(words.y) && !is_zero(words.y);
    is_unsure = is_unsure || !is_defined || !(is_normal || has_zero);
    return bitcast<f32>(select(u32(result), 0u, has_zero) | sign);
}

fn root(a: f32) -> f32 {
    let word = bitcast<u32>(a);
    // In [1, 4): with the last bit of the exponent.
    let x = bitcast<f32>((word & 0x7fffffu) | select(ONE, 0x40000000u, (exponent_of(word) & 1) == 0));
    return root_near(a, sqrt(x));
}

// The root of a from an estimate of that of its significand in [1, 4), off by 50 units of 2^-23 at most, as quotients.
fn root_near(a: f32, estimate: f32) -> f32 {
    let word = bitcast<u32>(a);
    let exponent = exponent_of(word);
    let square = significand_of(word) << select(23u, 24u, (exponent & 1) == 0);
    let found = whole_root(square, i32(estimate * 8388608.0));
    // Never exactly one half: (n + 1/2)^2 is no whole number.
    let significand = found.x + i32(found.y > found.x);
    let result = (((exponent + 127) >> 1u) << 23u) + significand - i32(HIDDEN);
    is_unsure = is_unsure || !is_plain(word) || ((word & SIGN) != 0u && !is_zero(word));
    return bitcast<f32>(select(u32(result), word, is_zero(word)));
}

// The largest n whose square is not above that of which `square` is the last 32 bits, and what is left of it. `estimate`: of n, within 100;
// n in [2^23, 2^24).
fn whole_root(square: u32, estimate: i32) -> vec2i {
    var root = estimate;
    root += i32(square - u32(root) * u32(root)) / (2 * root);
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

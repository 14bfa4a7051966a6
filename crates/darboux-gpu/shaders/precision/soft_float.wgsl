// IEEE 754 addition, multiplication, division and square root in integers, on the bits of floats. Subnormal numbers, infinities and the signs
// of zeros are correct on every device; every NaN is `NAN`. Requires correct_rounding.wgsl and uint64.wgsl.

const INFINITY: u32 = 0x7f800000u;
const NAN: u32 = 0x7fc00000u;

// The value significand 2^(exponent - 150), with the significand in [2^23, 2^24).
struct Decomposed {
    significand: u32,
    exponent: i32,
}

// Decomposes a finite number that is not zero.
fn decompose(word: u32) -> Decomposed {
    let exponent = exponent_of(word);
    let fraction = word & 0x7fffffu;
    if exponent > 0 {
        return Decomposed(fraction | HIDDEN, exponent);
    }
    let shift = countLeadingZeros(fraction) - 8u;
    return Decomposed(fraction << shift, 1 - i32(shift));
}

fn is_infinite(word: u32) -> bool {
    return (word & ~SIGN) == INFINITY;
}

// Shifts right; the last bit becomes 1 if any bit that was shifted out is 1 (sticky bit).
fn shift_right_sticky(a: vec2u, n: u32) -> vec2u {
    if n > 63u {
        return vec2u(0u, 1u);
    }
    let b = shift_right(a, n);
    let lost = any(shift_left_far(b, n) != a);
    return vec2u(b.x, b.y | u32(lost));
}

// n < 64.
fn shift_left_far(a: vec2u, n: u32) -> vec2u {
    if n < 32u {
        return shift_left(a, n);
    }
    return vec2u(a.y << (n - 32u), 0u);
}

// Rounds a 2^(exponent - 190) to the nearest float, ties to even. `a` is not zero.
fn round_to_float(sign: u32, a: vec2u, exponent: i32) -> u32 {
    let zeros = select(countLeadingZeros(a.x), 32u + countLeadingZeros(a.y), a.x == 0u);
    var significand = shift_left_far(a, zeros);
    var power = exponent - i32(zeros);
    if power >= 255 {
        return sign | INFINITY;
    }
    if power <= 0 {
        significand = shift_right_sticky(significand, u32(1 - power));
        power = 1;
    }
    let word = (u32(power - 1) << 23u) + (significand.x >> 8u);
    let is_above_half = (significand.x & 0x7fu) != 0u || significand.y != 0u;
    let is_odd = (significand.x & 0x100u) != 0u;
    return sign | (word + u32((significand.x & 0x80u) != 0u && (is_above_half || is_odd)));
}

fn soft_product(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    if is_nan(a) || is_nan(b) {
        return NAN;
    }
    if is_infinite(a) || is_infinite(b) {
        return select(sign | INFINITY, NAN, is_zero(a) || is_zero(b));
    }
    if is_zero(a) || is_zero(b) {
        return sign;
    }
    let x = decompose(a);
    let y = decompose(b);
    return round_to_float(sign, product_u32(x.significand, y.significand), x.exponent + y.exponent - 110);
}

fn soft_quotient(a: u32, b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    if is_nan(a) || is_nan(b) || (is_zero(a) && is_zero(b)) || (is_infinite(a) && is_infinite(b)) {
        return NAN;
    }
    if is_infinite(a) || is_zero(b) {
        return sign | INFINITY;
    }
    if is_zero(a) || is_infinite(b) {
        return sign;
    }
    let x = decompose(a);
    let y = decompose(b);
    var quotient = x.significand / y.significand;
    var rest = x.significand % y.significand;
    for (var digit = 0; digit < 4; digit++) {
        rest = rest << 7u;
        quotient = (quotient << 7u) + rest / y.significand;
        rest = rest % y.significand;
    }
    let marked = (quotient << 1u) | u32(rest != 0u);
    return round_to_float(sign, vec2u(0u, marked), x.exponent - y.exponent + 161);
}

fn soft_root(a: u32) -> u32 {
    if is_zero(a) || a == INFINITY {
        return a;
    }
    if is_nan(a) || (a & SIGN) != 0u {
        return NAN;
    }
    let x = decompose(a);
    let is_even = (x.exponent & 1) == 0;
    let square = i32(x.significand << select(23u, 24u, is_even));
    let estimate = 8388608.0 * sqrt(bitcast<f32>((x.significand & 0x7fffffu) | select(ONE, 0x40000000u, is_even)));
    let root = integer_sqrt(square, i32(estimate), 0.5 / estimate);
    let significand = u32(root.x + i32(root.y > root.x));
    return (u32((x.exponent + 127) >> 1u) << 23u) + significand - HIDDEN;
}

fn soft_sum(a: u32, b: u32) -> u32 {
    if is_nan(a) || is_nan(b) || (is_infinite(a) && b == (a ^ SIGN)) {
        return NAN;
    }
    if is_infinite(a) || is_infinite(b) {
        return select(b, a, is_infinite(a));
    }
    if is_zero(a) || is_zero(b) {
        return select(select(a, b, is_zero(a)), a & b, is_zero(a) && is_zero(b));
    }
    if b == (a ^ SIGN) {
        return 0u;
    }
    let a_is_larger = (a & ~SIGN) >= (b & ~SIGN);
    let larger = select(b, a, a_is_larger);
    let x = decompose(larger);
    let y = decompose(select(a, b, a_is_larger));
    let u = vec2u(x.significand << 7u, 0u);
    // The bits that are shifted out are below 2^-15 ulp and cannot change the rounding.
    let v = shift_right(vec2u(y.significand << 7u, 0u), u32(x.exponent - y.exponent));
    let has_one_sign = ((a ^ b) & SIGN) == 0u;
    let total = select(difference64(u, v), sum64(u, v), has_one_sign);
    return round_to_float(larger & SIGN, total, x.exponent + 1);
}

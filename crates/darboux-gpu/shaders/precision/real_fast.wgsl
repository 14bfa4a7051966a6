// `Real` as a float of the device, with the device's rounding. See real_exact.wgsl.

alias Real = f32;

const SIGN: u32 = 0x80000000u;
const ONE: u32 = 0x3f800000u;

// Nothing is checked.
fn is_unsure() -> bool {
    return false;
}

fn check_range(a: Real) {}

fn check_wide_range(a: Real) {}

fn check_not_tiny(a: Real) {}

fn check_normal_range(a: Real) {}

fn check_cancellation(total: Real, products: vec3<Real>) {}

fn has_direction(v: vec3<Real>, squares: Real) -> bool {
    return not_zero(v.x) || not_zero(v.y) || not_zero(v.z);
}

fn mark_unsure() {}

fn real(word: u32) -> Real {
    return bitcast<f32>(word);
}

fn bits_of(a: Real) -> u32 {
    return bitcast<u32>(a);
}

fn canonical_bits(a: Real) -> u32 {
    return bitcast<u32>(a);
}

fn float_of(a: Real) -> f32 {
    return a;
}

fn add(a: Real, b: Real) -> Real {
    return a + b;
}

fn subtract(a: Real, b: Real) -> Real {
    return a - b;
}

fn multiply(a: Real, b: Real) -> Real {
    return a * b;
}

fn divide(a: Real, b: Real) -> Real {
    return a / b;
}

// The square root and its reciprocal.
fn sqrt_and_inverse(a: Real) -> vec2<Real> {
    return vec2<Real>(sqrt(a), inverseSqrt(a));
}

fn inverse_sqrt(a: Real) -> Real {
    return inverseSqrt(a);
}

fn is_nan(word: u32) -> bool {
    return (word & ~SIGN) > 0x7f800000u;
}

fn is_above(a: Real, b: Real) -> bool {
    return a > b;
}

// M. Abramowitz and I. A. Stegun, "Handbook of Mathematical Functions", 4.4.46: an error of 2e-8, plus rounding. The built-in `acos` is wrong
// by thousands of ulp on some devices.
fn acos_of(a: Real) -> Real {
    let x = abs(a);
    var p = -0.0012624911;
    p = p * x + 0.0066700901;
    p = p * x - 0.0170881256;
    p = p * x + 0.0308918810;
    p = p * x - 0.0501743046;
    p = p * x + 0.0889789874;
    p = p * x - 0.2145988016;
    p = p * x + 1.5707963050;
    let found = sqrt(max(1.0 - x, 0.0)) * p;
    return select(found, 3.14159265 - found, a < 0.0);
}

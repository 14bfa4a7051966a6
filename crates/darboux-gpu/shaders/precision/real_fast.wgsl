// Real numbers as the device's own floats, as it rounds them.

alias Real = f32;

const SIGN: u32 = 0x80000000u;
const ONE: u32 = 0x3f800000u;

// Nothing to watch here.
fn is_unsure() -> bool {
    return false;
}

fn watch(a: Real) {}

fn watch_wide(a: Real) {}

fn watch_from_below(a: Real) {}

fn watch_short(a: Real) {}

fn watch_cancelling(total: Real, products: vec3<Real>) {}

fn has_direction(v: vec3<Real>, squares: Real) -> bool {
    return not_zero(v.x) || not_zero(v.y) || not_zero(v.z);
}

fn give_up() {}

fn real(word: u32) -> Real {
    return bitcast<f32>(word);
}

fn word_of(a: Real) -> u32 {
    return bitcast<u32>(a);
}

fn stored(a: Real) -> u32 {
    return bitcast<u32>(a);
}

fn estimate_of(a: Real) -> f32 {
    return a;
}

fn plus(a: Real, b: Real) -> Real {
    return a + b;
}

fn minus(a: Real, b: Real) -> Real {
    return a - b;
}

fn times(a: Real, b: Real) -> Real {
    return a * b;
}

fn over(a: Real, b: Real) -> Real {
    return a / b;
}

// And one over the root.
fn root_and_inverse_of(a: Real) -> vec2<Real> {
    return vec2<Real>(sqrt(a), inverseSqrt(a));
}

fn inverse_root_of(a: Real) -> Real {
    return inverseSqrt(a);
}

fn is_nan(word: u32) -> bool {
    return (word & ~SIGN) > 0x7f800000u;
}

fn is_above(a: Real, b: Real) -> bool {
    return a > b;
}

// M. Abramowitz and I. A. Stegun, "Handbook of Mathematical Functions", 4.4.46: off by 2e-8 besides rounding. WGSL's own is off by thousands
// of units on some devices.
fn arccosine_of(a: Real) -> Real {
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

// `Real` as the bits of a float, with arithmetic in integers: correct for all floats on every device. See real_exact.wgsl. Requires
// correct_rounding.wgsl, uint64.wgsl, soft_float.wgsl, arccosine.wgsl.

alias Real = u32;

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
    return word;
}

fn bits_of(a: Real) -> u32 {
    return a;
}

fn canonical_bits(a: Real) -> u32 {
    return a;
}

fn float_of(a: Real) -> f32 {
    return bitcast<f32>(a);
}

fn add(a: Real, b: Real) -> Real {
    return soft_sum(a, b);
}

fn subtract(a: Real, b: Real) -> Real {
    return soft_sum(a, b ^ SIGN);
}

fn multiply(a: Real, b: Real) -> Real {
    return soft_product(a, b);
}

fn divide(a: Real, b: Real) -> Real {
    return soft_quotient(a, b);
}

// The square root and its reciprocal.
fn sqrt_and_inverse(a: Real) -> vec2<Real> {
    let root = soft_root(a);
    return vec2<Real>(root, soft_quotient(ONE, root));
}

fn inverse_sqrt(a: Real) -> Real {
    return soft_quotient(ONE, soft_root(a));
}

fn is_above(a: Real, b: Real) -> bool {
    return order(a) > order(b) && !is_nan(a) && !is_nan(b);
}

fn acos_of(a: Real) -> Real {
    if is_nan(a) {
        return NAN;
    }
    return bitcast<u32>(arccosine(bitcast<f32>(a)));
}

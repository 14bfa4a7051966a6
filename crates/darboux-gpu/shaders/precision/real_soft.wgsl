// Real numbers as the words of floats, whose arithmetic is that of whole numbers: right for all floats on every device. Needs correct_rounding.wgsl,
// uint64.wgsl, soft_float.wgsl, arccosine.wgsl.

alias Real = u32;

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
    return word;
}

fn word_of(a: Real) -> u32 {
    return a;
}

fn stored(a: Real) -> u32 {
    return a;
}

fn estimate_of(a: Real) -> f32 {
    return bitcast<f32>(a);
}

fn plus(a: Real, b: Real) -> Real {
    return soft_sum(a, b);
}

fn minus(a: Real, b: Real) -> Real {
    return soft_sum(a, b ^ SIGN);
}

fn times(a: Real, b: Real) -> Real {
    return soft_product(a, b);
}

fn over(a: Real, b: Real) -> Real {
    return soft_quotient(a, b);
}

// And one over the root.
fn root_and_inverse_of(a: Real) -> vec2<Real> {
    let root = soft_root(a);
    return vec2<Real>(root, soft_quotient(ONE, root));
}

fn inverse_root_of(a: Real) -> Real {
    return soft_quotient(ONE, soft_root(a));
}

fn is_above(a: Real, b: Real) -> bool {
    return order(a) > order(b) && !is_nan(a) && !is_nan(b);
}

fn arccosine_of(a: Real) -> Real {
    if is_nan(a) {
        return NAN;
    }
    return bitcast<u32>(arccosine(bitcast<f32>(a)));
}

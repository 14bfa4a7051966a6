// Real numbers as the device's own floats, rounded as the CPU's; needs exact.wgsl, whole.wgsl, arccosine.wgsl. What these are unsure of is
// done again with reals/soft.wgsl. Stages are written in the functions of these files alone, so that each is one text in all
// three arithmetics.

alias Real = f32;

fn real(word: u32) -> Real {
    return bitcast<f32>(word);
}

fn word_of(a: Real) -> u32 {
    return bitcast<u32>(a);
}

// For estimates, whose errors the caller allows for.
fn estimate_of(a: Real) -> f32 {
    return a;
}

fn plus(a: Real, b: Real) -> Real {
    return sum(a, b);
}

fn minus(a: Real, b: Real) -> Real {
    return difference(a, b);
}

fn times(a: Real, b: Real) -> Real {
    return product(a, b);
}

fn over(a: Real, b: Real) -> Real {
    return quotient(a, b);
}

fn root_of(a: Real) -> Real {
    return root(a);
}

fn is_above(a: Real, b: Real) -> bool {
    return is_less(b, a);
}

fn arccosine_of(a: Real) -> Real {
    return arccosine(a);
}

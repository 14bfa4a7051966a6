// What a device computes that takes all liberties of WGSL but contraction: subnormal numbers are zeros, zeros have any sign, what is not finite
// is anything, reciprocals are off by units. For tests, on devices that take none.

fn is_tiny(a: f32) -> bool {
    return (bitcast<u32>(a) & 0x7f800000u) == 0u;
}

// As random as it needs to be.
fn noise(a: f32, b: f32) -> u32 {
    let mixed = (bitcast<u32>(a) ^ (bitcast<u32>(b) * 0x9e3779b9u)) * 0x85ebca6bu;
    return mixed ^ (mixed >> 15u);
}

fn taken(a: f32) -> f32 {
    return select(a, 0.0, is_tiny(a));
}

fn given_back(result: f32, noise: u32) -> f32 {
    let word = bitcast<u32>(result);
    if is_tiny(result) {
        return bitcast<f32>(noise & 0x80000000u);
    }
    return select(result, 0.75, (word & 0x7f800000u) == 0x7f800000u);
}

fn device_product(a: f32, b: f32) -> f32 {
    return given_back(taken(a) * taken(b), noise(a, b));
}

fn device_sum(a: f32, b: f32) -> f32 {
    return given_back(taken(a) + taken(b), noise(a, b));
}

fn device_reciprocal(a: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(1.0 / a) + noise(a, 1.0) % 9u - 4u);
}

fn device_reciprocal_root(a: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(inverseSqrt(a)) + noise(a, 2.0) % 9u - 4u);
}

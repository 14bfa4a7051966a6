// Simulates a device that rounds as badly as WGSL permits, except for fused operations: subnormal numbers are flushed to zero, zeros have
// random signs, values that are not finite are replaced, reciprocals are wrong by up to 4 ulp. For tests, instead of device_floats.wgsl.

fn is_subnormal_or_zero(a: f32) -> bool {
    return (bitcast<u32>(a) & 0x7f800000u) == 0u;
}

// A hash of the operands.
fn noise(a: f32, b: f32) -> u32 {
    let mixed = (bitcast<u32>(a) ^ (bitcast<u32>(b) * 0x9e3779b9u)) * 0x85ebca6bu;
    return mixed ^ (mixed >> 15u);
}

fn flush_operand(a: f32) -> f32 {
    return select(a, 0.0, is_subnormal_or_zero(a));
}

fn perturb_result(result: f32, noise: u32) -> f32 {
    let word = bitcast<u32>(result);
    if is_subnormal_or_zero(result) {
        return bitcast<f32>(noise & 0x80000000u);
    }
    return select(result, 0.75, (word & 0x7f800000u) == 0x7f800000u);
}

fn device_product(a: f32, b: f32) -> f32 {
    return perturb_result(flush_operand(a) * flush_operand(b), noise(a, b));
}

fn device_sum(a: f32, b: f32) -> f32 {
    return perturb_result(flush_operand(a) + flush_operand(b), noise(a, b));
}

fn device_reciprocal(a: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(1.0 / a) + noise(a, 1.0) % 9u - 4u);
}

fn device_reciprocal_root(a: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(inverseSqrt(a)) + noise(a, 2.0) % 9u - 4u);
}

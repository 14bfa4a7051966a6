// The float operations of the device. hostile_floats.wgsl replaces them in tests.

fn device_product(a: f32, b: f32) -> f32 {
    return a * b;
}

fn device_sum(a: f32, b: f32) -> f32 {
    return a + b;
}

fn device_reciprocal(a: f32) -> f32 {
    return 1.0 / a;
}

fn device_reciprocal_root(a: f32) -> f32 {
    return inverseSqrt(a);
}

//! The texels inside triangles of UVs.

/// Twice the signed area of a triangle.
pub fn twice_area([a, b, c]: [[f32; 2]; 3]) -> f32 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The texels inside a triangle of UVs in texels, and the weights of its corners there.
pub fn texels_inside(uvs: [[f32; 2]; 3]) -> Vec<(i32, i32, [f32; 3])> {
    let range = |i: usize| {
        let values = uvs.map(|uv| uv[i]);
        let low = values.into_iter().fold(f32::INFINITY, f32::min).ceil();
        let high = values.into_iter().fold(f32::NEG_INFINITY, f32::max).floor();
        low as i32..high as i32 + 1
    };
    let mut inside = Vec::new();
    for (y, x) in range(1).flat_map(|y| range(0).map(move |x| (y, x))) {
        let here = [x as f32, y as f32];
        let parts = [[here, uvs[1], uvs[2]], [uvs[0], here, uvs[2]], [uvs[0], uvs[1], here]];
        let weights = parts.map(|part| twice_area(part) / twice_area(uvs));
        if weights.iter().all(|&weight| weight >= 0.0) {
            inside.push((x, y, weights));
        }
    }
    inside
}

var<private> place_: vec2f;

// A value that changes by the vector at k per pixel to the right, and by the next vector per pixel down.
fn spread2(k: u32) -> vec2f { return place_.x * given2(k) + place_.y * given2(k + 2u); }
fn spread3(k: u32) -> vec3f { return place_.x * given3(k) + place_.y * given3(k + 3u); }

@fragment
fn main(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    place_ = vec2f(pixel & vec2u(1u));
    sample_ = 4u * (QUADS * (pixel.y / 2u) + pixel.x / 2u) + 2u * (pixel.y & 1u) + (pixel.x & 1u);
    BODY
    return vec4f();
}

struct Pixel {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
}

@vertex
fn vertex(
    @location(0) position: vec2f,
    @location(1) uv: vec2f,
    @location(2) normal: vec3f,
    @location(3) short_normal: vec2i,
    @location(4) code: CODE,
) -> Pixel {
    let frame = VERTEX_FRAME;
    return Pixel(vec4f(position, 0.0, 1.0), uv, frame.normal, frame.tangent);
}

@group(0) @binding(0) var map: texture_2d<f32>;

// The colour of copper, lit from the upper left.
fn lit(normal: vec3f) -> vec3f {
    let diffuse = max(dot(normal, normalize(vec3f(-1.0, 1.0, 1.0))), 0.0);
    let shine = 0.6 * pow(max(dot(normal, normalize(vec3f(-1.0, 1.0, 2.732))), 0.0), 16.0);
    return vec3f(0.85, 0.5, 0.35) * (0.15 + 0.85 * diffuse) + shine;
}

@fragment
fn fragment(pixel: Pixel) -> @location(0) vec4f {
    let place = vec2f(pixel.uv.x, 1.0 - pixel.uv.y) * vec2f(textureDimensions(map));
    let texel = textureLoad(map, vec2i(place), 0).xyz;
    let frame = tangent_frame(pixel.normal, pixel.tangent);
    return vec4f(lit(normal_to_surface(frame, normal_from_texel(texel))), 1.0);
}

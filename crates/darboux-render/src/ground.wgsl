// Draws the ground below a model: the background, darkened by the shadow.

struct Ground {
    // From eye space to clip space.
    projection: mat4x4f,
    // The corners of the square in eye space, along x and then along z.
    corners: array<vec4f, 4>,
    // The linear colour of the background.
    background: vec4f,
}

@group(0) @binding(0) var<uniform> ground: Ground;
@group(0) @binding(1) var shadow: texture_2d<f32>;
@group(0) @binding(2) var shadow_sampler: sampler;

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) place: vec2f,
}

@vertex
fn transform_ground(@builtin(vertex_index) corner: u32) -> Varyings {
    var out: Varyings;
    out.position = ground.projection * vec4f(ground.corners[corner].xyz, 1.0);
    // The near and far planes are set for the model and would cut the ground.
    out.position.z = 0.5 * out.position.w;
    out.place = vec2f(f32(corner & 1u), f32(corner >> 1u));
    return out;
}

@fragment
fn shade_ground(in: Varyings) -> @location(0) vec4f {
    return vec4f(ground.background.rgb * (1.0 - textureSample(shadow, shadow_sampler, in.place).x), 1.0);
}

// A model in one of the views. Needs shaders/wgsl: frame, normal_map, transform, derivatives.

struct Picture {
    // From the eye's space to clip space.
    projection: mat4x4f,
    // From the scene's directions to the eye's.
    turn: mat3x3f,
    // How far the eye is from the origin, along z.
    distance: f32,
    // 0 shaded, 1 tangent, 2 bitangent, 3 normal, 4 sign, 5 angle.
    view: u32,
    // Degrees.
    heat_ends: vec2f,
    ramp: array<vec4f, 9>,
    flip: vec4f,
    none: vec4f,
    // Where w is 1, and -1.
    plus: vec4f,
    minus: vec4f,
    // -1 where w is flipped by mistake, and where green is.
    w_side: f32,
    green_side: f32,
    // Whether images are sampled at 1 - v by mistake.
    is_v_flipped: u32,
    // Whether frames are derived at every pixel.
    is_derived: u32,
    // Whether this is a UV layout, which has no shape to be seen.
    is_flat: u32,
}

struct Material {
    base_color: vec4f,
    // Where u and v are taken on the image of the base colour, and of the normal map; and where the origin of both is.
    base_axes: vec4f,
    normal_axes: vec4f,
    origins: vec4f,
    normal_scale: f32,
    // Below it nothing is there; negative where alpha means nothing, above 1 where it covers partly.
    alpha_cutoff: f32,
    // 0: domes in its place.
    has_normal_map: u32,
}

@group(0) @binding(0) var<uniform> picture: Picture;
@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_texture: texture_2d<f32>;
@group(1) @binding(2) var base_sampler: sampler;
@group(1) @binding(3) var normal_texture: texture_2d<f32>;
@group(1) @binding(4) var normal_sampler: sampler;

struct Corner {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uvs: vec4f,
    @location(4) degrees: f32,
}

// Where a node places its mesh: to the eye's space, and of directions to the scene.
struct Place {
    @location(5) eye_x: vec4f,
    @location(6) eye_y: vec4f,
    @location(7) eye_z: vec4f,
    @location(8) eye_origin: vec4f,
    @location(9) x: vec3f,
    @location(10) y: vec3f,
    @location(11) z: vec3f,
}

struct Seen {
    @builtin(position) place: vec4f,
    @location(0) eye: vec3f,
    @location(1) normal: vec3f,
    // In the scene; its w is the scene's, too.
    @location(2) tangent: vec4f,
    @location(3) uvs: vec4f,
    @location(4) degrees: f32,
    // The w of the file.
    @location(5) sign: f32,
    // -1 where the node mirrors.
    @location(6) @interpolate(flat) orientation: f32,
}

@vertex
fn place_corner(corner: Corner, place: Place) -> Seen {
    let to_eye = mat4x4f(place.eye_x, place.eye_y, place.eye_z, place.eye_origin);
    let transform = frame_transform(linear_map(place.x, place.y, place.z));
    var seen: Seen;
    seen.eye = (to_eye * vec4f(corner.position, 1.0)).xyz;
    seen.place = picture.projection * vec4f(seen.eye, 1.0);
    seen.normal = transformed_normal(transform, corner.normal);
    // Not made perpendicular to the normal: what the file has is to be seen.
    let tangent = unit_or(mapped(transform.map, corner.tangent.xyz), vec3f(0.0, 0.0, 0.0));
    seen.sign = picture.w_side * corner.tangent.w;
    seen.tangent = vec4f(tangent, transform.orientation * seen.sign);
    let base_uv = on_image(corner.uvs.xy, material.base_axes, material.origins.xy);
    seen.uvs = vec4f(base_uv, on_image(corner.uvs.zw, material.normal_axes, material.origins.zw));
    seen.degrees = corner.degrees;
    seen.orientation = transform.orientation;
    return seen;
}

// Where a UV meets an image.
fn on_image(uv: vec2f, axes: vec4f, origin: vec2f) -> vec2f {
    let v = select(uv.y, 1.0 - uv.y, picture.is_v_flipped != 0u);
    return origin + uv.x * axes.xy + v * axes.zw;
}

@fragment
fn shade(seen: Seen, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = material.base_color * textureSample(base_texture, base_sampler, seen.uvs.xy);
    let texel = textureSample(normal_texture, normal_sampler, seen.uvs.zw).xyz;
    let facet = cross(dpdx(seen.eye), dpdy(seen.eye));
    let to_eye = unit_or(vec3f(0.0, 0.0, picture.distance) - seen.eye, vec3f(0.0, 0.0, 1.0));
    let facing = select(abs(dot(unit_or(facet, to_eye), to_eye)), 1.0, picture.is_flat != 0u);
    if (picture.view == 0u) {
        let side = select(-1.0, 1.0, is_front) * seen.orientation;
        return vec4f(lit(base.rgb, side * surface_normal(seen, texel), to_eye), coverage(base.a));
    }
    // Where triangles of a layout lie over each other, all are seen.
    let alpha = select(1.0, LAYOUT_ALPHA, picture.is_flat != 0u);
    return vec4f(frame_color(seen, 0.75 + 0.25 * facing), alpha);
}

const LAYOUT_ALPHA: f32 = 0.6;

// The unit normal with what the normal map says, in the eye's directions.
fn surface_normal(seen: Seen, texel: vec3f) -> vec3f {
    // As MikkTSpace wants them: interpolated, not made unit.
    var frame = tangent_frame(seen.normal, seen.tangent);
    if (picture.is_derived != 0u) {
        frame = derived_frame(seen);
    }
    var normal = vec3f(0.0, 0.0, 1.0);
    if (material.has_normal_map != 0u) {
        normal = scaled_normal(normal_from_texel(texel), vec2f(material.normal_scale, material.normal_scale));
    } else if (seen.sign != 0.0) {
        normal = dome(seen.uvs.zw);
    }
    normal.y *= picture.green_side;
    return picture.turn * normal_to_surface(frame, normal);
}

// The frame of shaders that have no tangents, in the scene's directions.
fn derived_frame(seen: Seen) -> TangentFrame {
    let position = seen.eye * picture.turn;
    // v goes down the image, green up.
    let uv = vec2f(seen.uvs.z, -seen.uvs.w);
    return cotangent_frame_from_derivatives(unit_or(seen.normal, vec3f(0.0, 0.0, 1.0)), position, uv);
}

// The pattern of parts without a normal map: eight domes across the UV square, as the viewer has it.
fn dome(uv: vec2f) -> vec3f {
    let slope = 0.9 * (fract(8.0 * uv) - vec2f(0.5, 0.5)) / 0.36;
    let size = dot(slope, slope);
    // v goes down the image, green up.
    return select(vec3f(0.0, 0.0, 1.0), vec3f(slope.x, -slope.y, sqrt(max(1.0 - size, 0.0))), size < 0.81);
}

// A light above right of the eye, and surroundings that are lighter above than below.
fn lit(color: vec3f, normal: vec3f, to_eye: vec3f) -> vec3f {
    let light = normalize(vec3f(0.6, 0.7, 0.55));
    let above = 0.5 + 0.5 * dot(normal, picture.turn[1]);
    let surroundings = mix(vec3f(0.16, 0.14, 0.13), vec3f(0.36, 0.40, 0.46), above);
    let diffuse = max(dot(normal, light), 0.0);
    let shine = 0.22 * pow(max(dot(normal, normalize(light + to_eye)), 0.0), 40.0);
    return color * (surroundings + vec3f(0.8 * diffuse)) + vec3f(shine * step(0.0, diffuse));
}

fn coverage(alpha: f32) -> f32 {
    if (material.alpha_cutoff < 0.0) {
        return 1.0;
    }
    if (material.alpha_cutoff > 1.0) {
        return alpha;
    }
    return step(material.alpha_cutoff, alpha);
}

// The colours of frames. facing: darker where the surface is seen from the side, so that flat colours have a shape.
fn frame_color(seen: Seen, facing: f32) -> vec3f {
    let has_tangent = seen.sign != 0.0;
    switch picture.view {
        case 2u: {
            return direction_color(bitangent_of(seen.normal, seen.tangent));
        }
        case 3u: {
            return direction_color(seen.normal);
        }
        case 4u: {
            let sides = select(picture.minus.rgb, picture.plus.rgb, seen.sign > 0.0);
            return facing * select(vec3f(0.0, 0.0, 0.0), sides, has_tangent);
        }
        case 5u: {
            return facing * heat_color(seen.degrees);
        }
        default: {
            return direction_color(seen.tangent.xyz);
        }
    }
}

// Black where there is none.
fn direction_color(v: vec3f) -> vec3f {
    let size = dot(v, v);
    if (!(size > 0.0)) {
        return vec3f(0.0, 0.0, 0.0);
    }
    return vec3f(0.5, 0.5, 0.5) + 0.5 * v / sqrt(size);
}

fn heat_color(degrees: f32) -> vec3f {
    if (degrees < -0.5) {
        return picture.none.rgb;
    }
    if (degrees > 180.5) {
        return picture.flip.rgb;
    }
    let ends = picture.heat_ends;
    let place = 8.0 * clamp(log(max(degrees, ends.x) / ends.x) / log(ends.y / ends.x), 0.0, 1.0);
    let below = min(u32(place), 7u);
    return mix(picture.ramp[below].rgb, picture.ramp[below + 1u].rgb, place - f32(below));
}

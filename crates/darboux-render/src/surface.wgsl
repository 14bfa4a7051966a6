// Draws the triangles of a model in one of the views. Requires shaders/wgsl: frame, normal_map, transform, derivatives.

struct Picture {
    // From eye space to clip space.
    projection: mat4x4f,
    // Rotates directions from the scene to eye space.
    rotation: mat3x3f,
    // The distance of the eye from the origin of eye space, along z.
    distance: f32,
    // 0 shaded, 1 tangent, 2 bitangent, 3 normal, 4 sign, 5 angle.
    view: u32,
    // The ends of the colour scale, in degrees.
    heat_ends: vec2f,
    ramp: array<vec4f, 9>,
    flip: vec4f,
    no_angle: vec4f,
    // The colours of w = 1 and w = -1.
    plus: vec4f,
    minus: vec4f,
    // -1 if the mistake is made to negate w, or green.
    w_factor: f32,
    green_factor: f32,
    // 1 if the mistake is made to sample images at 1 - v.
    is_v_flipped: u32,
    // 1 if frames are derived at every pixel.
    is_derived: u32,
    // 1 for a UV layout, which is drawn without shading.
    is_layout: u32,
    // 1 if the mistake is made to exchange the columns of bitangent and normal.
    has_wrong_columns: u32,
}

struct Material {
    base_color: vec4f,
    // The texture transforms of the base colour and the normal map: the images of the u and v axes, and of the origins.
    base_axes: vec4f,
    normal_axes: vec4f,
    origins: vec4f,
    normal_scale: f32,
    // Alpha below the cutoff is transparent. Negative if alpha is ignored, above 1 if alpha is the coverage.
    alpha_cutoff: f32,
    // 0 if the pattern of domes replaces the normal map.
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

// A place of a mesh: its transform to eye space, and its linear part to the scene.
struct Instance {
    @location(5) eye_x: vec4f,
    @location(6) eye_y: vec4f,
    @location(7) eye_z: vec4f,
    @location(8) eye_origin: vec4f,
    @location(9) x: vec3f,
    @location(10) y: vec3f,
    @location(11) z: vec3f,
}

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) eye: vec3f,
    @location(1) normal: vec3f,
    // In the scene, with the sign w in the scene.
    @location(2) tangent: vec4f,
    @location(3) uvs: vec4f,
    @location(4) degrees: f32,
    // The sign w of the file.
    @location(5) sign: f32,
    // -1 if the node mirrors.
    @location(6) @interpolate(flat) orientation: f32,
}

@vertex
fn transform_corner(corner: Corner, instance: Instance) -> Varyings {
    let to_eye = mat4x4f(instance.eye_x, instance.eye_y, instance.eye_z, instance.eye_origin);
    let transform = frame_transform(linear_map(instance.x, instance.y, instance.z));
    var out: Varyings;
    out.eye = (to_eye * vec4f(corner.position, 1.0)).xyz;
    out.position = picture.projection * vec4f(out.eye, 1.0);
    out.normal = transformed_normal(transform, corner.normal);
    // The tangent is not made perpendicular to the normal, so that the picture shows the data of the file.
    let tangent = unit_or(mapped(transform.map, corner.tangent.xyz), vec3f(0.0, 0.0, 0.0));
    out.sign = picture.w_factor * corner.tangent.w;
    out.tangent = vec4f(tangent, transform.orientation * out.sign);
    let base_uv = transformed_uv(corner.uvs.xy, material.base_axes, material.origins.xy);
    out.uvs = vec4f(base_uv, transformed_uv(corner.uvs.zw, material.normal_axes, material.origins.zw));
    out.degrees = corner.degrees;
    out.orientation = transform.orientation;
    return out;
}

// Applies a texture transform.
fn transformed_uv(uv: vec2f, axes: vec4f, origin: vec2f) -> vec2f {
    let v = select(uv.y, 1.0 - uv.y, picture.is_v_flipped != 0u);
    return origin + uv.x * axes.xy + v * axes.zw;
}

@fragment
fn shade(in: Varyings, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = material.base_color * textureSample(base_texture, base_sampler, in.uvs.xy);
    let texel = textureSample(normal_texture, normal_sampler, in.uvs.zw).xyz;
    let facet = cross(dpdx(in.eye), dpdy(in.eye));
    let to_eye = unit_or(vec3f(0.0, 0.0, picture.distance) - in.eye, vec3f(0.0, 0.0, 1.0));
    let facing = select(abs(dot(unit_or(facet, to_eye), to_eye)), 1.0, picture.is_layout != 0u);
    if (picture.view == 0u) {
        let side = select(-1.0, 1.0, is_front) * in.orientation;
        return vec4f(lit(base.rgb, side * surface_normal(in, texel), to_eye), coverage(base.a));
    }
    // Overlapping triangles of a layout are translucent.
    let alpha = select(1.0, LAYOUT_ALPHA, picture.is_layout != 0u);
    return vec4f(frame_color(in, 0.75 + 0.25 * facing), alpha);
}

const LAYOUT_ALPHA: f32 = 0.6;

// The unit normal in eye space, with the normal map applied.
fn surface_normal(in: Varyings, texel: vec3f) -> vec3f {
    // MikkTSpace requires interpolated vectors that are not normalised.
    var frame = tangent_frame(in.normal, in.tangent);
    if (picture.is_derived != 0u) {
        frame = derived_frame(in);
    }
    var normal = vec3f(0.0, 0.0, 1.0);
    if (material.has_normal_map != 0u) {
        normal = scaled_normal(normal_from_texel(texel), vec2f(material.normal_scale, material.normal_scale));
    } else if (in.sign != 0.0) {
        normal = dome(in.uvs.zw);
    }
    normal.y *= picture.green_factor;
    if (picture.has_wrong_columns != 0u) {
        normal = normal.xzy;
    }
    return picture.rotation * normal_to_surface(frame, normal);
}

// The frame that shaders without tangents derive, in the scene.
fn derived_frame(in: Varyings) -> TangentFrame {
    let position = in.eye * picture.rotation;
    // v points down in the image, green points up.
    let uv = vec2f(in.uvs.z, -in.uvs.w);
    return cotangent_frame_from_derivatives(unit_or(in.normal, vec3f(0.0, 0.0, 1.0)), position, uv);
}

// The pattern for materials without a normal map: 8 x 8 domes over the UV square, as in the viewer.
fn dome(uv: vec2f) -> vec3f {
    let slope = 0.9 * (fract(8.0 * uv) - vec2f(0.5, 0.5)) / 0.36;
    let size = dot(slope, slope);
    // v points down in the image, green points up.
    return select(vec3f(0.0, 0.0, 1.0), vec3f(slope.x, -slope.y, sqrt(max(1.0 - size, 0.0))), size < 0.81);
}

// A light at the upper right of the eye, and ambient light that is brighter from above.
fn lit(color: vec3f, normal: vec3f, to_eye: vec3f) -> vec3f {
    let light = normalize(vec3f(0.6, 0.7, 0.55));
    let above = 0.5 + 0.5 * dot(normal, picture.rotation[1]);
    let ambient = mix(vec3f(0.16, 0.14, 0.13), vec3f(0.36, 0.40, 0.46), above);
    let diffuse = max(dot(normal, light), 0.0);
    let shine = 0.22 * pow(max(dot(normal, normalize(light + to_eye)), 0.0), 40.0);
    return color * (ambient + vec3f(0.8 * diffuse)) + vec3f(shine * step(0.0, diffuse));
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

// The colour of a view of frames. `facing`: darkens surfaces at grazing angles, so that flat colours show the shape.
fn frame_color(in: Varyings, facing: f32) -> vec3f {
    let has_tangent = in.sign != 0.0;
    switch picture.view {
        case 2u: {
            return direction_color(bitangent_of(in.normal, in.tangent));
        }
        case 3u: {
            return direction_color(in.normal);
        }
        case 4u: {
            let sides = select(picture.minus.rgb, picture.plus.rgb, in.sign > 0.0);
            return facing * select(vec3f(0.0, 0.0, 0.0), sides, has_tangent);
        }
        case 5u: {
            return facing * heat_color(in.degrees);
        }
        default: {
            return direction_color(in.tangent.xyz);
        }
    }
}

// The colour of a direction; black for zero.
fn direction_color(v: vec3f) -> vec3f {
    let size = dot(v, v);
    if (!(size > 0.0)) {
        return vec3f(0.0, 0.0, 0.0);
    }
    return vec3f(0.5, 0.5, 0.5) + 0.5 * v / sqrt(size);
}

fn heat_color(degrees: f32) -> vec3f {
    if (degrees < -0.5) {
        return picture.no_angle.rgb;
    }
    if (degrees > 180.5) {
        return picture.flip.rgb;
    }
    let ends = picture.heat_ends;
    let place = 8.0 * clamp(log(max(degrees, ends.x) / ends.x) / log(ends.y / ends.x), 0.0, 1.0);
    let below = min(u32(place), 7u);
    return mix(picture.ramp[below].rgb, picture.ramp[below + 1u].rgb, place - f32(below));
}

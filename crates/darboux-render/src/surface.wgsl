// Draws the triangles of a model in one of the views. Requires shaders/wgsl: frame, normal_map, transform, derivatives.

struct Picture {
    // From eye space to clip space.
    projection: mat4x4f,
    // Rotates directions from the scene to eye space.
    rotation: mat3x3f,
    // The distance of the eye from the origin of eye space, along z.
    distance: f32,
    // 0 shaded, 1 shaded with test bumps, 2 tangent, 3 bitangent, 4 normal, 5 sign, 6 angle.
    view: u32,
    // The ends of the colour scale, in degrees.
    heat_ends: vec2f,
    ramp: array<vec4f, 9>,
    flip: vec4f,
    no_angle: vec4f,
    // The colours of w = 1 and w = -1.
    plus: vec4f,
    minus: vec4f,
    // The direction to the light, and its intensity.
    light: vec4f,
    // The directions to the lamps, and their sharpness.
    lamps: array<vec4f, 6>,
    lamp_radiance: array<vec4f, 6>,
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
    // The radiance from everywhere.
    room: f32,
}

struct Material {
    base_color: vec4f,
    // The texture transforms of base colour, normal map, roughness and metal, occlusion, emission: the images of the u and v axes, and of the origins.
    axes: array<vec4f, 5>,
    origins: array<vec4f, 5>,
    emission: vec3f,
    normal_scale: f32,
    metallic: f32,
    roughness: f32,
    occlusion: f32,
    // Alpha below the cutoff is transparent. Negative if alpha is ignored, above 1 if alpha is the coverage.
    alpha_cutoff: f32,
    // 1 if the base colour is shown without light.
    is_unlit: u32,
    has_normal_map: u32,
    // 1 if test bumps stand for a missing normal map.
    has_bumps: u32,
}

@group(0) @binding(0) var<uniform> picture: Picture;
@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_texture: texture_2d<f32>;
@group(1) @binding(2) var base_sampler: sampler;
@group(1) @binding(3) var normal_texture: texture_2d<f32>;
@group(1) @binding(4) var normal_sampler: sampler;
@group(1) @binding(5) var surface_texture: texture_2d<f32>;
@group(1) @binding(6) var surface_sampler: sampler;
@group(1) @binding(7) var occlusion_texture: texture_2d<f32>;
@group(1) @binding(8) var occlusion_sampler: sampler;
@group(1) @binding(9) var emission_texture: texture_2d<f32>;
@group(1) @binding(10) var emission_sampler: sampler;

struct Corner {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    // Of base colour and normal map, of roughness and occlusion, of emission.
    @location(3) uvs: vec4f,
    @location(4) surface_uvs: vec4f,
    @location(5) emission_uv: vec2f,
    @location(14) color: vec4f,
    @location(6) degrees: f32,
}

// A place of a mesh: its transform to eye space, and its linear part to the scene.
struct Instance {
    @location(7) eye_x: vec4f,
    @location(8) eye_y: vec4f,
    @location(9) eye_z: vec4f,
    @location(10) eye_origin: vec4f,
    @location(11) x: vec3f,
    @location(12) y: vec3f,
    @location(13) z: vec3f,
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
    @location(7) surface_uvs: vec4f,
    @location(8) emission_uv: vec2f,
    @location(9) color: vec4f,
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
    out.uvs = vec4f(transformed_uv(corner.uvs.xy, 0), transformed_uv(corner.uvs.zw, 1));
    out.surface_uvs = vec4f(transformed_uv(corner.surface_uvs.xy, 2), transformed_uv(corner.surface_uvs.zw, 3));
    out.emission_uv = transformed_uv(corner.emission_uv, 4);
    out.color = corner.color;
    out.degrees = corner.degrees;
    out.orientation = transform.orientation;
    return out;
}

// Applies the transform of a texture.
fn transformed_uv(uv: vec2f, texture: i32) -> vec2f {
    let axes = material.axes[texture];
    let v = select(uv.y, 1.0 - uv.y, picture.is_v_flipped != 0u);
    return material.origins[texture].xy + uv.x * axes.xy + v * axes.zw;
}

@fragment
fn shade(in: Varyings, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let base = in.color * material.base_color * textureSample(base_texture, base_sampler, in.uvs.xy);
    let texel = textureSample(normal_texture, normal_sampler, in.uvs.zw).xyz;
    let surface = textureSample(surface_texture, surface_sampler, in.surface_uvs.xy);
    let occlusion = textureSample(occlusion_texture, occlusion_sampler, in.surface_uvs.zw).x;
    let emission = textureSample(emission_texture, emission_sampler, in.emission_uv).xyz;
    // Curved surfaces are rougher for a pixel than for a point.
    let unit_normal = unit_or(in.normal, vec3f(0.0, 0.0, 1.0));
    let change = max(abs(dpdx(unit_normal)), abs(dpdy(unit_normal)));
    let facet = cross(dpdx(in.eye), dpdy(in.eye));
    let to_eye = unit_or(vec3f(0.0, 0.0, picture.distance) - in.eye, vec3f(0.0, 0.0, 1.0));
    let facing = select(abs(dot(unit_or(facet, to_eye), to_eye)), 1.0, picture.is_layout != 0u);
    if (picture.view < 2u) {
        let side = select(-1.0, 1.0, is_front) * in.orientation;
        let point = SurfacePoint(
            base.rgb,
            material.metallic * surface.z,
            max(material.roughness * surface.y, LEAST_ROUGHNESS) + max(change.x, max(change.y, change.z)),
            1.0 + material.occlusion * (occlusion - 1.0),
            material.emission * emission,
        );
        let radiance = radiance_of(point, side * surface_normal(in, texel), to_eye);
        return vec4f(tone_mapped(select(radiance, base.rgb, material.is_unlit != 0u)), coverage(base.a));
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
    } else if (material.has_bumps != 0u && in.sign != 0.0) {
        normal = bump(in.uvs.zw);
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

// Test bumps for materials without a normal map: 8 x 8 over the UV square, as in the viewer.
fn bump(uv: vec2f) -> vec3f {
    let slope = 0.9 * (fract(8.0 * uv) - vec2f(0.5, 0.5)) / 0.36;
    let size = dot(slope, slope);
    // v points down in the image, green points up.
    return select(vec3f(0.0, 0.0, 1.0), vec3f(slope.x, -slope.y, sqrt(max(1.0 - size, 0.0))), size < 0.81);
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
        case 3u: {
            return direction_color(bitangent_of(in.normal, in.tangent));
        }
        case 4u: {
            return direction_color(in.normal);
        }
        case 5u: {
            let sides = select(picture.minus.rgb, picture.plus.rgb, in.sign > 0.0);
            return facing * select(vec3f(0.0, 0.0, 0.0), sides, has_tangent);
        }
        case 6u: {
            return facing * heat_color(in.degrees, in.position.x + in.position.y);
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

// `along`: the position across the stripes, in pixels.
fn heat_color(degrees: f32, along: f32) -> vec3f {
    if (degrees < -0.5) {
        return picture.no_angle.rgb;
    }
    if (degrees > 180.5) {
        // Stripes tell opposite signs from angles without the hue.
        return select(picture.flip.rgb, vec3f(1.0, 1.0, 1.0), along % 8.0 < 3.0);
    }
    let ends = picture.heat_ends;
    let place = 8.0 * clamp(log(max(degrees, ends.x) / ends.x) / log(ends.y / ends.x), 0.0, 1.0);
    let below = min(u32(place), 7u);
    return mix(picture.ramp[below].rgb, picture.ramp[below + 1u].rgb, place - f32(below));
}

// Draws a flag with a relief in its normal map, lit from above.

struct Corner {
    @builtin(position) place: vec4f,
    @location(0) normal: vec3f,
    @location(1) tangent: vec4f,
    @location(2) uv: vec2f,
}

@vertex
fn place_vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) tangent: vec4f,
) -> Corner {
    let p = position - vec3f(1.5, 1.0, 0.0);
    let turned = vec3f(0.9 * p.x + 0.436 * p.z, p.y, 0.9 * p.z - 0.436 * p.x);
    let depth = 5.0 - turned.z;
    let place = vec4f(2.75 * turned.x, 3.9 * turned.y, depth - 2.0, depth);
    return Corner(place, normal, tangent, uv);
}

// The height of the relief: rings around the mirrored edge, furrows beside them, and a border.
fn height(uv: vec2f) -> f32 {
    let ring = length(vec2f(uv.x * 1.5, uv.y * 2.0 - 1.0));
    let rings = 0.06 * smoothstep(-0.4, 0.4, sin(18.0 * ring)) * smoothstep(0.93, 0.87, ring);
    let inside = smoothstep(0.06, 0.1, uv.y) * smoothstep(0.94, 0.9, uv.y) * smoothstep(0.96, 0.92, uv.x);
    let furrows = 0.012 * sin(50.0 * uv.x) * smoothstep(0.93, 1.0, ring) * inside;
    return rings + furrows + 0.03 * inside;
}

@fragment
fn shade(corner: Corner, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    // The normal that a baked map would have.
    let step = 1.0 / 1024.0;
    let u = (height(corner.uv + vec2f(step, 0.0)) - height(corner.uv - vec2f(step, 0.0))) / (2.0 * step);
    let v = (height(corner.uv + vec2f(0.0, step)) - height(corner.uv - vec2f(0.0, step))) / (2.0 * step);
    let texel = normalize(vec3f(-u, -v, 1.0));
    // As MikkTSpace requires: interpolated vectors without normalisation, and the bitangent computed here.
    let bitangent = corner.tangent.w * cross(corner.normal, corner.tangent.xyz);
    let side = select(-1.0, 1.0, is_front);
    let normal = side * normalize(texel.x * corner.tangent.xyz + texel.y * bitangent + texel.z * corner.normal);
    let light = normalize(vec3f(-0.5, 0.8, 0.7));
    let half_way = normalize(light + vec3f(-0.436, 0.0, 0.9));
    let diffuse = max(dot(normal, light), 0.0);
    let shine = 0.5 * pow(max(dot(normal, half_way), 0.0), 40.0);
    let ring = length(vec2f(corner.uv.x * 1.5, corner.uv.y * 2.0 - 1.0));
    let cloth = mix(vec3f(0.80, 0.22, 0.16), vec3f(0.95, 0.85, 0.55), smoothstep(0.9, 0.88, ring));
    return vec4f(cloth * (0.18 + 0.75 * diffuse) + vec3f(shine), 1.0);
}

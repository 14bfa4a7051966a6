// Light on a surface in the studio, as in the viewer: metal and roughness of glTF 2.0, lamps that rough surfaces see blurred, one light, and
// Khronos's PBR Neutral tone mapping. All directions are in eye space.
//
// The blur of lamps: after Wang et al., "All-frequency rendering of dynamic, spatially-varying reflectance", 2009. A lamp is a spherical Gaussian of sharpness s,
// the lobe of a rough surface nearly one of sharpness t, and their convolution one of sharpness s t / (s + t) and the same integral.

const PI: f32 = 3.14159265;
const LAMPS: i32 = 6;
// Mirrors are nearly mirrors, so that lamps stay soft.
const LEAST_ROUGHNESS: f32 = 0.045;
// The sharpness that the lobe of roughness 1 has more than the microfacet lobe: the cosine of a diffuse surface.
const COSINE_SHARPNESS: f32 = 1.6;
// The reflectance of surfaces that are no metal, seen from straight above.
const DIELECTRIC: vec3f = vec3f(0.04, 0.04, 0.04);

// What a surface is made of at a point.
struct SurfacePoint {
    color: vec3f,
    metallic: f32,
    roughness: f32,
    // From 0 to 1.
    occlusion: f32,
    emission: vec3f,
}

// Single and multiple scattering of the environment.
struct Scattering {
    single: vec3f,
    multiple: vec3f,
}

// The radiance that leaves a point. `normal`, `to_eye`: unit vectors.
fn radiance_of(point: SurfacePoint, normal: vec3f, to_eye: vec3f) -> vec3f {
    let facing = clamp(dot(normal, to_eye), 0.0, 1.0);
    let roughness = clamp(point.roughness, LEAST_ROUGHNESS, 1.0);
    let integral = environment_integral(roughness, facing);
    let reflectance = mix(DIELECTRIC, point.color, point.metallic);
    let diffuse = point.color * (1.0 - point.metallic);

    let dielectric = scattering(DIELECTRIC, integral);
    let metal = scattering(point.color, integral);
    let single = mix(dielectric.single, metal.single, point.metallic);
    let multiple = mix(dielectric.multiple, metal.multiple, point.metallic);
    // What a diffuse white surface shows is the lamps blurred by roughness 1.
    let ambient = environment(normal, 1.0);
    let r2 = roughness * roughness;
    let mirrored = normalize(mix(reflect(-to_eye, normal), normal, r2 * r2));
    let specular = environment(mirrored, roughness) * single + ambient * multiple;
    let scattered = diffuse * (vec3f(1.0, 1.0, 1.0) - dielectric.single - dielectric.multiple) * ambient;
    // S. Lagarde, "Moving Frostbite to PBR", 2014: occlusion of highlights.
    let dark = clamp(pow(facing + point.occlusion, exp2(-16.0 * roughness - 1.0)) - 1.0 + point.occlusion, 0.0, 1.0);

    let compensation = vec3f(1.0, 1.0, 1.0) + reflectance * (1.0 / (integral.x + integral.y) - 1.0);
    let direct = lit_directly(diffuse, reflectance, compensation, roughness, normal, to_eye);
    return direct + scattered * point.occlusion + specular * dark + point.emission;
}

// Reflected light of the directional light: the microfacet model of glTF 2.0, appendix B.
fn lit_directly(diffuse: vec3f, reflectance: vec3f, compensation: vec3f, roughness: f32, normal: vec3f, to_eye: vec3f) -> vec3f {
    let light = picture.light.xyz;
    let towards = clamp(dot(normal, light), 0.0, 1.0);
    let facing = clamp(dot(normal, to_eye), 0.0, 1.0);
    let half_way = normalize(light + to_eye);
    let along = clamp(dot(normal, half_way), 0.0, 1.0);
    let alpha = roughness * roughness;
    let a2 = alpha * alpha;
    let spread = along * along * (a2 - 1.0) + 1.0;
    let distribution = a2 / (PI * spread * spread);
    let shadowing = towards * sqrt(a2 + (1.0 - a2) * facing * facing) + facing * sqrt(a2 + (1.0 - a2) * towards * towards);
    let visibility = 0.5 / max(shadowing, 1e-6);
    let fresnel = reflectance + (vec3f(1.0, 1.0, 1.0) - reflectance) * pow(1.0 - clamp(dot(to_eye, half_way), 0.0, 1.0), 5.0);
    let shine = fresnel * visibility * distribution * compensation;
    return picture.light.w * towards * ((vec3f(1.0, 1.0, 1.0) - fresnel) * diffuse / PI + shine);
}

// The lamps and the room in a direction, seen by a surface of a roughness.
fn environment(direction: vec3f, roughness: f32) -> vec3f {
    let r2 = roughness * roughness;
    let lobe = min(1e4, 0.5 / (r2 * r2)) + COSINE_SHARPNESS;
    var sum = picture.room;
    for (var at = 0; at < LAMPS; at++) {
        let own = picture.lamps[at].w;
        let joint = own * lobe / (own + lobe);
        let brightness = picture.lamp_radiance[at].x * gaussian_integral(own) / gaussian_integral(joint);
        sum += brightness * exp(joint * (dot(picture.lamps[at].xyz, direction) - 1.0));
    }
    return vec3f(sum, sum, sum);
}

// The integral of a spherical Gaussian over the sphere, for a radiance of 1.
fn gaussian_integral(sharpness: f32) -> f32 {
    return 2.0 * PI / sharpness * (1.0 - exp(-2.0 * sharpness));
}

// The reflected part of a white environment: scale and bias of the reflectance. B. Karis, "Physically based shading on mobile", 2014.
fn environment_integral(roughness: f32, facing: f32) -> vec2f {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * facing)) * r.x + r.y;
    return vec2f(-1.04, 1.04) * a + r.zw;
}

// C. Fdez-Aguera, "A multiple-scattering microfacet model for real-time image-based lighting", 2019.
fn scattering(reflectance: vec3f, integral: vec2f) -> Scattering {
    let single = reflectance * integral.x + vec3f(integral.y, integral.y, integral.y);
    let lost = 1.0 - integral.x - integral.y;
    let mean = reflectance + (vec3f(1.0, 1.0, 1.0) - reflectance) / 21.0;
    return Scattering(single, lost * single * mean / (vec3f(1.0, 1.0, 1.0) - lost * mean));
}

// Khronos PBR Neutral tone mapper, specification of 2024: colours below 0.8 stay, brighter ones approach white.
fn tone_mapped(radiance: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let least = min(radiance.x, min(radiance.y, radiance.z));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let color = radiance - vec3f(offset, offset, offset);
    let peak = max(color.x, max(color.y, color.z));
    if (peak < start) {
        return color;
    }
    let room = 1.0 - start;
    let compressed = 1.0 - room * room / (peak + room - start);
    let whitening = 1.0 - 1.0 / (0.15 * (peak - compressed) + 1.0);
    return mix(color * compressed / peak, vec3f(compressed, compressed, compressed), whitening);
}

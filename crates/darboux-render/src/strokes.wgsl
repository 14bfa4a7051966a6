// Lines of one width, each a rectangle that faces the eye.

struct Strokes {
    // From the eye's space to clip space.
    projection: mat4x4f,
    // Of a pixel in the range from -1 to 1, across and down.
    pixel: vec2f,
    // How far the eye is from the origin, along z.
    distance: f32,
    // Half of the width in pixels.
    half_width: f32,
}

@group(0) @binding(0) var<uniform> strokes: Strokes;

struct Stroke {
    @location(0) begin: vec3f,
    @location(1) end: vec3f,
    @location(2) color: vec3f,
}

struct Seen {
    @builtin(position) place: vec4f,
    @location(0) color: vec3f,
}

// What lies nearer to the eye is cut off.
const NEAREST: f32 = 0.00001;
// Lines lie on surfaces, and are seen before them: so much nearer to the eye.
const NEARER: f32 = 0.998;

@vertex
fn place_stroke(@builtin(vertex_index) corner: u32, stroke: Stroke) -> Seen {
    let eye = vec3f(0.0, 0.0, strokes.distance);
    var begin = NEARER * (stroke.begin - eye);
    var end = NEARER * (stroke.end - eye);
    var seen: Seen;
    seen.color = stroke.color;
    seen.place = vec4f(0.0, 0.0, 2.0, 1.0);
    if (begin.z > -NEAREST && end.z > -NEAREST) {
        return seen;
    }
    if (begin.z > -NEAREST) {
        begin = mix(end, begin, (-NEAREST - end.z) / (begin.z - end.z));
    } else if (end.z > -NEAREST) {
        end = mix(begin, end, (-NEAREST - begin.z) / (end.z - begin.z));
    }
    let from_place = strokes.projection * vec4f(begin + eye, 1.0);
    let to_place = strokes.projection * vec4f(end + eye, 1.0);
    let along = (to_place.xy / to_place.w - from_place.xy / from_place.w) / strokes.pixel;
    let length = sqrt(dot(along, along));
    // A line towards the eye is a dot.
    let direction = select(vec2f(1.0, 0.0), along / length, length > 0.0);
    let side = select(-1.0, 1.0, (corner & 1u) == 1u) * strokes.half_width;
    seen.place = select(from_place, to_place, corner > 1u);
    let aside = side * vec2f(-direction.y, direction.x) * strokes.pixel;
    seen.place += vec4f(aside * seen.place.w, 0.0, 0.0);
    return seen;
}

@fragment
fn color_stroke(seen: Seen) -> @location(0) vec4f {
    return vec4f(seen.color, 1.0);
}

// Draws lines of constant width in pixels, each as a rectangle that faces the eye.

struct Lines {
    // From eye space to clip space.
    projection: mat4x4f,
    // The width and height of a pixel in clip space.
    pixel: vec2f,
    // The distance of the eye from the origin of eye space, along z.
    distance: f32,
    // Half the line width in pixels.
    half_width: f32,
}

@group(0) @binding(0) var<uniform> lines: Lines;

struct Segment {
    @location(0) begin: vec3f,
    @location(1) end: vec3f,
    @location(2) color: vec3f,
}

struct Varyings {
    @builtin(position) position: vec4f,
    @location(0) color: vec3f,
}

// The part of a line nearer to the eye than this is clipped.
const NEAREST: f32 = 0.00001;
// Scales lines towards the eye, so that they appear in front of the surface on which they lie.
const DEPTH_SCALE: f32 = 0.998;

@vertex
fn transform_line(@builtin(vertex_index) corner: u32, segment: Segment) -> Varyings {
    let eye = vec3f(0.0, 0.0, lines.distance);
    var begin = DEPTH_SCALE * (segment.begin - eye);
    var end = DEPTH_SCALE * (segment.end - eye);
    var out: Varyings;
    out.color = segment.color;
    out.position = vec4f(0.0, 0.0, 2.0, 1.0);
    if (begin.z > -NEAREST && end.z > -NEAREST) {
        return out;
    }
    if (begin.z > -NEAREST) {
        begin = mix(end, begin, (-NEAREST - end.z) / (begin.z - end.z));
    } else if (end.z > -NEAREST) {
        end = mix(begin, end, (-NEAREST - begin.z) / (end.z - begin.z));
    }
    let begin_position = lines.projection * vec4f(begin + eye, 1.0);
    let end_position = lines.projection * vec4f(end + eye, 1.0);
    let along = (end_position.xy / end_position.w - begin_position.xy / begin_position.w) / lines.pixel;
    let length = sqrt(dot(along, along));
    // A line in the direction of the eye is a dot.
    let direction = select(vec2f(1.0, 0.0), along / length, length > 0.0);
    let offset = select(-1.0, 1.0, (corner & 1u) == 1u) * lines.half_width;
    out.position = select(begin_position, end_position, corner > 1u);
    let offset_vector = offset * vec2f(-direction.y, direction.x) * lines.pixel;
    out.position += vec4f(offset_vector * out.position.w, 0.0, 0.0);
    return out;
}

@fragment
fn color_line(in: Varyings) -> @location(0) vec4f {
    return vec4f(in.color, 1.0);
}

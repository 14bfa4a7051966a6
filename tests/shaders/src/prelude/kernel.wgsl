LIBRARY
@group(0) @binding(0) var<storage, read> given: array<u32>;
@group(0) @binding(1) var<storage, read_write> got: array<u32>;
var<private> sample_: u32;

fn given_word(k: u32) -> u32 { return given[sample_ * GIVEN + k]; }
fn given_int(k: u32) -> i32 { return bitcast<i32>(given_word(k)); }
fn given_int2(k: u32) -> vec2i { return vec2i(given_int(k), given_int(k + 1u)); }
fn given_int4(k: u32) -> vec4i { return vec4i(given_int2(k), given_int2(k + 2u)); }
fn given1(k: u32) -> f32 { return bitcast<f32>(given_word(k)); }
fn given2(k: u32) -> vec2f { return vec2f(given1(k), given1(k + 1u)); }
fn given3(k: u32) -> vec3f { return vec3f(given2(k), given1(k + 2u)); }
fn given4(k: u32) -> vec4f { return vec4f(given3(k), given1(k + 3u)); }
fn given_frame(k: u32) -> TangentFrame {
    return TangentFrame(given3(k), given3(k + 3u), given3(k + 6u));
}
fn given_vertex_frame(k: u32) -> VertexFrame { return VertexFrame(given3(k), given4(k + 3u)); }
fn given_map(k: u32) -> LinearMap { return linear_map(given3(k), given3(k + 3u), given3(k + 6u)); }

fn got1(k: u32, value: f32) { got[sample_ * GOT + k] = bitcast<u32>(value); }
fn got2(k: u32, value: vec2f) { got1(k, value.x); got1(k + 1u, value.y); }
fn got3(k: u32, value: vec3f) { got2(k, value.xy); got1(k + 2u, value.z); }
fn got4(k: u32, value: vec4f) { got3(k, value.xyz); got1(k + 3u, value.w); }
fn got_int2(k: u32, value: vec2i) { got2(k, vec2f(value)); }
fn got_int4(k: u32, value: vec4i) { got4(k, vec4f(value)); }
fn got_vertex_frame(k: u32, frame: VertexFrame) { got3(k, frame.normal); got4(k + 3u, frame.tangent); }
fn got_frame(k: u32, frame: TangentFrame) {
    got3(k, frame.tangent);
    got3(k + 3u, frame.bitangent);
    got3(k + 6u, frame.normal);
}

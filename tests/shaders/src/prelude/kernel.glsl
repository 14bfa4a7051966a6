#version 450
LIBRARY
layout(set = 0, binding = 0) readonly buffer Given { uint given[]; };
layout(set = 0, binding = 1) buffer Got { uint got[]; };
uint sample_;

uint given_word(uint k) { return given[sample_ * GIVEN + k]; }
int given_int(uint k) { return int(given_word(k)); }
ivec2 given_int2(uint k) { return ivec2(given_int(k), given_int(k + 1u)); }
ivec4 given_int4(uint k) { return ivec4(given_int2(k), given_int2(k + 2u)); }
float given1(uint k) { return uintBitsToFloat(given_word(k)); }
vec2 given2(uint k) { return vec2(given1(k), given1(k + 1u)); }
vec3 given3(uint k) { return vec3(given2(k), given1(k + 2u)); }
vec4 given4(uint k) { return vec4(given3(k), given1(k + 3u)); }
TangentFrame given_frame(uint k) { return TangentFrame(given3(k), given3(k + 3u), given3(k + 6u)); }
VertexFrame given_vertex_frame(uint k) { return VertexFrame(given3(k), given4(k + 3u)); }
LinearMap given_map(uint k) { return linear_map(given3(k), given3(k + 3u), given3(k + 6u)); }

void got1(uint k, float value) { got[sample_ * GOT + k] = floatBitsToUint(value); }
void got2(uint k, vec2 value) { got1(k, value.x); got1(k + 1u, value.y); }
void got3(uint k, vec3 value) { got2(k, value.xy); got1(k + 2u, value.z); }
void got4(uint k, vec4 value) { got3(k, value.xyz); got1(k + 3u, value.w); }
void got_int2(uint k, ivec2 value) { got2(k, vec2(value)); }
void got_int4(uint k, ivec4 value) { got4(k, vec4(value)); }
void got_vertex_frame(uint k, VertexFrame frame) { got3(k, frame.normal); got4(k + 3u, frame.tangent); }
void got_frame(uint k, TangentFrame frame) {
    got3(k, frame.tangent);
    got3(k + 3u, frame.bitangent);
    got3(k + 6u, frame.normal);
}

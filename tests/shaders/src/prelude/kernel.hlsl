LIBRARY
[[vk::binding(0, 0)]] StructuredBuffer<uint> given;
[[vk::binding(1, 0)]] RWStructuredBuffer<uint> got;
static uint sample_;

uint given_word(uint k) { return given[sample_ * GIVEN + k]; }
int given_int(uint k) { return asint(given_word(k)); }
int2 given_int2(uint k) { return int2(given_int(k), given_int(k + 1u)); }
int4 given_int4(uint k) { return int4(given_int2(k), given_int2(k + 2u)); }
float given1(uint k) { return asfloat(given_word(k)); }
float2 given2(uint k) { return float2(given1(k), given1(k + 1u)); }
float3 given3(uint k) { return float3(given2(k), given1(k + 2u)); }
float4 given4(uint k) { return float4(given3(k), given1(k + 3u)); }
TangentFrame given_frame(uint k) {
    TangentFrame frame = { given3(k), given3(k + 3u), given3(k + 6u) };
    return frame;
}
VertexFrame given_vertex_frame(uint k) {
    VertexFrame frame = { given3(k), given4(k + 3u) };
    return frame;
}
LinearMap given_map(uint k) { return linear_map(given3(k), given3(k + 3u), given3(k + 6u)); }

void got1(uint k, float value) { got[sample_ * GOT + k] = asuint(value); }
void got2(uint k, float2 value) { got1(k, value.x); got1(k + 1u, value.y); }
void got3(uint k, float3 value) { got2(k, value.xy); got1(k + 2u, value.z); }
void got4(uint k, float4 value) { got3(k, value.xyz); got1(k + 3u, value.w); }
void got_int2(uint k, int2 value) { got2(k, float2(value)); }
void got_int4(uint k, int4 value) { got4(k, float4(value)); }
void got_vertex_frame(uint k, VertexFrame frame) { got3(k, frame.normal); got4(k + 3u, frame.tangent); }
void got_frame(uint k, TangentFrame frame) {
    got3(k, frame.tangent);
    got3(k + 3u, frame.bitangent);
    got3(k + 6u, frame.normal);
}

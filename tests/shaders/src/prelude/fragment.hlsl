static float2 place_;

// A value that changes by the vector at k per pixel to the right, and by the next vector per pixel down.
float2 spread2(uint k) { return place_.x * given2(k) + place_.y * given2(k + 2u); }
float3 spread3(uint k) { return place_.x * given3(k) + place_.y * given3(k + 3u); }

float4 main(float4 position : SV_Position) : SV_Target {
    uint2 pixel = uint2(position.xy);
    place_ = float2(pixel & uint2(1u, 1u));
    sample_ = 4u * (QUADS * (pixel.y / 2u) + pixel.x / 2u) + 2u * (pixel.y & 1u) + (pixel.x & 1u);
    BODY
    return float4(0.0, 0.0, 0.0, 0.0);
}

layout(location = 0) out vec4 color;
vec2 place_;

// A value that changes by the vector at k per pixel to the right, and by the next vector per pixel down.
vec2 spread2(uint k) { return place_.x * given2(k) + place_.y * given2(k + 2u); }
vec3 spread3(uint k) { return place_.x * given3(k) + place_.y * given3(k + 3u); }

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    place_ = vec2(pixel & uvec2(1u));
    sample_ = 4u * (QUADS * (pixel.y / 2u) + pixel.x / 2u) + 2u * (pixel.y & 1u) + (pixel.x & 1u);
    BODY
    color = vec4(0.0);
}

// Generated from shaders/wgsl/derivatives.wgsl by `cargo xtask gen`.

// Tangent frames from screen-space derivatives, for meshes without tangents. Only for fragment shaders, in uniform control flow: not
// inside a branch that depends on the pixel. Requires frame.
//
// position and normal: in any space, but both in the same. uv: as the map is sampled. Bitangents point towards increasing v; if the
// green channel of the map points towards decreasing v, as in glTF, pass -v. The results do not depend on the direction of the screen's
// y axis, on mirrored UVs, on the side of the face or on the scale of the space. They are constant over flat triangles, so facets are
// visible where vertex tangents would be smooth.

// A tangent as a vertex stores it: a unit vector along increasing u in the plane of the unit normal, and the sign. It is the tangent that
// MikkTSpace gives for the triangle alone, so it fits maps that were baked with MikkTSpace best.
float4 tangent_from_derivatives(float3 normal, float3 position, float2 uv) {
    float3 position_x = ddx(position);
    float3 position_y = ddy(position);
    float2 uv_x = ddx(uv);
    float2 uv_y = ddy(uv);
    // The derivatives of position by u and by v, times the determinant of the UV map, of which only the sign matters.
    float determinant = uv_x.x * uv_y.y - uv_y.x * uv_x.y;
    float orientation = 1.0;
    if (determinant < 0.0) {
        orientation = -1.0;
    }
    float3 along_u = orientation * (uv_y.y * position_x - uv_x.y * position_y);
    float3 along_v = orientation * (uv_x.x * position_y - uv_y.x * position_x);
    float3 tangent = unit_in_plane(normal, along_u);
    float w = 1.0;
    if (dot(cross(normal, tangent), along_v) < 0.0) {
        w = -1.0;
    }
    return float4(tangent, w);
}

// The frame for height maps: tangent and bitangent along the gradients of u and v in the plane of the unit normal, scaled so that the
// longer one is a unit vector. Where a map is stretched in one direction, its bumps are flatter in that direction. With sheared UVs the
// two are not perpendicular.
// Source: C. Schueler, "Normal Mapping without Precomputed Tangents", 2013. Unlike there, the sign comes from the normal.
TangentFrame cotangent_frame_from_derivatives(float3 normal, float3 position, float2 uv) {
    float3 position_x = ddx(position);
    float3 position_y = ddy(position);
    float2 uv_x = ddx(uv);
    float2 uv_y = ddy(uv);
    // Times the determinant of the map to the screen, of which only the sign matters.
    float3 dual_x = cross(position_y, normal);
    float3 dual_y = cross(normal, position_x);
    float orientation = 1.0;
    if (dot(dual_x, position_x) < 0.0) {
        orientation = -1.0;
    }
    float3 gradient_u = orientation * (uv_x.x * dual_x + uv_y.x * dual_y);
    float3 gradient_v = orientation * (uv_x.y * dual_x + uv_y.y * dual_y);
    float longer = sqrt(max(dot(gradient_u, gradient_u), dot(gradient_v, gradient_v)));
    TangentFrame frame;
    frame.tangent = first_perpendicular(normal);
    frame.bitangent = second_perpendicular(normal);
    frame.normal = normal;
    if (longer > 0.0) {
        frame.tangent = (1.0 / longer) * gradient_u;
        frame.bitangent = (1.0 / longer) * gradient_v;
    }
    return frame;
}

// Generated from shaders/wgsl/derivatives.wgsl by `cargo xtask gen`.
precision highp float;
precision highp int;

// Frames from screen-space derivatives, where a mesh has no tangents. Fragment shaders only, and only where all pixels of the
// draw go: no branch that depends on the pixel. Needs frame.
//
// position and normal in one space, whichever; uv as the map is sampled. Bitangents point towards increasing v: where the map's green
// leans towards decreasing v, as in glTF, give -v. The results do not depend on which way screens count y, on mirrored UVs, on
// the face's side or on the scale of the space. They are constant over flat triangles, so facets show where vertex tangents would be smooth.

// A tangent as a vertex would have it: unit, along increasing u in the plane of the unit normal, and the sign. What MikkTSpace gives for
// the triangle alone: the nearest to maps that were baked for it.
vec4 tangent_from_derivatives(vec3 normal, vec3 position, vec2 uv) {
    vec3 position_x = dFdx(position);
    vec3 position_y = dFdy(position);
    vec2 uv_x = dFdx(uv);
    vec2 uv_y = dFdy(uv);
    // The derivatives of position by u and by v, both times the UV map's determinant, of which the sign matters.
    float determinant = uv_x.x * uv_y.y - uv_y.x * uv_x.y;
    float orientation = 1.0;
    if (determinant < 0.0) {
        orientation = -1.0;
    }
    vec3 along_u = orientation * (uv_y.y * position_x - uv_x.y * position_y);
    vec3 along_v = orientation * (uv_x.x * position_y - uv_y.x * position_x);
    vec3 tangent = unit_in_plane(normal, along_u);
    float w = 1.0;
    if (dot(cross(normal, tangent), along_v) < 0.0) {
        w = -1.0;
    }
    return vec4(tangent, w);
}

// The frame that heights want: tangent and bitangent along the gradients of u and of v, in the plane of the unit normal, the longer of
// them made unit: where a map is stretched one way, its bumps are flatter that way. Not perpendicular to each other where UVs are sheared.
// Source: C. Schueler, "Normal Mapping without Precomputed Tangents", 2013; we take the sign from the normal.
TangentFrame cotangent_frame_from_derivatives(vec3 normal, vec3 position, vec2 uv) {
    vec3 position_x = dFdx(position);
    vec3 position_y = dFdy(position);
    vec2 uv_x = dFdx(uv);
    vec2 uv_y = dFdy(uv);
    // Times the determinant of the screen's map, of which the sign matters.
    vec3 dual_x = cross(position_y, normal);
    vec3 dual_y = cross(normal, position_x);
    float orientation = 1.0;
    if (dot(dual_x, position_x) < 0.0) {
        orientation = -1.0;
    }
    vec3 gradient_u = orientation * (uv_x.x * dual_x + uv_y.x * dual_y);
    vec3 gradient_v = orientation * (uv_x.y * dual_x + uv_y.y * dual_y);
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

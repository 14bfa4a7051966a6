// Frames from screen-space derivatives, where a mesh has no tangents. Fragment shaders only, and only where all pixels of the
// draw go: no branch that depends on the pixel. Needs frame.
//
// position and normal in one space, whichever; uv as the map is sampled. Bitangents point towards increasing v: where the map's green
// leans towards decreasing v, as in glTF, give -v. The results do not depend on which way screens count y, on mirrored UVs, on
// the face's side or on the scale of the space. They are constant over flat triangles, so facets show where vertex tangents would be smooth.

// A tangent as a vertex would have it: unit, along increasing u in the plane of the unit normal, and the sign. What MikkTSpace gives for
// the triangle alone: the nearest to maps that were baked for it.
fn tangent_from_derivatives(normal: vec3f, position: vec3f, uv: vec2f) -> vec4f {
    let position_x: vec3f = dpdx(position);
    let position_y: vec3f = dpdy(position);
    let uv_x: vec2f = dpdx(uv);
    let uv_y: vec2f = dpdy(uv);
    // The derivatives of position by u and by v, both times the UV map's determinant, of which the sign matters.
    let determinant: f32 = uv_x.x * uv_y.y - uv_y.x * uv_x.y;
    var orientation: f32 = 1.0;
    if (determinant < 0.0) {
        orientation = -1.0;
    }
    let along_u: vec3f = orientation * (uv_y.y * position_x - uv_x.y * position_y);
    let along_v: vec3f = orientation * (uv_x.x * position_y - uv_y.x * position_x);
    let tangent: vec3f = unit_in_plane(normal, along_u);
    var w: f32 = 1.0;
    if (dot(cross(normal, tangent), along_v) < 0.0) {
        w = -1.0;
    }
    return vec4f(tangent, w);
}

// The frame that heights want: tangent and bitangent along the gradients of u and of v, in the plane of the unit normal, the longer of
// them made unit: where a map is stretched one way, its bumps are flatter that way. Not perpendicular to each other where UVs are sheared.
// Source: C. Schueler, "Normal Mapping without Precomputed Tangents", 2013; we take the sign from the normal.
fn cotangent_frame_from_derivatives(normal: vec3f, position: vec3f, uv: vec2f) -> TangentFrame {
    let position_x: vec3f = dpdx(position);
    let position_y: vec3f = dpdy(position);
    let uv_x: vec2f = dpdx(uv);
    let uv_y: vec2f = dpdy(uv);
    // Times the determinant of the screen's map, of which the sign matters.
    let dual_x: vec3f = cross(position_y, normal);
    let dual_y: vec3f = cross(normal, position_x);
    var orientation: f32 = 1.0;
    if (dot(dual_x, position_x) < 0.0) {
        orientation = -1.0;
    }
    let gradient_u: vec3f = orientation * (uv_x.x * dual_x + uv_y.x * dual_y);
    let gradient_v: vec3f = orientation * (uv_x.y * dual_x + uv_y.y * dual_y);
    let longer: f32 = sqrt(max(dot(gradient_u, gradient_u), dot(gradient_v, gradient_v)));
    var frame: TangentFrame;
    frame.tangent = first_perpendicular(normal);
    frame.bitangent = second_perpendicular(normal);
    frame.normal = normal;
    if (longer > 0.0) {
        frame.tangent = (1.0 / longer) * gradient_u;
        frame.bitangent = (1.0 / longer) * gradient_v;
    }
    return frame;
}

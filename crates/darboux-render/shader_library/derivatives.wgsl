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
fn tangent_from_derivatives(normal: vec3f, position: vec3f, uv: vec2f) -> vec4f {
    let position_x: vec3f = dpdx(position);
    let position_y: vec3f = dpdy(position);
    let uv_x: vec2f = dpdx(uv);
    let uv_y: vec2f = dpdy(uv);
    // The derivatives of position by u and by v, times the determinant of the UV map, of which only the sign matters.
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

// The frame for height maps: tangent and bitangent along the gradients of u and v in the plane of the unit normal, scaled so that the
// longer one is a unit vector. Where a map is stretched in one direction, its bumps are flatter in that direction. With sheared UVs the
// two are not perpendicular.
// Source: C. Schueler, "Normal Mapping without Precomputed Tangents", 2013. Unlike there, the sign comes from the normal.
fn cotangent_frame_from_derivatives(normal: vec3f, position: vec3f, uv: vec2f) -> TangentFrame {
    let position_x: vec3f = dpdx(position);
    let position_y: vec3f = dpdy(position);
    let uv_x: vec2f = dpdx(uv);
    let uv_y: vec2f = dpdy(uv);
    // Times the determinant of the map to the screen, of which only the sign matters.
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

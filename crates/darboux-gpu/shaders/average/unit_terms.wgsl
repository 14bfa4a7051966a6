// The method `Average`: each triangle adds the unit vectors along dP/du and dP/dv.

// `s`, `t`: dP/du and dP/dv times `area`, twice the signed UV area.
fn term_vectors(s: vec3f, t: vec3f, area: f32) -> TermVectors {
    let s_length = sqrt(dot(s, s));
    let t_length = sqrt(dot(t, t));
    let magnitudes = bitcast<vec2u>(vec2f(s_length, t_length) / abs(area));
    let sign = select(-1.0, 1.0, area > 0.0);
    let are_finite = is_finite(magnitudes.x) && is_finite(magnitudes.y);
    return TermVectors((sign / s_length) * s, (sign / t_length) * t, 1.0, are_finite);
}

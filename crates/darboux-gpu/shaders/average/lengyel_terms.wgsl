// The method `Lengyel`: each triangle adds dP/du and dP/dv, not normalised (E. Lengyel, "Computing Tangent Space Basis Vectors for an
// Arbitrary Mesh", 2001).

// `s`, `t`: dP/du and dP/dv times `area`, twice the signed UV area.
fn term_vectors(s: vec3f, t: vec3f, area: f32) -> TermVectors {
    let reciprocal = 1.0 / area;
    let tangent = reciprocal * s;
    let bitangent = reciprocal * t;
    let sizes = bitcast<vec2u>(vec2f(size(tangent), size(bitangent)));
    return TermVectors(tangent, bitangent, size(tangent), is_finite(sizes.x) && is_finite(sizes.y));
}

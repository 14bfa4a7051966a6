// The derivatives of position by UV on a triangle, and its UV orientation: the twin of the core's tangents/derivatives.rs.

struct Derivative {
    s: V3,
    t: V3,
    magnitude: vec2<Real>,
    preserves: bool,
    // UV-degenerate: it joins any group and adds nothing.
    any: bool,
}

fn derivative(p0: V3, p1: V3, p2: V3, uv0: vec2<Real>, uv1: vec2<Real>, uv2: vec2<Real>) -> Derivative {
    let e1 = less(p1, p0);
    let e2 = less(p2, p0);
    let du1 = minus(uv1.x, uv0.x);
    let dv1 = minus(uv1.y, uv0.y);
    let du2 = minus(uv2.x, uv0.x);
    let dv2 = minus(uv2.y, uv0.y);
    let first = times(du1, dv2);
    let second = times(dv1, du2);
    let area = minus(first, second);
    watch_vector_from_below(e1);
    watch_vector_from_below(e2);
    watch_from_below(du1);
    watch_from_below(dv1);
    watch_from_below(du2);
    watch_from_below(dv2);
    watch(area);
    watch_cancelling(area, V3(first, second, second));
    var out: Derivative;
    out.s = difference_of_scaled(dv2, e1, dv1, e2);
    // The core has -du2 e1 + du1 e2: the same but for the signs of zeros.
    out.t = difference_of_scaled(du1, e2, du2, e1);
    out.preserves = is_above(area, real(0u));
    out.any = true;
    if not_zero(area) {
        let size = real(word_of(area) & ~SIGN);
        let s_length = length_and_inverse(out.s);
        let t_length = length_and_inverse(out.t);
        out.s = unit_unless_zero(!out.preserves, s_length, out.s);
        out.t = unit_unless_zero(!out.preserves, t_length, out.t);
        out.magnitude = vec2<Real>(over(s_length.x, size), over(t_length.x, size));
        out.any = !(not_zero(out.magnitude.x) && not_zero(out.magnitude.y));
    }
    return out;
}

// The derivatives of position by UV on a triangle, and its UV orientation. As in the core's tangents/mikktspace/derivatives.rs.

struct Derivative {
    s: V3,
    t: V3,
    magnitude: vec2<Real>,
    keeps_orientation: bool,
    // The triangle joins any group and has no term.
    uv_degenerate: bool,
}

fn derivative(p0: V3, p1: V3, p2: V3, uv0: vec2<Real>, uv1: vec2<Real>, uv2: vec2<Real>) -> Derivative {
    let e1 = subtract3(p1, p0);
    let e2 = subtract3(p2, p0);
    let du1 = subtract(uv1.x, uv0.x);
    let dv1 = subtract(uv1.y, uv0.y);
    let du2 = subtract(uv2.x, uv0.x);
    let dv2 = subtract(uv2.y, uv0.y);
    let first = multiply(du1, dv2);
    let second = multiply(dv1, du2);
    let area = subtract(first, second);
    check_not_tiny3(e1);
    check_not_tiny3(e2);
    check_not_tiny(du1);
    check_not_tiny(dv1);
    check_not_tiny(du2);
    check_not_tiny(dv2);
    check_range(area);
    check_cancellation(area, V3(first, second, second));
    var out: Derivative;
    out.s = difference_of_scaled(dv2, e1, dv1, e2);
    // The core computes -du2 e1 + du1 e2, which differs only in the signs of zeros.
    out.t = difference_of_scaled(du1, e2, du2, e1);
    out.keeps_orientation = is_above(area, real(0u));
    out.uv_degenerate = true;
    if not_zero(area) {
        let size = real(bits_of(area) & ~SIGN);
        let s_length = length_and_inverse(out.s);
        let t_length = length_and_inverse(out.t);
        out.s = unit_unless_zero(!out.keeps_orientation, s_length, out.s);
        out.t = unit_unless_zero(!out.keeps_orientation, t_length, out.t);
        out.magnitude = vec2<Real>(divide(s_length.x, size), divide(t_length.x, size));
        out.uv_degenerate = !(not_zero(out.magnitude.x) && not_zero(out.magnitude.y));
    }
    return out;
}

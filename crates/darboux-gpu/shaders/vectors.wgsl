// Vectors of real numbers, each operation rounded in the order written: the twin of the core's math.rs.

alias V3 = vec3<Real>;

const SMALLEST_NORMAL: u32 = 0x00800000u;

fn negated(a: Real) -> Real {
    return real(word_of(a) ^ SIGN);
}

// Above the smallest normal float in size. NaN counts as zero.
fn not_zero(a: Real) -> bool {
    let size = word_of(a) & ~SIGN;
    return size > SMALLEST_NORMAL && !is_nan(size);
}

fn added(a: V3, b: V3) -> V3 {
    return V3(plus(a.x, b.x), plus(a.y, b.y), plus(a.z, b.z));
}

fn less(a: V3, b: V3) -> V3 {
    return V3(minus(a.x, b.x), minus(a.y, b.y), minus(a.z, b.z));
}

fn scaled(s: Real, v: V3) -> V3 {
    return V3(times(s, v.x), times(s, v.y), times(s, v.z));
}

fn dotted(a: V3, b: V3) -> Real {
    return plus(plus(times(a.x, b.x), times(a.y, b.y)), times(a.z, b.z));
}

fn length_of(v: V3) -> Real {
    return root_of(dotted(v, v));
}

// The unit vector along `v`, or `v` itself when every component counts as zero.
fn direction(v: V3) -> V3 {
    if not_zero(v.x) || not_zero(v.y) || not_zero(v.z) {
        return scaled(over(real(ONE), length_of(v)), v);
    }
    return v;
}

// The direction of `v` in the plane perpendicular to `normal`, which is used as given.
fn direction_in_plane(normal: V3, v: V3) -> V3 {
    return direction(less(v, scaled(dotted(normal, v), normal)));
}

// The angle between two directions whose dot product is `cosine`, clamped to [-1, 1].
fn angle(cosine: Real) -> Real {
    if is_above(cosine, real(ONE)) {
        return arccosine_of(real(ONE));
    }
    if is_above(real(ONE | SIGN), cosine) {
        return arccosine_of(real(ONE | SIGN));
    }
    return arccosine_of(cosine);
}

// sign / length times `v`, or `v` itself.
fn unit_unless_zero(sign: Real, length: Real, v: V3) -> V3 {
    if not_zero(length) {
        return scaled(over(sign, length), v);
    }
    return v;
}

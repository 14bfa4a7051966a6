// Vectors of real numbers, each operation rounded in the order written: the twin of the core's math.rs.

alias V3 = vec3<Real>;

const SMALLEST_NORMAL: u32 = 0x00800000u;

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

fn watch_vector(v: V3) {
    watch(v.x);
    watch(v.y);
    watch(v.z);
}

// For sums of squares, and where what is below 2^-100 does not show.
fn dotted(a: V3, b: V3) -> Real {
    return plus(plus(times(a.x, b.x), times(a.y, b.y)), times(a.z, b.z));
}

fn watched_dot(a: V3, b: V3) -> Real {
    let x = times(a.x, b.x);
    let y = times(a.y, b.y);
    let z = times(a.z, b.z);
    let total = plus(plus(x, y), z);
    watch(total);
    watch_cancelling(total, x, y);
    watch_cancelling(total, z, z);
    return total;
}

fn length_of(v: V3) -> Real {
    return root_of(dotted(v, v));
}

// The unit vector along `v`, or `v` itself when every component counts as zero.
fn direction(v: V3) -> V3 {
    watch_vector(v);
    if not_zero(v.x) || not_zero(v.y) || not_zero(v.z) {
        return scaled(over(real(ONE), length_of(v)), v);
    }
    return v;
}

// The direction of `v` in the plane perpendicular to `normal`, which is used as given. Both are watched.
fn direction_in_plane(normal: V3, v: V3) -> V3 {
    return direction(less(v, scaled(watched_dot(normal, v), normal)));
}

// The angle between two directions whose dot product is `cosine`, clamped to [-1, 1].
fn angle(cosine: Real) -> Real {
    var clamped = cosine;
    if is_above(cosine, real(ONE)) {
        clamped = real(ONE);
    } else if is_above(real(ONE | SIGN), cosine) {
        clamped = real(ONE | SIGN);
    }
    return arccosine_of(clamped);
}

// a b - c d, in every component of b and d.
fn difference_of_scaled(a: Real, b: V3, c: Real, d: V3) -> V3 {
    let first = scaled(a, b);
    let second = scaled(c, d);
    let found = less(first, second);
    watch_cancelling(found.x, first.x, second.x);
    watch_cancelling(found.y, first.y, second.y);
    watch_cancelling(found.z, first.z, second.z);
    watch_vector(found);
    return found;
}

// sign / length times `v`, or `v` itself.
fn unit_unless_zero(sign: Real, length: Real, v: V3) -> V3 {
    if not_zero(length) {
        return scaled(over(sign, length), v);
    }
    return v;
}

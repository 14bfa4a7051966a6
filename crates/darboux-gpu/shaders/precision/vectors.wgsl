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

fn watch_short_vector(v: V3) {
    watch_short(v.x);
    watch_short(v.y);
    watch_short(v.z);
}

fn watch_vector_from_below(v: V3) {
    watch_from_below(v.x);
    watch_from_below(v.y);
    watch_from_below(v.z);
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
    watch_from_below(total);
    watch_cancelling(total, V3(x, y, z));
    return total;
}

// And one over it.
fn length_and_inverse(v: V3) -> vec2<Real> {
    return root_and_inverse_of(dotted(v, v));
}

// The unit vector along `v`, or `v` itself when every component counts as zero. `v` is watched.
fn direction(v: V3) -> V3 {
    let squares = dotted(v, v);
    if has_direction(v, squares) {
        return scaled(inverse_root_of(squares), v);
    }
    return v;
}

// The direction of `v` in the plane perpendicular to `normal`, which is used as given. Both are watched, the normal as a short one.
fn direction_in_plane(normal: V3, v: V3) -> V3 {
    let found = less(v, scaled(watched_dot(normal, v), normal));
    watch_vector_from_below(found);
    return direction(found);
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
    watch_cancelling(found.x, V3(first.x, second.x, second.x));
    watch_cancelling(found.y, V3(first.y, second.y, second.y));
    watch_cancelling(found.z, V3(first.z, second.z, second.z));
    watch_vector(found);
    return found;
}

fn negated(a: Real) -> Real {
    return real(word_of(a) ^ SIGN);
}

// `v` by its length, or `v` itself where that is none; turned round where it is to be. `length`: and one over it.
fn unit_unless_zero(is_reversed: bool, length: vec2<Real>, v: V3) -> V3 {
    if not_zero(length.x) {
        return scaled(real(word_of(length.y) ^ select(0u, SIGN, is_reversed)), v);
    }
    return v;
}

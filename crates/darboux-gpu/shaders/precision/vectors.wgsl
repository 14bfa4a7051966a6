// Vectors of `Real`, with the operations in the order of the core's math.rs.

alias V3 = vec3<Real>;

const SMALLEST_NORMAL: u32 = 0x00800000u;

// Whether |a| is above the smallest normal float. False for NaN.
fn not_zero(a: Real) -> bool {
    let size = bits_of(a) & ~SIGN;
    return size > SMALLEST_NORMAL && !is_nan(size);
}

fn add3(a: V3, b: V3) -> V3 {
    return V3(add(a.x, b.x), add(a.y, b.y), add(a.z, b.z));
}

fn subtract3(a: V3, b: V3) -> V3 {
    return V3(subtract(a.x, b.x), subtract(a.y, b.y), subtract(a.z, b.z));
}

fn scale3(s: Real, v: V3) -> V3 {
    return V3(multiply(s, v.x), multiply(s, v.y), multiply(s, v.z));
}

fn check_range3(v: V3) {
    check_range(v.x);
    check_range(v.y);
    check_range(v.z);
}

fn check_normal_range3(v: V3) {
    check_normal_range(v.x);
    check_normal_range(v.y);
    check_normal_range(v.z);
}

fn check_not_tiny3(v: V3) {
    check_not_tiny(v.x);
    check_not_tiny(v.y);
    check_not_tiny(v.z);
}

// The dot product without checks: for sums of squares, and where terms below 2^-100 do not matter.
fn dot3(a: V3, b: V3) -> Real {
    return add(add(multiply(a.x, b.x), multiply(a.y, b.y)), multiply(a.z, b.z));
}

fn checked_dot3(a: V3, b: V3) -> Real {
    let x = multiply(a.x, b.x);
    let y = multiply(a.y, b.y);
    let z = multiply(a.z, b.z);
    let total = add(add(x, y), z);
    check_not_tiny(total);
    check_cancellation(total, V3(x, y, z));
    return total;
}

// The length and its reciprocal.
fn length_and_inverse(v: V3) -> vec2<Real> {
    return sqrt_and_inverse(dot3(v, v));
}

// The unit vector along `v`, or `v` itself if every component counts as zero. The caller checks `v`.
fn direction(v: V3) -> V3 {
    let squares = dot3(v, v);
    if has_direction(v, squares) {
        return scale3(inverse_sqrt(squares), v);
    }
    return v;
}

// The unit vector along the part of `v` perpendicular to `normal`, which is not normalised. The caller checks both.
fn direction_in_plane(normal: V3, v: V3) -> V3 {
    let found = subtract3(v, scale3(checked_dot3(normal, v), normal));
    check_not_tiny3(found);
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
    return acos_of(clamped);
}

// a b - c d for vectors b and d, with checks.
fn difference_of_scaled(a: Real, b: V3, c: Real, d: V3) -> V3 {
    let first = scale3(a, b);
    let second = scale3(c, d);
    let found = subtract3(first, second);
    check_cancellation(found.x, V3(first.x, second.x, second.x));
    check_cancellation(found.y, V3(first.y, second.y, second.y));
    check_cancellation(found.z, V3(first.z, second.z, second.z));
    check_range3(found);
    return found;
}

fn negate(a: Real) -> Real {
    return real(bits_of(a) ^ SIGN);
}

// `v` divided by its length, and negated if `is_reversed`; `v` itself if its length counts as zero. `length`: the length and its reciprocal.
fn unit_unless_zero(is_reversed: bool, length: vec2<Real>, v: V3) -> V3 {
    if not_zero(length.x) {
        return scale3(real(bits_of(length.y) ^ select(0u, SIGN, is_reversed)), v);
    }
    return v;
}

// Real numbers as the device's own floats, rounded as the CPU's; needs correct_rounding.wgsl, uint64.wgsl, arccosine.wgsl. Stages are written in the functions
// of these files alone, so that each is one text in all three arithmetics.
//
// Nothing is looked at operation by operation. Stages let vectors and sums be watched where they are small in number, such that no
// operation between can have met or made a number that is subnormal, infinite or NaN: with what is not zero in [2^-62, 2^40],
// - products and squares are at least 2^-124, and lengths, their reciprocals and quotients far from both ends;
// - normals are to be in [2^-62, 8], so that what lies in their planes is below 2^50, and unit vectors there, times an angle, are above
//   2^-124: vectors that follow from what was watched are only watched from below;
// - a difference is a multiple of the last unit of what it is of, so at least 2^-86;
// - a sum of products can only vanish that should not where all of them are below 2^-102: so where it is zero, these are watched.
// The sign of a zero never shows in sums of terms, which begin at +0; what is stored has none.
//
// What was unsure is done again with real_soft.wgsl.

alias Real = f32;

// The least and the largest that were watched, as words times two, less one where zeros do not count.
var<private> least: u32 = 0xffffffffu;
var<private> largest: u32 = 0u;
var<private> largest_of_short: u32 = 0u;
var<private> least_of_wide: u32 = 0xffffffffu;
var<private> largest_of_wide: u32 = 0u;
var<private> is_lost: bool = false;

fn is_unsure() -> bool {
    let is_small = least < (65u << 24u) - 1u || least_of_wide < (25u << 24u) - 1u;
    let is_large = largest > (167u << 24u) || largest_of_short > (130u << 24u);
    return is_lost || is_small || is_large || largest_of_wide > (229u << 24u);
}

// In [2^-62, 2^40], or zero.
fn watch(a: Real) {
    let word = bitcast<u32>(a) << 1u;
    least = min(least, word - 1u);
    largest = max(largest, word);
}

// At least 2^-62, or zero.
fn watch_from_below(a: Real) {
    least = min(least, (bitcast<u32>(a) << 1u) - 1u);
}

// In [2^-62, 8], or zero.
fn watch_short(a: Real) {
    let word = bitcast<u32>(a) << 1u;
    least = min(least, word - 1u);
    largest_of_short = max(largest_of_short, word);
}

// In [2^-102, 2^102], or zero.
fn watch_wide(a: Real) {
    let word = bitcast<u32>(a) << 1u;
    least_of_wide = min(least_of_wide, word - 1u);
    largest_of_wide = max(largest_of_wide, word);
}

// Of products that are `total` together, zero where they cancel.
fn watch_cancelling(total: Real, products: vec3<Real>) {
    if is_zero(bitcast<u32>(total)) {
        watch_wide(products.x);
        watch_wide(products.y);
        watch_wide(products.z);
    }
}

// Whether a vector that was watched from below, the sum of whose squares this is, counts as more than zero.
fn has_direction(v: vec3<Real>, squares: Real) -> bool {
    return !is_zero(bitcast<u32>(squares));
}

fn give_up() {
    is_lost = true;
}

fn real(word: u32) -> Real {
    return bitcast<f32>(word);
}

fn word_of(a: Real) -> u32 {
    return bitcast<u32>(a);
}

// The word that is kept of a result: where arithmetic is sure, no zero of the core's has a sign.
fn stored(a: Real) -> u32 {
    let word = bitcast<u32>(a);
    return select(word, 0u, is_zero(word));
}

// For estimates, whose errors the caller allows for.
fn estimate_of(a: Real) -> f32 {
    return a;
}

fn plus(a: Real, b: Real) -> Real {
    return sum(a, b);
}

fn minus(a: Real, b: Real) -> Real {
    return difference(a, b);
}

fn times(a: Real, b: Real) -> Real {
    return product(a, b);
}

fn over(a: Real, b: Real) -> Real {
    return quotient(a, b);
}

// And one over the root.
fn root_and_inverse_of(a: Real) -> vec2<Real> {
    return root_and_reciprocal(a);
}

fn inverse_root_of(a: Real) -> Real {
    return reciprocal_root(a);
}

fn is_above(a: Real, b: Real) -> bool {
    return a > b;
}

fn arccosine_of(a: Real) -> Real {
    return arccosine(a);
}

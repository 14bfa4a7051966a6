// `Real` as a float of the device, with corrected rounding. Kernels use only the functions that real_exact.wgsl, real_soft.wgsl and
// real_fast.wgsl define, so one kernel source serves all three arithmetics. Requires correct_rounding.wgsl, uint64.wgsl, arccosine.wgsl.
//
// Corrected rounding is proven for normal numbers. Instead of testing every operation, kernels call the functions `check_*` for a few
// values, from which it follows that no operation between them had a subnormal, infinite or NaN operand or result. With all non-zero
// values in [2^-62, 2^40]:
// - Products and squares are at least 2^-124. Lengths, their reciprocals and quotients are far from both limits.
// - Normals are in [2^-62, 8]. So vectors projected into their planes are below 2^50, and need only a lower bound. Unit vectors in those
//   planes, times an angle, are above 2^-124.
// - A difference is a multiple of the last unit of its operands, so it is zero or at least 2^-86.
// - A sum of products can vanish by underflow only if all products are below 2^-102. So if the sum is zero, the products are checked.
// Signs of zeros do not matter: sums of terms begin at +0, and results are stored without them.
//
// Items that fail a check are computed again with real_soft.wgsl.

alias Real = f32;

// The smallest and largest checked values, as bits shifted left to drop the sign. Minima are decreased by 1, so that zero wraps around.
var<private> smallest: u32 = 0xffffffffu;
var<private> largest: u32 = 0u;
var<private> largest_normal: u32 = 0u;
var<private> smallest_wide: u32 = 0xffffffffu;
var<private> largest_wide: u32 = 0u;
var<private> is_marked_unsure: bool = false;

fn is_unsure() -> bool {
    let is_small = smallest < (65u << 24u) - 1u || smallest_wide < (25u << 24u) - 1u;
    let is_large = largest > (167u << 24u) || largest_normal > (130u << 24u);
    return is_marked_unsure || is_small || is_large || largest_wide > (229u << 24u);
}

// The value must be in [2^-62, 2^40], or zero.
fn check_range(a: Real) {
    let word = bitcast<u32>(a) << 1u;
    smallest = min(smallest, word - 1u);
    largest = max(largest, word);
}

// The value must be at least 2^-62, or zero.
fn check_not_tiny(a: Real) {
    smallest = min(smallest, (bitcast<u32>(a) << 1u) - 1u);
}

// The value must be in [2^-62, 8], or zero.
fn check_normal_range(a: Real) {
    let word = bitcast<u32>(a) << 1u;
    smallest = min(smallest, word - 1u);
    largest_normal = max(largest_normal, word);
}

// The value must be in [2^-102, 2^102], or zero.
fn check_wide_range(a: Real) {
    let word = bitcast<u32>(a) << 1u;
    smallest_wide = min(smallest_wide, word - 1u);
    largest_wide = max(largest_wide, word);
}

// `total`, the sum of the products, must not be zero by underflow.
fn check_cancellation(total: Real, products: vec3<Real>) {
    if is_zero(bitcast<u32>(total)) {
        check_wide_range(products.x);
        check_wide_range(products.y);
        check_wide_range(products.z);
    }
}

// Whether a vector that passed `check_not_tiny3` is not zero. `squares`: the sum of its squares.
fn has_direction(v: vec3<Real>, squares: Real) -> bool {
    return !is_zero(bitcast<u32>(squares));
}

fn mark_unsure() {
    is_marked_unsure = true;
}

fn real(word: u32) -> Real {
    return bitcast<f32>(word);
}

fn bits_of(a: Real) -> u32 {
    return bitcast<u32>(a);
}

// The bits of a result as they are stored. Where this arithmetic is sure, the core's zeros are positive.
fn canonical_bits(a: Real) -> u32 {
    let word = bitcast<u32>(a);
    return select(word, 0u, is_zero(word));
}

// An approximation whose error the caller has to allow for.
fn float_of(a: Real) -> f32 {
    return a;
}

fn add(a: Real, b: Real) -> Real {
    return sum(a, b);
}

fn subtract(a: Real, b: Real) -> Real {
    return difference(a, b);
}

fn multiply(a: Real, b: Real) -> Real {
    return product(a, b);
}

fn divide(a: Real, b: Real) -> Real {
    return quotient(a, b);
}

// The square root and its reciprocal.
fn sqrt_and_inverse(a: Real) -> vec2<Real> {
    return root_and_reciprocal(a);
}

fn inverse_sqrt(a: Real) -> Real {
    return reciprocal_root(a);
}

fn is_above(a: Real, b: Real) -> bool {
    return a > b;
}

fn acos_of(a: Real) -> Real {
    return arccosine(a);
}

// The arccosine of floats with the bits of the CPU, which rounds to double precision and then to a float. (Double rounding matters for one
// float, 0x328885a3.) Requires correct_rounding.wgsl and uint64.wgsl.
//
//     |x| <= 1/2:  acos x = pi/2 - asin x
//     |x| > 1/2:   acos |x| = 2 asin sqrt((1 - |x|) / 2),  acos -x = pi - acos x
//     asin z = z + z t P(t), t = z^2, with a polynomial P
//
// `arccosine` computes about 32 bits; if they do not determine the rounding, which happens for one float in 500, `long_arccosine` computes
// 60 bits in 64-bit fixed point. Pairs of floats would give 48 bits, too few for about a hundred floats.

// Fixed point, scaled by 2^62.
const PI: vec2u = vec2u(0xc90fdaa2u, 0x2168c235u);
const HALF_PI: vec2u = vec2u(0x6487ed51u, 0x10b4611au);

// t P(t) for t in [0, 1/4], both scaled by 2^64. The error of asin z is z 2^-61.8. P interpolates at 14 Chebyshev nodes; one of its
// coefficients is negative.
fn arcsine_tail(t: vec2u) -> vec2u {
    var p = difference64(vec2u(0x04ed05aeu, 0xdf6495beu), product64(t, vec2u(0x0794a71bu, 0xf3a6ecf6u)));
    p = difference64(vec2u(0x0501864bu, 0x44918a4eu), product64(t, p));
    p = sum64(vec2u(0x00c78c9bu, 0xa1a0c7f9u), product64(t, p));
    p = sum64(vec2u(0x0262c448u, 0xd39cb5adu), product64(t, p));
    p = sum64(vec2u(0x027693bcu, 0xe24290d5u), product64(t, p));
    p = sum64(vec2u(0x02f604fdu, 0xc3bab09du), product64(t, p));
    p = sum64(vec2u(0x0393215au, 0x7b1fb939u), product64(t, p));
    p = sum64(vec2u(0x04713bf3u, 0x88c067a9u), product64(t, p));
    p = sum64(vec2u(0x05ba2e84u, 0x8f925320u), product64(t, p));
    p = sum64(vec2u(0x07c71c71u, 0xe94ae8bcu), product64(t, p));
    p = sum64(vec2u(0x0b6db6dbu, 0x6d60efdau), product64(t, p));
    p = sum64(vec2u(0x13333333u, 0x3333880cu), product64(t, p));
    p = sum64(vec2u(0x2aaaaaaau, 0xaaaaaa9du), product64(t, p));
    return product64(t, p);
}

// a 2^(scale - 62), rounded to 53 bits and then to 24, ties to even. The high word of `a` is not 0.
fn float_of_double(a: vec2u, scale: i32) -> f32 {
    let zeros = countLeadingZeros(a.x);
    let double = sum64(shift_left(a, zeros), vec2u(0u, 0x400u));
    let is_above_half = (double.x & 0x7fu) != 0u || double.y >= 0x800u;
    let is_odd = (double.x & 0x100u) != 0u;
    let is_up = (double.x & 0x80u) != 0u && (is_above_half || is_odd);
    let exponent = u32(128 + scale) - zeros;
    return bitcast<f32>((exponent << 23u) + (double.x >> 8u) - HIDDEN + u32(is_up));
}

// The arccosine of x in [-1, 1], to 60 bits before rounding.
fn long_arccosine(x: f32) -> f32 {
    let word = bitcast<u32>(x);
    let is_negative = (word & SIGN) != 0u;
    // |x| = significand 2^(exponent - 23)
    let significand = significand_of(word);
    let exponent = exponent_of(word) - 127;
    if exponent >= -1 {
        let above = (HIDDEN << 1u) - (significand << u32(exponent + 1));
        return arccosine_of_large(above, is_negative);
    }
    let size = shift(vec2u(significand, 0u), exponent + 7);
    let square = shift(product_u32(significand, significand), 2 * exponent + 18);
    let arcsine = sum64(size, product64(size, arcsine_tail(square)));
    if is_negative {
        return float_of_double(sum64(HALF_PI, arcsine), 0);
    }
    return float_of_double(difference64(HALF_PI, arcsine), 0);
}

// The arccosine of 1 - above / 2^24, or of its negative.
fn arccosine_of_large(above: u32, is_negative: bool) -> f32 {
    if above == 0u {
        return select(0.0, float_of_double(PI, 0), is_negative);
    }
    // z = sqrt(above / 2^25) = sqrt(square / 2^25) 2^-halvings, square in [2^23, 2^25).
    let halvings = (countLeadingZeros(above) - 7u) >> 1u;
    let square = above << (2u * halvings);
    let z = sqrt64(square);
    let arcsine = sum64(z, product64(z, arcsine_tail(vec2u(above << 7u, 0u))));
    if is_negative {
        return float_of_double(difference64(PI, shift_right(shift_left(arcsine, 1u), halvings)), 0);
    }
    return float_of_double(arcsine, 1 - i32(halvings));
}

// floor(sqrt(square 2^23)) for square in [2^23, 2^25), and the remainder. `inverse`: an estimate of 1 / sqrt(square).
fn integer_sqrt_of(square: u32, inverse: f32) -> vec2i {
    let estimate = i32(f32(square) * inverse * 2896.3093);
    return integer_sqrt(bitcast<i32>(square << 23u), estimate, inverse * 1.7263349e-4);
}

// sqrt(square / 2^25) 2^62 for square in [2^23, 2^25), with an error below 4.
fn sqrt64(square: u32) -> vec2u {
    let found = integer_sqrt_of(square, inverseSqrt(f32(square)));
    // (n + f)^2 = n^2 + rest, so f = (rest - f^2) / 2n. First rest / 2n, by long division to 42 fraction bits.
    let divisor = u32(2 * found.x);
    var rest = u32(found.y);
    var fraction = vec2u(0u, rest / divisor);
    rest = rest % divisor;
    for (var digit = 0; digit < 6; digit++) {
        rest = rest << 7u;
        fraction = sum64(shift_left(fraction, 7u), vec2u(0u, rest / divisor));
        rest = rest % divisor;
    }
    // Then subtract f^2 / 2n, which is below 2^-24, so 15 bits of f are enough.
    let short = min(shift_right(fraction, 27u).y, 0x7fffu);
    fraction = difference64(fraction, vec2u(0u, ((short * short) << 2u) / (divisor >> 10u)));
    return sum64(vec2u(u32(found.x) << 6u, 0u), shift_right(fraction, 4u));
}

// a b / 2^32, too low by less than 3.
fn product32(a: u32, b: u32) -> u32 {
    let low = vec2u(a & 0xffffu, b & 0xffffu);
    let high = vec2u(a >> 16u, b >> 16u);
    return high.x * high.y + ((low.x * high.y) >> 16u) + ((high.x * low.y) >> 16u);
}

// t P(t) scaled by 2^35, from t scaled by 2^32 (`t`) and by 2^33 (`twice`). Too low, by less than 2^-32.4 at t = 1/4. P interpolates at 9
// Chebyshev nodes, to 2^-40. Floats sum the coefficients from t^3 on, with an error below 2^-28, which is subtracted.
fn short_arcsine_tail(t: u32, twice: u32) -> u32 {
    let x = f32(t) * 2.3283064e-10;
    let rest = 0.0303799454 + x * (0.0224124175 + x * (0.0169026833 + x * (0.0168640912 + x * (0.00106750638 + x * 0.0283467453))));
    var p = 0x2db6debdu + product32(t, u32(rest * 17179869184.0) - 64u);
    p = 0x4cccccc5u + product32(t, p);
    p = 0xaaaaaaabu + product32(t, p);
    return product32(twice, p);
}

// The largest error of an arcsine, scaled by 2^62.
const SHORT_ERROR: vec2u = vec2u(0u, 0x40000000u);

// a 2^(scale - 62), too low by at most 2^-32, or 2^-31 if `a` has no leading zero.
struct Estimate {
    a: vec2u,
    scale: i32,
}

// The arccosine of x in [-1, 1].
fn arccosine(x: f32) -> f32 {
    let word = bitcast<u32>(x);
    let is_negative = (word & SIGN) != 0u;
    let significand = significand_of(word);
    let exponent = exponent_of(word) - 127;
    var estimate: Estimate;
    if exponent >= -1 {
        let above = (HIDDEN << 1u) - (significand << u32(exponent + 1));
        if above == 0u {
            return select(0.0, float_of_double(PI, 0), is_negative);
        }
        estimate = arccosine_estimate_of_large(above, is_negative);
    } else {
        let size = shift(vec2u(significand, 0u), exponent + 7);
        let z = shift_left(size, 3u).x;
        let t = product32(z, z);
        let rest = product32(z, short_arcsine_tail(t >> 2u, t >> 1u) << 1u);
        let arcsine = sum64(size, vec2u(rest >> 7u, rest << 25u));
        let less = difference64(HALF_PI, sum64(arcsine, SHORT_ERROR));
        estimate = Estimate(select(less, sum64(HALF_PI, arcsine), is_negative), 0);
    }
    let zeros = countLeadingZeros(estimate.a.x);
    let significant = shift_left(estimate.a, zeros);
    // The 32 bits below the float. The rounding is undecided if half a unit lies within the error, or within the rounding to doubles.
    let behind = (significant.x << 24u) | (significant.y >> 8u);
    let error = 0x400000u << max(zeros, 1u);
    if behind - (0x7ffffff8u - error) < error + 16u {
        return long_arccosine(x);
    }
    let binary_exponent = u32(128 + estimate.scale) - zeros;
    return bitcast<f32>((binary_exponent << 23u) + (significant.x >> 8u) - HIDDEN + ((significant.x >> 7u) & 1u));
}

// As `arccosine_of_large`. The square root needs 12 fraction bits, which a float has.
fn arccosine_estimate_of_large(above: u32, is_negative: bool) -> Estimate {
    let halvings = (countLeadingZeros(above) - 7u) >> 1u;
    let square = above << (2u * halvings);
    let inverse = inverseSqrt(f32(square));
    let found = integer_sqrt_of(square, inverse);
    // Scaled by 2^31, and decreased by a factor of 1 - 2^-20, so that it is too low.
    let fraction = u32(f32(found.y) * inverse * 370727.2);
    let z = vec2u((u32(found.x) << 6u) + (fraction >> 25u), fraction << 7u);
    let rest = product32((z.x << 1u) | (z.y >> 31u), short_arcsine_tail(above << 7u, above << 8u) << 1u);
    let arcsine = sum64(z, vec2u(rest >> 5u, rest << 27u));
    if is_negative {
        let more = sum64(arcsine, SHORT_ERROR);
        return Estimate(difference64(PI, shift_right(shift_left(more, 1u), halvings)), 0);
    }
    return Estimate(arcsine, 1 - i32(halvings));
}

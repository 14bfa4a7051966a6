//! Vector functions in single precision, arccosine and cosine.
//!
//! Every operation is rounded to `f32` in the order written. Nothing here may be re-associated or contracted:
//! results are specified to the bit.

/// Three floats.
pub type V3 = [f32; 3];

/// a + b.
#[inline(always)]
pub fn add(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a - b.
#[inline(always)]
pub fn sub(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// s * v.
#[inline(always)]
pub fn scale(s: f32, v: V3) -> V3 {
    [s * v[0], s * v[1], s * v[2]]
}

/// The dot product.
#[inline(always)]
pub fn dot(a: V3, b: V3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
#[inline(always)]
pub fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length.
#[inline(always)]
pub fn length(v: V3) -> f32 {
    dot(v, v).sqrt()
}

/// The bits by which tangents are told apart. All NaNs have the same, since the sign and payload of a
/// computed NaN depend on the processor and the compiler.
#[inline(always)]
pub(crate) fn distinct_bits<const N: usize>(v: [f32; N]) -> [u32; N] {
    v.map(|x| if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() })
}

/// -1 for a value below zero, +1 for any other, -0 and NaN included.
#[inline(always)]
pub(crate) fn sign(x: f32) -> f32 {
    if x < 0.0 { -1.0 } else { 1.0 }
}

/// `NotZero` of mikktspace.c: true for absolute values above the smallest normal float. False for NaN.
#[inline(always)]
pub(crate) fn not_zero(x: f32) -> bool {
    x.abs() > f32::MIN_POSITIVE
}

/// `v`, normalised; `v` itself when no component is [`not_zero`]. No branches, so that it vectorises.
#[inline(always)]
pub(crate) fn normalized_unless_zero(v: V3) -> V3 {
    let has_direction = not_zero(v[0]) | not_zero(v[1]) | not_zero(v[2]);
    let factor = if has_direction { 1.0 / length(v) } else { 1.0 };
    scale(factor, v)
}

/// `v`, projected to the plane of `normal` and normalised. `normal` is used as given.
#[inline(always)]
pub(crate) fn direction_in_plane(normal: V3, v: V3) -> V3 {
    normalized_unless_zero(sub(v, scale(dot(normal, v), normal)))
}

/// `v`, projected to the plane of the unit `normal` and normalised. A perpendicular of `normal` where the
/// projection is rounding error.
pub(crate) fn unit_in_plane(normal: V3, v: V3) -> V3 {
    let rest = sub(v, scale(dot(normal, v), normal));
    let size = length(rest);
    if size > 1e-6 * length(v) { scale(1.0 / size, rest) } else { perpendiculars(normal)[0] }
}

/// Two unit vectors that with the unit `normal` make a right-handed frame (T. Duff et al., "Building an
/// Orthonormal Basis, Revisited", JCGT 6(1), 2017, listing 3; -0 counts as +0, so that GPUs need no
/// copysign).
pub(crate) fn perpendiculars([x, y, z]: V3) -> [V3; 2] {
    let sign = if z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

/// Equal as floats: -0 equals +0, NaN equals nothing.
#[inline(always)]
pub(crate) fn equal<const N: usize>(a: [f32; N], b: [f32; N]) -> bool {
    a == b
}

/// The angle between two directions whose dot product is `cosine`, clamped to [-1, 1]. NaN gives NaN.
#[inline(always)]
pub(crate) fn angle(cosine: f32) -> f32 {
    let above = if cosine > 1.0 { 1.0 } else { cosine };
    acos(if above < -1.0 { -1.0 } else { above })
}

const HALF_PI: f64 = std::f64::consts::FRAC_PI_2;
/// pi / 2 - HALF_PI.
const HALF_PI_REST: f64 = 6.123_233_995_736_766e-17;

/// The arccosine of `x` in [-1, 1]: `acos` in double precision, rounded to `f32`.
///
/// Up to 1/2: acos x = pi/2 - asin x. Above: acos x = 2 asin sqrt((1 - x) / 2).
#[inline(always)]
pub(crate) fn acos(x: f32) -> f32 {
    let x = f64::from(x);
    let size = x.abs();
    let is_small = size <= 0.5;
    let square = if is_small { x * x } else { (1.0 - size) * 0.5 };
    let z = if is_small { x } else { square.sqrt() };
    let tail = z * (square * asin_tail(square));
    let small = HALF_PI - (z + (tail - HALF_PI_REST));
    let folded = 2.0 * (z + tail);
    let large = if x > 0.0 { folded } else { 2.0 * HALF_PI - (folded - 2.0 * HALF_PI_REST) };
    (if is_small { small } else { large }) as f32
}

/// (asin z - z) / z^3 as a polynomial in t = z^2 on [0, 1/4]: a minimax fit whose error of asin z is below
/// 2e-15. A fit of one degree less, or with another weight, rounds a few floats wrong.
#[inline(always)]
fn asin_tail(t: f64) -> f64 {
    ASIN_TAIL.iter().rev().fold(0.0, |sum, coefficient| sum * t + coefficient)
}

const ASIN_TAIL: [f64; 10] = [
    0.166_666_666_665_042_07,
    0.075_000_000_397_970_53,
    0.044_642_828_694_801_65,
    0.030_382_897_907_276_694,
    0.022_354_261_392_941_735,
    0.017_557_038_462_088_413,
    0.012_499_434_946_492_026,
    0.018_127_203_292_192_6,
    -0.007_734_214_434_533_398_5,
    0.031_868_290_267_532_76,
];

/// The cosine of `degrees` as MikkTSpace takes it: the angle in `f32` radians, its cosine in double
/// precision, rounded.
pub(crate) fn cosine_of_degrees(degrees: f32) -> f32 {
    let radians = (degrees * std::f32::consts::PI) / 180.0;
    if radians.is_finite() { cosine(radians.abs()) } else { f32::NAN }
}

/// The first 256 bits of 1 / (2 pi).
const TURNS_PER_RADIAN: [u64; 4] =
    [0x28be_60db_9391_054a, 0x7f09_d5f4_7d4d_3770, 0x36d8_a566_4f10_e410, 0x7f94_58ea_f7ae_f158];

/// The cosine of `radians` >= 0, rounded from a double.
///
/// `radians` is an integer times a power of two. The fraction of a turn is that integer times the bits of 1 /
/// (2 pi) that follow the power, modulo 1. Error: below 2^-104 of a turn for every float (Payne and Hanek
/// 1983).
fn cosine(radians: f32) -> f32 {
    let exponent = (radians.to_bits() >> 23).max(1) as i32 - 150;
    let mantissa =
        u128::from(radians.to_bits() & 0x7f_ffff) | if radians >= f32::MIN_POSITIVE { 1 << 23 } else { 0 };
    let turn = mantissa.wrapping_mul(digits_from(exponent));
    let quadrant = turn.wrapping_add(1 << 125) >> 126;
    let rest = turn.wrapping_sub(quadrant << 126) as i128;
    let angle = rest as f64 * (std::f64::consts::TAU / 2f64.powi(128));
    let square = angle * angle;
    let even = COSINE.iter().rev().fold(0.0, |sum, coefficient| sum * square + coefficient);
    let odd = angle * SINE.iter().rev().fold(0.0, |sum, coefficient| sum * square + coefficient);
    (match quadrant {
        0 => even,
        1 => -odd,
        2 => -even,
        _ => odd,
    }) as f32
}

/// 128 bits of 1 / (2 pi), the first of weight 2^-(1 + `place`) before the shift by `place`.
fn digits_from(place: i32) -> u128 {
    let [a, b, c, d] = TURNS_PER_RADIAN.map(u128::from);
    let (high, low) = (a << 64 | b, c << 64 | d);
    match place {
        ..=-128 => 0,
        -127..=-1 => high >> -place,
        0 => high,
        _ => high << place | low >> (128 - place),
    }
}

/// cos x and sin x / x as polynomials in x^2 on [0, (pi/4)^2], fitted at Chebyshev nodes; absolute errors
/// below 2e-23 and 1e-24.
const COSINE: [f64; 9] = [
    1.0,
    -0.5,
    0.041_666_666_666_666_664,
    -0.001_388_888_888_888_886,
    2.480_158_730_156_307_3e-5,
    -2.755_731_921_264_828_3e-7,
    2.087_675_387_074_841_5e-9,
    -1.147_024_597_889_514e-11,
    4.736_262_392_223_979e-14,
];
const SINE: [f64; 9] = [
    1.0,
    -0.166_666_666_666_666_66,
    0.008_333_333_333_333_333,
    -0.000_198_412_698_412_698_25,
    2.755_731_922_397_313e-6,
    -2.505_210_837_947_071_7e-8,
    1.605_904_219_523_892e-10,
    -7.646_900_632_538_675e-13,
    2.788_703_315_331_74e-15,
];

#[cfg(test)]
mod tests {
    use super::*;

    fn differing(bits: impl Iterator<Item = u32>) -> usize {
        let differs = |&x: &f32| acos(x).to_bits() != (f64::from(x).acos() as f32).to_bits();
        bits.map(f32::from_bits).filter(differs).inspect(|x| println!("acos({x:e}) differs")).count()
    }

    const ONE: u32 = 0x3f80_0000;
    const SIGN: u32 = 0x8000_0000;

    #[test]
    fn acos_agrees_with_the_platform_on_a_sample() {
        let sample = (0..=ONE).step_by(997).chain(ONE - 20_000..=ONE);
        assert_eq!(differing(sample.flat_map(|bits| [bits, bits | SIGN])), 0);
    }

    /// All 2,130,706,434 bit patterns of [-1, 1], -0 and +0 both: run by `cargo xtask acos`.
    #[test]
    #[ignore = "minutes: cargo xtask acos"]
    fn acos_exhaustive() {
        let threads = std::thread::available_parallelism().map_or(1, usize::from) as u32;
        let count = std::thread::scope(|scope| {
            let run = |first| {
                scope.spawn(move || {
                    differing((first..=ONE).step_by(threads as usize).flat_map(|bits| [bits, bits | SIGN]))
                })
            };
            let workers: Vec<_> = (0..threads).map(run).collect();
            workers.into_iter().map(|worker| worker.join().expect("no panic")).sum::<usize>()
        });
        println!("acos: {} floats checked, {count} differ", 2 * (u64::from(ONE) + 1));
        assert_eq!(count, 0);
    }

    #[test]
    fn cosine_agrees_with_the_platform() {
        let wide = (0..=0x7f7f_ffffu32).step_by(9973).map(f32::from_bits);
        let degrees = (0..=72_000).map(|step| step as f32 / 100.0);
        for degrees in wide.chain(degrees).flat_map(|d| [d, -d]) {
            let radians = (degrees * std::f32::consts::PI) / 180.0;
            let expected = f64::from(radians).cos() as f32;
            let found = cosine_of_degrees(degrees);
            let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
            assert!(same, "cos of {degrees:e} degrees: {found:e}, expected {expected:e}");
        }
    }
}

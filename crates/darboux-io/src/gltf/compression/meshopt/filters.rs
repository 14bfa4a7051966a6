//! The filters of attributes: `KHR_meshopt_compression`, appendix B.
//!
//! The specification permits an error of one unit in every filter but the exponential one. The order of
//! operations and the rounding (to the nearest integer, halves to the even one) are those of meshoptimizer's
//! SIMD code for 16 bits, so that the results are the same. For octahedral vectors and colours of 8 bits that
//! code takes an approximate root and quotient, which differ from processor to processor; here they are
//! exact.

/// Undoes the filter `name` on elements of `stride` bytes. None: there is no such filter, or it does not have
/// this stride.
pub fn undo(name: &str, stride: usize, bytes: &mut [u8]) -> Option<()> {
    match (name, stride) {
        ("NONE", _) => {}
        ("OCTAHEDRAL", 4) => on_bytes(bytes, |[x, y, one, w]| {
            let vector = octahedral([x, y, one].map(|value| f32::from(value as i8)), 127.0);
            [vector[0] as u8, vector[1] as u8, vector[2] as u8, w]
        }),
        ("OCTAHEDRAL", 8) => on_shorts(bytes, |[x, y, one, w]| {
            let vector = octahedral([x, y, one].map(|value| f32::from(value as i16)), 32767.0);
            [vector[0], vector[1], vector[2], w]
        }),
        ("QUATERNION", 8) => on_shorts(bytes, quaternion),
        ("EXPONENTIAL", _) => {
            for word in bytes.as_chunks_mut::<4>().0 {
                *word = exponential(i32::from_le_bytes(*word)).to_le_bytes();
            }
        }
        ("COLOR", 4) => on_bytes(bytes, |[y, co, cg, alpha]| {
            let chroma = [co, cg].map(|value| i32::from(value as i8));
            color(y.into(), chroma, alpha.into(), 255.0).map(|value| value as u8)
        }),
        ("COLOR", 8) => on_shorts(bytes, |[y, co, cg, alpha]| {
            let chroma = [co, cg].map(|value| i32::from(value as i16));
            color(y.into(), chroma, alpha.into(), 65535.0)
        }),
        _ => return None,
    }
    Some(())
}

fn on_bytes(bytes: &mut [u8], filter: impl Fn([u8; 4]) -> [u8; 4]) {
    bytes.as_chunks_mut().0.iter_mut().for_each(|element| *element = filter(*element));
}

fn on_shorts(bytes: &mut [u8], filter: impl Fn([u16; 4]) -> [u16; 4]) {
    for element in bytes.as_chunks_mut::<2>().0.as_chunks_mut::<4>().0 {
        *element = filter(element.map(u16::from_le_bytes)).map(u16::to_le_bytes);
    }
}

/// A unit vector of octahedral coordinates, times `max`, in two's complement. `one` is the 1.0 of the
/// coordinates.
fn octahedral([x, y, one]: [f32; 3], max: f32) -> [u16; 3] {
    let z = one - x.abs() - y.abs();
    // The lower half is folded over the upper one.
    let fold = z.min(0.0);
    let x = x + if x >= 0.0 { fold } else { -fold };
    let y = y + if y >= 0.0 { fold } else { -fold };
    let scale = max / (x * x + (y * y + z * z)).sqrt();
    [x, y, z].map(|value| rounded(value * scale))
}

/// A quaternion of its three smaller components; the last number has the scale, and in two bits which
/// component the largest is.
fn quaternion([x, y, z, last]: [u16; 4]) -> [u16; 4] {
    const MAX: f32 = 32767.0 * std::f32::consts::FRAC_1_SQRT_2;
    let one = f32::from(last as i16 | 3);
    let [x, y, z] = [x, y, z].map(|value| f32::from(value as i16));
    let w = (one * one * 2.0 - (x * x + (y * y + z * z))).max(0.0).sqrt();
    let scale = MAX / one;
    let mut quaternion = [w, x, y, z].map(|value| rounded(value * scale));
    quaternion.rotate_right(usize::from(last & 3));
    quaternion
}

/// A float of a mantissa of 24 bits and an exponent of 8 bits, as bits.
fn exponential(code: i32) -> u32 {
    let (exponent, mantissa) = (code >> 24, code << 8 >> 8);
    // Exponents from -100 to 100 are valid; others have meshoptimizer's bits.
    let power = f32::from_bits(((exponent + 127) as u32) << 23);
    (power * mantissa as f32).to_bits()
}

/// Red, green, blue and alpha of YCoCg. The highest bit of `alpha` is the scale's highest bit.
fn color(y: i32, [co, cg]: [i32; 2], alpha: i32, max: f32) -> [u16; 4] {
    let one = (2 << alpha.max(1).ilog2()) - 1;
    let alpha = (alpha << 1 & one) | (alpha & 1);
    let scale = max / one as f32;
    [y + co - cg, y + cg, y - co - cg, alpha].map(|value| rounded(value as f32 * scale))
}

/// The low 16 bits of the nearest integer, halves to the even one. Values above 2²² in size are not valid.
fn rounded(value: f32) -> u16 {
    // At this size floats are whole numbers, and the sum is rounded to one.
    (value + 12_582_912.0).to_bits() as u16
}

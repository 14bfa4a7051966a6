//! The sRGB transfer function (IEC 61966-2-1), with the same bits on every platform: the power functions of
//! systems differ in the last bit.

/// The linear value of a channel in sRGB, both from 0 to 1.
pub fn srgb_to_linear(channel: f64) -> f64 {
    if channel <= 0.04045 {
        return channel / 12.92;
    }
    // x^2.4 = x^2 x^(2/5).
    let x = (channel + 0.055) / 1.055;
    let root = root(x, 5);
    x * x * root * root
}

/// The sRGB value of a linear channel, both from 0 to 1.
pub fn linear_to_srgb(channel: f64) -> f64 {
    if channel <= 0.04045 / 12.92 {
        return 12.92 * channel;
    }
    // x^(5/12): the third root of the root of the root of x^5.
    let square = channel * channel;
    1.055 * root((square * square * channel).sqrt().sqrt(), 3) - 0.055
}

/// The root of a positive number by Newton's method, from a guess whose exponent is right; relative error
/// below 1e-15.
fn root(x: f64, degree: i32) -> f64 {
    const ONE: i64 = 1.0f64.to_bits() as i64;
    let guess = f64::from_bits(((x.to_bits() as i64 - ONE) / i64::from(degree) + ONE) as u64);
    let power = |x: f64| (1..degree - 1).fold(x, |product, _| product * x);
    let better = |y: f64| y - (y - x / power(y)) / f64::from(degree);
    better(better(better(better(guess))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_functions_agree_with_powers_and_undo_each_other() {
        for step in 0..=100_000 {
            let x = f64::from(step) / 100_000.0;
            if x > 0.04045 {
                let expected = ((x + 0.055) / 1.055).powf(2.4);
                assert!((srgb_to_linear(x) - expected).abs() <= 1e-14 * expected, "{x}");
            }
            assert!((linear_to_srgb(srgb_to_linear(x)) - x).abs() < 1e-14, "{x}");
        }
        assert_eq!([0.0, 1.0].map(srgb_to_linear), [0.0, 1.0]);
    }
}

//! The places of samples within a texel.

/// Steps per texel and axis: places of samples and corners of triangles are multiples of 1 / 256 texel, so
/// that the test whether a triangle covers a sample is exact.
pub const STEPS: i64 = 256;

/// The samples of a texel, evenly spaced, row after row, in steps from the upper left corner of the texel.
pub fn pattern(per_axis: u32) -> Vec<[i64; 2]> {
    let per_axis = i64::from(per_axis);
    let place = |i: i64| (2 * i + 1) * STEPS / (2 * per_axis);
    (0..per_axis).flat_map(|y| (0..per_axis).map(move |x| [place(x), place(y)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::MAX_SAMPLES_PER_AXIS;

    #[test]
    fn one_sample_is_the_centre_and_more_are_spread_evenly() {
        assert_eq!(pattern(1), [[128, 128]]);
        assert_eq!(pattern(2), [[64, 64], [192, 64], [64, 192], [192, 192]]);
        for per_axis in 1..=MAX_SAMPLES_PER_AXIS {
            let pattern = pattern(per_axis);
            let mean =
                [0, 1].map(|i| pattern.iter().map(|place| place[i]).sum::<i64>() / pattern.len() as i64);
            assert!(mean.iter().all(|mean| (mean - STEPS / 2).abs() <= 1), "{per_axis}: {mean:?}");
        }
    }
}

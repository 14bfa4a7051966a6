//! The colour scale of angles in heat maps and rendered pictures: logarithmic, from violet to yellow.

/// The ends of the scale in degrees; it is logarithmic between them.
pub const ENDS: [f64; 2] = [0.01, 180.0];
/// The ticks of the scale in degrees.
pub const TICKS: [f64; 4] = [0.1, 1.0, 10.0, 100.0];

/// The colours from the smallest to the largest angle: nine of viridis (N. Smith and S. van der Walt, 2015, CC0), whose lightness increases evenly.
pub const RAMP: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];
const TICK: [u8; 3] = [255, 255, 255];
/// The colour of opposite signs, at any angle.
pub const FLIP: [u8; 3] = [230, 40, 40];

/// One row of the scale in a picture: its colours and ticks.
pub fn row(width: usize) -> Vec<[u8; 3]> {
    let last = width.saturating_sub(1).max(1) as f64;
    let ticks = TICKS.map(|tick| (scale_position(tick) * last).round() as usize);
    (0..width).map(|x| if ticks.contains(&x) { TICK } else { ramp(x as f64 / last) }).collect()
}

/// The position of an angle on the scale, from 0 to 1.
pub fn scale_position(degrees: f64) -> f64 {
    let [from, to] = ENDS;
    ((degrees.max(from) / from).ln() / (to / from).ln()).min(1.0)
}

/// The colour at a position from 0 to 1.
pub fn ramp(position: f64) -> [u8; 3] {
    let steps = (RAMP.len() - 1) as f64;
    let below = ((position * steps) as usize).min(RAMP.len() - 2);
    let part = position * steps - below as f64;
    [0, 1, 2].map(|i| {
        let [a, b] = [RAMP[below][i], RAMP[below + 1][i]].map(f64::from);
        (a + part * (b - a)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_grows_lighter() {
        let light =
            |[r, g, b]: [u8; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        let steps = (0..=100).map(|i| light(ramp(f64::from(i) / 100.0)));
        assert!(steps.collect::<Vec<_>>().is_sorted());
        assert_eq!([scale_position(0.0), scale_position(0.01), scale_position(180.0)], [0.0, 0.0, 1.0]);
    }
}

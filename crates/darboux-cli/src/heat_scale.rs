//! The colour scale of angles in heat maps and rendered pictures: logarithmic, from violet to yellow.

mod digits;

use std::fmt;

/// The ends of the scale in degrees, unless others are chosen.
pub const ENDS: [f64; 2] = [0.01, 180.0];
/// The ticks of that scale in degrees.
pub const TICKS: [f64; 4] = [0.1, 1.0, 10.0, 100.0];

/// The ends of a scale in degrees; it is logarithmic between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatRange([f64; 2]);

impl HeatRange {
    /// The range of `darboux compare`, the viewer and `darboux render`.
    pub const WHOLE: Self = Self(ENDS);

    /// The range from a tenth of the median angle to the greatest, each rounded outwards to 1, 2 or 5 times a
    /// power of ten. Values that are not finite do not count.
    #[cfg(feature = "bake")]
    pub fn fitting(degrees: impl Iterator<Item = f64>) -> Self {
        let mut known: Vec<f64> = degrees.filter(|angle| angle.is_finite() && *angle > 0.0).collect();
        known.sort_unstable_by(f64::total_cmp);
        let (Some(&median), Some(&most)) = (known.get(known.len() / 2), known.last()) else {
            return Self::WHOLE;
        };
        let to = rounded(most, true).clamp(ENDS[0] * 10.0, ENDS[1]);
        Self([rounded(0.1 * median, false).clamp(1e-4, to / 10.0), to])
    }

    /// The position of an angle on the scale, from 0 to 1.
    pub fn position(self, degrees: f64) -> f64 {
        let [from, to] = self.0;
        ((degrees.max(from) / from).ln() / (to / from).ln()).min(1.0)
    }

    /// The powers of ten between the ends, and the ends.
    fn ticks(self) -> Vec<f64> {
        let [from, to] = self.0;
        let [first, last] = [from.log10().floor() as i32 + 1, to.log10().ceil() as i32 - 1];
        // A tick beside an end would be written over the end's number.
        let between = (first..=last)
            .map(|power| 10f64.powi(power))
            .filter(|tick| (0.12..0.9).contains(&self.position(*tick)));
        [from].into_iter().chain(between).chain([to]).collect()
    }

    /// The scale in a picture: rows of its colours, with ticks, and of numbers below them.
    pub fn rows(self, width: usize) -> Vec<Vec<[u8; 3]>> {
        const BAR: usize = 16;
        let last = width.saturating_sub(1).max(1) as f64;
        let place = |degrees: f64| (self.position(degrees) * last).round() as usize;
        let ticks = self.ticks();
        let color =
            |x: usize| if ticks.iter().any(|&tick| place(tick) == x) { TICK } else { ramp(x as f64 / last) };
        let bar: Vec<[u8; 3]> = (0..width).map(color).collect();
        let mut rows = vec![bar; BAR];
        let first = rows.len();
        rows.resize(first + digits::HEIGHT, vec![[0; 3]; width]);
        for degrees in ticks {
            let text = format!("{}°", shown(degrees));
            let wide = digits::width(&text);
            if wide <= width {
                let left = place(degrees).saturating_sub(wide / 2).min(width - wide);
                digits::write(&text, left, &mut rows[first..]);
            }
        }
        rows
    }
}

impl std::str::FromStr for HeatRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text
            .split_once(',')
            .and_then(|(from, to)| Some([from.trim().parse().ok()?, to.trim().parse().ok()?]));
        let is_range = |[from, to]: &[f64; 2]| *from >= 1e-4 && *to <= 180.0 && *to >= 2.0 * *from;
        let sentence = "expected two angles such as 0.1,20: at least 0.0001, at most 180, the second at \
             least twice the first";
        ends.filter(is_range).map(Self).ok_or_else(|| sentence.to_owned())
    }
}

impl fmt::Display for HeatRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {} degrees", shown(self.0[0]), shown(self.0[1]))
    }
}

/// The next of 1, 2, 5 times a power of ten, upwards or downwards.
#[cfg(feature = "bake")]
fn rounded(x: f64, is_up: bool) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
    let found = if is_up {
        steps.into_iter().find(|step| *step >= x)
    } else {
        steps.into_iter().rev().find(|step| *step <= x)
    };
    found.unwrap_or(x)
}

/// A number without what its binary digits add.
fn shown(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// The colours from the smallest to the largest angle: nine of viridis (N. Smith and S. van der Walt, 2015,
/// CC0), whose lightness increases evenly.
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
#[cfg(feature = "gpu")]
pub fn row(width: usize) -> Vec<[u8; 3]> {
    let last = width.saturating_sub(1).max(1) as f64;
    let ticks = TICKS.map(|tick| (scale_position(tick) * last).round() as usize);
    (0..width).map(|x| if ticks.contains(&x) { TICK } else { ramp(x as f64 / last) }).collect()
}

/// The position of an angle on the whole scale, from 0 to 1.
pub fn scale_position(degrees: f64) -> f64 {
    HeatRange::WHOLE.position(degrees)
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
    fn ranges_fit_and_have_numbers_at_their_ticks() {
        let fitting = HeatRange::fitting([f64::NAN, 0.5, 0.7, 0.3, 13.0].into_iter());
        assert_eq!(fitting, HeatRange([0.05, 20.0]));
        assert_eq!(fitting.to_string(), "0.05 to 20 degrees");
        assert_eq!(HeatRange::fitting([].into_iter()), HeatRange::WHOLE);
        assert_eq!(fitting.ticks(), [0.05, 1.0, 10.0, 20.0]);
        let rows = fitting.rows(300);
        assert!(rows.iter().all(|row| row.len() == 300));
        let ink = |from: usize| {
            rows[16..].iter().flat_map(|row| &row[from..from + 30]).filter(|&&pixel| pixel != [0; 3]).count()
        };
        assert!(ink(0) > 20 && ink(270) > 10 && ink(60) == 0, "numbers at both ends");
        assert_eq!("0.1, 20".parse(), Ok(HeatRange([0.1, 20.0])));
        for wrong in ["", "1", "0,1", "2,3", "1,200", "NaN,2", "5,1"] {
            assert!(wrong.parse::<HeatRange>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_scale_grows_lighter() {
        let light =
            |[r, g, b]: [u8; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        let steps = (0..=100).map(|i| light(ramp(f64::from(i) / 100.0)));
        assert!(steps.collect::<Vec<_>>().is_sorted());
        assert_eq!([scale_position(0.0), scale_position(0.01), scale_position(180.0)], [0.0, 0.0, 1.0]);
    }
}

//! Why the rays of a low model miss high ones, judged by the boxes around both: units, axes, places.

use crate::vector::{Vector, add_scaled, length, sub};

/// The length of a model over its width from which on single precision cannot hold its directions.
const LONGEST: f64 = 1e6;

/// The ratio of two models' extents from which on they are taken to have different units.
const OTHER_UNIT: f64 = 5.0;

/// How far the corners of two boxes are apart, relative to a diagonal, from which on they differ, and up to
/// which they are alike.
const DIFFERENT: f64 = 0.1;
const ALIKE: f64 = 0.05;

/// The low and the high corner of a box along the axes.
pub type Corners = [Vector; 2];

/// A clause on what is wrong with the boxes of a low model and of all high models, and what to do; none where
/// they fit.
pub fn of_boxes(low: Corners, high: Corners) -> Option<String> {
    let [of_low, of_high] = [low, high].map(extents);
    let mut sorted = of_low;
    sorted.sort_by(f64::total_cmp);
    if sorted[2] > LONGEST * sorted[1] && sorted[1] > 0.0 {
        return Some(
            "the low model is more than a million times as long as wide, so that numbers cannot hold its \
             directions; scale it evenly in its scene"
                .to_owned(),
        );
    }
    let ratio = length(of_high) / length(of_low);
    if !ratio.is_finite() || ratio == 0.0 {
        return None;
    }
    if !(1.0 / OTHER_UNIT..OTHER_UNIT).contains(&ratio) {
        let [larger, smaller, times] = match ratio > 1.0 {
            true => ["the high models are", "the low one", &rounded(ratio)],
            false => ["the low model is", "the high ones", &rounded(1.0 / ratio)],
        };
        return Some(format!("{larger} {times} times as large as {smaller}; export both in one unit"));
    }
    let apart = |other: Corners| distance(low, other) / length(of_low);
    if apart(high) > DIFFERENT && turned(high).iter().any(|turned| apart(*turned) < ALIKE) {
        return Some(
            "the high models have another axis up than the low one; export both alike, or turn one (darboux \
             convert --from blender for a file whose z is up)"
                .to_owned(),
        );
    }
    let is_apart = (0..3).any(|axis| low[1][axis] < high[0][axis] || high[1][axis] < low[0][axis]);
    is_apart.then(|| {
        let between = length(sub(center(low), center(high)));
        format!(
            "the high models lie beside the low one, {} away from middle to middle; move them onto each other",
            rounded(between)
        )
    })
}

fn extents([low, high]: Corners) -> Vector {
    sub(high, low)
}

fn center([low, high]: Corners) -> Vector {
    add_scaled(low, 0.5, sub(high, low))
}

/// The larger distance between the low corners and between the high corners of two boxes.
fn distance(a: Corners, b: Corners) -> f64 {
    length(sub(a[0], b[0])).max(length(sub(a[1], b[1])))
}

/// A box whose z is up with y up, and one whose y is up with z up.
fn turned([low, high]: Corners) -> [Corners; 2] {
    [
        [[low[0], low[2], -high[1]], [high[0], high[2], -low[1]]],
        [[low[0], -high[2], low[1]], [high[0], -low[2], high[1]]],
    ]
}

/// A positive number with three significant digits.
fn rounded(number: f64) -> String {
    let digits = (2.0 - number.log10().floor()).max(0.0);
    format!("{number:.0$}", digits as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clause(low: Corners, high: Corners) -> String {
        of_boxes(low, high).unwrap_or_default()
    }

    #[test]
    fn units_axes_and_places_are_told() {
        let low = [[0.0; 3], [1.0, 2.0, 3.0]];
        let scaled = |by: f64| low.map(|corner| corner.map(|x| by * x));
        assert_eq!(clause(low, scaled(1.1)), "");
        assert!(clause(low, scaled(100.0)).contains("the high models are 100 times as large as the low one"));
        assert!(clause(scaled(39.37), low).contains("the low model is 39.4 times as large as the high ones"));
        let turned = [[0.0, -3.0, 0.0], [1.0, 0.0, 2.0]];
        assert!(clause(low, turned).contains("have another axis up"), "{}", clause(low, turned));
        // As long as high, as a horse is.
        let horse = [[-0.5, 0.0, -1.5], [0.5, 3.0, 1.5]];
        let turned = [[-0.5, -1.5, 0.0], [0.5, 1.5, 3.0]];
        assert!(
            clause(horse, turned).contains("another axis up")
                && clause(turned, horse).contains("another axis up")
        );
        let beside = low.map(|[x, y, z]| [x + 10.0, y, z]);
        assert!(clause(low, beside).contains("lie beside the low one, 10.0 away"));
        // A part of a scene, and decals on a model, may be of any shape.
        assert_eq!(clause(low, [[-1.0; 3], [4.0; 3]]), "");
        assert_eq!(clause(low, [[0.5; 3], [0.9, 1.9, 2.9]]), "");
        assert!(clause([[0.0; 3], [1e7, 1.0, 1.0]], low).contains("a million times as long as wide"));
        assert_eq!(clause([[0.0; 3]; 2], [[0.0; 3]; 2]), "");
    }
}

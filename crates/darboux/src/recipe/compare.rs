//! Compares the tangents of a recipe with those of a file, corner by corner, several corners side by side.

use super::definition::{Recipe, RecipeMatch, RecipeRounding};
use crate::exec::simd::{Task, Width};

/// Corners that are compared side by side.
const LANES: usize = 8;

/// Counts how well the tangents of a recipe agree with others. Both have one tangent per corner.
pub fn compare(recipe: Recipe, candidate: &[[f32; 4]], tangents: &[[f32; 4]], width: Width) -> RecipeMatch {
    let mut out =
        RecipeMatch { recipe, corners: tangents.len(), identical: 0, close: 0, sign_flips: 0, worst: 0.0 };
    width.run(Comparison { candidate, tangents, out: &mut out });
    out
}

struct Comparison<'a> {
    candidate: &'a [[f32; 4]],
    tangents: &'a [[f32; 4]],
    out: &'a mut RecipeMatch,
}

impl Task for Comparison<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { candidate, tangents, out } = self;
        let rounding = out.recipe.rounding;
        let close_degrees: f64 = if rounding == RecipeRounding::Bits8 { 1.0 } else { 0.1 };
        let limit = close_degrees.to_radians().sin().powi(2);
        let mut worst = [0.0f64; LANES];
        for (ours, theirs) in candidate.chunks(LANES).zip(tangents.chunks(LANES)) {
            // The last chunk is filled with equal tangents, which are subtracted again.
            let filling = LANES - ours.len();
            let [ours, theirs] = [ours, theirs].map(transposed);
            let mut counts = [0usize; 3];
            for i in 0..LANES {
                let [ours, theirs] = [ours, theirs].map(|vectors| vectors.map(|component| component[i]));
                let is_identical = same(rounded(ours, rounding), theirs);
                let is_flipped = (ours[3] < 0.0) != (theirs[3] < 0.0);
                let turn = if is_identical { 0.0 } else { turn(ours, theirs) };
                counts[0] += usize::from(is_identical);
                counts[1] += usize::from((turn <= limit) & !is_flipped);
                counts[2] += usize::from(is_flipped);
                worst[i] = if turn > worst[i] { turn } else { worst[i] };
            }
            out.identical += counts[0] - filling;
            out.close += counts[1] - filling;
            out.sign_flips += counts[2];
        }
        out.worst = degrees(worst.into_iter().fold(0.0, f64::max));
    }
}

/// One array per component.
#[inline(always)]
fn transposed(tangents: &[[f32; 4]]) -> [[f32; LANES]; 4] {
    let mut out = [[0.0; LANES]; 4];
    for (i, tangent) in tangents.iter().enumerate() {
        (0..4).for_each(|component| out[component][i] = tangent[component]);
    }
    out
}

/// The nearest tangent whose components are multiples of 1/127 or 1/32767.
#[inline(always)]
pub fn rounded(tangent: [f32; 4], rounding: RecipeRounding) -> [f32; 4] {
    let largest = match rounding {
        RecipeRounding::Floats => return tangent,
        RecipeRounding::Bits8 => 127.0,
        RecipeRounding::Bits16 => 32767.0,
    };
    tangent.map(|x| (x * largest).round() / largest)
}

/// Whether all components are equal or NaN. Both zeros are equal.
#[inline(always)]
fn same(a: [f32; 4], b: [f32; 4]) -> bool {
    let is_same = |i: usize| (a[i] == b[i]) | (a[i].is_nan() & b[i].is_nan());
    is_same(0) & is_same(1) & is_same(2) & is_same(3)
}

/// The bits, with one zero and one NaN.
pub fn bits(tangent: [f32; 4]) -> [u32; 4] {
    tangent.map(|x| if x.is_nan() { f32::NAN.to_bits() } else { (x + 0.0).to_bits() })
}

/// A number that grows with the angle: the squared sine up to 90 degrees, 2 minus it above.
#[inline(always)]
fn turn(a: [f32; 4], b: [f32; 4]) -> f64 {
    let [[ax, ay, az, _], [bx, by, bz, _]] = [a, b].map(|v| v.map(f64::from));
    let cross = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
    let dot = ax * bx + ay * by + az * bz;
    let squares = (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz);
    let sine = (cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]) / squares;
    let turn = if dot >= 0.0 { sine } else { 2.0 - sine };
    if sine.is_finite() { turn } else { 2.0 }
}

fn degrees(turn: f64) -> f64 {
    if turn <= 1.0 {
        turn.sqrt().min(1.0).asin().to_degrees()
    } else {
        180.0 - (2.0 - turn).max(0.0).sqrt().asin().to_degrees()
    }
}

//! Stage 7: fills texels without a hit from the nearest texel that has one.
//!
//! A renderer mixes texels across the border of a chart, more of them at every mip level. Without padding the
//! background shows there as a seam. The nearest texel is exact: A. Meijster, J. Roerdink, W. Hesselink, "A
//! General Algorithm for Computing Distance Transforms in Linear Time", 2000. Its first phase finds the
//! nearest row of every column, the second the nearest column of every row.

use darboux::internal::jobs;
use darboux::{Context, Error};

use crate::images::TexelState;

/// The bytes that the tables take per texel.
pub const BYTES_PER_TEXEL: u64 = 8;

/// No row of the column has a hit.
const NONE: u32 = u32::MAX;

/// Rows per job.
const ROWS: usize = 16;

/// For each texel the one whose content it gets: itself where it has content, or where nothing is near
/// enough.
///
/// `padding`: how far texels outside the charts are filled, in texels; missed texels in charts are always
/// filled. The nearest texel with content counts; of several, that in the leftmost column, and in it the
/// upper one. Errors: the context's token was cancelled.
pub fn sources(
    states: &[TexelState],
    width: usize,
    padding: Option<u32>,
    context: &Context,
) -> Result<Vec<u32>, Error> {
    let nearest_row = nearest_rows(states, width);
    let mut sources: Vec<u32> = (0..states.len() as u32).collect();
    let mut parts: Vec<_> = sources.chunks_mut(ROWS * width).enumerate().collect();
    jobs::for_each(context, &mut parts, |(part, sources)| {
        let mut envelope = Envelope::default();
        for (row, sources) in sources.chunks_mut(width).enumerate() {
            let row = *part * ROWS + row;
            let of_row = row * width..(row + 1) * width;
            envelope.fill(row, &nearest_row[of_row.clone()], &states[of_row], padding, sources);
        }
    })?;
    Ok(sources)
}

/// For each texel the nearest row with a baked texel in its column, the upper one of two.
fn nearest_rows(states: &[TexelState], width: usize) -> Vec<u32> {
    let height = states.len() / width;
    let mut nearest = vec![NONE; states.len()];
    for row in 0..height {
        for column in 0..width {
            let texel = row * width + column;
            nearest[texel] = match states[texel] {
                state if state.has_content() => row as u32,
                _ if row > 0 => nearest[texel - width],
                _ => NONE,
            };
        }
    }
    for row in (0..height.saturating_sub(1)).rev() {
        for column in 0..width {
            let texel = row * width + column;
            let below = nearest[texel + width];
            let distance = |of: u32| if of == NONE { u32::MAX } else { of.abs_diff(row as u32) };
            if distance(below) < distance(nearest[texel]) {
                nearest[texel] = below;
            }
        }
    }
    nearest
}

/// The lower envelope of the parabolas (x - column)^2 + (row - nearest row)^2 of a row.
#[derive(Default)]
struct Envelope {
    /// The columns of the parabolas, with their squared distances of rows, and where each begins to be the
    /// lowest.
    parts: Vec<(i64, i64, i64)>,
}

impl Envelope {
    fn fill(
        &mut self,
        row: usize,
        nearest_row: &[u32],
        states: &[TexelState],
        padding: Option<u32>,
        sources: &mut [u32],
    ) {
        let width = sources.len();
        self.parts.clear();
        for (column, &nearest) in nearest_row.iter().enumerate().filter(|(_, nearest)| **nearest != NONE) {
            let square = (nearest as i64 - row as i64).pow(2);
            self.add(column as i64, square, width as i64);
        }
        let limit = padding.map_or(i64::MAX, |padding| i64::from(padding).pow(2));
        let mut part = 0;
        for (column, source) in sources.iter_mut().enumerate() {
            while part + 1 < self.parts.len() && self.parts[part + 1].2 <= column as i64 {
                part += 1;
            }
            let Some(&(nearest, square, _)) = self.parts.get(part) else { return };
            let distance = (nearest - column as i64).pow(2) + square;
            let is_filled = match states[column] {
                TexelState::Baked | TexelState::Extended => false,
                TexelState::Missed | TexelState::MissedBehind => true,
                TexelState::Outside => distance <= limit,
            };
            if is_filled {
                *source = nearest_row[nearest as usize] * width as u32 + nearest as u32;
            }
        }
    }

    /// Adds the parabola of a column to the right of all others.
    fn add(&mut self, column: i64, square: i64, width: i64) {
        let mut from = 0;
        while let Some(&(last, last_square, last_from)) = self.parts.last() {
            // From this place on the new parabola is lower; where both are equal the left one counts.
            let difference = column * column - last * last + square - last_square;
            from = difference.div_euclid(2 * (column - last)) + 1;
            if from > last_from {
                break;
            }
            self.parts.pop();
            from = 0;
        }
        if from < width {
            self.parts.push((column, square, from));
        }
    }
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;

    use super::*;

    /// The slow twin: every texel against every baked one.
    fn nearest(states: &[TexelState], width: usize, texel: usize) -> Option<(usize, u64)> {
        let place = |texel: usize| [texel % width, texel / width];
        let distance = |other: usize| {
            let ([a, b], [c, d]) = (place(texel), place(other));
            a.abs_diff(c).pow(2) as u64 + b.abs_diff(d).pow(2) as u64
        };
        (0..states.len())
            .filter(|&other| states[other].has_content())
            .map(|other| (other, distance(other)))
            .min_by_key(|&(other, distance)| (distance, place(other)))
    }

    #[test]
    fn texels_are_filled_from_the_nearest_hit() {
        let mut dice = Dice::from_seed(4);
        for round in 0..200 {
            let [width, height] = [1 + dice.below(40), 1 + dice.below(40)];
            let rare = [2, 9, 60, 700][round % 4];
            let states: Vec<TexelState> = (0..width * height)
                .map(|_| match (dice.one_in(rare), dice.one_in(3)) {
                    (true, true) => TexelState::Extended,
                    (true, _) => TexelState::Baked,
                    (_, true) => TexelState::Missed,
                    _ => TexelState::Outside,
                })
                .collect();
            let padding = [None, Some(0), Some(3)][round % 3];
            let found = sources(&states, width, padding, &Context::new()).expect("not cancelled");
            for (texel, &source) in found.iter().enumerate() {
                let limit = padding.map_or(u64::MAX, |padding| u64::from(padding).pow(2));
                let expected = match (states[texel], nearest(&states, width, texel)) {
                    (TexelState::Missed, Some((other, _))) => other,
                    (TexelState::Outside, Some((other, distance))) if distance <= limit => other,
                    _ => texel,
                };
                assert_eq!(source as usize, expected, "texel {texel} of {width} x {height}");
            }
        }
    }
}

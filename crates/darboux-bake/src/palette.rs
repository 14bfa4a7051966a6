//! Colours for labels: labels that meet in the image get colours that are far from each other.

use std::collections::HashSet;

use darboux::internal::cancel_checks::check;
use darboux::{Context, Error};

use crate::MapKind;
use crate::images::{Images, TexelState};
use crate::maps::turn_of;

/// A colour of a map, and what it stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct IdColor {
    /// The number of the material, mesh, part or chart.
    pub id: u32,
    /// Red, green and blue in 8 bits; the image has them divided by 255.
    pub color: [u8; 3],
    /// The texels that rays found, or that the chart covers.
    pub texels: u64,
}

/// Colours among which the last one is chosen, and how many of the colours before it a label's differs from.
const SPARE: usize = 24;

/// The most labels that have all unused colours compared for each of them.
const FEW: usize = 1000;

/// The colours that are compared for each of many labels.
const COMPARED: usize = 64;

/// The comparisons beyond [`COMPARED`] that each of more than [`FEW`] labels gets, times the number of all
/// colours: the choice does not become worse abruptly.
const MORE_COMPARED: usize = 1 << 20;

/// The largest label: the image keeps labels plus 1 as `f32`, which has all integers up to here.
const MOST_LABELS: usize = 1 << 24;

/// The place of a label that no texel has.
const NO_ENTRY: u32 = u32::MAX;

/// Replaces the labels in the first channel of a map, each plus 1, by colours from 0 to 1. Returns the
/// colours, in the order of the labels.
///
/// Labels get their colours one after the other: the unused colour that is farthest from the colours of
/// neighbouring labels, and then from those of the labels before it. Errors: the context's token was
/// cancelled.
pub fn color_labels(images: &mut Images, kind: MapKind, context: &Context) -> Result<Vec<IdColor>, Error> {
    let [width, height] = images.size.map(|side| side as usize);
    let is_low = kind.is_of_low_surface();
    let has_label = |state: TexelState| state.has_content() || is_low && state.is_missed();
    let states = &images.states;
    let Some(numbers) = images.numbers(kind) else { return Ok(Vec::new()) };
    let label =
        |texel: usize| has_label(states[texel]).then(|| (numbers[3 * texel] as usize).min(MOST_LABELS) - 1);
    let Labels { mut entries, rank_of_label } = Labels::count([width, height], label, context)?;
    let rank = |texel: usize| label(texel).map(|label| rank_of_label[label]);
    let adjacency = adjacency([width, height], rank, context)?;
    let colors = choose(entries.len(), &adjacency, distance, context)?;
    entries.iter_mut().zip(&colors).for_each(|(entry, color)| entry.color = *color);
    for row in images.numbers_mut(kind).unwrap_or_default().chunks_mut(3 * width) {
        check(context)?;
        for texel in row.as_chunks_mut::<3>().0 {
            // Where no padding reaches, the background is 0.
            let rank = (texel[0] as usize)
                .min(MOST_LABELS)
                .checked_sub(1)
                .and_then(|label| rank_of_label.get(label));
            let color = rank.and_then(|&rank| colors.get(rank as usize));
            *texel = color.map_or([0.0; 3], |color| color.map(|code| f32::from(code) / 255.0));
        }
    }
    Ok(entries)
}

/// Replaces labels, each plus 1, that are codes of colours, as [`MapKind::Id`] of vertex colours has them, by
/// these colours.
pub fn unpack_colors(images: &mut Images, kind: MapKind) {
    let Some(numbers) = images.numbers_mut(kind) else { return };
    for texel in numbers.as_chunks_mut::<3>().0 {
        let label = (texel[0] as u32).saturating_sub(1);
        *texel = [label >> 16, label >> 8, label].map(|code| (code & 255) as f32 / 255.0);
    }
}

/// The labels of a map, and the places of labels among them.
struct Labels {
    /// Without colours yet.
    entries: Vec<IdColor>,
    rank_of_label: Vec<u32>,
}

impl Labels {
    /// Errors: the context's token was cancelled.
    fn count(
        [width, height]: [usize; 2],
        label: impl Fn(usize) -> Option<usize>,
        context: &Context,
    ) -> Result<Self, Error> {
        let mut texels_of_label: Vec<u64> = Vec::new();
        for row in 0..height {
            check(context)?;
            for label in (row * width..(row + 1) * width).filter_map(&label) {
                if label >= texels_of_label.len() {
                    texels_of_label.resize(label + 1, 0);
                }
                texels_of_label[label] += 1;
            }
        }
        let mut entries = Vec::new();
        let mut rank_of_label = vec![NO_ENTRY; texels_of_label.len()];
        for (id, texels) in (0..).zip(texels_of_label).filter(|(_, texels)| *texels > 0) {
            rank_of_label[id as usize] = entries.len() as u32;
            entries.push(IdColor { id, color: [0; 3], texels });
        }
        Ok(Self { entries, rank_of_label })
    }
}

/// The labels of texels that share a side: pairs of a label and an earlier one, each once, sorted. Errors:
/// the context's token was cancelled.
fn adjacency(
    [width, height]: [usize; 2],
    label: impl Fn(usize) -> Option<u32>,
    context: &Context,
) -> Result<Vec<(u32, u32)>, Error> {
    let mut pairs = HashSet::new();
    for row in 0..height {
        check(context)?;
        for column in 0..width {
            let texel = row * width + column;
            let Some(here) = label(texel) else { continue };
            let right = (column + 1 < width).then_some(texel + 1);
            let below = (row + 1 < height).then_some(texel + width);
            let others = [right, below].into_iter().flatten().filter_map(&label);
            pairs.extend(
                others.filter(|&other| other != here).map(|other| (here.max(other), here.min(other))),
            );
        }
    }
    let mut pairs: Vec<(u32, u32)> = pairs.into_iter().collect();
    pairs.sort_unstable();
    Ok(pairs)
}

/// The colours of labels from 0 to `count`. `adjacency`: as that function returns it. Errors: the context's
/// token was cancelled.
fn choose(
    count: usize,
    mut adjacency: &[(u32, u32)],
    distance: impl Fn([u8; 3], [u8; 3]) -> u64,
    context: &Context,
) -> Result<Vec<[u8; 3]>, Error> {
    let mut unused = Unused::for_labels(count);
    let mut colors: Vec<[u8; 3]> = Vec::with_capacity(count);
    let mut near = Vec::new();
    for label in 0..count {
        check(context)?;
        let (of_label, later) =
            adjacency.split_at(adjacency.partition_point(|&(of, _)| of as usize <= label));
        adjacency = later;
        near.clear();
        near.extend(of_label.iter().map(|&(_, other)| colors[other as usize]));
        // Of recent colours too, so that parts of a model look different from each other.
        let recent = &colors[label.saturating_sub(SPARE)..];
        // Where 8 bits have no more colours, labels are black, as the background.
        colors.push(unused.take_farthest(&near, recent, &distance).unwrap_or_default());
    }
    Ok(colors)
}

/// The colours that no label has.
struct Unused {
    colors: Vec<[u8; 3]>,
    /// How many are compared for a label.
    compared: usize,
    /// The first one that is compared next.
    first: usize,
}

impl Unused {
    /// Of few labels, each is compared with all colours. For many labels, there are twice as many colours in
    /// random order, and each label is compared with the next ones: the time is linear.
    fn for_labels(count: usize) -> Self {
        if count <= FEW {
            let colors = candidates(count + SPARE);
            return Self { compared: colors.len(), colors, first: 0 };
        }
        let in_order = candidates(2 * count);
        let mut places: Vec<u32> = (0..in_order.len() as u32).collect();
        places.sort_by_cached_key(|&place| turn_of(u64::from(place)).to_bits());
        let colors: Vec<_> = places.into_iter().map(|place| in_order[place as usize]).collect();
        Self { compared: COMPARED + MORE_COMPARED / colors.len(), colors, first: 0 }
    }

    /// Removes the colour that is farthest from the nearest of `near`, and of several with this distance the
    /// one that is farthest from the nearest of `recent`; none if no colour is left.
    fn take_farthest(
        &mut self,
        near: &[[u8; 3]],
        recent: &[[u8; 3]],
        distance: &impl Fn([u8; 3], [u8; 3]) -> u64,
    ) -> Option<[u8; 3]> {
        let count = self.colors.len();
        // Once all are compared, in the order of the list.
        let first = if self.compared < count { self.first % count } else { 0 };
        let mut best: Option<(u64, u64, usize)> = None;
        for place in (first..count).chain(0..first).take(self.compared) {
            let color = self.colors[place];
            let (of_near, of_recent) = best.map_or((0, 0), |(near, recent, _)| (near, recent));
            let to_near = least(color, near, of_near, distance);
            if to_near < of_near {
                continue;
            }
            let to_recent = least(color, recent, if to_near > of_near { 0 } else { of_recent }, distance);
            if best.is_none() || (to_near, to_recent) > (of_near, of_recent) {
                best = Some((to_near, to_recent, place));
            }
        }
        self.first = first + self.compared;
        best.map(|(_, _, place)| self.colors.swap_remove(place))
    }
}

/// The least distance to others; where it is below `limit`, any distance below `limit`.
fn least(color: [u8; 3], others: &[[u8; 3]], limit: u64, distance: &impl Fn([u8; 3], [u8; 3]) -> u64) -> u64 {
    let mut least = u64::MAX;
    for &other in others {
        least = least.min(distance(color, other));
        if least < limit {
            break;
        }
    }
    least
}

/// At least `count` colours, as far as 8 bits have them: a grid over red, green and blue without its darkest
/// corner, where the rest suffices. The background is black.
fn candidates(count: usize) -> Vec<[u8; 3]> {
    let levels = (2..=256usize).find(|levels| levels.pow(3) * 3 / 4 >= count).unwrap_or(256);
    let code = |level: usize| (level * 255 / (levels - 1)) as u8;
    let grid =
        (0..levels.pow(3)).map(|at| [at, at / levels, at / levels / levels].map(|at| code(at % levels)));
    let is_bright = |color: &[u8; 3]| color.iter().any(|&code| code > 80);
    let mut colors: Vec<_> = grid.clone().filter(is_bright).collect();
    if colors.len() < count {
        colors.extend(grid.filter(|color| !is_bright(color)));
    }
    colors
}

/// The square of a distance that follows the eye's (T. Riemersma, "Colour metric", 2019), times 256.
fn distance(a: [u8; 3], b: [u8; 3]) -> u64 {
    let red = (u64::from(a[0]) + u64::from(b[0])) / 2;
    let [r, g, c] = [0, 1, 2].map(|i| u64::from(a[i].abs_diff(b[i])).pow(2));
    (512 + red) * r + 1024 * g + (767 - red) * c
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::collections::HashSet;

    use darboux_dice::Dice;

    use super::*;

    type Color = [u8; 3];

    /// Every unused colour compared with all neighbours and all recent colours.
    fn choose_slowly(count: usize, adjacency: &[(u32, u32)]) -> Vec<Color> {
        let mut unused = candidates(count + SPARE);
        let mut colors: Vec<Color> = Vec::new();
        for label in 0..count {
            let near: Vec<Color> = adjacency
                .iter()
                .filter(|pair| pair.0 as usize == label)
                .map(|pair| colors[pair.1 as usize])
                .collect();
            let recent = &colors[label.saturating_sub(SPARE)..];
            let least = |color: Color, others: &[Color]| {
                others.iter().map(|&other| distance(color, other)).min().unwrap_or(u64::MAX)
            };
            let key = |at: usize| (least(unused[at], &near), least(unused[at], recent), usize::MAX - at);
            let best = (0..unused.len()).max_by_key(|&at| key(at)).expect("there are spare colours");
            colors.push(unused.swap_remove(best));
        }
        colors
    }

    /// Pairs of labels, of which each meets at most `most` earlier ones.
    fn random_adjacency(count: usize, most: usize, dice: &mut Dice) -> Vec<(u32, u32)> {
        let mut pairs = HashSet::new();
        for label in 1..count {
            for _ in 0..dice.below(most + 1) {
                pairs.insert((label as u32, dice.below(label) as u32));
            }
        }
        let mut pairs: Vec<_> = pairs.into_iter().collect();
        pairs.sort_unstable();
        pairs
    }

    /// Labels in rows of `side`, each of which meets those before, above, and above to both sides.
    fn rows(side: u32) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        for label in 0..side * side {
            let (row, column) = (label / side, label % side);
            if row > 0 {
                pairs.extend((column > 0).then(|| (label, label - side - 1)));
                pairs.push((label, label - side));
                pairs.extend((column + 1 < side).then(|| (label, label - side + 1)));
            }
            pairs.extend((column > 0).then(|| (label, label - 1)));
        }
        pairs
    }

    #[test]
    fn few_labels_get_the_best_colours_of_all() {
        let mut dice = Dice::from_seed(34);
        for (count, most) in [(1, 0), (2, 1), (30, 0), (30, 4), (300, 0), (300, 12), (FEW, 3)] {
            let adjacency = random_adjacency(count, most, &mut dice);
            let colors = choose(count, &adjacency, distance, &Context::new()).expect("not cancelled");
            assert_eq!(colors, choose_slowly(count, &adjacency), "{count} {most}");
        }
    }

    #[test]
    fn colours_differ_and_those_of_neighbours_are_far_apart() {
        for side in [17, 31, 32, 200] {
            let adjacency = rows(side);
            let count = (side * side) as usize;
            let colors = choose(count, &adjacency, distance, &Context::new()).expect("not cancelled");
            assert_eq!(colors.iter().collect::<HashSet<_>>().len(), count);
            let apart = |&(a, b): &(u32, u32)| distance(colors[a as usize], colors[b as usize]);
            let least = adjacency.iter().map(apart).min().expect("labels meet");
            // Black and white are 764 apart.
            assert!(least > 256 * 180 * 180, "{side} {}", (least as f64 / 256.0).sqrt());
        }
    }

    /// The comparisons are counted: of each label with at most so many colours, for each with at most its
    /// neighbours and the recent colours.
    #[test]
    fn the_time_is_linear_in_the_labels() {
        let comparisons = |side: u32| {
            let count = Cell::new(0u64);
            let counted = |a, b| {
                count.set(count.get() + 1);
                distance(a, b)
            };
            let labels = (side * side) as usize;
            choose(labels, &rows(side), counted, &Context::new()).expect("not cancelled");
            count.get() as usize / labels
        };
        for side in [32, 100, 200] {
            let (labels, found) = ((side * side) as usize, comparisons(side));
            assert!(found < (COMPARED + MORE_COMPARED / (2 * labels)) * (4 + SPARE), "{side}: {found}");
        }
        let [of_10_000, of_90_000] = [comparisons(100), comparisons(300)];
        assert!(of_90_000 <= of_10_000, "{of_10_000} {of_90_000}");
    }

    #[test]
    fn there_are_colours_for_every_number_of_labels() {
        for count in [1, 30, 1000, 100_000, 1 << 24] {
            assert!(candidates(count).len() >= count, "{count}");
        }
    }
}

//! Colours for labels: labels that meet in the image get colours that are far from each other.

use std::collections::{BTreeMap, BTreeSet};

use crate::MapKind;
use crate::images::{Images, TexelState};

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

/// Colours among which the next one is chosen, besides one per label.
const SPARE: usize = 24;

/// The most colours that are compared for a label.
const MOST_COMPARED: usize = 4096;

/// Replaces the labels in the first channel of a map, each plus 1, by colours from 0 to 1. Returns the
/// colours, in the order of the labels.
///
/// Labels get their colours one after the other: the unused colour that is farthest from the colours of
/// neighbouring labels, and then from all others.
pub fn color_labels(images: &mut Images, kind: MapKind) -> Vec<IdColor> {
    let size = images.size.map(|side| side as usize);
    let is_low = kind.is_of_low_surface();
    let has_label = |state: TexelState| state.has_content() || is_low && state.is_missed();
    let states = &images.states;
    let Some(numbers) = images.numbers(kind) else { return Vec::new() };
    let label = |texel: usize| numbers[3 * texel] as u32 - 1;
    let mut texels_of_label = BTreeMap::new();
    for texel in (0..states.len()).filter(|&texel| has_label(states[texel])) {
        *texels_of_label.entry(label(texel)).or_insert(0u64) += 1;
    }
    let neighbors = neighbors(size, |texel| has_label(states[texel]).then(|| label(texel)));
    let colors = choose(&texels_of_label.keys().copied().collect::<Vec<_>>(), &neighbors);
    for texel in images.numbers_mut(kind).unwrap_or_default().as_chunks_mut::<3>().0 {
        // Where no padding reaches, the background is 0.
        let color = (texel[0] as u32).checked_sub(1).and_then(|label| colors.get(&label));
        *texel = color.map_or([0.0; 3], |color| color.map(|code| f32::from(code) / 255.0));
    }
    let entry = |(id, texels)| IdColor { id, color: colors[&id], texels };
    texels_of_label.into_iter().map(entry).collect()
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

/// The labels that meet, at sides of texels.
fn neighbors(
    [width, height]: [usize; 2],
    label: impl Fn(usize) -> Option<u32>,
) -> BTreeMap<u32, BTreeSet<u32>> {
    let mut neighbors: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for texel in 0..width * height {
        let right = (texel % width + 1 < width).then_some(texel + 1);
        let below = (texel / width + 1 < height).then_some(texel + width);
        for other in [right, below].into_iter().flatten() {
            if let (Some(a), Some(b)) = (label(texel), label(other))
                && a != b
            {
                neighbors.entry(a).or_default().insert(b);
                neighbors.entry(b).or_default().insert(a);
            }
        }
    }
    neighbors
}

fn choose(labels: &[u32], neighbors: &BTreeMap<u32, BTreeSet<u32>>) -> BTreeMap<u32, [u8; 3]> {
    let mut unused = candidates(labels.len() + SPARE);
    let mut colors: BTreeMap<u32, [u8; 3]> = BTreeMap::new();
    for &label in labels {
        let near: Vec<[u8; 3]> = neighbors
            .get(&label)
            .into_iter()
            .flatten()
            .filter_map(|other| colors.get(other))
            .copied()
            .collect();
        // Of recent colours too, so that parts of a model look different from each other.
        let recent: Vec<[u8; 3]> = colors.values().rev().take(SPARE).copied().collect();
        let least = |color: [u8; 3], others: &[[u8; 3]]| {
            others.iter().map(|&other| distance(color, other)).min().unwrap_or(u64::MAX)
        };
        let best = (0..unused.len().min(MOST_COMPARED))
            .max_by_key(|&at| (least(unused[at], &near), least(unused[at], &recent), usize::MAX - at));
        if let Some(best) = best {
            colors.insert(label, unused.swap_remove(best));
        }
    }
    colors
}

/// At least `count` colours: a grid over red, green and blue without its darkest corner. The background is
/// black.
fn candidates(count: usize) -> Vec<[u8; 3]> {
    let levels = (2..=256usize).find(|levels| levels.pow(3) * 3 / 4 >= count).unwrap_or(256);
    let code = |level: usize| (level * 255 / (levels - 1)) as u8;
    let grid =
        (0..levels.pow(3)).map(|at| [at, at / levels, at / levels / levels].map(|at| code(at % levels)));
    grid.filter(|color| color.iter().any(|&code| code > 80)).collect()
}

/// The square of a distance that follows the eye's (T. Riemersma, "Colour metric", 2019), times 256.
fn distance(a: [u8; 3], b: [u8; 3]) -> u64 {
    let red = (u64::from(a[0]) + u64::from(b[0])) / 2;
    let [r, g, c] = [0, 1, 2].map(|i| u64::from(a[i].abs_diff(b[i])).pow(2));
    (512 + red) * r + 1024 * g + (767 - red) * c
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_differ_and_those_of_neighbours_are_far_apart() {
        let labels: Vec<u32> = (0..300).collect();
        let neighbors: BTreeMap<u32, BTreeSet<u32>> =
            (0..300u32).map(|i| (i, [i.saturating_sub(1), i + 1, (i + 7) % 300].into())).collect();
        let colors = choose(&labels, &neighbors);
        assert_eq!(colors.values().collect::<BTreeSet<_>>().len(), 300);
        for (label, of_label) in &neighbors {
            for other in of_label.iter().filter(|other| *other != label) {
                let Some(color) = colors.get(other) else { continue };
                let apart = distance(colors[label], *color);
                assert!(apart > 256 * 100 * 100, "{label} {other} {apart}");
            }
        }
    }

    #[test]
    fn there_are_colours_for_every_number_of_labels() {
        for count in [1, 30, 1000, 100_000] {
            assert!(candidates(count).len() >= count, "{count}");
        }
    }
}

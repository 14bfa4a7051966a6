//! What each kind of map has at a sample, and how samples become texels: one file per kind.
//!
//! All maps of a run share the rays of their samples. [`MapKind`] has the list of kinds;
//! [`MapList::add_high`] and [`MapList::add_low`] add the numbers of a sample to its texel, and
//! [`MapList::resolve`] makes the texel's content of them.

mod curvature;
mod hemisphere;
mod id;
mod material;
mod normals;
mod thickness;
mod vertex_color;
mod wireframe;
mod world_direction;

pub use hemisphere::turn_of;

use darboux::Conversion;
use hemisphere::Surroundings;

use crate::bvh::Stack;
use crate::common_box::CommonBox;
use crate::found::{Found, LowSample};
use crate::vector::{Vector, narrow, unit};
use crate::{BakeOptions, IdSource, MapKind};

/// The maps of a run, and where their numbers lie.
#[derive(Clone, Debug)]
pub struct MapList {
    /// Each kind, and the place of its first number.
    maps: Vec<(MapKind, usize)>,
    /// The numbers of a sample.
    pub len: usize,
    /// Whether some map needs the rays of [`hemisphere`].
    looks_around: bool,
    /// Whether some map needs the sides of a texel's area.
    pub needs_sides: bool,
}

impl MapList {
    pub fn new(options: &BakeOptions) -> Self {
        let mut len = 0;
        let maps: Vec<_> = options
            .maps
            .kinds()
            .map(|kind| {
                let first = len;
                len += numbers_of(kind);
                (kind, first)
            })
            .collect();
        let has = |kind| options.maps.has(kind);
        Self {
            maps,
            len,
            looks_around: [MapKind::Occlusion, MapKind::BentNormal, MapKind::ObjectBentNormal]
                .into_iter()
                .any(has),
            needs_sides: options.maps.kinds().any(MapKind::is_of_material) || has(MapKind::Curvature),
        }
    }

    /// Adds the numbers of the maps of the high surfaces at a hit to those of its texel.
    pub fn add_high(&self, found: &Found<'_>, stack: &mut Stack, sums: &mut [f64]) {
        let around =
            if self.looks_around { hemisphere::look_around(found, stack) } else { Surroundings::default() };
        for &(kind, first) in &self.maps {
            add_high_map(kind, found, &around, stack, &mut sums[first..]);
        }
    }

    /// Whether some map shows the low surface.
    pub fn has_low(&self) -> bool {
        self.maps.iter().any(|(kind, _)| kind.is_of_low_surface())
    }

    /// Adds the numbers of the maps of the low surface at a sample to those of its texel.
    pub fn add_low(&self, sample: &LowSample<'_>, sums: &mut [f64]) {
        for &(kind, first) in &self.maps {
            let into = &mut sums[first..];
            match kind {
                MapKind::WorldDirection => add(into, world_direction::direction(sample)),
                MapKind::UvIslands => {
                    vote(into, f64::from(sample.charts.of_triangle(&sample.face.triangle)));
                }
                MapKind::Wireframe => add(into, [wireframe::line(sample)]),
                _ => {}
            }
        }
    }

    /// Stores the content of a texel. `share`: 1 over the number of hits; `share_low`: 1 over the number of
    /// samples on the low surface. Without hits or samples the share is none and the background stays.
    pub fn resolve(
        &self,
        sums: &[f64],
        [share, share_low]: [Option<f64>; 2],
        texel: usize,
        images: &mut [&mut [f32]],
        units: &Units,
    ) {
        for (&(kind, first), image) in self.maps.iter().zip(images) {
            let share = if kind.is_of_low_surface() { share_low } else { share };
            let Some(share) = share else { continue };
            let channels = kind.channels();
            let into = &mut image[channels * texel..][..channels];
            let sums = &sums[first..];
            match kind {
                MapKind::Normal | MapKind::BentNormal | MapKind::WorldDirection => {
                    store(into, units.tangent(direction(sums)));
                }
                MapKind::ObjectNormal | MapKind::ObjectBentNormal => {
                    store(into, units.conversion.vector(narrow(direction(sums))));
                }
                MapKind::Position => {
                    let position = [0, 1, 2].map(|i| units.space.restored(share * sums[i]));
                    store(into, units.conversion.vector(narrow(position)));
                }
                MapKind::Height | MapKind::Thickness => {
                    store(into, [units.space.restored(share * sums[0]) as f32]);
                }
                // One more than the label, because the background is 0.
                MapKind::Id | MapKind::UvIslands => store(into, [(sums[0] + 1.0) as f32, 0.0, 0.0]),
                _ => {
                    for (channel, sum) in into.iter_mut().zip(sums) {
                        *channel = (share * sum) as f32;
                    }
                }
            }
        }
    }
}

/// Into what the numbers of texels are converted.
pub struct Units {
    pub conversion: Conversion,
    pub space: CommonBox,
}

impl Units {
    /// A direction in tangent space, with red and green as the map's convention says.
    fn tangent(&self, direction: Vector) -> [f32; 3] {
        let sign = |inverts| if inverts { -1.0 } else { 1.0 };
        let [x, y, z] = narrow(direction);
        [sign(self.conversion.inverts_red()) * x, sign(self.conversion.inverts_green()) * y, z]
    }
}

/// The numbers of a sample of a kind: its channels, or a label and how often it was found.
fn numbers_of(kind: MapKind) -> usize {
    if is_label(kind) { 2 } else { kind.channels() }
}

/// Whether the samples of a texel are labels, which have no mean.
pub fn is_label(kind: MapKind) -> bool {
    matches!(kind, MapKind::Id | MapKind::UvIslands)
}

/// Whether the colours of a kind are chosen for its labels after the bake.
pub fn has_palette(kind: MapKind, options: &BakeOptions) -> bool {
    kind == MapKind::UvIslands || kind == MapKind::Id && options.id_source != IdSource::VertexColor
}

/// Adds the numbers of a map of the high surfaces. It is a function of its own, because in the loop over maps
/// the compiler prepares all of them before the first one, which takes longer than most of them.
#[inline(never)]
fn add_high_map(
    kind: MapKind,
    found: &Found<'_>,
    around: &Surroundings,
    stack: &mut Stack,
    sums: &mut [f64],
) {
    match kind {
        MapKind::Normal => add(sums, normals::tangent(found)),
        MapKind::ObjectNormal => add(sums, found.high.normal),
        MapKind::Height => add(sums, [found.height]),
        MapKind::Occlusion => add(sums, [around.open]),
        MapKind::Position => add(sums, found.position),
        MapKind::BentNormal => add(sums, normals::bent(found, around.bent)),
        MapKind::ObjectBentNormal => add(sums, around.bent),
        MapKind::Thickness => add(sums, [thickness::mean(found, stack)]),
        MapKind::Curvature => add(sums, [curvature::mean(found, stack)]),
        MapKind::Id => vote(sums, id::label(found)),
        MapKind::VertexColor => add(sums, vertex_color::color(found)),
        MapKind::BaseColor => add(sums, material::base_color(found)),
        MapKind::Opacity => add(sums, [material::opacity(found)]),
        MapKind::Roughness => add(sums, [material::roughness_and_metalness(found)[0]]),
        MapKind::Metalness => add(sums, [material::roughness_and_metalness(found)[1]]),
        MapKind::Emission => add(sums, material::emission(found)),
        MapKind::Texture => add(sums, material::texture(found)),
        MapKind::WorldDirection | MapKind::UvIslands | MapKind::Wireframe => {}
    }
}

fn add<const N: usize>(sums: &mut [f64], numbers: [f64; N]) {
    sums[..N].iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number);
}

fn store<const N: usize>(into: &mut [f32], numbers: [f32; N]) {
    into.copy_from_slice(&numbers);
}

/// The direction of a sum of vectors; up where they cancel.
fn direction(sums: &[f64]) -> Vector {
    unit([sums[0], sums[1], sums[2]]).unwrap_or([0.0, 0.0, 1.0])
}

/// A vote for a label: `state` is the leading label and its lead. The most frequent label remains if it has
/// more samples than all others (R. Boyer, J. Moore, "MJRTY", 1991), and else one of the frequent ones.
fn vote(state: &mut [f64], label: f64) {
    if state[1] == 0.0 {
        (state[0], state[1]) = (label, 1.0);
    } else if state[0] == label {
        state[1] += 1.0;
    } else {
        state[1] -= 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_label_of_most_samples_remains() {
        let mut state = [0.0; 2];
        [3.0, 7.0, 7.0, 3.0, 7.0].into_iter().for_each(|label| vote(&mut state, label));
        assert_eq!(state[0], 7.0);
    }
}

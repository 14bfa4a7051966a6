//! The images of a run, while they are filled and when they are done.

use crate::budget::Budget;
use crate::vector::{dot, narrow, scale, sub, unit, wide};
use crate::{BakeError, BakeOptions, MapKind};

/// The cosine of the largest angle between neighbouring texels that is continued into the gutter: 11 degrees.
const SMOOTH: f64 = 0.98;

/// What is in a texel. Arrays of states in Python and JavaScript have the same numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[repr(u8)]
pub enum TexelState {
    /// Outside the charts: the background, or filled from the nearest chart.
    #[default]
    Outside = 0,
    /// Baked.
    Baked = 1,
    /// In the gutter, within a texel of a chart, where filters read it: baked on the surface, which is
    /// continued there.
    Extended = 2,
    /// In a chart, but no ray hit: filled from the nearest texel with a hit.
    Missed = 3,
    /// As `Missed`, and rays hit triangles from behind: the high mesh is inside out there, or has a hole.
    MissedBehind = 4,
}

impl TexelState {
    /// The number of the state, from 0 to 4 in the order of the variants.
    pub fn number(self) -> u8 {
        self as u8
    }

    /// The state of a number; none for other numbers.
    pub fn from_number(number: u8) -> Option<Self> {
        let all = [Self::Outside, Self::Baked, Self::Extended, Self::Missed, Self::MissedBehind];
        all.get(usize::from(number)).copied()
    }

    /// Whether the texel's content comes from rays, not from another texel.
    pub fn has_content(self) -> bool {
        matches!(self, Self::Extended | Self::Baked)
    }

    /// Whether the texel lies in a chart and no ray hit.
    pub fn is_missed(self) -> bool {
        matches!(self, Self::Missed | Self::MissedBehind)
    }
}

/// The images that were chosen, row after row, the top row first.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Images {
    /// Texels per row, and rows.
    pub size: [u32; 2],
    /// What is in each texel.
    pub states: Vec<TexelState>,
    images: Vec<Image>,
}

/// The content of a map.
#[derive(Clone, Debug, PartialEq)]
struct Image {
    kind: MapKind,
    /// [`MapKind::channels`] numbers per texel.
    numbers: Vec<f32>,
}

impl Images {
    /// Images of the background. Errors: the system refuses the memory.
    pub(crate) fn background(options: &BakeOptions, budget: &Budget) -> Result<Self, BakeError> {
        let count = options.size.map(|side| side as usize).iter().product();
        let image = |kind: MapKind| {
            let numbers = repeated(count, &kind.background()[..kind.channels()])?;
            Ok(Image { kind, numbers })
        };
        let images: Result<_, std::collections::TryReserveError> = options.maps.kinds().map(image).collect();
        Ok(Self {
            size: options.size,
            states: repeated(count, &[TexelState::Outside]).map_err(|_| budget.refused())?,
            images: images.map_err(|_| budget.refused())?,
        })
    }

    /// A normal map in tangent space that was baked earlier, for [`verify`](crate::verify()).
    ///
    /// `size`: texels per row, and rows; `states`, `normals`: row after row, the top row first. Errors:
    /// another number of texels.
    pub fn of_normals(
        size: [u32; 2],
        states: Vec<TexelState>,
        normals: &[[f32; 3]],
    ) -> Result<Self, BakeError> {
        let expected = size[0] as usize * size[1] as usize;
        match [states.len(), normals.len()].into_iter().find(|&found| found != expected) {
            Some(found) => Err(BakeError::Texels { expected, found }),
            None => {
                let numbers = normals.as_flattened().to_vec();
                Ok(Self { size, states, images: vec![Image { kind: MapKind::Normal, numbers }] })
            }
        }
    }

    /// The kinds that were chosen, in the order of the list of [`MapKind`].
    pub fn kinds(&self) -> impl Iterator<Item = MapKind> {
        self.images.iter().map(|image| image.kind)
    }

    /// The numbers of a map, [`MapKind::channels`] per texel; none if it was not chosen.
    pub fn numbers(&self, kind: MapKind) -> Option<&[f32]> {
        self.images.iter().find(|image| image.kind == kind).map(|image| &image.numbers[..])
    }

    /// As [`Images::numbers`], to change them.
    pub fn numbers_mut(&mut self, kind: MapKind) -> Option<&mut [f32]> {
        self.images.iter_mut().find(|image| image.kind == kind).map(|image| &mut image.numbers[..])
    }

    /// The texels of a map of three channels; none if it was not chosen or has another number of channels.
    pub fn vectors(&self, kind: MapKind) -> Option<&[[f32; 3]]> {
        let numbers = self.numbers(kind).filter(|_| kind.channels() == 3)?;
        Some(numbers.as_chunks().0)
    }

    /// Removes a map and returns its numbers; none if it was not chosen.
    pub fn take(&mut self, kind: MapKind) -> Option<Vec<f32>> {
        let at = self.images.iter().position(|image| image.kind == kind)?;
        Some(self.images.remove(at).numbers)
    }

    /// The rows of all images, in bands of `height` rows.
    pub(crate) fn bands(&mut self, height: usize) -> Vec<Band<'_>> {
        let texels = self.size[0] as usize * height;
        let band = |(index, states)| Band { row: index * height, states, images: Vec::new() };
        let mut bands: Vec<Band<'_>> = self.states.chunks_mut(texels).enumerate().map(band).collect();
        for Image { kind, numbers } in &mut self.images {
            let parts = numbers.chunks_mut(texels * kind.channels());
            bands.iter_mut().zip(parts).for_each(|(band, part)| band.images.push(part));
        }
        bands
    }

    /// Continues the normals of charts into the texels around them, where they are copies: a filter between a
    /// copy and the chart would flatten what changes across the border. Sharp changes are not continued.
    pub(crate) fn continue_normals(&mut self, source_of_texel: &[u32]) {
        let [width, height] = self.size.map(|side| side as usize);
        let Self { images, states, .. } = self;
        for Image { numbers, .. } in
            images.iter_mut().filter(|image| matches!(image.kind, MapKind::Normal | MapKind::ObjectNormal))
        {
            let image = numbers.as_chunks_mut::<3>().0;
            for (texel, &source) in source_of_texel.iter().enumerate() {
                let source = source as usize;
                if source == texel {
                    continue;
                }
                let place = |texel: usize| [texel % width, texel / width];
                let (to, from) = (place(texel), place(source));
                if to[0].abs_diff(from[0]) > 1 || to[1].abs_diff(from[1]) > 1 {
                    continue;
                }
                let [x, y] = [0, 1].map(|i| (2 * from[i]).checked_sub(to[i]).unwrap_or(usize::MAX));
                if x >= width || y >= height || states[y * width + x] != TexelState::Baked {
                    continue;
                }
                let [near, far] = [image[source], image[y * width + x]].map(wide);
                if let Some(normal) = unit(sub(scale(2.0, near), far)).filter(|_| dot(near, far) > SMOOTH) {
                    image[texel] = narrow(normal);
                }
            }
        }
    }

    /// Copies texels within every image. `source_of_texel`: for each texel the one that it copies, which
    /// copies itself. Maps of the low surface keep what they have in charts.
    pub(crate) fn copy_texels(&mut self, source_of_texel: &[u32]) {
        for Image { kind, numbers } in &mut self.images {
            let channels = kind.channels();
            for (texel, &source) in source_of_texel.iter().enumerate() {
                let keeps = kind.is_of_low_surface() && self.states[texel].is_missed();
                if source as usize != texel && !keeps {
                    let from = channels * source as usize;
                    numbers.copy_within(from..from + channels, channels * texel);
                }
            }
        }
    }
}

/// Consecutive rows of all images.
#[derive(Debug)]
pub(crate) struct Band<'a> {
    /// The first row.
    pub row: usize,
    pub states: &'a mut [TexelState],
    /// In the order of [`Images::kinds`].
    pub images: Vec<&'a mut [f32]>,
}

/// A list of `count` times the same elements, or the system's refusal.
fn repeated<T: Copy>(count: usize, elements: &[T]) -> Result<Vec<T>, std::collections::TryReserveError> {
    let mut list = Vec::new();
    list.try_reserve_exact(count * elements.len())?;
    (0..count).for_each(|_| list.extend_from_slice(elements));
    Ok(list)
}

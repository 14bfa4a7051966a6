//! The images of a run, while they are filled and when they are done.

use crate::budget::Budget;
use crate::vector::{dot, narrow, scale, sub, unit, wide};
use crate::{BakeError, BakeOptions, MapKind};

/// The cosine of the largest angle between neighbouring texels that is continued beyond a chart: 11 degrees.
const SMOOTH: f64 = 0.98;

/// What is in a texel. The numbers are those of arrays of states in Python and JavaScript.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[repr(u8)]
pub enum TexelState {
    /// Outside the charts: the background, or filled from the nearest chart.
    #[default]
    Outside = 0,
    /// Baked.
    Baked = 1,
    /// Within a texel of a chart, where filters read it: baked on the surface, continued beyond the chart.
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

    /// Whether the texel's content comes from rays, not from another texel.
    pub fn has_content(self) -> bool {
        matches!(self, Self::Extended | Self::Baked)
    }

    /// Whether the texel lies in a chart and no ray hit.
    pub fn is_missed(self) -> bool {
        matches!(self, Self::Missed | Self::MissedBehind)
    }
}

/// The images that were chosen, row after row, the top row first; one element per texel.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Images {
    /// Texels per row, and rows.
    pub size: [u32; 2],
    /// Unit normals in tangent space: red and green point as the map's convention says. (0, 0, 1) in the background.
    pub normal: Option<Vec<[f32; 3]>>,
    /// Unit normals along the axes of the map's convention. (0, 0, 0) in the background.
    pub object_normal: Option<Vec<[f32; 3]>>,
    /// Distances in units of the positions, positive outside. 0 in the background.
    pub height: Option<Vec<f32>>,
    /// From 0, closed, to 1, open. 1 in the background.
    pub occlusion: Option<Vec<f32>>,
    /// Positions along the axes of the map's convention. (0, 0, 0) in the background.
    pub position: Option<Vec<[f32; 3]>>,
    /// What is in each texel.
    pub states: Vec<TexelState>,
}

impl Images {
    /// Images of the background. Errors: the system refuses the memory.
    pub(crate) fn background(options: &BakeOptions, budget: &Budget) -> Result<Self, BakeError> {
        let count = options.size.map(|side| side as usize).iter().product();
        let vectors = |kind, background| {
            let filled = options.maps.has(kind).then(|| filled(count, background));
            filled.transpose().map_err(|_| budget.refused())
        };
        let numbers = |kind, background| {
            let filled = options.maps.has(kind).then(|| filled(count, background));
            filled.transpose().map_err(|_| budget.refused())
        };
        Ok(Self {
            size: options.size,
            normal: vectors(MapKind::Normal, [0.0, 0.0, 1.0])?,
            object_normal: vectors(MapKind::ObjectNormal, [0.0; 3])?,
            height: numbers(MapKind::Height, 0.0)?,
            occlusion: numbers(MapKind::Occlusion, 1.0)?,
            position: vectors(MapKind::Position, [0.0; 3])?,
            states: filled(count, TexelState::Outside).map_err(|_| budget.refused())?,
        })
    }

    /// The rows of all images, in bands of `height` rows.
    pub(crate) fn bands(&mut self, height: usize) -> Vec<Band<'_>> {
        let width = self.size[0] as usize;
        let texels = width * height;
        let mut bands: Vec<Band<'_>> = self
            .states
            .chunks_mut(texels)
            .enumerate()
            .map(|(index, states)| Band {
                row: index * height,
                states,
                normal: None,
                object_normal: None,
                height: None,
                occlusion: None,
                position: None,
            })
            .collect();
        deal(&mut bands, &mut self.normal, texels, |band| &mut band.normal);
        deal(&mut bands, &mut self.object_normal, texels, |band| &mut band.object_normal);
        deal(&mut bands, &mut self.height, texels, |band| &mut band.height);
        deal(&mut bands, &mut self.occlusion, texels, |band| &mut band.occlusion);
        deal(&mut bands, &mut self.position, texels, |band| &mut band.position);
        bands
    }

    /// Continues the normals of charts into the texels around them, where they are copies: a filter between a copy and the chart would flatten what
    /// changes across the border. Sharp changes are not continued.
    pub(crate) fn continue_normals(&mut self, source_of_texel: &[u32]) {
        let [width, height] = self.size.map(|side| side as usize);
        for image in [&mut self.normal, &mut self.object_normal].into_iter().flatten() {
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
                if x >= width || y >= height || self.states[y * width + x] != TexelState::Baked {
                    continue;
                }
                let [near, far] = [image[source], image[y * width + x]].map(wide);
                if let Some(normal) = unit(sub(scale(2.0, near), far)).filter(|_| dot(near, far) > SMOOTH) {
                    image[texel] = narrow(normal);
                }
            }
        }
    }

    /// Copies texels within every image. `source_of_texel`: for each texel the one that it copies, which copies itself.
    pub(crate) fn copy_texels(&mut self, source_of_texel: &[u32]) {
        fn copy<T: Copy>(image: &mut Option<Vec<T>>, source_of_texel: &[u32]) {
            let Some(image) = image else { return };
            for (texel, &source) in source_of_texel.iter().enumerate() {
                image[texel] = image[source as usize];
            }
        }
        copy(&mut self.normal, source_of_texel);
        copy(&mut self.object_normal, source_of_texel);
        copy(&mut self.height, source_of_texel);
        copy(&mut self.occlusion, source_of_texel);
        copy(&mut self.position, source_of_texel);
    }
}

/// Consecutive rows of all images.
#[derive(Debug)]
pub(crate) struct Band<'a> {
    /// The first row.
    pub row: usize,
    pub states: &'a mut [TexelState],
    pub normal: Option<&'a mut [[f32; 3]]>,
    pub object_normal: Option<&'a mut [[f32; 3]]>,
    pub height: Option<&'a mut [f32]>,
    pub occlusion: Option<&'a mut [f32]>,
    pub position: Option<&'a mut [[f32; 3]]>,
}

/// Gives every band its part of an image.
fn deal<'a, T>(
    bands: &mut [Band<'a>],
    image: &'a mut Option<Vec<T>>,
    texels: usize,
    slot: impl for<'b> Fn(&'b mut Band<'a>) -> &'b mut Option<&'a mut [T]>,
) {
    let Some(image) = image else { return };
    for (band, part) in bands.iter_mut().zip(image.chunks_mut(texels)) {
        *slot(band) = Some(part);
    }
}

/// A list of `count` equal elements, or the system's refusal.
fn filled<T: Clone>(count: usize, element: T) -> Result<Vec<T>, std::collections::TryReserveError> {
    let mut list = Vec::new();
    list.try_reserve_exact(count)?;
    list.resize(count, element);
    Ok(list)
}

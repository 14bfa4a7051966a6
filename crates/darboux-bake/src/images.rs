//! The images of a run, while they are filled and when they are done.

use crate::{BakeError, BakeOptions, MapKind};

/// What is in a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TexelState {
    /// Outside the charts: the background, or filled from the nearest chart.
    #[default]
    Outside,
    /// In a chart, but no ray hit: filled from the nearest texel with a hit.
    Missed,
    /// Baked.
    Baked,
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
    /// Images of the background. `needed`: the bytes of the run, for the error. Errors: the system refuses the memory.
    pub(crate) fn background(options: &BakeOptions, needed: u64) -> Result<Self, BakeError> {
        let count = options.size.map(|side| side as usize).iter().product();
        let vectors = |kind, background| {
            let filled = options.maps.has(kind).then(|| filled(count, background));
            filled.transpose().map_err(|_| BakeError::Memory { needed, limit: None })
        };
        let numbers = |kind, background| {
            let filled = options.maps.has(kind).then(|| filled(count, background));
            filled.transpose().map_err(|_| BakeError::Memory { needed, limit: None })
        };
        Ok(Self {
            size: options.size,
            normal: vectors(MapKind::Normal, [0.0, 0.0, 1.0])?,
            object_normal: vectors(MapKind::ObjectNormal, [0.0; 3])?,
            height: numbers(MapKind::Height, 0.0)?,
            occlusion: numbers(MapKind::Occlusion, 1.0)?,
            position: vectors(MapKind::Position, [0.0; 3])?,
            states: filled(count, TexelState::Outside)
                .map_err(|_| BakeError::Memory { needed, limit: None })?,
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

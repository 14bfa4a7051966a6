//! [`convert_space`]: normal maps from object space to tangent space and back, without rays.

use darboux::internal::jobs;
use darboux::{Context, Convention};
use serde::Serialize;

use crate::budget::Budget;
use crate::coverage::{Coverage, TEXELS};
use crate::face::Face;
use crate::frame::ShadingFrame;
use crate::gutter::Gutter;
use crate::images::TexelState;
use crate::layout::{BLOCK, Layout};
use crate::limits::MAX_SIDE;
use crate::point::SurfacePoint;
use crate::samples::{STEPS, pattern};
use crate::vector::{narrow, unit, wide};
use crate::{BakeError, Bitangent, LowSurface, Udim, padding};

/// The space of a map's normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NormalSpace {
    /// The frames of the low surface.
    Tangent,
    /// The axes of the positions.
    Object,
}

/// Options of [`convert_space`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpaceOptions {
    /// Texels per row, and rows.
    pub size: [u32; 2],
    /// The space of the result; the map is in the other one.
    pub to: NormalSpace,
    /// How a renderer rebuilds the bitangent.
    pub bitangent: Bitangent,
    /// The convention of the surfaces. Default: glTF's.
    pub surface_convention: Convention,
    /// The convention of the map: directions of red and green, or axes. Default: glTF's.
    pub from_convention: Convention,
    /// The convention of the result. Default: glTF's.
    pub to_convention: Convention,
    /// How far texels outside the charts are filled, as in
    /// [`BakeOptions::padding`](crate::BakeOptions::padding).
    pub padding: Option<u32>,
    /// The tile of the UV plane that the map covers. Default: all tiles lie over each other, as a repeated
    /// texture shows them.
    pub udim: Option<Udim>,
    /// The most bytes that a run may take. Default: no limit.
    pub memory_limit: Option<u64>,
}

impl SpaceOptions {
    /// Maps in glTF's convention, filled everywhere. `size`: texels per row, and rows.
    pub fn new(size: [u32; 2], to: NormalSpace) -> Self {
        Self {
            size,
            to,
            bitangent: Bitangent::PerPixel,
            surface_convention: Convention::GLTF,
            from_convention: Convention::GLTF,
            to_convention: Convention::GLTF,
            padding: None,
            udim: None,
            memory_limit: None,
        }
    }

    /// These options with another bitangent.
    #[must_use]
    pub fn with_bitangent(self, bitangent: Bitangent) -> Self {
        Self { bitangent, ..self }
    }

    /// These options with surfaces in another convention.
    #[must_use]
    pub fn with_surface_convention(self, surface_convention: Convention) -> Self {
        Self { surface_convention, ..self }
    }

    /// These options with other conventions of the map and of the result.
    #[must_use]
    pub fn with_conventions(self, from_convention: Convention, to_convention: Convention) -> Self {
        Self { from_convention, to_convention, ..self }
    }

    /// These options with so many texels of padding, or with all.
    #[must_use]
    pub fn with_padding(self, padding: Option<u32>) -> Self {
        Self { padding, ..self }
    }

    /// These options for a tile of the UV plane, or for all.
    #[must_use]
    pub fn with_udim(self, udim: Option<Udim>) -> Self {
        Self { udim, ..self }
    }

    /// These options with a memory limit in bytes, or none.
    #[must_use]
    pub fn with_memory_limit(self, memory_limit: Option<u64>) -> Self {
        Self { memory_limit, ..self }
    }
}

/// The result of [`convert_space`].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ConvertedSpace {
    /// Unit normals, row after row.
    #[serde(skip)]
    pub texels: Vec<[f32; 3]>,
    /// Texels that the charts cover.
    pub charted_texels: u64,
    /// Texels that more than one triangle covers. The first triangle's frame counts.
    pub overlapping_texels: u64,
    /// Texels at which the frame of the low mesh is degenerate, or the map holds no direction.
    pub invalid_texels: u64,
}

/// Converts a normal map from object space to tangent space or back.
///
/// `texels`: row after row, the top row first, as [`darboux::TexelLayout::vector`] decodes them; their
/// lengths do not count. Each texel is converted by the frame at its centre, as a renderer interpolates it;
/// texels within one of a chart by the nearest triangle's, continued; all others are filled from the nearest.
/// A texel without a frame or a direction becomes (0, 0, 1), or the normal of the low surface.
///
/// Errors: another number of texels; a size out of range; no triangles; more memory than the limit; the
/// context's token was cancelled.
pub fn convert_space(
    low: &[LowSurface<'_>],
    texels: &[[f32; 3]],
    options: &SpaceOptions,
    context: &mut Context,
) -> Result<ConvertedSpace, BakeError> {
    let [width, height] = options.size.map(|side| side as usize);
    if options.size.iter().any(|&side| side == 0 || side > MAX_SIDE) {
        return Err(BakeError::Size { size: options.size });
    }
    if width * height != texels.len() {
        return Err(BakeError::Texels { expected: width * height, found: texels.len() });
    }
    if low.iter().all(|surface| surface.triangle_count() == 0) {
        return Err(BakeError::NoLowTriangles);
    }
    let mut budget = Budget::new(options.memory_limit);
    budget.add(texels.len() as u64 * (12 + 1 + padding::BYTES_PER_TEXEL))?;
    let layout = Layout::new(low, options.size, options.surface_convention, options.udim, &mut budget)?;
    let converter = Converter { low, layout: &layout, texels, options };
    let mut converted = vec![[0.0; 3]; texels.len()];
    let mut states = vec![TexelState::Outside; texels.len()];
    let rows = width * BLOCK;
    let parts = converted.chunks_mut(rows).zip(states.chunks_mut(rows)).enumerate();
    let mut bands: Vec<_> =
        parts.map(|(row, (texels, states))| (row, texels, states, ConvertedSpace::default())).collect();
    jobs::for_each(context, &mut bands, |(row, texels, states, counts)| {
        *counts = converter.band(*row, texels, states);
    })?;
    let counts: Vec<ConvertedSpace> = bands.into_iter().map(|(.., counts)| counts).collect();
    let background = if options.to == NormalSpace::Tangent { [0.0, 0.0, 1.0] } else { [0.0; 3] };
    if states.contains(&TexelState::Baked) {
        let sources = padding::sources(&states, width, options.padding, context)?;
        for (texel, &source) in sources.iter().enumerate() {
            let source = source as usize;
            converted[texel] = if states[source].has_content() { converted[source] } else { background };
        }
    } else {
        converted.fill(background);
    }
    let sum = |of: fn(&ConvertedSpace) -> u64| counts.iter().map(of).sum();
    Ok(ConvertedSpace {
        texels: converted,
        charted_texels: sum(|counts| counts.charted_texels),
        overlapping_texels: sum(|counts| counts.overlapping_texels),
        invalid_texels: sum(|counts| counts.invalid_texels),
    })
}

/// What all bands share.
struct Converter<'a> {
    low: &'a [LowSurface<'a>],
    layout: &'a Layout,
    texels: &'a [[f32; 3]],
    options: &'a SpaceOptions,
}

impl Converter<'_> {
    /// Converts a row of blocks; returns its counts.
    fn band(&self, row: usize, out: &mut [[f32; 3]], states: &mut [TexelState]) -> ConvertedSpace {
        let (width, centre) = (self.layout.size[0], pattern(1)[0]);
        let mut counts = ConvertedSpace::default();
        let mut coverage = Coverage::new();
        for column in 0..self.layout.blocks_per_row() {
            coverage.clear();
            for triangle in self.layout.block(column, row) {
                let low = &self.low[triangle.surface as usize];
                coverage.add(*triangle, self.layout.steps_in_block(low, triangle, [column, row]), centre);
            }
            let is_full = coverage.owners.iter().all(Option::is_some);
            let gutter = (!is_full).then(|| Gutter::of_block(self.layout, self.low, [column, row]));
            let mut last: Option<Face> = None;
            for texel in 0..TEXELS {
                let [x, y] = [column * BLOCK + texel % BLOCK, texel / BLOCK];
                let owner = coverage.owners[texel];
                let nearest = || gutter.as_ref().and_then(|gutter| gutter.nearest(texel));
                let Some(triangle) = owner.or_else(nearest).filter(|_| x < width && y * width < out.len())
                else {
                    continue;
                };
                if last.as_ref().is_none_or(|face| face.triangle != triangle) {
                    last = Some(Face::new(self.layout, self.low, triangle));
                }
                let Some(face) = &last else { continue };
                let place = [x, row * BLOCK + y].map(|at| at as f64 + centre[0] as f64 / STEPS as f64);
                let point = match owner {
                    Some(_) => Some(face.point(place)),
                    None => face.continued_point(place).filter(|_| self.options.padding != Some(0)),
                };
                let Some(point) = point else { continue };
                let at = y * width + x;
                let found = self.converted(&point, self.texels[(row * BLOCK + y) * width + x]);
                out[at] = found.unwrap_or_else(|| self.without_direction(&point));
                states[at] = if owner.is_some() { TexelState::Baked } else { TexelState::Extended };
                counts.charted_texels += u64::from(owner.is_some());
                counts.overlapping_texels += u64::from(coverage.overlaps[texel]);
                counts.invalid_texels += u64::from(owner.is_some() && found.is_none());
            }
        }
        counts
    }

    /// The vector of a texel in the other space; `None` where the frame or the vector has no direction.
    fn converted(&self, point: &SurfacePoint, texel: [f32; 3]) -> Option<[f32; 3]> {
        let SpaceOptions { to, bitangent, surface_convention, from_convention, to_convention, .. } =
            *self.options;
        let frame = ShadingFrame::new(point, bitangent);
        let generated = surface_convention.generated();
        Some(match to {
            NormalSpace::Tangent => {
                let normal = unit(wide(from_convention.to(surface_convention).vector(texel)))?;
                turned(generated, to_convention, narrow(frame.to_tangent_space(normal)?))
            }
            NormalSpace::Object => {
                let texel = turned(from_convention, generated, texel);
                let normal = narrow(frame.shade(unit(wide(texel))?)?);
                surface_convention.to(to_convention).vector(normal)
            }
        })
    }

    fn without_direction(&self, point: &SurfacePoint) -> [f32; 3] {
        let SpaceOptions { to, surface_convention, to_convention, .. } = *self.options;
        match to {
            NormalSpace::Tangent => [0.0, 0.0, 1.0],
            NormalSpace::Object => {
                let normal = narrow(unit(point.normal).unwrap_or(point.face_normal));
                surface_convention.to(to_convention).vector(normal)
            }
        }
    }
}

/// A vector in tangent space with red and green of another convention.
fn turned(from: Convention, to: Convention, [x, y, z]: [f32; 3]) -> [f32; 3] {
    let conversion = from.to(to);
    let sign = |inverts| if inverts { -1.0 } else { 1.0 };
    [sign(conversion.inverts_red()) * x, sign(conversion.inverts_green()) * y, z]
}

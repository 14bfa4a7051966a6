//! [`verify`]: shades the low surfaces with a map that was written, as a renderer does, and measures the
//! angle to the high surfaces.
//!
//! ```text
//! points      one per texel and triangle that covers it, of at most 64, at a random place
//! truth       the normal where the point's ray hits the high surfaces
//! shown       the map, filtered, in the frame at the point
//! statistics  the angles between both: of all points, by place, and for renderers with other frames
//! ```

mod errors;
mod places;
mod points;
mod summary;

use darboux::Context;

use crate::bake::for_each_band;
use crate::budget::Budget;
use crate::layout::Layout;
use crate::prepared::check_surfaces;
use crate::{
    BakeError, BakeOptions, BakeProgress, HighSurface, Images, LowSurface, MapKind, NormalTexture,
    PreparedSurfaces, memory,
};
use points::{BYTES_PER_POINT, BandPoints, Points, cell_side};
use summary::summarize;

pub use errors::ErrorStatistics;
pub use places::{Mistake, VerifiedPlace};
pub use summary::Verification;

/// Compares what a renderer shows with the high surfaces, at one random point per texel and triangle, of at
/// most the first 64 at a texel (fewer where the map has more than 2048 rows or columns, or where there would
/// be more than 8,388,608 points: then one texel in each square of several is compared).
///
/// `low`: as the renderer has them; `baked`: the images of [`bake`](crate::bake()) with these options;
/// `written`: the normal map as it is in its file, in the options' conventions. The truth at a point is the
/// normal where its ray hits, also between texels, so that the error of resolution and filter is part of the
/// result. `progress` is called on any thread, after each row of blocks.
///
/// Errors: as of [`bake`](crate::bake()); images without a normal map or of another size.
pub fn verify(
    low: &[LowSurface<'_>],
    high: &[HighSurface<'_>],
    baked: &Images,
    written: &NormalTexture,
    options: &BakeOptions,
    context: &mut Context,
    progress: &mut (dyn FnMut(BakeProgress) + Send),
) -> Result<Verification, BakeError> {
    Plan::new(low, high, options)?;
    PreparedSurfaces::new(low, high, options.memory_limit, context)?
        .verify(baked, written, options, context, progress)
}

impl PreparedSurfaces<'_> {
    /// As [`verify()`].
    pub fn verify(
        &self,
        baked: &Images,
        written: &NormalTexture,
        options: &BakeOptions,
        context: &mut Context,
        progress: &mut (dyn FnMut(BakeProgress) + Send),
    ) -> Result<Verification, BakeError> {
        let PreparedSurfaces { low, high, groups, .. } = self;
        let Plan { layout, cell_side } = Plan::new(low, high, options)?;
        let unrounded = baked.vectors(MapKind::Normal).map(<[_]>::to_vec);
        let unrounded = unrounded.filter(|_| baked.size == options.size && written.size() == options.size);
        let unrounded = unrounded.ok_or(BakeError::NoMaps)?;
        let unrounded =
            NormalTexture::new(options.size, unrounded, options.map_convention, options.surface_convention)?;
        let options = &self.options_in_box(options);
        let points = Points {
            low,
            groups,
            layout: &layout,
            options,
            states: &baked.states,
            written,
            unrounded: &unrounded,
            cell_side,
        };
        let mut bands: Vec<(usize, BandPoints)> =
            (0..points.band_count()).map(|row| (row, BandPoints::default())).collect();
        for_each_band(context, &mut bands, progress, |(row, band)| *band = points.band(*row))?;
        let bands = bands.into_iter().map(|(_, band)| band).collect();
        Ok(summarize(bands, low.len(), points.heat_size()))
    }
}

/// Refuses, before anything is baked, what [`verify`] would refuse after the bake: options out of range, no
/// triangles, more memory than the limit.
pub fn check_verification(
    low: &[LowSurface<'_>],
    high: &[HighSurface<'_>],
    options: &BakeOptions,
) -> Result<(), BakeError> {
    Plan::new(low, high, options).map(|_| ())
}

/// Which points a verification compares.
struct Plan {
    layout: Layout,
    /// Texels per side of a cell, in which one texel is compared.
    cell_side: usize,
}

impl Plan {
    /// Errors: as of [`check_verification`].
    fn new(
        low: &[LowSurface<'_>],
        high: &[HighSurface<'_>],
        options: &BakeOptions,
    ) -> Result<Self, BakeError> {
        options.check()?;
        check_surfaces(low, high)?;
        let mut budget = Budget::new(options.memory_limit);
        budget.add(memory::of_verification(high, options))?;
        let layout = Layout::new(low, options.size, options.surface_convention, options.udim, &mut budget)?;
        let cell_side = cell_side(&layout, low);
        let points = layout.charted_area(low) / (cell_side * cell_side) as f64;
        budget.add(points as u64 * BYTES_PER_POINT)?;
        Ok(Self { layout, cell_side })
    }
}

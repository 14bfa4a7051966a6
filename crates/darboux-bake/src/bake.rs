//! The entry point: runs the stages.

use std::sync::Mutex;

use darboux::Context;
use darboux::internal::jobs;

use crate::band::Bake;
use crate::budget::Budget;
use crate::charts::Charts;
use crate::high::HighGroup;
use crate::images::{Band, Images, TexelState};
use crate::layout::{BLOCK, Layout};
use crate::maps::{MapList, Units, has_palette, is_label};
use crate::prepared::check_surfaces;
use crate::samples::pattern;
use crate::{
    BakeError, BakeOptions, BakeReport, HighSurface, IdColor, LowSurface, MapKind, PreparedSurfaces, memory,
    padding, palette,
};

/// The share of a run that is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BakeProgress {
    /// Rows of blocks that are finished.
    pub done: usize,
    /// All rows of blocks.
    pub total: usize,
}

/// The result of [`bake`].
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Baked {
    /// The images that were chosen.
    pub images: Images,
    /// The counts of the run.
    pub report: BakeReport,
    /// For each map whose colours stand for numbers: the colours.
    pub legends: Vec<(MapKind, Vec<IdColor>)>,
}

/// Bakes the detail of the high surfaces into images over the UVs of the low surfaces.
///
/// From every sample of every texel that a low triangle covers, a ray passes from outside through the low
/// surface; its first hit on a high surface of the same group gives the content. The first triangle, in the
/// order of surfaces and triangles, owns texels that several cover; texels without a hit are filled from
/// around. The images have the same bits for every number of threads. `progress` is called on any
/// thread, after each row of blocks.
///
/// Errors: options out of range; no triangles; more memory than the limit; the context's token was cancelled.
///
/// ```
/// use darboux::{Context, Mesh, TangentOptions, generate_tangents};
/// use darboux_bake::{BakeOptions, HighSurface, LowSurface, MapKind, bake};
///
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
/// let indices = [0u16, 1, 2, 0, 2, 3];
/// let mesh = Mesh::triangles(&positions, &[[0.0, 0.0, 1.0]; 4], &uvs, &indices)?;
/// let tangents = generate_tangents(&mesh, &TangentOptions::default()).corners;
/// let low = LowSurface::new(mesh, tangents.per_corner())?;
///
/// // A roof that rises to the right by one half: its normal leans to the left.
/// let roof = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]];
/// let high = HighSurface::new(&roof, None, &indices)?;
///
/// let options = BakeOptions::new([16, 16], [1.0, 1.0]);
/// let baked = bake(&[low], &[high], &options, &mut Context::new(), &mut |_| {})?;
/// let [x, y, z] = baked.images.vectors(MapKind::Normal).expect("was chosen")[0];
/// assert!((x / z + 0.5).abs() < 1e-6 && y.abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bake(
    low: &[LowSurface<'_>],
    high: &[HighSurface<'_>],
    options: &BakeOptions,
    context: &mut Context,
    progress: &mut (dyn FnMut(BakeProgress) + Send),
) -> Result<Baked, BakeError> {
    options.check()?;
    check_surfaces(low, high)?;
    Budget::new(options.memory_limit).add(memory::of_bake(high, options))?;
    PreparedSurfaces::new(low, high, options.memory_limit, context)?.bake(options, context, progress)
}

impl PreparedSurfaces<'_> {
    /// As [`bake()`].
    pub fn bake(
        &self,
        options: &BakeOptions,
        context: &mut Context,
        progress: &mut (dyn FnMut(BakeProgress) + Send),
    ) -> Result<Baked, BakeError> {
        options.check()?;
        let PreparedSurfaces { space, low, high, groups } = self;
        let mut budget = Budget::new(options.memory_limit);
        budget.add(memory::of_bake(high, options))?;
        let options = &self.options_in_box(options);
        let layout = Layout::new(low, options.size, options.surface_convention, options.udim, &mut budget)?;
        let mut images = Images::background(options, &budget)?;
        let needs_charts = options.maps.has(MapKind::UvIslands);
        let stages = Bake {
            low,
            groups,
            layout: &layout,
            options,
            maps: MapList::new(options),
            charts: if needs_charts { Charts::of(low) } else { Charts::default() },
            units: Units {
                conversion: options.surface_convention.generated().to(options.map_convention),
                space: *space,
            },
            samples: pattern(options.samples_per_axis),
        };
        let mut report = bake_bands(&stages, &mut images, context, progress)?;
        fill(&mut images, options.padding, context)?;
        let legends = color_labels(&mut images, options, context)?;
        count_triangles(&mut report, low, high, &layout, groups);
        Ok(Baked { images, report, legends })
    }
}

/// Bakes all bands of the images, on all threads.
fn bake_bands(
    stages: &Bake<'_>,
    images: &mut Images,
    context: &Context,
    progress: &mut (dyn FnMut(BakeProgress) + Send),
) -> Result<BakeReport, BakeError> {
    let mut bands: Vec<(Band<'_>, BakeReport)> =
        images.bands(BLOCK).into_iter().map(|band| (band, BakeReport::default())).collect();
    for_each_band(context, &mut bands, progress, |(band, report)| *report = stages.band(band))?;
    Ok(bands.into_iter().map(|(_, report)| report).fold(BakeReport::default(), BakeReport::plus))
}

/// Calls a function for every row of blocks, on all threads, and tells the progress after each.
///
/// Errors: the context's token was cancelled.
pub(crate) fn for_each_band<T: Send>(
    context: &Context,
    bands: &mut [T],
    progress: &mut (dyn FnMut(BakeProgress) + Send),
    with: impl Fn(&mut T) + Sync,
) -> Result<(), BakeError> {
    let (total, progress) = (bands.len(), Mutex::new((0, progress)));
    jobs::for_each(context, bands, |band| {
        with(band);
        if let Ok(mut progress) = progress.lock() {
            let (done, tell) = &mut *progress;
            *done += 1;
            tell(BakeProgress { done: *done, total });
        }
    })?;
    Ok(())
}

/// Stage 7: fills texels without a hit.
fn fill(images: &mut Images, padding: Option<u32>, context: &Context) -> Result<(), BakeError> {
    if images.states.contains(&TexelState::Baked) {
        let width = images.size[0] as usize;
        let sources = padding::sources(&images.states, width, padding, context)?;
        images.copy_texels(&sources);
        images.continue_normals(&sources);
    }
    Ok(())
}

/// Gives labels their colours; returns the legends. Errors: the context's token was cancelled.
fn color_labels(
    images: &mut Images,
    options: &BakeOptions,
    context: &Context,
) -> Result<Vec<(MapKind, Vec<IdColor>)>, BakeError> {
    let mut legends = Vec::new();
    for kind in options.maps.kinds().filter(|&kind| is_label(kind)) {
        match has_palette(kind, options) {
            true => legends.push((kind, palette::color_labels(images, kind, context)?)),
            false => palette::unpack_colors(images, kind),
        }
    }
    Ok(legends)
}

fn count_triangles(
    report: &mut BakeReport,
    low: &[LowSurface<'_>],
    high: &[HighSurface<'_>],
    layout: &Layout,
    groups: &[HighGroup<'_>],
) {
    report.low_triangles = low.iter().map(|surface| surface.triangle_count() as u64).sum();
    report.chart_area = layout.charted_area(low).round() as u64;
    report.degenerate_triangles = layout.degenerate as u64;
    report.oversized_triangles = layout.oversized as u64;
    report.non_finite_low_triangles = layout.non_finite as u64;
    report.high_triangles = high.iter().map(|surface| surface.triangle_count() as u64).sum();
    report.non_finite_triangles = groups.iter().map(|group| group.non_finite as u64).sum();
}

//! [`PreparedSurfaces`]: surfaces in their common box, with the hierarchies over the high ones, for several
//! bakes.

use std::sync::Arc;

use darboux::Context;

use crate::budget::Budget;
use crate::common_box::CommonBox;
use crate::high::HighGroup;
use crate::{BakeError, BakeOptions, CurvatureRadius, HighSurface, LowSurface, memory};

/// Low and high surfaces with all that does not depend on the options of a bake: bakes with other options, of
/// other UDIM tiles or with another cage skip what costs most of the time before the first ray.
pub struct PreparedSurfaces<'a> {
    pub(crate) space: CommonBox,
    /// In the box.
    pub(crate) low: Vec<LowSurface<'a>>,
    /// In the box.
    pub(crate) high: Arc<[HighSurface<'a>]>,
    /// The high surfaces by group, for every group of the low surfaces.
    pub(crate) groups: Arc<[HighGroup<'a>]>,
}

impl<'a> PreparedSurfaces<'a> {
    /// Builds the hierarchies. `memory_limit`: the most bytes that they may take.
    ///
    /// Errors: no triangles; more memory than the limit; the context's token was cancelled.
    pub fn new(
        low: &[LowSurface<'a>],
        high: &[HighSurface<'a>],
        memory_limit: Option<u64>,
        context: &Context,
    ) -> Result<Self, BakeError> {
        check_surfaces(low, high)?;
        Budget::new(memory_limit).add(memory::of_hierarchies(high))?;
        let space = box_around(low);
        let high: Arc<[_]> = high.iter().map(|surface| surface.in_space(space)).collect();
        let low: Vec<_> = low.iter().map(|surface| surface.in_space(space)).collect();
        let groups = (0..group_count(&low))
            .map(|group| HighGroup::new(&high, group, context))
            .collect::<Result<_, _>>()?;
        Ok(Self { space, low, high, groups })
    }

    /// These surfaces with other low ones, such as the same with another cage. The hierarchies are shared
    /// where the new surfaces lie in the same box and groups, and are built anew otherwise. Errors: as of
    /// [`PreparedSurfaces::new`].
    pub fn with_low<'b>(
        &self,
        low: &[LowSurface<'b>],
        context: &Context,
    ) -> Result<PreparedSurfaces<'b>, BakeError>
    where
        'a: 'b,
    {
        let is_same = box_around(low) == self.space && group_count(low) == self.groups.len();
        if !is_same {
            return PreparedSurfaces::new(low, &self.high, None, context);
        }
        check_surfaces(low, &self.high)?;
        let low = low.iter().map(|surface| surface.in_space(self.space)).collect();
        Ok(PreparedSurfaces { space: self.space, low, high: self.high.clone(), groups: self.groups.clone() })
    }

    /// The low surfaces.
    pub fn low(&self) -> &[LowSurface<'a>] {
        &self.low
    }

    /// The options with their distances in the box.
    pub(crate) fn options_in_box(&self, options: &BakeOptions) -> BakeOptions {
        let space = self.space;
        BakeOptions {
            distance: options.distance.map(|distance| space.distance(distance)),
            occlusion_distance: space.distance(options.occlusion_distance),
            thickness_distance: space.distance(options.thickness_distance),
            curvature_radius: match options.curvature_radius {
                CurvatureRadius::Distance(radius) => CurvatureRadius::Distance(space.distance(radius)),
                texels => texels,
            },
            ..*options
        }
    }
}

/// The box around the places that the low triangles use.
fn box_around(low: &[LowSurface<'_>]) -> CommonBox {
    let used = low.iter().flat_map(|surface| {
        let vertex = |corner| surface.mesh.positions().get(surface.mesh.vertex_of_corner(corner));
        (0..surface.mesh.corner_count()).map(vertex)
    });
    CommonBox::around(used)
}

/// The number of groups that the low surfaces use.
fn group_count(low: &[LowSurface<'_>]) -> usize {
    low.iter().map(|surface| surface.group + 1).max().unwrap_or(0)
}

/// Refuses surfaces without triangles.
pub(crate) fn check_surfaces(low: &[LowSurface<'_>], high: &[HighSurface<'_>]) -> Result<(), BakeError> {
    if low.iter().all(|surface| surface.triangle_count() == 0) {
        return Err(BakeError::NoLowTriangles);
    }
    if high.iter().all(|surface| surface.triangle_count() == 0) {
        return Err(BakeError::NoHighTriangles);
    }
    Ok(())
}

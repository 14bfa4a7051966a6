//! [`BakeReport`]: what happened to texels, rays and triangles.

use serde::Serialize;

/// The counts of a run. A texel counts where at least one of its samples does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct BakeReport {
    /// The texels of the image.
    pub texels: u64,
    /// Texels that the charts cover.
    pub charted_texels: u64,
    /// Charted texels without any hit. They are filled from around.
    pub missed_texels: u64,
    /// Missed texels whose rays hit triangles from behind: the high mesh is inside out there, or has a hole.
    pub back_facing_texels: u64,
    /// Texels that more than one triangle covers. The first triangle owns them.
    pub overlapping_texels: u64,
    /// The area of all charts in texels: the number of pairs of a texel and a triangle that covers it, on
    /// average over the places of texels. Greater than `charted_texels` where charts overlap or repeat.
    pub chart_area: u64,
    /// Texels at which the normal of the high mesh points to the back of its triangle: normals or winding
    /// are inverted there.
    pub inverted_texels: u64,
    /// Texels at which tangent, bitangent and normal of the low mesh do not span space. Their normal is (0,
    /// 0, 1).
    pub frameless_texels: u64,
    /// Texels whose normal points below the low surface (z < 0), which maps of two channels cannot hold.
    pub below_horizon_texels: u64,
    /// Rays of samples.
    pub rays: u64,
    /// Triangles of the low surfaces.
    pub low_triangles: u64,
    /// Triangles of the low surfaces without an area in the image, or with UVs that are not finite. They are
    /// not baked.
    pub degenerate_triangles: u64,
    /// Triangles of the low surfaces across more than 16 tiles of UVs. They are not baked.
    pub oversized_triangles: u64,
    /// Triangles of the low surfaces with positions or normals that are not finite. They are not baked.
    pub non_finite_low_triangles: u64,
    /// Triangles of the high surfaces.
    pub high_triangles: u64,
    /// Triangles of the high surfaces with positions that are not finite. No ray hits them.
    pub non_finite_triangles: u64,
}

impl BakeReport {
    /// The counts of several tiles of the same surfaces: the sums over texels and rays. Triangles that have
    /// an area in one of the tiles are not degenerate.
    #[must_use]
    pub fn with_tile(self, tile: &Self) -> Self {
        if self.texels == 0 {
            return *tile;
        }
        let degenerate_triangles = self.degenerate_triangles.min(tile.degenerate_triangles);
        Self {
            degenerate_triangles,
            low_triangles: tile.low_triangles,
            oversized_triangles: tile.oversized_triangles,
            non_finite_low_triangles: tile.non_finite_low_triangles,
            high_triangles: tile.high_triangles,
            non_finite_triangles: tile.non_finite_triangles,
            ..self.plus(*tile)
        }
    }

    /// A warning where the rays of more than a hundredth of the texels hit nothing. `misfit`: as of
    /// [`Models::misfit`](crate::Models::misfit).
    pub fn warning_of_misses(&self, misfit: Option<&str>) -> Option<String> {
        let share = self.missed_texels as f64 / self.charted_texels.max(1) as f64;
        let cause =
            misfit.unwrap_or("begin rays farther outside, and check that the models lie on each other");
        (share > 0.01)
            .then(|| format!("the rays of {:.1} % of the texels hit nothing: {cause}", 100.0 * share))
    }

    /// The sums of both.
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            texels: self.texels + other.texels,
            charted_texels: self.charted_texels + other.charted_texels,
            missed_texels: self.missed_texels + other.missed_texels,
            back_facing_texels: self.back_facing_texels + other.back_facing_texels,
            overlapping_texels: self.overlapping_texels + other.overlapping_texels,
            chart_area: self.chart_area + other.chart_area,
            inverted_texels: self.inverted_texels + other.inverted_texels,
            frameless_texels: self.frameless_texels + other.frameless_texels,
            below_horizon_texels: self.below_horizon_texels + other.below_horizon_texels,
            rays: self.rays + other.rays,
            low_triangles: self.low_triangles + other.low_triangles,
            degenerate_triangles: self.degenerate_triangles + other.degenerate_triangles,
            oversized_triangles: self.oversized_triangles + other.oversized_triangles,
            non_finite_low_triangles: self.non_finite_low_triangles + other.non_finite_low_triangles,
            high_triangles: self.high_triangles + other.high_triangles,
            non_finite_triangles: self.non_finite_triangles + other.non_finite_triangles,
        }
    }
}

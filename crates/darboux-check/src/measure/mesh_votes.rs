//! [`MeshVotes`]: what the meshes that use a map say about it.

use darboux_io::image::RgbaImage;

use crate::measure::arrangement::Arrangement;
use crate::measure::facet::MapUse;
use crate::measure::facets::FacetVotes;
use crate::measure::padding::Padding;
use crate::measure::seams::SeamFits;

/// The votes of the facets, and how the map fits the seams.
#[derive(Clone, Copy, Debug)]
pub struct MeshVotes {
    facets: FacetVotes,
    /// None where the meshes have too few seams, or the map hardly leans there.
    pub seams: Option<SeamFits>,
    /// Where borders of charts are lit wrongly in smaller mip levels.
    pub padding: Option<Padding>,
}

impl MeshVotes {
    /// The votes of all surfaces that use a map.
    pub fn of(uses: &[MapUse<'_>], image: &RgbaImage) -> Self {
        Self {
            facets: FacetVotes::of(uses, image),
            seams: SeamFits::of(uses, image),
            padding: Padding::of(uses, image),
        }
    }

    /// True where the first of the two possibilities of an arrangement is decided, false for the second one;
    /// none without a decision. Nothing is decided where the seams show that the map was made for another
    /// layout.
    pub fn decide(&self, arrangement: Arrangement) -> Option<bool> {
        self.facets.decide(arrangement).filter(|_| !self.is_of_other_layout())
    }

    /// The z score of an arrangement.
    pub fn z_score(&self, arrangement: Arrangement) -> f64 {
        if self.is_of_other_layout() { 0.0 } else { self.facets.z_score(arrangement) }
    }

    /// The number of triangles that voted.
    pub fn count(&self) -> usize {
        self.facets.count()
    }

    fn is_of_other_layout(&self) -> bool {
        self.seams.is_some_and(|seams| seams.other_layout.is_some())
    }

    /// Votes with this z score of one arrangement, and none of the others.
    #[cfg(test)]
    pub fn only(arrangement: Arrangement, z_score: f64) -> Self {
        Self { facets: FacetVotes::only(arrangement, z_score), seams: None, padding: None }
    }
}

//! [`RayOrigin`]: where rays begin, and the cages that follow from it.

use darboux::Context;

use crate::{
    AutoCageOptions, BakeError, BakeOptions, LowSurface, PreparedSurfaces, auto_cage, default_cage_offset,
    default_cage_reach, inflated_cage,
};

/// Where the rays of a bake begin. In units of the positions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RayOrigin {
    /// Along the normals: so far outside, to so far inside.
    Normals([f32; 2]),
    /// On a copy of each low surface that is inflated by this distance; they end as far inside. Without a
    /// distance, it is [`default_cage_offset`].
    InflatedCage(Option<f32>),
    /// On the cages of [`auto_cage`].
    AutoCage {
        /// As [`AutoCageOptions::share`].
        share: f32,
        /// As [`AutoCageOptions::reach`]. Without it, it is [`default_cage_reach`].
        reach: Option<f32>,
    },
}

/// The cages that follow from a [`RayOrigin`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cages {
    /// For each low surface, one position per vertex; empty where rays follow normals.
    pub positions: Vec<Vec<[f32; 3]>>,
    /// How far outside rays begin where they follow normals or inflated copies, and how far inside they end.
    pub distance: [f32; 2],
}

impl RayOrigin {
    /// [`Cages::distance`] as far as it is known before the cages are.
    ///
    /// `diagonal`: of the box around the low surfaces.
    pub fn distance(self, diagonal: f64) -> [f32; 2] {
        match self {
            Self::Normals(distance) => distance,
            Self::InflatedCage(offset) => [offset.unwrap_or(default_cage_offset(diagonal)); 2],
            Self::AutoCage { reach, .. } => [0.0, reach.unwrap_or(default_cage_reach(diagonal))],
        }
    }

    /// Refuses distances and shares out of range, before models are read.
    ///
    /// # Errors
    ///
    /// As of [`BakeOptions::check`] and [`AutoCageOptions::check`].
    pub fn check(self) -> Result<(), BakeError> {
        // Any diagonal gives a valid distance where none was chosen.
        let distance = self.distance(1.0);
        match self {
            Self::AutoCage { share, .. } => AutoCageOptions::new(share, distance[1]).check(),
            Self::Normals(_) | Self::InflatedCage(_) => BakeOptions::new([1; 2], distance).check(),
        }
    }

    /// Makes the cages. `low`: the low surfaces of `prepared`. Errors: as of [`auto_cage`].
    pub fn cages(
        self,
        diagonal: f64,
        low: &[LowSurface<'_>],
        prepared: &PreparedSurfaces<'_>,
        context: &mut Context,
    ) -> Result<Cages, BakeError> {
        let distance = self.distance(diagonal);
        match self {
            Self::Normals(_) => Ok(Cages { positions: Vec::new(), distance }),
            Self::InflatedCage(_) => {
                let positions = low.iter().map(|surface| inflated_cage(surface.mesh(), distance[0]));
                Ok(Cages { positions: positions.collect::<Result<_, _>>()?, distance })
            }
            Self::AutoCage { share, .. } => {
                let made = auto_cage(prepared, &AutoCageOptions::new(share, distance[1]), context)?;
                Ok(Cages { positions: made.positions, distance: [0.0, made.inwards] })
            }
        }
    }
}

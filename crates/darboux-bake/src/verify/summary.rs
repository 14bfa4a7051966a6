//! [`Verification`]: the statistics over all points.

use serde::Serialize;

use super::errors::ErrorStatistics;
use super::places::{Mistake, VerifiedPlace};
use super::points::BandPoints;

/// The angles between what a renderer shows and the normals of the high surfaces, in degrees.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Verification {
    /// Of all points.
    pub all: ErrorStatistics,
    /// Between the map as it was written and the map before its components were rounded, at all points.
    pub rounding: ErrorStatistics,
    /// By what the filter reads at a point.
    pub places: Vec<(VerifiedPlace, ErrorStatistics)>,
    /// Of each low surface, in their order.
    #[serde(skip)]
    pub surfaces: Vec<ErrorStatistics>,
    /// The errors that renderers would show whose frames differ from the bake's.
    pub mistakes: Vec<(Mistake, ErrorStatistics)>,
    /// Points whose ray hits nothing, so that there is nothing to compare with.
    pub points_without_hit: u64,
    /// Points at which the low surface has no frame.
    pub points_without_frame: u64,
    /// The width and height of `heat`.
    pub heat_size: [u32; 2],
    /// The largest error around each texel, row after row; NaN where no point lies. Texels are merged where
    /// one of several is compared.
    #[serde(skip)]
    pub heat: Vec<f32>,
}

/// Merges the points of all bands. `surfaces`: the number of low surfaces.
pub fn summarize(bands: Vec<BandPoints>, surfaces: usize, heat_size: [u32; 2]) -> Verification {
    let points = || bands.iter().flat_map(|band| &band.points);
    let place = |place: VerifiedPlace| {
        let angles = points().filter(|point| point.place == place).map(|point| point.shown).collect();
        (place, ErrorStatistics::of(angles))
    };
    let mistake = |(index, mistake): (usize, Mistake)| {
        (mistake, ErrorStatistics::of(points().map(|point| point.mistakes[index]).collect()))
    };
    Verification {
        all: ErrorStatistics::of(points().map(|point| point.shown).collect()),
        rounding: ErrorStatistics::of(points().map(|point| point.rounding).collect()),
        places: VerifiedPlace::ALL.into_iter().map(place).collect(),
        surfaces: by_surface(&bands, surfaces),
        mistakes: Mistake::ALL.into_iter().enumerate().map(mistake).collect(),
        points_without_hit: bands.iter().map(|band| band.without_hit).sum(),
        points_without_frame: bands.iter().map(|band| band.without_frame).sum(),
        heat_size,
        heat: heat(&bands, heat_size),
    }
}

fn by_surface(bands: &[BandPoints], surfaces: usize) -> Vec<ErrorStatistics> {
    let mut angles = vec![Vec::new(); surfaces];
    for point in bands.iter().flat_map(|band| &band.points) {
        angles[point.surface as usize].push(point.shown);
    }
    angles.into_iter().map(ErrorStatistics::of).collect()
}

/// The largest error of each cell.
fn heat(bands: &[BandPoints], [width, height]: [u32; 2]) -> Vec<f32> {
    let mut heat = vec![f32::NAN; width as usize * height as usize];
    for point in bands.iter().flat_map(|band| &band.points) {
        let cell = &mut heat[point.cell as usize];
        *cell = cell.max(point.shown);
    }
    heat
}

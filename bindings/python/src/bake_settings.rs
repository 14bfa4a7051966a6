//! The options that bakes of meshes and of models share.

use darboux_bake::{BakeOptions, CurvatureRadius, MapSet, Udim};
use darboux_io::memory_of_process;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::choices::{choice, named_choice};
use crate::convention::convention;
use crate::numbers::Natural;

/// Makes a radius of a number in some unit.
type RadiusOf = fn(f32) -> CurvatureRadius;

const UNITS: &[(&str, RadiusOf)] =
    &[("texels", CurvatureRadius::Texels), ("distance", CurvatureRadius::Distance)];

/// What callers pass by name. The docstring of `bake` documents it.
pub struct BakeSettings<'a> {
    pub size: (Natural, Natural),
    pub maps: &'a [String],
    pub samples: u32,
    pub target: &'a str,
    pub bitangent: &'a str,
    pub padding: Option<Natural>,
    pub back_faces: bool,
    pub ao_rays: u32,
    pub ao_distance: f32,
    pub ao_falloff: &'a str,
    pub ao_weights: &'a str,
    pub thickness_distance: f32,
    pub curvature_radius: f32,
    pub curvature_unit: &'a str,
    pub world_direction: (f32, f32, f32),
    pub udim: Option<Natural>,
}

impl BakeSettings<'_> {
    /// The options of the baker, with the memory that the process may still use.
    pub fn options(&self, distance: [f32; 2]) -> PyResult<BakeOptions> {
        let kinds = self.maps.iter().map(|name| named_choice(name)).collect::<PyResult<Vec<_>>>()?;
        Ok(BakeOptions::new([self.size.0.0, self.size.1.0], distance)
            .with_maps(MapSet::of(&kinds))
            .with_samples_per_axis(self.samples)
            .with_map_convention(convention("target", self.target)?)
            .with_bitangent(named_choice(self.bitangent)?)
            .with_padding(self.padding.map(|Natural(texels)| texels))
            .with_back_faces(self.back_faces)
            .with_occlusion(self.ao_rays, self.ao_distance)
            .with_occlusion_falloff(named_choice(self.ao_falloff)?)
            .with_occlusion_weights(named_choice(self.ao_weights)?)
            .with_thickness_distance(self.thickness_distance)
            .with_curvature_radius(choice("curvature_unit", self.curvature_unit, UNITS)?(
                self.curvature_radius,
            ))
            .with_world_direction(self.world_direction.into())
            .with_udim(tile(self.udim)?)
            .with_memory_limit(memory_of_process()))
    }
}

/// The tile of a UDIM number. Errors: a number that no tile has.
pub fn tile(number: Option<Natural>) -> PyResult<Option<Udim>> {
    let known = |Natural(number)| {
        Udim::from_number(number).ok_or_else(|| {
            PyValueError::new_err(format!("udim is {number}; it must be a number of a tile, 1001 to 9990"))
        })
    };
    number.map(known).transpose()
}

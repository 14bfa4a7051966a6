//! What a rule is.

use darboux_io::gltf::Material;

use crate::defect::Defect;
use crate::facts::SurfaceFacts;
use crate::measure::map::Map;

/// A rule about surfaces.
pub type SurfaceRule = fn(&SurfaceFacts<'_>) -> Vec<Defect>;

/// A rule about normal maps.
pub type MapRule = fn(&Map) -> Option<Defect>;

/// A rule about the use of normal maps by a material.
pub type MaterialRule = fn(&Material) -> Option<Defect>;

//! The three kinds of rules: functions that look at one surface, map or texture use and return findings.

use darboux_io::gltf::TextureUse;

use crate::finding::Finding;
use crate::fit::Fit;
use crate::map::Map;
use crate::surface::Surface;

/// A surface and how its tangents differ from MikkTSpace's.
pub struct Measured<'a> {
    pub surface: &'a Surface,
    pub fit: Option<Fit>,
}

/// A rule about surfaces.
pub type SurfaceRule = fn(&Measured<'_>) -> Vec<Finding>;

/// A rule about normal maps.
pub type MapRule = fn(&Map) -> Option<Finding>;

/// A rule about the use of a normal map by a material.
pub type TextureRule = fn(&TextureUse) -> Option<Finding>;

//! The three kinds of rules: functions that look at one surface, map or texture use and return findings.

use darboux_io::gltf::TextureUse;

use crate::finding::Finding;
use crate::fit::{self, Fit};
use crate::map::Map;
use crate::orientation::Reversal;
use crate::surface::Surface;

/// A surface and what several rules ask about it.
pub struct Measured<'a> {
    pub surface: &'a Surface,
    /// MikkTSpace's tangents of all corners; none where the surface has no tangents, or they cannot be computed.
    pub expected: Option<Vec<[f32; 4]>>,
    /// What is reversed; none where the faces agree with the normals.
    pub reversal: Option<Reversal>,
    /// How its tangents differ from MikkTSpace's.
    pub fit: Option<Fit>,
}

impl<'a> Measured<'a> {
    pub fn new(surface: &'a Surface) -> Self {
        let expected = surface.tangents.as_ref().and_then(|_| surface.expected_tangents(surface.uv_set));
        let reversal = Reversal::of(surface);
        let fit = expected.as_ref().and_then(|expected| fit::measure(surface, expected, reversal));
        Self { surface, expected, reversal, fit }
    }
}

/// A rule about surfaces.
pub type SurfaceRule = fn(&Measured<'_>) -> Vec<Finding>;

/// A rule about normal maps.
pub type MapRule = fn(&Map) -> Option<Finding>;

/// A rule about the use of a normal map by a material.
pub type TextureRule = fn(&TextureUse) -> Option<Finding>;

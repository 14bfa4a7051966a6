//! The three kinds of rules: functions that look at one surface, map or material and return findings.

use darboux_io::gltf::Appearance;

use crate::expected::{are_those_of_the_file, on_mirrored_seams, vertices_with_own_tangents};
use crate::finding::Finding;
use crate::fit::{self, Fit};
use crate::map::Map;
use crate::orientation::Reversal;
use crate::other_axes::OtherAxes;
use crate::surface::Surface;

/// A surface and what several rules ask about it.
pub struct Measured<'a> {
    pub surface: &'a Surface,
    /// Per vertex whether MikkTSpace's tangents of its corners have both signs; empty where the surface has no tangents, or they cannot be computed.
    pub is_on_mirrored_seam: Vec<bool>,
    /// Per vertex whether its tangent is that of MikkTSpace for a corner without an area, which tells nothing.
    pub has_own_tangent: Vec<bool>,
    /// Whether all tangents are those of MikkTSpace, bit for bit.
    pub is_mikktspace: bool,
    /// What is reversed; none where the faces agree with the normals.
    pub reversal: Option<Reversal>,
    /// In which other axes its normals are; then nothing is measured that depends on them. None where they fit the faces, or in no axes.
    pub other_axes: Option<OtherAxes>,
    /// How its tangents differ from MikkTSpace's, in their directions and in their signs; empty where that cannot be measured.
    pub fits: Vec<Fit>,
}

impl<'a> Measured<'a> {
    pub fn new(surface: &'a Surface) -> Self {
        let other_axes = OtherAxes::of(surface);
        let reversal = Reversal::of(surface).filter(|_| other_axes.is_none());
        let has_tangents = surface.tangents.is_some() && other_axes.is_none();
        let expected = has_tangents.then(|| surface.expected_tangents(surface.uv_set)).flatten();
        let Some(expected) = expected else {
            return Self {
                surface,
                is_on_mirrored_seam: Vec::new(),
                has_own_tangent: vec![false; surface.positions.len()],
                is_mikktspace: false,
                reversal,
                other_axes,
                fits: Vec::new(),
            };
        };
        let is_on_mirrored_seam = on_mirrored_seams(surface, surface.uv_set, &expected);
        Self {
            surface,
            has_own_tangent: vertices_with_own_tangents(surface, &expected),
            is_mikktspace: are_those_of_the_file(surface, &expected),
            reversal,
            fits: fit::measure(surface, &expected, &is_on_mirrored_seam, reversal),
            is_on_mirrored_seam,
            other_axes,
        }
    }
}

/// A rule about surfaces.
pub type SurfaceRule = fn(&Measured<'_>) -> Vec<Finding>;

/// A rule about normal maps.
pub type MapRule = fn(&Map) -> Option<Finding>;

/// A rule about the use of normal maps by a material.
pub type MaterialRule = fn(&Appearance) -> Option<Finding>;

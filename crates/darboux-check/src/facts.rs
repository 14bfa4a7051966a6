//! [`SurfaceFacts`]: what is measured of a surface, once, before the rules look at it.

use darboux::CornerDifference;

use crate::measure::expected::{
    are_those_of_the_file, on_mirrored_seams, rounding, vertices_with_own_tangents,
};
use crate::measure::fit::{self, Fit, Winding};
use crate::measure::other_axes::OtherAxes;
use crate::measure::reversal::{Reversal, Sides, Undecided};
use crate::measure::reversed::{Reversed, reversed};
use crate::surface::Surface;

/// A surface and what several rules ask about it.
pub struct SurfaceFacts<'a> {
    pub surface: &'a Surface,
    /// The triangles by the side to which their normals point.
    pub sides: Sides,
    /// MikkTSpace's tangents of all corners in glTF's convention; none where the surface has no tangents, or
    /// none can be computed.
    pub expected: Option<Vec<[f32; 4]>>,
    /// Per vertex whether MikkTSpace's tangents of its corners have both signs; empty without `expected`.
    pub is_on_mirrored_seam: Vec<bool>,
    /// Per vertex whether its tangent is MikkTSpace's for a degenerate corner, which is no evidence.
    pub has_own_tangent: Vec<bool>,
    /// Whether all tangents are MikkTSpace's, bit for bit.
    pub is_mikktspace: bool,
    /// What is reversed; none where the faces agree with the normals.
    pub reversal: Option<Reversal>,
    /// The vertices whose normals point to the back of all faces around them.
    pub reversed: Option<Reversed>,
    /// In which other axes its normals are; then nothing is measured that depends on them. None where they
    /// fit the faces, or in no axes.
    pub other_axes: Option<OtherAxes>,
    /// How its tangents differ from MikkTSpace's, in their directions and in their signs; empty where that
    /// cannot be measured.
    pub fits: Vec<Fit>,
}

impl<'a> SurfaceFacts<'a> {
    pub fn new(surface: &'a Surface) -> Self {
        let other_axes = OtherAxes::of(surface);
        let sides = Sides::of(surface);
        let reversal = Reversal::of(surface, &sides).filter(|_| other_axes.is_none());
        let reversed = if other_axes.is_none() { reversed(surface) } else { None };
        let has_tangents = surface.tangents.is_some() && other_axes.is_none();
        let expected = has_tangents.then(|| surface.expected_tangents(surface.uv_set)).flatten();
        let mut facts = Self {
            surface,
            sides,
            expected: None,
            is_on_mirrored_seam: Vec::new(),
            has_own_tangent: vec![false; surface.positions.len()],
            is_mikktspace: false,
            reversal,
            reversed,
            other_axes,
            fits: Vec::new(),
        };
        if let Some(expected) = expected {
            facts.is_on_mirrored_seam = on_mirrored_seams(surface, surface.uv_set, &expected);
            facts.has_own_tangent = vertices_with_own_tangents(surface, &expected);
            facts.is_mikktspace = are_those_of_the_file(surface, &expected);
            let winding = Winding { reversal: facts.reversal, sides: &facts.sides };
            facts.fits = fit::measure(surface, &expected, &facts.is_on_mirrored_seam, winding);
            facts.expected = Some(expected);
        }
        facts
    }

    /// Whether a repair can compute tangents. Where it cannot, tangents that lean towards damaged normals
    /// stay when the normals are repaired.
    pub fn has_repairable_tangents(&self) -> bool {
        let is_about_all = |reason: Undecided| reason != Undecided::OnlyAPart;
        let is_undecided = matches!(self.reversal, Some(Reversal::Unknown(reason)) if is_about_all(reason));
        self.surface.ineligible.is_none() && !is_undecided
    }

    /// Whether the tangents of all corners of a triangle are MikkTSpace's, up to rounding, with right signs
    /// or with all three flipped.
    pub fn has_expected_tangents(&self, triangle: usize) -> bool {
        let (Some(tangents), Some(expected)) = (&self.surface.tangents, &self.expected) else { return false };
        let flips = |corner: usize| {
            let vertex = self.surface.vertex_of_corner[3 * triangle + corner] as usize;
            let difference = CornerDifference::between(expected[3 * triangle + corner], tangents[vertex]);
            let is_close = difference.angle.is_some_and(|angle| angle <= rounding(self.surface));
            is_close.then_some(difference.flips_sign)
        };
        let of_corners = [0, 1, 2].map(flips);
        of_corners[0].is_some() && of_corners == [of_corners[0]; 3]
    }
}

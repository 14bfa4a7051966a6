//! Rules about tangents: values, signs and directions.

use super::rule::SurfaceRule;
use crate::defect::{Defect, TangentDifference, TangentFault};
use crate::facts::SurfaceFacts;
use crate::indices::Part;
use crate::measure::fit::{Difference, Fit};
use crate::measure::leaning::leaning;
use crate::measure::reversal::Reversal;
use crate::measure::values::{has_length, is_finite, is_sign, is_unit};
use crate::severity::SEEN;
use crate::severity::Severity;
use crate::surface::{Surface, indices_where, xyz};

pub const RULES: &[SurfaceRule] = &[
    missing,
    unused,
    not_finite,
    zero,
    not_unit,
    not_perpendicular,
    sign_not_one,
    shared_across_mirror,
    sign_mixed,
    direction_or_sign,
];

fn missing(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let surface = facts.surface;
    let is_missing = surface.needs_tangents && surface.tangents.is_none();
    let defect = || Defect::new(TangentFault::Missing(surface.used_count()));
    is_missing.then(defect).into_iter().collect()
}

fn unused(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Surface { needs_tangents, tangents, tangent_size, vertices_of_file, .. } = facts.surface;
    let is_unused = !needs_tangents && tangents.is_some();
    let bytes = tangent_size * vertices_of_file;
    let defect = || Defect::new(TangentFault::Unused { bytes, also: Vec::new() });
    is_unused.then(defect).into_iter().collect()
}

/// A defect of the vertices whose tangents fulfil a condition.
fn vertices(
    facts: &SurfaceFacts<'_>,
    fault: fn(Part) -> TangentFault,
    condition: impl Fn([f32; 4]) -> bool,
) -> Vec<Defect> {
    let Some(tangents) = &facts.surface.tangents else { return Vec::new() };
    let found = facts.surface.vertices_where(tangents, |tangent| condition(*tangent));
    found.map(fault).map(Defect::new).into_iter().collect()
}

fn not_finite(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    vertices(facts, TangentFault::NotFinite, |tangent| !is_finite(tangent))
}

fn zero(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    vertices(facts, TangentFault::Zero, |tangent| is_finite(tangent) && !has_length(tangent))
}

fn not_unit(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    vertices(facts, TangentFault::NotUnit, |tangent| has_length(tangent) && !is_unit(xyz(tangent)))
}

fn sign_not_one(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    vertices(facts, TangentFault::SignNotOne, |tangent| is_finite(tangent) && !is_sign(tangent[3]))
}

fn not_perpendicular(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let (found, angles): (Vec<usize>, Vec<f64>) = leaning(facts).into_iter().unzip();
    if found.is_empty() {
        return Vec::new();
    }
    let worst = angles.into_iter().fold(0.0, f64::max);
    let severity = if worst > SEEN { Severity::Error } else { Severity::Warning };
    let fault = TangentFault::Leaning { vertices: found.as_slice().into(), worst };
    vec![Defect::new(fault).with_severity(severity)]
}

fn shared_across_mirror(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let found = indices_where(&facts.is_on_mirrored_seam, |is_on_seam| *is_on_seam);
    let part = Part::new(&found, facts.surface.used_count());
    part.map(TangentFault::SharedAcrossMirror).map(Defect::new).into_iter().collect()
}

fn sign_mixed(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Some(tangents) = &facts.surface.tangents else { return Vec::new() };
    let is_own = &facts.has_own_tangent;
    let is_mixed = |triangle: [usize; 3]| {
        let signs = triangle.map(|vertex| tangents[vertex][3] < 0.0);
        // The sign of a tangent without a direction says nothing; that it has none is a finding of its own.
        let have_directions = triangle.iter().all(|&vertex| has_length(tangents[vertex]));
        signs != [signs[0]; 3] && have_directions && !triangle.iter().all(|&vertex| is_own[vertex])
    };
    let mut found = facts.surface.triangles_where(is_mixed);
    // Where MikkTSpace itself gives both signs, computing the tangents again does not help.
    found.retain(|&triangle| !facts.has_expected_tangents(triangle));
    let part = Part::new(&found, facts.surface.vertex_of_corner.len() / 3);
    part.map(TangentFault::SignMixed).map(Defect::new).into_iter().collect()
}

/// The rules that one measurement decides: at most one rule about directions and one about signs applies.
fn direction_or_sign(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    facts.fits.iter().filter_map(|fit| different(facts, fit)).collect()
}

fn different(facts: &SurfaceFacts<'_>, fit: &Fit) -> Option<Defect> {
    let Fit { difference, supporting, measured, items, exceptions, flipped_percent } = fit;
    let difference = (*difference)?;
    let difference = TangentDifference {
        difference,
        supporting: *supporting,
        measured: *measured,
        items: items.as_slice().into(),
        exceptions: exceptions.as_slice().into(),
        flipped_percent: *flipped_percent,
        uv_set: facts.surface.uv_set,
        follows_from_normals: difference == Difference::SignFlipped
            && facts.reversal == Some(Reversal::NormalsByTangents),
    };
    let is_warning = difference.follows_from_normals;
    let defect = Defect::new(TangentFault::Differs(difference));
    Some(if is_warning { defect.with_severity(Severity::Warning) } else { defect })
}

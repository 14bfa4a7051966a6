//! Rules about tangents: values, signs and directions.

use super::normals::UNIT as UNIT_OF_NORMALS;
use crate::code::Code;
use crate::finding::Finding;
use crate::fit::{Difference, Fit};
use crate::orientation::Reversal;
use crate::reversed::reversed;
use crate::rule::{Measured, SurfaceRule};
use crate::severity::Severity;
use crate::surface::{Surface, dot, indices_where, length, xyz};
use crate::text::counted;

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

/// How far lengths of tangents may be from 1: 8-bit tangents are up to 0.007 off.
pub const UNIT: f64 = 0.02;

/// How far the size of a sign w may be from 1.
pub const SIGN: f32 = 0.01;

/// The share in percent above which flipped signs of some triangles, or turned tangents of some vertices, are an error: each shows dents for
/// bumps, and one in a hundred is seen on a model that fills the screen. Fewer may be slivers, whose UV area is rounding, so that programs
/// differ in their sign.
const MAX_PERCENT_OF_PART: f64 = 1.0;

/// Degrees from the plane of the normal.
const MAX_DEGREES_FROM_PLANE: [f64; 2] = [2.0, 15.0];

fn missing(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let is_missing = surface.needs_tangents && surface.tangents.is_none();
    let finding = || {
        Finding::new(Code::TangentMissing, "its material has a normal map, and it has no tangents")
            .with_evidence("without tangents", surface.used_count() as f64, "vertices")
    };
    is_missing.then(finding).into_iter().collect()
}

fn unused(measured: &Measured<'_>) -> Vec<Finding> {
    let Surface { needs_tangents, tangents, tangent_size, positions, .. } = measured.surface;
    let is_unused = !needs_tangents && tangents.is_some();
    let finding = || {
        Finding::new(Code::TangentUnused, "it has tangents, and its material has nothing that reads them")
            .with_evidence("size", (tangent_size * positions.len()) as f64, "bytes")
    };
    is_unused.then(finding).into_iter().collect()
}

/// A finding about the vertices whose tangents fulfil a condition. `one`, `many`: what is said of one tangent, and of several.
fn vertices(
    surface: &Surface,
    code: Code,
    condition: impl Fn([f32; 4]) -> bool,
    [one, many]: [&str; 2],
) -> Vec<Finding> {
    let Some(tangents) = &surface.tangents else { return Vec::new() };
    let found = surface.used(indices_where(tangents, |tangent| condition(*tangent)));
    if found.is_empty() {
        return Vec::new();
    }
    let share = surface.percent_of_vertices(found.len());
    let finding = Finding::new(code, counted(found.len(), one, many)).with_items(&found);
    vec![finding.with_evidence("part of all vertices", share, "%")]
}

/// Whether all components are numbers.
pub fn is_finite(tangent: [f32; 4]) -> bool {
    tangent.iter().all(|x| x.is_finite())
}

/// Whether a tangent has a direction.
pub fn has_length(tangent: [f32; 4]) -> bool {
    is_finite(tangent) && length(xyz(tangent)) > 0.1
}

fn not_finite(measured: &Measured<'_>) -> Vec<Finding> {
    vertices(
        measured.surface,
        Code::TangentNotFinite,
        |tangent| !is_finite(tangent),
        ["tangent contains NaN or infinity", "tangents contain NaN or infinity"],
    )
}

fn zero(measured: &Measured<'_>) -> Vec<Finding> {
    let is_zero = |tangent| is_finite(tangent) && !has_length(tangent);
    let text = ["tangent has length zero", "tangents have length zero"];
    vertices(measured.surface, Code::TangentZero, is_zero, text)
}

fn not_unit(measured: &Measured<'_>) -> Vec<Finding> {
    let is_other = |tangent| has_length(tangent) && (length(xyz(tangent)) - 1.0).abs() > UNIT;
    let text = ["tangent has another length than 1", "tangents have another length than 1"];
    vertices(measured.surface, Code::TangentNotUnit, is_other, text)
}

fn sign_not_one(measured: &Measured<'_>) -> Vec<Finding> {
    let is_other = |tangent: [f32; 4]| is_finite(tangent) && (tangent[3].abs() - 1.0).abs() > SIGN;
    let text =
        ["tangent has a sign w that is neither 1 nor -1", "tangents have a sign w that is neither 1 nor -1"];
    vertices(measured.surface, Code::TangentSignNotOne, is_other, text)
}

/// The vertices whose tangents lean towards their normals by a mistake of their own, ascending, each with the degrees from the plane of the normal.
pub fn leaning(measured: &Measured<'_>) -> Vec<(usize, f64)> {
    if measured.other_axes.is_some() {
        return Vec::new();
    }
    let (Some(tangents), Some(normals)) = (&measured.surface.tangents, &measured.surface.normals) else {
        return Vec::new();
    };
    let is_own = &measured.has_own_tangent;
    let angle = |vertex: usize| {
        let (tangent, normal) = (xyz(tangents[vertex]), normals[vertex]);
        let sine = dot(tangent, normal) / (length(tangent) * length(normal));
        if has_length(tangents[vertex]) && sine.is_finite() && !is_own[vertex] {
            sine.abs().min(1.0).asin().to_degrees()
        } else {
            0.0
        }
    };
    let leans = |&vertex: &usize| angle(vertex) > MAX_DEGREES_FROM_PLANE[0];
    let found = measured.surface.used((0..tangents.len()).filter(leans).collect());
    let found = without_spoilt_normals(measured.surface, normals, found);
    found.into_iter().map(|vertex| (vertex, angle(vertex))).collect()
}

fn not_perpendicular(measured: &Measured<'_>) -> Vec<Finding> {
    let (found, angles): (Vec<usize>, Vec<f64>) = leaning(measured).into_iter().unzip();
    if found.is_empty() {
        return Vec::new();
    }
    let worst = angles.into_iter().fold(0.0, f64::max);
    let severity = if worst > MAX_DEGREES_FROM_PLANE[1] { Severity::Error } else { Severity::Warning };
    let tangents = counted(
        found.len(),
        "tangent is not perpendicular to its normal",
        "tangents are not perpendicular to their normals",
    );
    let text = format!("{tangents}, by up to {worst:.1} degrees");
    vec![
        Finding::new(Code::TangentNotPerpendicular, text)
            .with_items(&found)
            .with_severity(severity)
            .with_evidence("largest angle", worst, "degrees"),
    ]
}

/// Those of some vertices whose normals have no finding of their own. Where the normals of most vertices have one, as after they were scaled or
/// negated, their axes are right.
fn without_spoilt_normals(surface: &Surface, normals: &[[f32; 3]], vertices: Vec<usize>) -> Vec<usize> {
    if vertices.is_empty() {
        return vertices;
    }
    let is_most = |spoilt: &[usize]| 2 * spoilt.len() > surface.used_count();
    let reversed = reversed(surface).map(|reversed| reversed.vertices).filter(|reversed| !is_most(reversed));
    let reversed = reversed.unwrap_or_default();
    let is_unit = |vertex: usize| (length(normals[vertex]) - 1.0).abs() <= UNIT_OF_NORMALS;
    let not_unit = surface.used((0..normals.len()).filter(|&vertex| !is_unit(vertex)).collect());
    let are_scaled = is_most(&not_unit);
    let is_sound =
        |vertex: &usize| (are_scaled || is_unit(*vertex)) && reversed.binary_search(vertex).is_err();
    vertices.into_iter().filter(is_sound).collect()
}

fn shared_across_mirror(measured: &Measured<'_>) -> Vec<Finding> {
    let found = indices_where(&measured.is_on_mirrored_seam, |is_on_seam| *is_on_seam);
    if found.is_empty() {
        return Vec::new();
    }
    let vertices = counted(found.len(), "vertex serves", "vertices serve");
    let text = format!("{vertices} both sides of mirrored UV seams");
    let share = measured.surface.percent_of_vertices(found.len());
    let finding = Finding::new(Code::TangentSharedAcrossMirror, text).with_items(&found);
    vec![finding.with_evidence("part of all vertices", share, "%")]
}

fn sign_mixed(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let Some(tangents) = &surface.tangents else { return Vec::new() };
    let is_own = &measured.has_own_tangent;
    let found = surface.triangles_where(|triangle| {
        let signs = triangle.map(|vertex| tangents[vertex][3] < 0.0);
        signs != [signs[0]; 3] && !triangle.iter().all(|&vertex| is_own[vertex])
    });
    if found.is_empty() {
        return Vec::new();
    }
    let triangles = counted(found.len(), "triangle has", "triangles have");
    let text = format!("{triangles} corners with both signs");
    let share = surface.percent_of_triangles(found.len());
    let finding = Finding::new(Code::TangentSignMixed, text).with_items(&found);
    vec![finding.with_evidence("part of all triangles", share, "%")]
}

/// The rules that one measurement decides: at most one about all directions, or a part of them, and one about signs is true.
fn direction_or_sign(measured: &Measured<'_>) -> Vec<Finding> {
    measured.fits.iter().filter_map(|fit| different(measured, fit)).collect()
}

fn different(measured: &Measured<'_>, fit: &Fit) -> Option<Finding> {
    let Fit { difference, supporting, measured: all, items, .. } = fit;
    let set = measured.surface.uv_set;
    let follows_from_normals =
        *difference == Difference::SignFlipped && measured.reversal == Some(Reversal::NormalsByTangents);
    let (code, text) = match *difference {
        Difference::None | Difference::Unknown => return None,
        Difference::SignFlipped => {
            let which = if supporting == all { "all" } else { "nearly all" };
            let follows = if follows_from_normals {
                "; they are right again once the normals are turned over, unless space was mirrored, which reverses faces and signs"
            } else {
                ""
            };
            (Code::TangentSignFlipped, format!("{which} signs w are flipped{follows}"))
        }
        Difference::SignFlippedWhereMirrored => {
            let text = "the signs w are right on one side of the mirrored UVs and flipped on the other";
            (Code::TangentSignFlippedWhereMirrored, text.to_owned())
        }
        Difference::SignPartlyFlipped => {
            let signs = counted(*supporting, "triangle", "triangles");
            (Code::TangentSignPartlyFlipped, format!("the signs w of all corners of {signs} are flipped"))
        }
        Difference::PartlyNegated => {
            let tangents = counted(*supporting, "tangent points", "tangents point");
            (Code::TangentNegated, format!("{tangents} against u"))
        }
        Difference::PartlyRotated => {
            let tangents = counted(*supporting, "tangent points", "tangents point");
            (Code::TangentRotated, format!("{tangents} along v"))
        }
        Difference::Rotated => (Code::TangentRotated, "the tangents point along v".to_owned()),
        Difference::Negated => (Code::TangentNegated, "the tangents point against u".to_owned()),
        Difference::OtherUvSet(other) => {
            let text = format!("the tangents follow TEXCOORD_{other} instead of TEXCOORD_{set}");
            (Code::TangentOtherUvSet, text)
        }
    };
    let part = match difference {
        Difference::SignPartlyFlipped => "part of all triangles",
        Difference::PartlyNegated | Difference::PartlyRotated => "part of all vertices",
        _ => "part of all corners",
    };
    let share = 100.0 * *supporting as f64 / (*all).max(1) as f64;
    let is_partly = matches!(
        difference,
        Difference::SignPartlyFlipped | Difference::PartlyNegated | Difference::PartlyRotated
    );
    let is_small = is_partly && share <= MAX_PERCENT_OF_PART;
    let severity = if is_small || follows_from_normals { Severity::Warning } else { code.severity() };
    let finding = Finding::new(code, text).with_items(items).with_count(*supporting);
    let finding = Finding { is_on_all_corners: supporting == all && !is_partly, ..finding };
    Some(finding.with_severity(severity).with_evidence(part, share, "%"))
}

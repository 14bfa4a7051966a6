//! Rules about normals.

use crate::code::Code;
use crate::finding::Finding;
use crate::parts::reversed_parts;
use crate::rule::{Measured, SurfaceRule};
use crate::severity::Severity;
use crate::surface::{indices_where, length};
use crate::text::counted;

pub const RULES: &[SurfaceRule] = &[missing, not_finite, not_unit, against_winding];

/// How far lengths of normals may be from 1: 8-bit normals are up to 0.007 off.
pub const UNIT: f64 = 0.02;

fn missing(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let finding = || {
        let vertices = surface.used_count() as f64;
        Finding::new(Code::NormalMissing, "it has no normals").with_evidence(
            "without normals",
            vertices,
            "vertices",
        )
    };
    surface.normals.is_none().then(finding).into_iter().collect()
}

fn is_finite(normal: [f32; 3]) -> bool {
    normal.iter().all(|x| x.is_finite())
}

fn not_finite(measured: &Measured<'_>) -> Vec<Finding> {
    let Some(normals) = &measured.surface.normals else { return Vec::new() };
    let found = measured.surface.used(indices_where(normals, |normal| !is_finite(*normal)));
    if found.is_empty() {
        return Vec::new();
    }
    let share = measured.surface.percent_of_vertices(found.len());
    let text = counted(found.len(), "normal contains NaN or infinity", "normals contain NaN or infinity");
    let finding = Finding::new(Code::NormalNotFinite, text).with_items(&found);
    vec![finding.with_evidence("part of all vertices", share, "%")]
}

fn not_unit(measured: &Measured<'_>) -> Vec<Finding> {
    let Some(normals) = &measured.surface.normals else { return Vec::new() };
    let is_other = |normal: &[f32; 3]| is_finite(*normal) && (length(*normal) - 1.0).abs() > UNIT;
    let found = measured.surface.used(indices_where(normals, is_other));
    if found.is_empty() {
        return Vec::new();
    }
    let smallest = found.iter().map(|&vertex| length(normals[vertex])).fold(f64::INFINITY, f64::min);
    let severity = if smallest < 0.1 { Severity::Error } else { Severity::Warning };
    let text = counted(found.len(), "normal has another length than 1", "normals have another length than 1");
    let share = measured.surface.percent_of_vertices(found.len());
    let finding = Finding::new(Code::NormalNotUnit, text).with_items(&found).with_severity(severity);
    vec![finding.with_evidence("part of all vertices", share, "%").with_evidence(
        "smallest length",
        smallest,
        "",
    )]
}

/// Most faces, or all faces of some connected parts, have normals that point to their back.
fn against_winding(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let found = surface.triangles_against_normals();
    if found.is_empty() {
        return Vec::new();
    }
    let finding = |triangles: &[usize], place: String| {
        let share = surface.percent_of_triangles(triangles.len());
        let what = counted(triangles.len(), "triangle", "triangles");
        let verb = if triangles.len() == 1 { "points to its back" } else { "point to their back" };
        let text = format!("the normals of {what}{place} {verb}");
        let finding = Finding::new(Code::NormalAgainstWinding, text).with_items(triangles);
        finding.with_evidence("part of all triangles", share, "%")
    };
    if let Some(reversal) = measured.reversal {
        let mut finding = finding(&found, String::new());
        finding.text += &reversal.explanation().map_or(String::new(), |clause| format!(": {clause}"));
        return vec![finding];
    }
    let reversed = reversed_parts(surface);
    if reversed.triangles.is_empty() {
        return Vec::new();
    }
    let parts = counted(reversed.all_parts, "connected part", "connected parts");
    let partly = finding(&reversed.triangles, format!(", in {} of {parts},", reversed.parts));
    vec![partly.with_severity(Severity::Warning)]
}

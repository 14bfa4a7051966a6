//! Rules about normals.

use crate::code::Code;
use crate::finding::Finding;
use crate::rule::{Measured, SurfaceRule};
use crate::severity::Severity;
use crate::surface::{indices_where, length};

pub const RULES: &[SurfaceRule] = &[missing, not_finite, not_unit, against_winding];

/// How far lengths of normals may be from 1: 8-bit normals are up to 0.007 off.
pub const UNIT: f64 = 0.02;

fn missing(measured: &Measured<'_>) -> Vec<Finding> {
    let is_missing = measured.surface.normals.is_none();
    is_missing.then(|| Finding::new(Code::NormalMissing, "it has no normals")).into_iter().collect()
}

fn is_finite(normal: [f32; 3]) -> bool {
    normal.iter().all(|x| x.is_finite())
}

fn not_finite(measured: &Measured<'_>) -> Vec<Finding> {
    let Some(normals) = &measured.surface.normals else { return Vec::new() };
    let found = indices_where(normals, |normal| !is_finite(*normal));
    if found.is_empty() {
        return Vec::new();
    }
    vec![
        Finding::new(Code::NormalNotFinite, format!("{} normals contain NaN or infinity", found.len()))
            .with_items(&found),
    ]
}

fn not_unit(measured: &Measured<'_>) -> Vec<Finding> {
    let Some(normals) = &measured.surface.normals else { return Vec::new() };
    let found = indices_where(normals, |normal| is_finite(*normal) && (length(*normal) - 1.0).abs() > UNIT);
    if found.is_empty() {
        return Vec::new();
    }
    let smallest = found.iter().map(|&vertex| length(normals[vertex])).fold(f64::INFINITY, f64::min);
    let severity = if smallest < 0.1 { Severity::Error } else { Severity::Warning };
    let text = format!("{} normals have another length than 1", found.len());
    vec![Finding::new(Code::NormalNotUnit, text).with_items(&found).with_severity(severity).with_evidence(
        "smallest length",
        smallest,
        "",
    )]
}

/// Most faces have normals at all corners that point to their back.
fn against_winding(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    if !surface.is_wound_against_normals() {
        return Vec::new();
    }
    let found = surface.triangles_against_normals();
    let share = 300.0 * found.len() as f64 / surface.vertex_of_corner.len() as f64;
    let text = format!("the normals of {} triangles point to their back", found.len());
    vec![Finding::new(Code::NormalAgainstWinding, text).with_items(&found).with_evidence(
        "triangles",
        share,
        "%",
    )]
}

//! Rules about normals.

use crate::code::Code;
use crate::finding::Finding;
use crate::reversed::{Reversed, reversed};
use crate::rule::{Measured, SurfaceRule};
use crate::severity::Severity;
use crate::surface::{Surface, indices_where, length};
use crate::text::counted;

pub const RULES: &[SurfaceRule] = &[missing, not_finite, not_unit, other_axes, against_winding];

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

/// Most faces have normals that point to their back, or some vertices have such normals for all their faces.
fn against_winding(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    if measured.other_axes.is_some() {
        return Vec::new();
    }
    if let Some(reversal) = measured.reversal {
        let found = surface.triangles_against_normals();
        let what = counted(found.len(), "triangle points to its back", "triangles point to their back");
        let why = reversal.explanation().map_or(String::new(), |clause| format!(": {clause}"));
        return vec![reversed_finding(surface, format!("the normals of {what}{why}"), &found)];
    }
    let Some(reversed) = reversed(surface) else { return Vec::new() };
    let Reversed { vertices, triangles, mixed, parts, all_parts } = reversed;
    let all_parts = counted(all_parts, "connected part", "connected parts");
    let whole = counted(triangles.len(), "triangle", "triangles");
    let verb = if triangles.len() == 1 { "points to its back" } else { "point to their back" };
    let place = format!(", in {parts} of {all_parts},");
    let text = match (triangles.is_empty(), mixed.len()) {
        (false, 0) => format!("the normals of {whole}{place} {verb}"),
        (false, 1) => format!(
            "the normals of {whole}{place} {verb}, and 1 triangle beside them has normals on both sides"
        ),
        (false, count) => {
            format!(
                "the normals of {whole}{place} {verb}, and {count} triangles beside them have normals on both sides"
            )
        }
        (true, _) => {
            let what = counted(mixed.len(), "triangle has", "triangles have");
            format!("{what} normals on both sides: some of their corners' normals point to the back")
        }
    };
    let mut all = [triangles, mixed].concat();
    all.sort_unstable();
    all.dedup();
    let share = surface.percent_of_triangles(all.len());
    let severity = if share > MAX_PERCENT_OF_PART { Severity::Error } else { Severity::Warning };
    let finding = reversed_finding(surface, text, &all).with_severity(severity);
    vec![finding.with_evidence(
        "normals that point to the back of all their faces",
        vertices.len() as f64,
        "vertices",
    )]
}

/// The share in percent above which reversed normals of a part of the surface are an error. Fewer may be creases that a modelling program made.
const MAX_PERCENT_OF_PART: f64 = 1.0;

fn reversed_finding(surface: &Surface, text: String, triangles: &[usize]) -> Finding {
    let share = surface.percent_of_triangles(triangles.len());
    let finding = Finding::new(Code::NormalAgainstWinding, text).with_items(triangles);
    finding.with_evidence("part of all triangles", share, "%")
}

/// The normals fit the faces with other axes only.
fn other_axes(measured: &Measured<'_>) -> Vec<Finding> {
    let Some(axes) = measured.other_axes else { return Vec::new() };
    let cause = match axes.are_exchanged() {
        true => "the positions were turned to another up axis, and they were not",
        false => "the positions were mirrored or turned by 180 degrees, and they were not",
    };
    let text =
        format!("its normals fit its faces only if they are read as ({}), as if {cause}", axes.components());
    let degrees = axes.mean_cosines.map(|cosine| cosine.clamp(-1.0, 1.0).acos().to_degrees());
    let finding = Finding::new(Code::NormalOtherAxes, text).with_count(measured.surface.used_count());
    let finding = finding.with_evidence("angle between normals and faces", degrees[0], "degrees");
    vec![finding.with_evidence("with these axes", degrees[1], "degrees")]
}

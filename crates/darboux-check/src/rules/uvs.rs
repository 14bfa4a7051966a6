//! Rules about UVs: the set that the tangents follow.

use crate::code::Code;
use crate::finding::Finding;
use crate::overlap;
use crate::rule::{Measured, SurfaceRule};
use crate::severity::Severity;
use crate::surface::{Surface, indices_where, uv_area};
use crate::text::counted;

pub const RULES: &[SurfaceRule] = &[missing, not_finite, degenerate];

/// Rules about what is no mistake.
pub const REMARKS: &[SurfaceRule] = &[mirrored, overlapping];

fn missing(measured: &Measured<'_>) -> Vec<Finding> {
    let Surface { needs_tangents, uv_sets, uv_set, .. } = measured.surface;
    if !needs_tangents || uv_sets.contains_key(uv_set) {
        return Vec::new();
    }
    let text = format!("its normal texture uses TEXCOORD_{uv_set}, which it does not have");
    vec![Finding::new(Code::UvMissing, text).with_evidence("present", uv_sets.len() as f64, "UV sets")]
}

/// UVs of any set: every texture may use it. Those of the normal texture decide the tangents, too.
fn not_finite(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let of_set = |(&set, uvs): (&usize, &Vec<[f32; 2]>)| {
        let found = surface.used(indices_where(uvs, |uv| !uv.iter().all(|x| x.is_finite())));
        let decides = surface.needs_tangents && set == surface.uv_set;
        let severity = if decides { Severity::Error } else { Severity::Warning };
        let what = counted(found.len(), "vertex has", "vertices have");
        let text = format!("{what} NaN or infinity in TEXCOORD_{set}");
        let share = surface.percent_of_vertices(found.len());
        let finding = || {
            let finding = Finding::new(Code::UvNotFinite, text).with_items(&found).with_severity(severity);
            finding.with_evidence("part of all vertices", share, "%")
        };
        (!found.is_empty()).then(finding)
    };
    surface.uv_sets.iter().filter_map(of_set).collect()
}

/// Triangles with an area in space and none in UV space.
fn degenerate(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let Some(uvs) = surface.uv_sets.get(&surface.uv_set).filter(|_| surface.needs_tangents) else {
        return Vec::new();
    };
    let found =
        surface.triangles_where(|triangle| uv_area(uvs, triangle) == 0.0 && surface.has_area(triangle));
    if found.is_empty() {
        return Vec::new();
    }
    let triangles = counted(found.len(), "triangle has", "triangles have");
    let text = format!("{triangles} no area in TEXCOORD_{}", surface.uv_set);
    let share = surface.percent_of_triangles(found.len());
    let finding = Finding::new(Code::UvDegenerate, text).with_items(&found);
    vec![finding.with_evidence("part of all triangles", share, "%")]
}

/// Triangles whose UVs turn the other way than glTF's images do.
fn mirrored(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let Some(uvs) = surface.uv_sets.get(&surface.uv_set).filter(|_| surface.needs_tangents) else {
        return Vec::new();
    };
    // glTF's v points down, so an unmirrored triangle has a negative area.
    let found = surface.triangles_where(|triangle| uv_area(uvs, triangle) > 0.0);
    if found.is_empty() {
        return Vec::new();
    }
    let text = counted(found.len(), "triangle has mirrored UVs", "triangles have mirrored UVs");
    let share = surface.percent_of_triangles(found.len());
    let finding = Finding::new(Code::UvMirrored, text).with_items(&found);
    vec![finding.with_evidence("part of all triangles", share, "%")]
}

/// Triangles that share UV space with others.
fn overlapping(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let Some(uvs) = surface.uv_sets.get(&surface.uv_set).filter(|_| surface.needs_tangents) else {
        return Vec::new();
    };
    let found = overlap::overlapping(uvs, &surface.vertex_of_corner);
    if found.triangles.is_empty() {
        return Vec::new();
    }
    let at_least = if found.is_complete { "" } else { "at least " };
    let count = found.triangles.len();
    let text = format!("{at_least}{count} triangles share area in TEXCOORD_{} with others", surface.uv_set);
    vec![Finding::new(Code::UvOverlapping, text).with_items(&found.triangles).with_evidence(
        "part of the UV area",
        100.0 * found.area_share,
        "%",
    )]
}

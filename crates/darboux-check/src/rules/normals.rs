//! Rules about normals.

use super::rule::SurfaceRule;
use crate::damage::NO_LENGTH;
use crate::defect::{Defect, NormalFault};
use crate::facts::SurfaceFacts;
use crate::indices::Part;
use crate::measure::reversed::Reversed;
use crate::measure::values::{is_finite, is_unit};
use crate::severity::Severity;
use crate::surface::length;

pub const RULES: &[SurfaceRule] = &[missing, not_finite, not_unit, other_axes, against_winding];

fn missing(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let surface = facts.surface;
    let defect = || Defect::new(NormalFault::Missing(surface.used_count()));
    surface.normals.is_none().then(defect).into_iter().collect()
}

fn not_finite(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Some(normals) = &facts.surface.normals else { return Vec::new() };
    let vertices = facts.surface.vertices_where(normals, |normal| !is_finite(*normal));
    vertices.map(NormalFault::NotFinite).map(Defect::new).into_iter().collect()
}

fn not_unit(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Some(normals) = &facts.surface.normals else { return Vec::new() };
    let is_other = |normal: &[f32; 3]| is_finite(*normal) && !is_unit(*normal);
    let Some(vertices) = facts.surface.vertices_where(normals, is_other) else { return Vec::new() };
    let lengths = vertices.items.iter().map(|vertex| length(normals[vertex]));
    let smallest = lengths.fold(f64::INFINITY, f64::min);
    let severity = if smallest < NO_LENGTH { Severity::Error } else { Severity::Warning };
    vec![Defect::new(NormalFault::NotUnit { vertices, smallest }).with_severity(severity)]
}

/// The normals fit the faces with other axes only.
fn other_axes(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let vertices = facts.surface.used_count();
    let fault = facts.other_axes.map(|axes| NormalFault::OtherAxes { axes, vertices });
    fault.map(Defect::new).into_iter().collect()
}

/// Most faces have normals that point to their back, or some vertices have such normals for all their faces.
fn against_winding(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let all = facts.surface.vertex_of_corner.len() / 3;
    if let Some(reversal) = facts.reversal {
        let triangles = Part::new(&facts.sides.against, all);
        let fault = triangles.map(|triangles| NormalFault::Reversed { reversal, triangles });
        return fault.map(Defect::new).into_iter().collect();
    }
    let Some(reversed) = &facts.reversed else { return Vec::new() };
    let Reversed { vertices, triangles, mixed, parts, all_parts } = reversed;
    let mut either = [&triangles[..], mixed].concat();
    either.sort_unstable();
    either.dedup();
    let Some(part) = Part::new(&either, all) else { return Vec::new() };
    let fault = NormalFault::PartlyReversed {
        triangles: part,
        whole: triangles.len(),
        mixed: mixed.len(),
        vertices: vertices.len(),
        parts: [*parts, *all_parts],
    };
    vec![Defect::new(fault)]
}

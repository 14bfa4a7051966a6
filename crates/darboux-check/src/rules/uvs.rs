//! Rules about UVs: the set that the tangents follow.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::rule::SurfaceRule;
use crate::defect::{Defect, UvFault};
use crate::facts::SurfaceFacts;
use crate::measure::hard_edges::HardEdges;
use crate::measure::overlap::overlapping;
use crate::measure::uv_rounding::UvRounding;
use crate::measure::uv_scale::UvScale;
use crate::measure::values::is_finite;
use crate::severity::Severity;
use crate::surface::{Surface, uv_area};

pub const RULES: &[SurfaceRule] = &[missing, not_finite, degenerate];

/// Rules about what is no mistake, or seldom one.
pub const REMARKS: &[SurfaceRule] = &[scale, rounded, hard_edges, mirrored, overlaps];

fn missing(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Surface { needs_tangents, uv_sets, uv_set, .. } = facts.surface;
    if !needs_tangents || uv_sets.contains_key(uv_set) {
        return Vec::new();
    }
    vec![Defect::new(UvFault::Missing { set: *uv_set, present: uv_sets.len() })]
}

/// UVs of any set: every texture may use it. The UV set of the normal texture also decides the tangents.
/// Sets of one accessor have one defect.
fn not_finite(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let surface = facts.surface;
    let mut sets_of: BTreeMap<*const Vec<[f32; 2]>, Vec<usize>> = BTreeMap::new();
    for (&set, uvs) in &surface.uv_sets {
        sets_of.entry(Arc::as_ptr(uvs)).or_default().push(set);
    }
    let mut groups: Vec<Vec<usize>> = sets_of.into_values().collect();
    groups.sort_unstable();
    let of_sets = |sets: Vec<usize>| {
        let decides = surface.needs_tangents && sets.contains(&surface.uv_set);
        let set = if decides { surface.uv_set } else { *sets.first()? };
        let vertices = surface.vertices_where(surface.uv_sets.get(&set)?, |uv| !is_finite(*uv))?;
        let severity = if decides { Severity::Error } else { Severity::Warning };
        let fault = UvFault::NotFinite { set, others: sets.len() - 1, vertices };
        Some(Defect::new(fault).with_severity(severity))
    };
    groups.into_iter().filter_map(of_sets).collect()
}

/// The UVs that the tangents follow, if the surface needs tangents.
fn needed_uvs(surface: &Surface) -> Option<&Vec<[f32; 2]>> {
    surface.uv_sets.get(&surface.uv_set).map(|uvs| &**uvs).filter(|_| surface.needs_tangents)
}

/// Triangles with an area in space that are UV-degenerate.
fn degenerate(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let surface = facts.surface;
    let Some(uvs) = needed_uvs(surface) else { return Vec::new() };
    let is_degenerate = |triangle| uv_area(uvs, triangle) == 0.0 && surface.has_area(triangle);
    let triangles = surface.part_of_triangles(is_degenerate);
    let fault = triangles.map(|triangles| UvFault::Degenerate { set: surface.uv_set, triangles });
    fault.map(Defect::new).into_iter().collect()
}

/// The degrees of a turn from which on it is a warning: a slope of 20 degrees is then lit as if it leaned by
/// three degrees or more to the side.
const WARNED_TURN: f64 = 15.0;

/// Faces whose UVs are unlike the UVs of the other faces. The poles of every sphere with rings are so: it is
/// worth knowing, and often meant.
fn scale(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Some(uvs) = needed_uvs(facts.surface) else { return Vec::new() };
    let UvScale { stretched, coarse } = UvScale::of(facts.surface, uvs);
    let faults = stretched.map(UvFault::Stretched).into_iter().chain(coarse.map(UvFault::Coarse));
    faults.map(Defect::new).collect()
}

/// UVs on a grid that turns tangents. Tangents of the file that are not MikkTSpace's for these UVs were
/// computed before the rounding, or in another way.
fn rounded(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Some(uvs) = needed_uvs(facts.surface) else { return Vec::new() };
    let Some(found) = UvRounding::of(facts.surface, uvs) else { return Vec::new() };
    let follows = |triangle: &usize| facts.has_expected_tangents(*triangle);
    let following = found.triangles.iter().filter(follows).count();
    if facts.surface.tangents.is_some() && 2 * following < found.triangles.len() {
        return Vec::new();
    }
    let is_plain = found.degrees >= WARNED_TURN;
    let severity = if is_plain { Severity::Warning } else { Severity::Info };
    vec![Defect::new(UvFault::Rounded(found)).with_severity(severity)]
}

fn hard_edges(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let found = needed_uvs(facts.surface).and_then(|uvs| HardEdges::of(facts.surface, uvs));
    found.map(UvFault::HardEdge).map(Defect::new).into_iter().collect()
}

/// Triangles whose UVs turn the other way than glTF's images do.
fn mirrored(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Some(uvs) = needed_uvs(facts.surface) else { return Vec::new() };
    // glTF's v points down, so an unmirrored triangle has a negative area.
    let triangles = facts.surface.part_of_triangles(|triangle| uv_area(uvs, triangle) > 0.0);
    triangles.map(UvFault::Mirrored).map(Defect::new).into_iter().collect()
}

/// Triangles that share UV space with others.
fn overlaps(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let surface = facts.surface;
    let Some(uvs) = needed_uvs(surface) else { return Vec::new() };
    let found = overlapping(uvs, &surface.vertex_of_corner);
    if found.triangles.is_empty() {
        return Vec::new();
    }
    vec![Defect::new(UvFault::Overlapping {
        set: surface.uv_set,
        triangles: found.triangles.as_slice().into(),
        is_complete: found.is_complete,
        area_share: found.area_share,
    })]
}

//! Rules about tangents: values, signs, directions, and how they were computed.

use darboux::{Convention, Method, Recipe, RecipeMatch, RecipeRounding, recognise_recipe};

use crate::code::Code;
use crate::finding::Finding;
use crate::fit::{Difference, Fit, on_mirrored_seams};
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
    other_recipe,
];

/// How far lengths of tangents may be from 1: 8-bit tangents are up to 0.007 off.
const UNIT: f64 = 0.02;

/// The share in percent above which flipped signs of some triangles, or negated tangents of some vertices, are an error: each shows dents for
/// bumps, and one in a hundred is seen on a model that fills the screen. Fewer may be slivers, whose UV area is rounding, so that programs
/// differ in their sign.
const MAX_PERCENT_OF_PART: f64 = 1.0;

/// Degrees from the plane of the normal.
const MAX_DEGREES_FROM_PLANE: [f64; 2] = [2.0, 15.0];

fn missing(measured: &Measured<'_>) -> Vec<Finding> {
    let Surface { needs_tangents, tangents, .. } = measured.surface;
    let is_missing = *needs_tangents && tangents.is_none();
    let text = "its material has a normal map, and it has no tangents";
    is_missing.then(|| Finding::new(Code::TangentMissing, text)).into_iter().collect()
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
    let found = indices_where(tangents, |tangent| condition(*tangent));
    if found.is_empty() {
        return Vec::new();
    }
    let share = 100.0 * found.len() as f64 / tangents.len() as f64;
    let finding = Finding::new(code, counted(found.len(), one, many)).with_items(&found);
    vec![finding.with_evidence("part of all vertices", share, "%")]
}

fn is_finite(tangent: [f32; 4]) -> bool {
    tangent.iter().all(|x| x.is_finite())
}

fn has_length(tangent: [f32; 4]) -> bool {
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
    let is_other = |tangent: [f32; 4]| is_finite(tangent) && (tangent[3].abs() - 1.0).abs() > 0.01;
    let text =
        ["tangent has a sign w that is neither 1 nor -1", "tangents have a sign w that is neither 1 nor -1"];
    vertices(measured.surface, Code::TangentSignNotOne, is_other, text)
}

fn not_perpendicular(measured: &Measured<'_>) -> Vec<Finding> {
    let (Some(tangents), Some(normals)) = (&measured.surface.tangents, &measured.surface.normals) else {
        return Vec::new();
    };
    let angle = |vertex: usize| {
        let (tangent, normal) = (xyz(tangents[vertex]), normals[vertex]);
        let sine = dot(tangent, normal) / (length(tangent) * length(normal));
        if has_length(tangents[vertex]) && sine.is_finite() {
            sine.abs().min(1.0).asin().to_degrees()
        } else {
            0.0
        }
    };
    let angles: Vec<f64> = (0..tangents.len()).map(angle).collect();
    let found = indices_where(&angles, |angle| *angle > MAX_DEGREES_FROM_PLANE[0]);
    if found.is_empty() {
        return Vec::new();
    }
    let worst = angles.iter().copied().fold(0.0, f64::max);
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

fn shared_across_mirror(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let expected = surface.tangents.as_ref().and_then(|_| surface.expected_tangents(surface.uv_set));
    let Some(expected) = expected else { return Vec::new() };
    let found = indices_where(&on_mirrored_seams(surface, surface.uv_set, &expected), |is_shared| *is_shared);
    if found.is_empty() {
        return Vec::new();
    }
    let vertices = counted(found.len(), "vertex serves", "vertices serve");
    let text = format!("{vertices} both sides of mirrored UV seams");
    vec![Finding::new(Code::TangentSharedAcrossMirror, text).with_items(&found)]
}

fn sign_mixed(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let Some(tangents) = &surface.tangents else { return Vec::new() };
    let found = surface.triangles_where(|triangle| {
        let signs = triangle.map(|vertex| tangents[vertex][3] < 0.0);
        signs != [signs[0]; 3]
    });
    if found.is_empty() {
        return Vec::new();
    }
    let triangles = counted(found.len(), "triangle has", "triangles have");
    let text = format!("{triangles} corners with both signs");
    vec![Finding::new(Code::TangentSignMixed, text).with_items(&found)]
}

/// The rules that one measurement decides: at most one of them is true.
fn direction_or_sign(measured: &Measured<'_>) -> Vec<Finding> {
    let Some(Fit { difference, supporting, measured: all, items }) = &measured.fit else { return Vec::new() };
    let set = measured.surface.uv_set;
    let (code, text) = match *difference {
        Difference::None | Difference::Unknown => return Vec::new(),
        Difference::SignFlipped => (Code::TangentSignFlipped, "all signs w are flipped".to_owned()),
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
        Difference::Rotated => (Code::TangentRotated, "the tangents point along v".to_owned()),
        Difference::Negated => (Code::TangentNegated, "the tangents point against u".to_owned()),
        Difference::OtherUvSet(other) => {
            let text = format!("the tangents follow TEXCOORD_{other} instead of TEXCOORD_{set}");
            (Code::TangentOtherUvSet, text)
        }
    };
    let part = match difference {
        Difference::SignPartlyFlipped => "part of all triangles",
        Difference::PartlyNegated => "part of all vertices",
        _ => "part of all corners",
    };
    let share = 100.0 * *supporting as f64 / (*all).max(1) as f64;
    let is_partly = matches!(difference, Difference::SignPartlyFlipped | Difference::PartlyNegated);
    let is_small = is_partly && share <= MAX_PERCENT_OF_PART;
    let severity = if is_small { Severity::Warning } else { code.severity() };
    let finding = Finding::new(code, text).with_items(items).with_count(*supporting);
    vec![finding.with_severity(severity).with_evidence(part, share, "%")]
}

fn other_recipe(measured: &Measured<'_>) -> Vec<Finding> {
    let surface = measured.surface;
    let is_fit = measured.fit.as_ref().is_some_and(|fit| {
        matches!(fit.difference, Difference::None | Difference::Unknown) && fit.measured > 0
    });
    let (Some(mesh), Some(tangents)) = (surface.mesh(surface.uv_set), surface.corner_tangents()) else {
        return Vec::new();
    };
    if !is_fit || surface.is_wound_against_normals() {
        return Vec::new();
    }
    let to_generated = Convention::GLTF.to(Convention::GLTF.generated());
    let tangents: Vec<[f32; 4]> = tangents.iter().map(|tangent| to_generated.tangent(*tangent)).collect();
    let Ok(matches) = recognise_recipe(&mesh, &tangents) else { return Vec::new() };
    let is_mikktspace = |found: &&RecipeMatch| {
        matches!(found.recipe.method, Method::MikkTSpace(_)) && !found.recipe.from_quads
    };
    let (Some(best), Some(mikktspace)) = (matches.first(), matches.iter().find(is_mikktspace)) else {
        return Vec::new();
    };
    let close = |found: &RecipeMatch| 100.0 * found.close as f64 / found.corners.max(1) as f64;
    if is_mikktspace(&best) && close(best) >= 99.0 || best.corners == 0 {
        return Vec::new();
    }
    let differing = mikktspace.corners - mikktspace.close;
    let (text, nearest) = match () {
        () if is_mikktspace(&best) => {
            let corners = counted(differing, "corner differs", "corners differ");
            (format!("most tangents are those of MikkTSpace, but {corners}"), None)
        }
        () if close(best) >= 90.0 => {
            let text = format!("the tangents were computed by {}", name(&best.recipe));
            (text, Some("corners within 0.1 degrees (1 with 8 bits) of this method"))
        }
        () => {
            let is_coarse = best.recipe.rounding == RecipeRounding::Bits8;
            let coarse =
                if is_coarse { ", or the file's numbers are rounded too coarsely to tell" } else { "" };
            let text = format!("the tangents are not those of any method that Darboux knows{coarse}");
            (text, Some("corners within 0.1 degrees (1 with 8 bits) of the nearest known method"))
        }
    };
    let severity = if mikktspace.worst > 0.5 { Severity::Warning } else { Severity::Info };
    let finding = Finding::new(Code::TangentOtherRecipe, text)
        .with_severity(severity)
        .with_count(differing)
        .with_evidence("corners within 0.1 degrees (1 with 8 bits) of MikkTSpace", close(mikktspace), "%")
        .with_evidence("largest angle to MikkTSpace", mikktspace.worst, "degrees");
    vec![match nearest {
        Some(what) => finding.with_evidence(what, close(best), "%"),
        None => finding,
    }]
}

/// A recipe by the programs that use it.
fn name(recipe: &Recipe) -> &'static str {
    match recipe.method {
        Method::MikkTSpace(_) if recipe.from_quads => {
            "MikkTSpace before quads were cut into triangles (Unity and other importers)"
        }
        Method::MikkTSpace(_) => "MikkTSpace",
        Method::AngleArea => "sums weighted by angle and area",
        Method::AngleEdge => "sums weighted by angle and edges (meshoptimizer, gltfpack, Godot 4.6)",
        Method::Lengyel => "Lengyel's sums, split at mirrored seams",
        Method::LengyelPerVertex => "Lengyel's sums per vertex (three.js and many tutorials)",
        Method::Average => "averages of the triangles' tangents (Maya)",
        Method::Area => "averages weighted by area",
        Method::Face => "one tangent per face",
        _ => "another method",
    }
}

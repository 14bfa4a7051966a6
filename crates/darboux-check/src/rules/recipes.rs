//! The rule about how tangents were computed.

use darboux::{Mesh, Method, Recipe, RecipeMatch, RecipeRounding, recognise_recipe};

use super::normals::UNIT;
use super::tangents::has_length;
use crate::code::Code;
use crate::expected::is_measured;
use crate::finding::Finding;
use crate::fit::{Difference, Fit};
use crate::outliers::{FAR, Outliers, tangents_without_other_mistakes};
use crate::rule::{Measured, SurfaceRule};
use crate::severity::Severity;
use crate::surface::{Surface, cross, dot, length, xyz};
use crate::text::counted;

pub const RULES: &[SurfaceRule] = &[other_recipe];

/// The percentage of close corners from which on tangents are those of MikkTSpace.
const IS_MIKKTSPACE: f64 = 99.0;

/// The percentage from which on they are called those of another method.
const IS_KNOWN: f64 = 90.0;

/// The share of such corners, in percent, above which tangents of no known method are an error: one in a hundred is seen on a model that fills the
/// screen.
const MAX_PERCENT_FAR: f64 = 1.0;

/// The best recipe and the best one of MikkTSpace on the triangles as they are.
struct Recognised {
    best: RecipeMatch,
    mikktspace: RecipeMatch,
    /// Whether the recipe shows only with normals of length 1, which the file does not have.
    with_unit_normals: bool,
}

fn other_recipe(measured: &Measured<'_>) -> Vec<Finding> {
    let is_turned = |fit: &Fit| matches!(fit.difference, Difference::Rotated | Difference::OtherUvSet(_));
    let has_measured = measured.fits.iter().any(|fit| fit.measured > 0);
    // No recipe explains tangents better than one that gives all their bits.
    if !has_measured || measured.fits.iter().any(is_turned) || measured.is_mikktspace {
        return Vec::new();
    }
    // Tangents that were computed before positions were lost cannot be computed again.
    if !measured.surface.positions.as_flattened().iter().all(|x| x.is_finite()) {
        return Vec::new();
    }
    let tangents = tangents_without_other_mistakes(measured);
    let recognised = tangents.and_then(|tangents| Some((recognise(measured.surface, &tangents)?, tangents)));
    let Some((recognised, tangents)) = recognised else { return Vec::new() };
    let outliers = match is_of_mikktspace(&recognised) {
        true => None,
        false => Outliers::from(measured, tangents, &recognised.best),
    };
    let Some(Outliers { recipe, vertices, replaced }) = outliers else {
        return method_of_all(measured, &recognised, &[]).into_iter().collect();
    };
    let of_others = recognise(measured.surface, &replaced);
    let of_others = of_others.and_then(|of_others| method_of_all(measured, &of_others, &vertices));
    [unlike_the_others(measured, &recipe, &vertices)].into_iter().chain(of_others).collect()
}

/// The finding about tangents that are not those of the method that made the others.
fn unlike_the_others(measured: &Measured<'_>, recipe: &Recipe, vertices: &[usize]) -> Finding {
    let are = counted(vertices.len(), "tangent differs", "tangents differ");
    let text = format!(
        "{are} by more than {FAR} degrees from those of {}, which made the others, and bumps are lit from wrong directions there",
        name(recipe)
    );
    let share = measured.surface.percent_of_vertices(vertices.len());
    Finding::new(Code::TangentOtherRecipe, text)
        .with_items(vertices)
        .with_severity(Severity::Error)
        .with_cure("Compute these tangents again as the others were: `darboux check --fix`.")
        .with_evidence("part of all vertices", share, "%")
}

fn is_of_mikktspace(Recognised { best, mikktspace, .. }: &Recognised) -> bool {
    // Where MikkTSpace explains all corners, nothing shows that another recipe was used, though it may have more bits in common.
    let is_explained = mikktspace.close == mikktspace.corners;
    is_explained || is_mikktspace(best) && close(best) >= IS_MIKKTSPACE
}

/// The finding about the method that made the tangents; none where it is MikkTSpace. `outliers`: the vertices whose tangents are not its.
fn method_of_all(measured: &Measured<'_>, recognised: &Recognised, outliers: &[usize]) -> Option<Finding> {
    let Recognised { best, mikktspace, with_unit_normals } = recognised;
    if is_of_mikktspace(recognised) {
        return None;
    }
    let (text, nearest) = description(best);
    let text = if *with_unit_normals { format!("{text}, on normals of length 1") } else { text };
    let is_known = !is_mikktspace(best) && close(best) >= IS_KNOWN;
    let far = if is_known { 0.0 } else { percent_far(measured, outliers) };
    let severity = match () {
        () if far > MAX_PERCENT_FAR => Severity::Error,
        () if mikktspace.worst > 0.5 => Severity::Warning,
        () => Severity::Info,
    };
    let mut finding = Finding::new(Code::TangentOtherRecipe, text).with_severity(severity);
    if severity == Severity::Error {
        finding.text += ", and bumps are lit from wrong directions where they differ most";
        finding = finding
            .with_cure("Compute the tangents again: `darboux tangents --overwrite`.")
            .with_evidence("corners more than 20 degrees from MikkTSpace", far, "%");
    }
    let finding = finding
        .with_count(mikktspace.corners - mikktspace.close)
        .with_evidence("corners within 0.1 degrees (1 with 8 bits) of MikkTSpace", close(mikktspace), "%")
        .with_evidence("largest angle to MikkTSpace", mikktspace.worst, "degrees");
    let finding = match nearest {
        Some(what) => finding.with_evidence(what, close(best), "%"),
        None => finding,
    };
    Some(finding.with_obstacle(obstacle(best, severity)))
}

/// The corners that are more than [`FAR`] from MikkTSpace around the normal, in percent of those that lie in triangles with an area and not on
/// mirrored seams. Tangents that are negated or rotated, or lean towards the normal, have findings of their own.
fn percent_far(measured: &Measured<'_>, outliers: &[usize]) -> f64 {
    let surface = measured.surface;
    let (Some(tangents), Some(normals), Some(uvs), Some(expected)) = (
        &surface.tangents,
        &surface.normals,
        surface.uv_sets.get(&surface.uv_set),
        surface.expected_tangents(surface.uv_set),
    ) else {
        return 0.0;
    };
    let mut is_other = measured.is_on_mirrored_seam.clone();
    outliers.iter().for_each(|&vertex| is_other[vertex] = true);
    let is_turned =
        |fit: &&Fit| matches!(fit.difference, Difference::PartlyNegated | Difference::PartlyRotated);
    for fit in measured.fits.iter().filter(is_turned) {
        fit.items.iter().for_each(|&vertex| is_other[vertex] = true);
    }
    let angle = |vertex: usize, expected: [f32; 3]| {
        let tangent = xyz(tangents[vertex]);
        dot(cross(normals[vertex], expected), tangent).atan2(dot(expected, tangent)).to_degrees().abs()
    };
    let (mut corners, mut far) = (0usize, 0usize);
    for (triangle, expected) in surface.triangles().zip(expected.as_chunks::<3>().0) {
        let is_counted = |vertex: usize| has_length(tangents[vertex]) && !is_other[vertex];
        if !is_measured(surface, uvs, triangle) {
            continue;
        }
        for (vertex, &expected) in
            triangle.into_iter().zip(expected).filter(|(vertex, _)| is_counted(*vertex))
        {
            corners += 1;
            far += usize::from(angle(vertex, xyz(expected)) > FAR);
        }
    }
    100.0 * far as f64 / corners.max(1) as f64
}

/// What is said of the best recipe, and the name of the evidence for it unless it is MikkTSpace.
fn description(best: &RecipeMatch) -> (String, Option<&'static str>) {
    let is_coarse = best.recipe.rounding == RecipeRounding::Bits8;
    let coarse = if is_coarse { ", or the file's numbers are rounded too coarsely to tell" } else { "" };
    match () {
        () if is_mikktspace(best) && close(best) >= 50.0 => {
            let corners = counted(best.corners - best.close, "corner differs", "corners differ");
            (format!("most tangents are those of MikkTSpace, but {corners}"), None)
        }
        () if close(best) >= IS_KNOWN => {
            let text = format!("the tangents were computed by {}", name(&best.recipe));
            (text, Some("corners within 0.1 degrees (1 with 8 bits) of this method"))
        }
        () => {
            let text = format!("the tangents are not those of any method that Darboux knows{coarse}");
            let what = "corners within 0.1 degrees (1 with 8 bits) of the nearest known method";
            (text, Some(what).filter(|_| !is_mikktspace(best)))
        }
    }
}

/// Why a repair leaves the tangents.
fn obstacle(best: &RecipeMatch, severity: Severity) -> Option<String> {
    match () {
        () if severity == Severity::Info => Some("the difference cannot be seen".to_owned()),
        () if best.recipe.from_quads && close(best) >= IS_KNOWN => {
            Some("the map was probably baked on the quads, for these tangents".to_owned())
        }
        () => None,
    }
}

/// None where no recipe can be computed. `tangents`: of corners.
fn recognise(surface: &Surface, tangents: &[[f32; 4]]) -> Option<Recognised> {
    let as_they_are = recognise_on(&surface.mesh(surface.uv_set)?, tangents)?;
    if close(&as_they_are.best) >= IS_MIKKTSPACE {
        return Some(as_they_are);
    }
    // Normals that were scaled after the tangents were computed hide how they were.
    let Some(unit) = unit_normals(surface) else { return Some(as_they_are) };
    let uvs = surface.uv_sets.get(&surface.uv_set)?;
    let mesh = Mesh::triangles(&surface.positions, &unit, uvs, &surface.vertex_of_corner).ok()?;
    let on_unit = recognise_on(&mesh, tangents)?;
    let is_better = on_unit.best.close > as_they_are.best.close;
    Some(if is_better { Recognised { with_unit_normals: true, ..on_unit } } else { as_they_are })
}

fn recognise_on(mesh: &Mesh<'_>, tangents: &[[f32; 4]]) -> Option<Recognised> {
    let matches = recognise_recipe(mesh, tangents).ok()?;
    let best = *matches.first()?;
    // Of large meshes, some recipes are compared on a sample only.
    let all_corners = mesh.corner_count();
    let mikktspace = *matches.iter().find(|found| is_mikktspace(found) && found.corners == all_corners)?;
    // Tangents without a direction have findings of their own, and no method explains them.
    let unusable = tangents.iter().filter(|tangent| !has_length(**tangent)).count();
    let judged = |mut found: RecipeMatch| {
        found.corners -= if found.corners == all_corners { unusable } else { 0 };
        found
    };
    let (best, mikktspace) = (judged(best), judged(mikktspace));
    (best.corners > 0).then_some(Recognised { best, mikktspace, with_unit_normals: false })
}

/// The normals with length 1; none where all have it already. Normals without a direction stay as they are.
fn unit_normals(surface: &Surface) -> Option<Vec<[f32; 3]>> {
    let normals = surface.normals.as_ref()?;
    let is_scalable = |normal: [f32; 3]| length(normal).is_finite() && length(normal) > 0.0;
    let is_scaled = |normal: &[f32; 3]| is_scalable(*normal) && (length(*normal) - 1.0).abs() > UNIT;
    let unit = |normal: [f32; 3]| {
        let length = length(normal);
        if is_scalable(normal) { normal.map(|x| (f64::from(x) / length) as f32) } else { normal }
    };
    normals.iter().any(is_scaled).then(|| normals.iter().copied().map(unit).collect())
}

fn is_mikktspace(found: &RecipeMatch) -> bool {
    matches!(found.recipe.method, Method::MikkTSpace(_)) && !found.recipe.from_quads
}

/// Close corners in percent.
fn close(found: &RecipeMatch) -> f64 {
    100.0 * found.close as f64 / found.corners.max(1) as f64
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

//! The words of defects of tangents.

use darboux::{Choice, Method, Recipe, RecipeMatch, RecipeRounding};

use super::counts::counted;
use super::said::Said;
use crate::defect::{TangentDifference, TangentFault};
use crate::indices::Part;
use crate::measure::closeness::{
    MIN_KNOWN, MIN_MIKKTSPACE, are_most_of_mikktspace, close_percent, is_mikktspace,
};
use crate::measure::fit::Difference;
use crate::measure::outliers::FAR;
use crate::measure::recipe::{Far, Recognised};
use crate::severity::Severity;

pub fn said(fault: &TangentFault, severity: Severity) -> Said {
    match fault {
        TangentFault::Missing(vertices) => Said::new("its material has a normal map, and it has no tangents")
            .with("without tangents", *vertices as f64, "vertices"),
        TangentFault::Unused { bytes, also } => {
            let also: Vec<&str> = also.iter().map(|code| code.name()).collect();
            let also = if also.is_empty() {
                String::new()
            } else {
                format!("; if something did, they would be {}", also.join(", "))
            };
            Said::new(format!("it has tangents, and its material has nothing that reads them{also}")).with(
                "size",
                *bytes as f64,
                "bytes",
            )
        }
        TangentFault::NotFinite(part) => {
            vertices(part, ["tangent contains NaN or infinity", "tangents contain NaN or infinity"])
        }
        TangentFault::Zero(part) => vertices(part, ["tangent has length zero", "tangents have length zero"]),
        TangentFault::NotUnit(part) => {
            vertices(part, ["tangent has another length than 1", "tangents have another length than 1"])
        }
        TangentFault::SignNotOne(part) => vertices(
            part,
            [
                "tangent has a sign w that is neither 1 nor -1",
                "tangents have a sign w that is neither 1 nor -1",
            ],
        ),
        TangentFault::Leaning { vertices, worst } => {
            let what = counted(
                vertices.len(),
                "tangent is not perpendicular to its normal",
                "tangents are not perpendicular to their normals",
            );
            Said::new(format!("{what}, by up to {worst:.1} degrees")).with("largest angle", *worst, "degrees")
        }
        TangentFault::SharedAcrossMirror(part) => {
            let what = counted(part.len(), "vertex serves", "vertices serve");
            Said::of_vertices(format!("{what} both sides of mirrored UV seams"), part)
        }
        TangentFault::SignMixed(part) => {
            let what = counted(part.len(), "triangle has", "triangles have");
            Said::of_triangles(format!("{what} corners with both signs"), part)
        }
        TangentFault::Differs(difference) => differing(difference),
        TangentFault::Outliers { recipe, vertices } => outliers(recipe, vertices),
        TangentFault::OtherRecipe { recognised, far } => other_recipe(recognised, *far, severity),
    }
}

fn vertices(part: &Part, [one, many]: [&str; 2]) -> Said {
    Said::of_vertices(counted(part.len(), one, many), part)
}

fn differing(found: &TangentDifference) -> Said {
    let TangentDifference { difference, supporting, measured, uv_set, follows_from_normals, .. } = found;
    let points = || counted(*supporting, "tangent points", "tangents point");
    let text = match difference {
        Difference::SignFlipped => {
            let which = if supporting == measured { "all" } else { "nearly all" };
            let follows = if *follows_from_normals {
                "; they are right again once the normals are flipped, unless space was mirrored, which \
                 reverses faces and signs"
            } else {
                ""
            };
            format!("{which} signs w are flipped{follows}")
        }
        Difference::SignFlippedWhereMirrored => {
            "the signs w are right on one side of the mirrored UVs and flipped on the other".to_owned()
        }
        Difference::SignPartlyFlipped => {
            let triangles = counted(*supporting, "triangle", "triangles");
            format!("the signs w of all corners of {triangles} are flipped")
        }
        Difference::PartlyNegated => format!("{} against u", points()),
        Difference::PartlyRotated => format!("{} along v", points()),
        Difference::Rotated => "the tangents point along v".to_owned(),
        Difference::Negated => "the tangents point against u".to_owned(),
        Difference::OtherUvSet(other) => {
            format!("the tangents follow TEXCOORD_{other} instead of TEXCOORD_{uv_set}")
        }
    };
    let part = match difference {
        Difference::SignPartlyFlipped => "part of all triangles",
        Difference::PartlyNegated | Difference::PartlyRotated => "part of all vertices",
        _ => "part of all corners",
    };
    let said = Said::new(text).with(part, found.percent(), "%");
    match difference {
        Difference::SignPartlyFlipped | Difference::SignFlippedWhereMirrored => {
            said.with("part of the area of this surface", found.flipped_percent, "%")
        }
        _ => said,
    }
}

fn outliers(recipe: &Recipe, part: &Part) -> Said {
    let what = counted(part.len(), "tangent differs", "tangents differ");
    let text = format!(
        "{what} by more than {FAR} degrees from those of {}, which made the others, and bumps are lit from \
         wrong directions there",
        name(recipe)
    );
    Said::of_vertices(text, part)
        .with_cure("Compute these tangents again as the others were: `darboux check --fix`.")
}

fn other_recipe(recognised: &Recognised, far: Far, severity: Severity) -> Said {
    let Recognised { best, mikktspace, with_unit_normals } = recognised;
    let (mut text, nearest) = description(best);
    if *with_unit_normals {
        text += ", on normals of length 1";
    }
    let mut said = match severity {
        Severity::Error => {
            Said::new(text + ", and bumps are lit from wrong directions where they differ most")
        }
        _ => Said::new(text),
    };
    if far.are_many() {
        said = said.with("corners more than 20 degrees from MikkTSpace", far.percent, "%");
    }
    let said = said
        .with_cure("Compute the tangents again: `darboux tangents --overwrite`.")
        .with("corners within 0.1 degrees (1 with 8 bits) of MikkTSpace", close_percent(mikktspace), "%")
        .with("largest angle to MikkTSpace", mikktspace.worst, "degrees");
    match nearest {
        Some(what) if close_percent(best) < 100.0 => said.with(what, close_percent(best), "%").with(
            "largest angle to that method",
            best.worst,
            "degrees",
        ),
        Some(what) => said.with(what, close_percent(best), "%"),
        None => said,
    }
}

/// What is said of the best recipe, and the name of the evidence for it unless it is MikkTSpace.
fn description(best: &RecipeMatch) -> (String, Option<&'static str>) {
    let is_coarse = best.recipe.rounding == RecipeRounding::Bits8;
    let coarse = if is_coarse { ", or the file's numbers are rounded too coarsely to tell" } else { "" };
    if are_most_of_mikktspace(best) {
        let corners = counted(best.corners - best.close, "corner differs", "corners differ");
        (format!("most tangents are those of MikkTSpace, but {corners}"), None)
    } else if close_percent(best) >= MIN_KNOWN {
        let differ = if close_percent(best) < MIN_MIKKTSPACE { ", but some differ" } else { "" };
        let text = format!("the tangents were computed by {}{differ}", name(&best.recipe));
        (text, Some("corners within 0.1 degrees (1 with 8 bits) of this method"))
    } else {
        let text = format!("the tangents are not those of any method that Darboux knows{coarse}");
        let what = "corners within 0.1 degrees (1 with 8 bits) of the nearest known method";
        (text, Some(what).filter(|_| !is_mikktspace(best)))
    }
}

/// A recipe by the programs that use it.
pub fn name(recipe: &Recipe) -> &'static str {
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
        other => other.name(),
    }
}

//! The rule about how tangents were computed.

use super::rule::SurfaceRule;
use crate::defect::Obstacle;
use crate::defect::{Defect, TangentFault};
use crate::facts::SurfaceFacts;
use crate::indices::Part;
use crate::measure::recipe::{Far, Recipes, Recognised};
use crate::measure::uv_rounding::UvRounding;
use crate::severity::Severity;
use crate::surface::Surface;

pub const RULES: &[SurfaceRule] = &[other_recipe];

/// The largest angle to MikkTSpace in degrees that cannot be seen.
const MAX_UNSEEN: f64 = 0.5;

fn other_recipe(facts: &SurfaceFacts<'_>) -> Vec<Defect> {
    let Some(recipes) = Recipes::of(facts) else { return Vec::new() };
    let outliers = recipes.outliers.as_ref().and_then(|outliers| {
        let vertices = Part::new(&outliers.vertices, facts.surface.used_count())?;
        let fault = TangentFault::Outliers { recipe: outliers.recipe, vertices };
        Some(Defect::new(fault).with_severity(Severity::Error))
    });
    outliers.into_iter().chain(of_all(facts, &recipes)).collect()
}

/// The defect of tangents that another method than MikkTSpace made.
fn of_all(facts: &SurfaceFacts<'_>, recipes: &Recipes) -> Option<Defect> {
    let recognised = recipes.of_all.filter(|recognised| !recognised.is_of_mikktspace())?;
    let far = if recognised.other_method().is_some() { Far::default() } else { recipes.far(facts) };
    let severity = if far.are_many() {
        Severity::Error
    } else if recognised.mikktspace.worst > MAX_UNSEEN {
        Severity::Warning
    } else {
        Severity::Info
    };
    let rounding = rounding_of_uvs(facts.surface).filter(|_| recognised.other_method().is_none());
    let severity = if rounding.is_some() { severity.min(Severity::Warning) } else { severity };
    let defect = Defect::new(TangentFault::OtherRecipe { recognised, far }).with_severity(severity);
    let rounding = rounding.map(|rounding| Obstacle::UvsWereRounded { steps: rounding.steps });
    Some(defect.with_obstacle(rounding.or_else(|| obstacle(&recognised, far, severity))))
}

/// Tangents of no known method may be older than the rounding of UVs, and right.
fn rounding_of_uvs(surface: &Surface) -> Option<UvRounding> {
    UvRounding::of(surface, surface.uv_sets.get(&surface.uv_set)?)
}

/// Why tangents are left: nobody sees the difference, or the map may have been baked with them. Where most
/// are MikkTSpace's, or many point to wrong directions, they are repaired.
fn obstacle(recognised: &Recognised, far: Far, severity: Severity) -> Option<Obstacle> {
    match recognised.other_method() {
        _ if severity == Severity::Info => Some(Obstacle::DifferenceIsInvisible),
        Some(recipe) if recipe.from_quads => Some(Obstacle::BakedOnQuads),
        Some(_) => Some(Obstacle::MapMayFitTangents),
        None if far.are_many() || recognised.are_most_of_mikktspace() => None,
        None => Some(Obstacle::MapMayFitTangents),
    }
}

//! How close tangents are to those of a recipe, and what that says about who made them.

use darboux::{Method, RecipeMatch};

/// The percentage of close corners from which on tangents are those of MikkTSpace.
pub const MIN_MIKKTSPACE: f64 = 99.0;

/// The percentage from which on they are called those of another method.
pub const MIN_KNOWN: f64 = 90.0;

/// The percentage from which on these are most.
const MIN_MOST: f64 = 50.0;

/// Close corners in percent.
pub fn close_percent(found: &RecipeMatch) -> f64 {
    100.0 * found.close as f64 / found.corners.max(1) as f64
}

/// Whether a recipe is MikkTSpace on the triangles as they are.
pub fn is_mikktspace(found: &RecipeMatch) -> bool {
    matches!(found.recipe.method, Method::MikkTSpace(_)) && !found.recipe.from_quads
}

/// Whether the tangents are those of another known method.
pub fn is_other_method(found: &RecipeMatch) -> bool {
    !is_mikktspace(found) && close_percent(found) >= MIN_KNOWN
}

/// Whether MikkTSpace, as the nearest method, gives most tangents.
pub fn are_most_of_mikktspace(found: &RecipeMatch) -> bool {
    is_mikktspace(found) && close_percent(found) >= MIN_MOST
}

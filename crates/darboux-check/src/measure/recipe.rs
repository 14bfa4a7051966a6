//! How the tangents of a surface were computed.

use darboux::{Mesh, Recipe, RecipeMatch, recognise_recipe};

use crate::facts::SurfaceFacts;
use crate::measure::closeness::{
    MIN_MIKKTSPACE, are_most_of_mikktspace, close_percent, is_mikktspace, is_other_method,
};
use crate::measure::expected::is_measured;
use crate::measure::fit::{Difference, Fit};
use crate::measure::outliers::{FAR, Outliers, tangents_without_other_mistakes};
use crate::measure::values::{has_length, is_unit};
use crate::model_area::area_of;
use crate::severity::MIN_DAMAGED;
use crate::surface::{Surface, cross, dot, length, xyz};

/// The share of corners far from MikkTSpace, in percent, above which they are many.
const MAX_PERCENT_FAR: f64 = 1.0;

/// The best recipe and the best one of MikkTSpace on the triangles as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recognised {
    pub best: RecipeMatch,
    pub mikktspace: RecipeMatch,
    /// Whether the recipe shows only with normals of length 1, which the file does not have.
    pub with_unit_normals: bool,
}

/// The corners whose tangents are far from MikkTSpace's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Far {
    /// In percent of all corners.
    pub percent: f64,
    /// Their area by the angle, in the units of the positions: a right angle counts whole.
    pub damaged_area: f64,
    /// That area in percent of the area of all corners.
    pub damaged_percent: f64,
}

impl Far {
    /// Whether there are so many, by number and by area, that tangents of no known method are an error where
    /// the surface is enough of the model.
    pub fn are_many(&self) -> bool {
        self.percent > MAX_PERCENT_FAR && self.damaged_percent >= MIN_DAMAGED
    }
}

/// The recipes of a surface.
pub struct Recipes {
    /// The recipe of all tangents, or of those that are not outliers.
    pub of_all: Option<Recognised>,
    /// The tangents that are far from the method that made the others.
    pub outliers: Option<Outliers>,
}

impl Recipes {
    /// None where the tangents are MikkTSpace's bit for bit, follow other axes or UVs, or cannot be compared.
    pub fn of(facts: &SurfaceFacts<'_>) -> Option<Self> {
        let is_turned =
            |fit: &Fit| matches!(fit.difference, Some(Difference::Rotated | Difference::OtherUvSet(_)));
        let has_measured = facts.fits.iter().any(|fit| fit.measured > 0);
        // No recipe explains tangents better than one that gives all their bits.
        if !has_measured || facts.fits.iter().any(is_turned) || facts.is_mikktspace {
            return None;
        }
        // Tangents that were computed before positions were lost cannot be computed again.
        if !facts.surface.positions.as_flattened().iter().all(|x| x.is_finite()) {
            return None;
        }
        let tangents = tangents_without_other_mistakes(facts)?;
        let recognised = recognise(facts.surface, &tangents)?;
        if recognised.is_of_mikktspace() {
            return Some(Self { of_all: Some(recognised), outliers: None });
        }
        match Outliers::from(facts, tangents, &recognised.best) {
            None => Some(Self { of_all: Some(recognised), outliers: None }),
            Some(outliers) => {
                let of_all = recognise(facts.surface, &outliers.replaced);
                Some(Self { of_all, outliers: Some(outliers) })
            }
        }
    }

    /// The corners that are more than [`FAR`] from MikkTSpace around the normal, of those that lie in
    /// triangles with an area and not on mirrored seams. Tangents that are outliers, negated or rotated,
    /// or lean towards the normal, have findings of their own.
    pub fn far(&self, facts: &SurfaceFacts<'_>) -> Far {
        let surface = facts.surface;
        let (Some(tangents), Some(normals), Some(uvs), Some(expected)) =
            (&surface.tangents, &surface.normals, surface.uv_sets.get(&surface.uv_set), &facts.expected)
        else {
            return Far::default();
        };
        let mut is_other = facts.is_on_mirrored_seam.clone();
        let outliers = self.outliers.iter().flat_map(|outliers| &outliers.vertices);
        outliers.for_each(|&vertex| is_other[vertex] = true);
        let is_turned = |fit: &&Fit| {
            matches!(fit.difference, Some(Difference::PartlyNegated | Difference::PartlyRotated))
        };
        for fit in facts.fits.iter().filter(is_turned) {
            fit.items.iter().for_each(|&vertex| is_other[vertex] = true);
        }
        let angle = |vertex: usize, expected: [f32; 3]| {
            let tangent = xyz(tangents[vertex]);
            dot(cross(normals[vertex], expected), tangent).atan2(dot(expected, tangent)).to_degrees().abs()
        };
        let is_counted = |vertex: usize| has_length(tangents[vertex]) && !is_other[vertex];
        let (mut corners, mut far, mut all_area, mut damaged_area) = (0usize, 0usize, 0.0, 0.0);
        for (triangle, expected) in surface.triangles().zip(expected.as_chunks::<3>().0) {
            if !is_measured(surface, uvs, triangle) {
                continue;
            }
            let area = area_of(triangle.map(|vertex| surface.positions[vertex])) / 3.0;
            for (vertex, &expected) in
                triangle.into_iter().zip(expected).filter(|(vertex, _)| is_counted(*vertex))
            {
                (corners, all_area) = (corners + 1, all_area + area);
                let angle = angle(vertex, xyz(expected));
                if angle > FAR {
                    far += 1;
                    damaged_area += area * (angle / 90.0).min(1.0);
                }
            }
        }
        let percent = 100.0 * far as f64 / corners.max(1) as f64;
        // Without an area there is nothing to see.
        let damaged_percent = Some(100.0 * damaged_area / all_area).filter(|percent| percent.is_finite());
        Far { percent, damaged_area, damaged_percent: damaged_percent.unwrap_or(0.0) }
    }
}

impl Recognised {
    /// The known method, other than MikkTSpace on the triangles as they are.
    pub fn other_method(&self) -> Option<Recipe> {
        is_other_method(&self.best).then_some(self.best.recipe)
    }

    /// Whether the tangents of most corners are those of MikkTSpace.
    pub fn are_most_of_mikktspace(&self) -> bool {
        are_most_of_mikktspace(&self.best)
    }

    pub fn is_of_mikktspace(&self) -> bool {
        // Where MikkTSpace explains all corners, nothing shows that another recipe was used, though it may
        // have more bits in common.
        let is_explained = self.mikktspace.close == self.mikktspace.corners;
        is_explained || is_mikktspace(&self.best) && close_percent(&self.best) >= MIN_MIKKTSPACE
    }
}

/// None where no recipe can be computed. `tangents`: of corners.
fn recognise(surface: &Surface, tangents: &[[f32; 4]]) -> Option<Recognised> {
    let as_they_are = recognise_on(&surface.mesh(surface.uv_set)?, tangents)?;
    if close_percent(&as_they_are.best) >= MIN_MIKKTSPACE {
        return Some(as_they_are);
    }
    // Normals that were scaled after the tangents were computed hide how they were.
    let Some(unit) = unit_normals(surface) else { return Some(as_they_are) };
    let uvs = surface.uv_sets.get(&surface.uv_set)?;
    let mesh = Mesh::triangles(&surface.positions, &unit, &**uvs, &surface.vertex_of_corner).ok()?;
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
        // A direction that is too short to be used may still be the recipe's.
        found.close = found.close.min(found.corners);
        found
    };
    let (best, mikktspace) = (judged(best), judged(mikktspace));
    (best.corners > 0).then_some(Recognised { best, mikktspace, with_unit_normals: false })
}

/// The normals with length 1; none where all have it already. Normals without a direction stay as they are.
fn unit_normals(surface: &Surface) -> Option<Vec<[f32; 3]>> {
    let normals = surface.normals.as_ref()?;
    let is_scalable = |normal: [f32; 3]| length(normal).is_finite() && length(normal) > 0.0;
    let is_scaled = |normal: &[f32; 3]| is_scalable(*normal) && !is_unit(*normal);
    let unit = |normal: [f32; 3]| {
        let length = length(normal);
        if is_scalable(normal) { normal.map(|x| (f64::from(x) / length) as f32) } else { normal }
    };
    normals.iter().any(is_scaled).then(|| normals.iter().copied().map(unit).collect())
}

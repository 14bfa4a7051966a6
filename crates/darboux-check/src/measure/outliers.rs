//! Finds outliers: tangents that are far from the method that made most tangents, as after a part of them was
//! overwritten.
//!
//! Such damage leaves two kinds of tangents: tangents of the method, and tangents that have nothing to do
//! with it. Where many lie between the two, the method is not known. Where the method is known, a
//! few are outliers, too, if no method can have made them.

use std::borrow::Cow;

use darboux::internal::recipe_tangents;
use darboux::{Context, Convention, CornerDifference, Recipe, RecipeMatch};

use crate::facts::SurfaceFacts;
use crate::measure::closeness::is_other_method;
use crate::measure::expected::{is_measured, rounding};
use crate::measure::fit::{Difference, Fit};
use crate::measure::leaning::{in_plane, leaning};
use crate::measure::u_directions::outside_u_directions;
use crate::measure::values::{has_length, is_sign};
use crate::surface::{Surface, indices_where, length, xyz};

/// Degrees to the method's tangent beyond which one is far: bumps lean by a third of their slope (the sine).
pub const FAR: f64 = 20.0;

/// The least share of vertices with the tangents of the method.
const MIN_NEAR: f64 = 0.5;

/// The largest share of vertices between near and far: quads that were cut are estimated, and some estimates
/// are wrong.
const MAX_BETWEEN: f64 = 0.1;

/// The share above which far tangents are damage by their number: one in a hundred is seen on a model that
/// fills the screen. Fewer may be differences between versions of a method, unless no method makes them.
const MIN_FAR: f64 = 0.01;

/// The tangents that are far from the method that made the others.
pub struct Outliers {
    /// The method of the others.
    pub recipe: Recipe,
    /// The vertices, ascending.
    pub vertices: Vec<usize>,
    /// The tangents of corners without other mistakes, in the convention in which they are computed, with
    /// the method's tangents at these vertices.
    pub replaced: Vec<[f32; 4]>,
}

impl Outliers {
    /// None where no method explains most tangents, or none of the others is an outlier. `tangents`: of
    /// corners, without other mistakes; `best`: the recipe that explains them best.
    pub fn from(facts: &SurfaceFacts<'_>, mut tangents: Vec<[f32; 4]>, best: &RecipeMatch) -> Option<Self> {
        if (best.close as f64) < MIN_NEAR * best.corners as f64 {
            return None;
        }
        let surface = facts.surface;
        let made = recipe_tangents(&surface.mesh(surface.uv_set)?, &best.recipe, &mut Context::new()).ok()?;
        let angles = angles(facts, &tangents, &made)?;
        let judged = angles.iter().flatten().count() as f64;
        let count = |is_counted: &dyn Fn(f64) -> bool| {
            angles.iter().flatten().filter(|angle| is_counted(**angle)).count() as f64
        };
        let near = count(&|angle| angle <= rounding(surface));
        let far = count(&|angle| angle > FAR);
        let are_many = near >= MIN_NEAR * judged
            && far > MIN_FAR * judged
            && judged - near - far <= MAX_BETWEEN * judged;
        let old = surface.tangents.as_ref()?;
        let tangent_of = |vertex: usize| match facts.fits.iter().any(|fit| fit.is_negated(vertex)) {
            true => xyz(old[vertex]).map(|x| -x),
            false => xyz(old[vertex]),
        };
        let far = surface.used(indices_where(&angles, |angle| angle.is_some_and(|angle| angle > FAR)));
        let vertices = match are_many {
            true => far,
            // The triangles of quads may have been other ones.
            false if is_other_method(best) && !best.recipe.from_quads => {
                outside_u_directions(surface, far, tangent_of, FAR)
            }
            false => return None,
        };
        if vertices.is_empty() {
            return None;
        }
        for ((tangent, made), &vertex) in tangents.iter_mut().zip(made).zip(&surface.vertex_of_corner) {
            if vertices.binary_search(&(vertex as usize)).is_ok() {
                *tangent = made;
            }
        }
        Some(Self { recipe: best.recipe, vertices, replaced: tangents })
    }
}

/// Per vertex the smallest angle in degrees between its tangent and the method's at its corners in triangles
/// with an area; none where its tangent has another mistake, or none can be right for all its corners.
fn angles(facts: &SurfaceFacts<'_>, of_corners: &[[f32; 4]], made: &[[f32; 4]]) -> Option<Vec<Option<f64>>> {
    let Surface { tangents, normals, uv_sets, uv_set, .. } = facts.surface;
    let (tangents, normals, uvs) = (tangents.as_ref()?, normals.as_ref()?, uv_sets.get(uv_set)?);
    let has_normal = |vertex: usize| length(normals[vertex]).is_finite() && length(normals[vertex]) > 0.0;
    // Elsewhere leaning tangents are repaired before outliers matter.
    let leaning = if facts.has_repairable_tangents() { Vec::new() } else { leaning(facts) };
    let leans = |vertex: usize| leaning.binary_search_by_key(&vertex, |(leaning, _)| *leaning).is_ok();
    let is_named = |vertex: usize| {
        facts.is_on_mirrored_seam[vertex]
            || leans(vertex)
            || facts.has_own_tangent[vertex]
            || facts.fits.iter().any(|fit| fit.is_rotated(vertex))
    };
    let is_judged: Vec<bool> = (0..tangents.len())
        .map(|vertex| has_length(tangents[vertex]) && has_normal(vertex) && !is_named(vertex))
        .collect();
    let mut angles: Vec<Option<f64>> = vec![None; tangents.len()];
    let corners = of_corners.as_chunks::<3>().0.iter().zip(made.as_chunks::<3>().0);
    for (triangle, (of_corners, made)) in facts.surface.triangles().zip(corners) {
        if !is_measured(facts.surface, uvs, triangle) {
            continue;
        }
        let corners = triangle.into_iter().zip(of_corners.iter().zip(made));
        for (vertex, (tangent, made)) in corners.filter(|(vertex, _)| is_judged[*vertex]) {
            let angle = CornerDifference::between(*made, *tangent).angle;
            let smallest = &mut angles[vertex];
            *smallest = match (angle, *smallest) {
                (Some(angle), Some(other)) => Some(angle.min(other)),
                (angle, other) => angle.or(other),
            };
        }
    }
    Some(angles)
}

/// The tangents of corners as methods compute them, without the mistakes that other rules name. Invalid
/// signs, and all signs where some are flipped, become MikkTSpace's; negated directions are negated again;
/// leaning ones are laid into the plane of the normal; single rotated tangents become MikkTSpace's. None
/// where there are no tangents or none can be computed.
pub fn tangents_without_other_mistakes(facts: &SurfaceFacts<'_>) -> Option<Vec<[f32; 4]>> {
    let surface = facts.surface;
    let mut of_vertex = Cow::Borrowed(surface.tangents.as_deref()?);
    for (vertex, _) in leaning(facts) {
        let normal = surface.normals.as_ref()?[vertex];
        if let Some([x, y, z]) = in_plane(xyz(of_vertex[vertex]), normal) {
            of_vertex.to_mut()[vertex] = [x, y, z, of_vertex[vertex][3]];
        }
    }
    let to_generated = Convention::GLTF.to(Convention::GLTF.generated());
    let of_corner = |&vertex: &u32| to_generated.tangent(of_vertex[vertex as usize]);
    let mut tangents: Vec<[f32; 4]> = surface.vertex_of_corner.iter().map(of_corner).collect();
    for fit in &facts.fits {
        for (tangent, &vertex) in tangents.iter_mut().zip(&surface.vertex_of_corner) {
            if fit.is_negated(vertex as usize) {
                (0..3).for_each(|i| tangent[i] = -tangent[i]);
            }
        }
    }
    let single = [None, Some(Difference::PartlyNegated), Some(Difference::PartlyRotated)];
    let is_about_all = |fit: &Fit| !single.contains(&fit.difference);
    let all_signs = facts.reversal.is_some() || facts.fits.iter().any(is_about_all);
    let is_no_sign = |vertex: usize| !is_sign(of_vertex[vertex][3]);
    let is_rotated = |vertex: usize| facts.fits.iter().any(|fit| fit.is_rotated(vertex));
    if all_signs || (0..of_vertex.len()).any(|vertex| is_no_sign(vertex) || is_rotated(vertex)) {
        let expected = facts.expected.as_ref()?;
        for ((tangent, &vertex), expected) in tangents.iter_mut().zip(&surface.vertex_of_corner).zip(expected)
        {
            let (vertex, expected) = (vertex as usize, to_generated.tangent(*expected));
            if is_rotated(vertex) {
                *tangent = expected;
            } else if all_signs || is_no_sign(vertex) {
                tangent[3] = expected[3];
            }
        }
    }
    Some(tangents)
}

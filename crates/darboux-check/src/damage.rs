//! The damaged area of a defect: the area of the faces that show it, each weighted by the angle by which it
//! turns the light.
//!
//! A face whose tangent frame is turned by a right angle or more, or mirrored, counts whole; one that is
//! turned less counts by its angle over 90 degrees, and one that is turned by less than [`SEEN`] does not
//! count.

use crate::defect::{Fault, NormalFault, TangentDifference, TangentFault};
use crate::facts::SurfaceFacts;
use crate::indices::Indices;
use crate::measure::fit::{Difference, flips_signs};
use crate::measure::leaning::leaning;
use crate::measure::reversed::front;
use crate::model_area::area;
use crate::severity::SEEN;
use crate::surface::{Surface, dot, length};

/// The length below which a normal has no direction.
pub const NO_LENGTH: f64 = 0.1;

/// The area that a defect damages, in the squared units of the positions; none where the severity of the
/// defect does not depend on its area.
pub fn damaged_area(fault: &Fault, facts: &SurfaceFacts<'_>) -> Option<f64> {
    let surface = facts.surface;
    match fault {
        Fault::Normal(NormalFault::NotUnit { vertices, smallest }) if *smallest < NO_LENGTH => {
            let normals = surface.normals.as_ref()?;
            let has_none = |vertex: usize| if length(normals[vertex]) < NO_LENGTH { 1.0 } else { 0.0 };
            Some(area_at(surface, &vertices.items, has_none))
        }
        Fault::Normal(NormalFault::Reversed { triangles, .. }) => {
            Some(area_of_triangles(surface, &triangles.items))
        }
        Fault::Normal(NormalFault::PartlyReversed { triangles, .. }) => {
            Some(area_at_backs(surface, &triangles.items))
        }
        Fault::Tangent(fault) => of_tangents(fault, facts),
        _ => None,
    }
}

fn of_tangents(fault: &TangentFault, facts: &SurfaceFacts<'_>) -> Option<f64> {
    let surface = facts.surface;
    let at = |vertices: &Indices| Some(area_at(surface, vertices, |_| 1.0));
    match fault {
        TangentFault::SignMixed(triangles) => Some(area_of_triangles(surface, &triangles.items)),
        TangentFault::SharedAcrossMirror(_) => Some(area_with_other_sign(facts)),
        TangentFault::SignNotOne(part) | TangentFault::NotUnit(part) => at(&part.items),
        TangentFault::Outliers { vertices, .. } => at(&vertices.items),
        TangentFault::Leaning { .. } => {
            let leaning = leaning(facts);
            let vertices: Vec<usize> = leaning.iter().map(|(vertex, _)| *vertex).collect();
            let weight = |vertex: usize| {
                let found = leaning.binary_search_by_key(&vertex, |(leaning, _)| *leaning);
                let degrees = found.map_or(0.0, |index| leaning[index].1);
                if degrees > SEEN { (degrees / 90.0).min(1.0) } else { 0.0 }
            };
            Some(area_at(surface, &vertices.as_slice().into(), weight))
        }
        TangentFault::Differs(found) => Some(of_difference(facts, found)),
        TangentFault::OtherRecipe { far, .. } if far.percent > 0.0 => Some(far.damaged_area),
        _ => None,
    }
}

fn of_difference(facts: &SurfaceFacts<'_>, found: &TangentDifference) -> f64 {
    let surface = facts.surface;
    match found.difference {
        // The side with more corners may be the smaller one.
        Difference::SignFlippedWhereMirrored => {
            let are_opposite = flips_signs(facts.reversal);
            area_of_corners(facts, |differs, _| differs != are_opposite)
        }
        Difference::SignPartlyFlipped => area_of_triangles(surface, &found.items),
        Difference::PartlyNegated | Difference::PartlyRotated => area_at(surface, &found.items, |_| 1.0),
        Difference::SignFlipped => area_of_all(surface) * found.flipped_percent / 100.0,
        _ => area_of_all(surface) * found.percent() / 100.0,
    }
}

fn area_of_all(surface: &Surface) -> f64 {
    surface.triangles().map(|triangle| area(surface, triangle)).sum()
}

fn area_of_triangles(surface: &Surface, triangles: &Indices) -> f64 {
    let numbered = surface.triangles().enumerate();
    let found = numbered.filter(|(number, _)| triangles.contains(*number));
    found.map(|(_, triangle)| area(surface, triangle)).sum()
}

/// A third of the area of each of some triangles for each corner whose normal points to its back.
fn area_at_backs(surface: &Surface, triangles: &Indices) -> f64 {
    let Some(normals) = &surface.normals else { return 0.0 };
    let numbered = surface.triangles().enumerate();
    let found = numbered.filter(|(number, _)| triangles.contains(*number));
    let at_backs = |(_, triangle): (usize, [usize; 3])| {
        let front = front(triangle.map(|vertex| surface.positions[vertex]));
        let points_back = |vertex: &&usize| front.is_some_and(|front| dot(front, normals[**vertex]) < 0.0);
        area(surface, triangle) * triangle.iter().filter(points_back).count() as f64 / 3.0
    };
    found.map(at_backs).sum()
}

/// A third of the area of each triangle at a vertex, times the weight of that vertex.
fn area_at(surface: &Surface, vertices: &Indices, weight: impl Fn(usize) -> f64) -> f64 {
    let of_triangle = |triangle: [usize; 3]| {
        let found = triangle.into_iter().filter(|&vertex| vertices.contains(vertex));
        let weights: f64 = found.map(&weight).sum();
        if weights > 0.0 { area(surface, triangle) * weights / 3.0 } else { 0.0 }
    };
    surface.triangles().map(of_triangle).sum()
}

/// The area of the corners on mirrored seams whose tangent has the sign of the other side. If most signs of
/// the surface are flipped, which is a defect of its own, these are the corners with the sign of MikkTSpace.
fn area_with_other_sign(facts: &SurfaceFacts<'_>) -> f64 {
    let beside_seams = |vertex: usize| !facts.is_on_mirrored_seam[vertex];
    let differing = area_of_corners(facts, |differs, vertex| differs && beside_seams(vertex));
    let all = area_of_corners(facts, |_, vertex| beside_seams(vertex));
    let are_flipped = 2.0 * differing > all;
    area_of_corners(facts, |differs, vertex| !beside_seams(vertex) && differs != are_flipped)
}

/// The area of some corners, each a third of its triangle. `counts` chooses them: it gets whether the sign of
/// the corner's tangent differs from MikkTSpace's, and the corner's vertex.
fn area_of_corners(facts: &SurfaceFacts<'_>, counts: impl Fn(bool, usize) -> bool) -> f64 {
    let (Some(tangents), Some(expected)) = (&facts.surface.tangents, &facts.expected) else { return 0.0 };
    let of_triangle = |(triangle, expected): ([usize; 3], &[[f32; 4]; 3])| {
        let counts = |(vertex, expected): &(usize, &[f32; 4])| {
            counts((expected[3] < 0.0) != (tangents[*vertex][3] < 0.0), *vertex)
        };
        let count = triangle.into_iter().zip(expected).filter(counts).count();
        area(facts.surface, triangle) * count as f64 / 3.0
    };
    facts.surface.triangles().zip(expected.as_chunks::<3>().0).map(of_triangle).sum()
}

//! Corrects the tangents of a surface that findings name one by one, and keeps the bits of all others.
//!
//! A tangent without a direction gets the direction of the recipe that explains the other tangents, or, where
//! no recipe does, of the method that is asked for. A tangent that is not unit or leans keeps its direction:
//! it gets the recipe's bits where the recipe points the same way; otherwise it is projected into the plane
//! of its normal and normalised. Signs follow the UVs.

use std::collections::{BTreeMap, BTreeSet};

use darboux::internal::recipe_tangents;
use darboux::{
    Context, Convention, CornerDifference, Method, Recipe, RecipeMatch, generate_tangents, recognise_recipe,
};

use crate::code::Code;
use crate::measure::expected::{is_measured, rounding, vertices_with_own_tangents};
use crate::measure::fit::{flips_signs, is_at_most_a_part};
use crate::measure::leaning::in_plane;
use crate::measure::reversal::Sides;
use crate::measure::values::{MIN_SIGN, UNIT, has_length, is_finite, is_sign};
use crate::repair::options::FixOptions;
use crate::repair::plan::WrongTangents;
use crate::surface::{Surface, length, xyz};

/// The share of close corners from which on a recipe explains tangents.
const EXPLAINED: f64 = 0.9;

/// The share from which on the default of MikkTSpace does, whatever other recipes give: on simple surfaces
/// all give the same.
const IS_MIKKTSPACE: f64 = 0.99;

/// The tangents of all corners of a surface, in glTF's convention; some were corrected.
pub struct Correction {
    pub surface: Surface,
    pub tangent_of_corner: Vec<[f32; 4]>,
}

impl Correction {
    /// Corrects wrong tangents; none where the surface lacks what is needed. `options`: the method where no
    /// recipe is recognised.
    pub fn new(surface: Surface, wrong: &WrongTangents, options: &FixOptions) -> Option<Self> {
        let among = surface.vertices_in_file.as_ref().map(|in_file| wrong.among(in_file));
        let wrong = among.as_ref().unwrap_or(wrong);
        let corrector = Corrector::new(&surface, wrong, options)?;
        let corrected = corrector.corrected()?;
        let is_mixed = wrong.codes.contains(&Code::TangentSignMixed);
        let tangent_of_corner = if is_mixed { corrector.unmixed(corrected) } else { corrected };
        Some(Self { surface, tangent_of_corner })
    }

    /// The tangents of the vertices that triangles use, by their indices in the file; none where the corners
    /// of a vertex have different ones.
    pub fn of_vertices(&self) -> Option<BTreeMap<usize, [f32; 4]>> {
        let mut of_vertices = BTreeMap::new();
        for (&vertex, &tangent) in self.surface.vertex_of_corner.iter().zip(&self.tangent_of_corner) {
            let vertex = self.surface.vertex_in_file(vertex as usize);
            if bits(*of_vertices.entry(vertex).or_insert(tangent)) != bits(tangent) {
                return None;
            }
        }
        Some(of_vertices)
    }

    /// The number of vertices with a corner whose tangent changes.
    pub fn changed_count(&self) -> usize {
        let Some(old) = &self.surface.tangents else { return 0 };
        let corners = self.surface.vertex_of_corner.iter().zip(&self.tangent_of_corner);
        let changed = corners.filter(|(vertex, new)| bits(old[**vertex as usize]) != bits(**new));
        changed.map(|(vertex, _)| *vertex).collect::<BTreeSet<u32>>().len()
    }
}

/// The bits of a tangent, which tell whether it changes.
pub fn bits(tangent: [f32; 4]) -> [u32; 4] {
    tangent.map(f32::to_bits)
}

/// What becomes of the xyz of a vertex's tangent.
#[derive(Clone, Copy, PartialEq)]
enum Direction {
    /// These bits.
    Exact([f32; 3]),
    /// The recipe's where it points this way, and this one elsewhere.
    Near([f32; 3]),
    /// The recipe's.
    Unknown,
}

/// The sign that the corners of a vertex should have.
#[derive(Clone, Copy, PartialEq)]
enum VertexSign {
    /// No corner has a reliable sign.
    Unknown,
    /// The sign of all corners whose sign is reliable; true for -1.
    Same(bool),
    /// The vertex lies on a mirrored seam.
    Both,
}

struct Corrector<'a> {
    surface: &'a Surface,
    tangents: &'a [[f32; 4]],
    wrong: &'a WrongTangents,
    options: &'a FixOptions,
    /// Per vertex whether its tangent is MikkTSpace's for a degenerate corner, which is no evidence.
    has_own_tangent: Vec<bool>,
    /// MikkTSpace's tangents of the corners, with the signs that are right here.
    expected: Vec<[f32; 4]>,
    /// Whether those are the opposite of MikkTSpace's.
    flips: bool,
    /// Per vertex whether the sign of its first corner should be -1.
    is_first_negative: Vec<bool>,
    /// Per triangle whether it is not UV-degenerate and its side is not in doubt.
    has_reliable_sign: Vec<bool>,
    signs: Vec<VertexSign>,
    /// Per vertex whether a defect that is to be repaired is about its sign.
    has_named_sign: Vec<bool>,
}

/// The tangents of corners by the recipe of the file.
struct Reference {
    tangents: Vec<[f32; 4]>,
    /// Whether they are the bits of the file. Where they are not, all corners of a vertex with one sign get
    /// the tangent of the first.
    is_exact: bool,
}

impl<'a> Corrector<'a> {
    fn new(surface: &'a Surface, wrong: &'a WrongTangents, options: &'a FixOptions) -> Option<Self> {
        let tangents = surface.tangents.as_ref()?;
        let uvs = surface.uv_sets.get(&surface.uv_set)?;
        let mut expected = surface.expected_tangents(surface.uv_set)?;
        let has_own_tangent = vertices_with_own_tangents(surface, &expected);
        // Where flipped signs are to stay, the others follow them.
        let follows_flipped = wrong.are_most_flipped
            && !wrong.codes.contains(&Code::TangentSignFlipped)
            && !wrong.codes.contains(&Code::TangentSignPartlyFlipped)
            && !wrong.codes.contains(&Code::TangentSignFlippedWhereMirrored);
        let flips = flips_signs(wrong.reversal) != follows_flipped;
        if flips {
            expected.iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
        }
        let mut has_reliable_sign: Vec<bool> =
            surface.triangles().map(|triangle| is_measured(surface, uvs, triangle)).collect();
        if is_at_most_a_part(wrong.reversal) {
            Sides::of(surface).against.into_iter().for_each(|triangle| has_reliable_sign[triangle] = false);
        }
        let mut signs = vec![VertexSign::Unknown; tangents.len()];
        let mut is_first_negative = vec![false; tangents.len()];
        for (corner, &vertex) in surface.vertex_of_corner.iter().enumerate().rev() {
            let sign = &mut signs[vertex as usize];
            is_first_negative[vertex as usize] = expected[corner][3] < 0.0;
            let own = VertexSign::Same(expected[corner][3] < 0.0);
            if has_reliable_sign[corner / 3] {
                *sign = if *sign == VertexSign::Unknown || *sign == own { own } else { VertexSign::Both };
            }
        }
        Some(Self {
            has_named_sign: with_named_signs(surface, wrong),
            surface,
            tangents,
            wrong,
            options,
            has_own_tangent,
            expected,
            flips,
            is_first_negative,
            has_reliable_sign,
            signs,
        })
    }

    fn repairs(&self, code: Code) -> bool {
        self.wrong.codes.contains(&code)
    }

    /// The tangents of all corners; none where no recipe can be computed.
    fn corrected(&self) -> Option<Vec<[f32; 4]>> {
        let directions: Vec<Direction> =
            (0..self.tangents.len()).map(|vertex| self.direction(vertex)).collect();
        let of_vertex: Vec<[f32; 4]> =
            (0..self.tangents.len()).map(|vertex| self.kept(vertex, directions[vertex])).collect();
        let is_on_seam = |vertex: usize| {
            self.repairs(Code::TangentSharedAcrossMirror) && self.signs[vertex] == VertexSign::Both
        };
        let is_unknown = |vertex: usize| directions[vertex] == Direction::Unknown;
        let numbered = || self.surface.vertex_of_corner.iter().map(|&vertex| vertex as usize).enumerate();
        let needs_reference = |vertex: usize| {
            is_unknown(vertex) || is_on_seam(vertex) || matches!(directions[vertex], Direction::Near(_))
        };
        if !numbered().any(|(_, vertex)| needs_reference(vertex)) {
            return Some(numbered().map(|(_, vertex)| of_vertex[vertex]).collect());
        }
        let reference = self.reference(&of_vertex, &directions)?;
        let near = self.nearest(&reference, &directions, of_vertex.clone());
        let first = self.first_corners();
        let is_new = |corner: usize, vertex: usize| {
            let is_wrong_side = (self.expected[corner][3] < 0.0) != (of_vertex[vertex][3] < 0.0);
            is_unknown(vertex)
                || is_on_seam(vertex)
                    && self.has_reliable_sign[corner / 3]
                    && (is_wrong_side || reference.is_exact)
        };
        let corrected = numbered().map(|(corner, vertex)| match is_new(corner, vertex) {
            true => self.made(&reference, &first, corner),
            false => near[vertex],
        });
        Some(corrected.collect())
    }

    /// What becomes of the direction of a vertex.
    fn direction(&self, vertex: usize) -> Direction {
        let tangent = self.tangents[vertex];
        let old = xyz(tangent);
        let (has_numbers, is_zero) =
            (old.iter().all(|x| x.is_finite()), !has_length([old[0], old[1], old[2], 1.0]));
        if !is_finite(tangent) && (!has_numbers || is_zero) && self.repairs(Code::TangentNotFinite) {
            return Direction::Unknown;
        }
        if is_zero {
            let is_repaired = is_finite(tangent) && self.repairs(Code::TangentZero);
            return if is_repaired { Direction::Unknown } else { Direction::Exact(old) };
        }
        let is_outlier = self.wrong.outliers.contains(vertex) && self.repairs(Code::TangentOtherRecipe);
        let is_rotated = self.wrong.rotated.contains(vertex) && self.repairs(Code::TangentRotated);
        if is_outlier || is_rotated {
            return Direction::Unknown;
        }
        let kept = if self.is_negated(vertex) { old.map(|x| -x) } else { old };
        let is_other_length = (length(kept) - 1.0).abs() > UNIT;
        if self.repairs(Code::TangentNotPerpendicular) && self.wrong.leaning.contains(vertex) {
            let normal = self.surface.normals.as_ref().map(|normals| normals[vertex]);
            let laid = normal.and_then(|normal| in_plane(kept, normal));
            return laid.map_or(Direction::Unknown, Direction::Near);
        }
        match is_other_length && self.repairs(Code::TangentNotUnit) {
            true => Direction::Near(kept.map(|x| (f64::from(x) / length(kept)) as f32)),
            false => Direction::Exact(kept),
        }
    }

    fn is_negated(&self, vertex: usize) -> bool {
        self.repairs(Code::TangentNegated) && self.wrong.negated.contains(vertex)
    }

    /// Whether the direction of a vertex is evidence of the recipe that made it: it is known, and not one
    /// that is wrong and stays.
    fn is_judged(&self, vertex: usize, direction: Direction) -> bool {
        match direction {
            Direction::Unknown => false,
            Direction::Near(_) => true,
            Direction::Exact(_) => {
                let WrongTangents { negated, rotated, outliers, .. } = self.wrong;
                let stays_negated = !self.repairs(Code::TangentNegated) && negated.contains(vertex);
                let is_wrong = stays_negated || rotated.contains(vertex) || outliers.contains(vertex);
                has_length(self.tangents[vertex]) && !is_wrong
            }
        }
    }

    /// Gives UV-degenerate faces whose corners have both signs MikkTSpace's tangents, which come from
    /// neighbours.
    fn unmixed(&self, mut tangent_of_corner: Vec<[f32; 4]>) -> Vec<[f32; 4]> {
        let is_own = |vertex: &usize| self.has_own_tangent[*vertex];
        for (number, triangle) in self.surface.triangles().enumerate() {
            let corners = 3 * number..3 * number + 3;
            let is_negative = |corner: usize| tangent_of_corner[corner][3] < 0.0;
            let is_mixed = corners.clone().any(|corner| is_negative(corner) != is_negative(3 * number));
            if is_mixed && !self.has_reliable_sign[number] && !triangle.iter().all(is_own) {
                tangent_of_corner[corners.clone()].copy_from_slice(&self.expected[corners]);
            }
        }
        tangent_of_corner
    }

    /// The tangent of a vertex with its direction and the sign of the side on which it stays.
    fn kept(&self, vertex: usize, direction: Direction) -> [f32; 4] {
        let [x, y, z] = match direction {
            Direction::Exact(xyz) | Direction::Near(xyz) => xyz,
            Direction::Unknown => [f32::NAN; 3],
        };
        [x, y, z, self.sign(vertex)]
    }

    fn sign(&self, vertex: usize) -> f32 {
        let tangent = self.tangents[vertex];
        let w = tangent[3];
        let right = |is_negative: bool| if is_negative { -1.0 } else { 1.0 };
        let is_none = match is_finite(tangent) {
            true => !is_sign(w) && self.repairs(Code::TangentSignNotOne),
            false => self.repairs(Code::TangentNotFinite),
        };
        let old = if is_none && w.is_finite() && w.abs() >= MIN_SIGN { w.signum() } else { w };
        let has_sign = old.is_finite() && old.abs() >= MIN_SIGN;
        let is_wrong = self.has_named_sign[vertex];
        match self.signs[vertex] {
            VertexSign::Same(sign) if !has_sign && is_none => right(sign),
            VertexSign::Same(sign) if has_sign && is_wrong && sign != (old < 0.0) => {
                if self.has_own_tangent[vertex] { old } else { -old }
            }
            VertexSign::Unknown | VertexSign::Both if !has_sign && is_none => {
                right(self.is_first_negative[vertex])
            }
            _ => old,
        }
    }

    /// The tangents of corners by the recipe that explains the right ones.
    fn reference(&self, of_vertex: &[[f32; 4]], directions: &[Direction]) -> Option<Reference> {
        let mesh = self.surface.mesh(self.surface.uv_set)?;
        let (own, generated) = (Convention::GLTF, Convention::GLTF.generated());
        // The directions decide: all signs are MikkTSpace's.
        let of_corner = |(&vertex, expected): (&u32, &[f32; 4])| {
            let ([x, y, z, _], w) = (of_vertex[vertex as usize], expected[3]);
            own.to(generated).tangent([x, y, z, if self.flips { -w } else { w }])
        };
        let tangents: Vec<[f32; 4]> =
            self.surface.vertex_of_corner.iter().zip(&self.expected).map(of_corner).collect();
        let matches = recognise_recipe(&mesh, &tangents).ok()?;
        // Only tangents that are known can be the recipe's. Of a large mesh, some recipes are compared on a
        // sample.
        let vertices = self.surface.vertex_of_corner.iter().map(|&vertex| vertex as usize);
        let judged = vertices.filter(|&vertex| self.is_judged(vertex, directions[vertex])).count();
        let scale = tangents.len() as f64 / judged.max(1) as f64;
        let share =
            |count: usize, of: &RecipeMatch| (scale * count as f64 / of.corners.max(1) as f64).min(1.0);
        let is_default = |found: &&RecipeMatch| {
            let Recipe { method, flips_v, from_quads, .. } = found.recipe;
            method == Method::default() && !flips_v && !from_quads
        };
        let default =
            matches.iter().find(is_default).filter(|found| share(found.close, found) >= IS_MIKKTSPACE);
        let best = default.or(matches.first().filter(|found| share(found.close, found) >= EXPLAINED));
        let is_exact = best.is_some_and(|best| share(best.identical, best) >= EXPLAINED);
        let made = match best {
            Some(best) => recipe_tangents(&mesh, &best.recipe, &mut Context::new()).ok()?,
            None => generate_tangents(&mesh, &self.options.tangents).corners.into_per_corner(),
        };
        let back = generated.to(own);
        let with_right_sign = |(made, expected): ([f32; 4], &[f32; 4])| {
            let [x, y, z, w] = back.tangent(made);
            let is_other_side = ((w < 0.0) != (expected[3] < 0.0)) != self.flips;
            if is_other_side { *expected } else { [x, y, z, expected[3]] }
        };
        let tangents = made.into_iter().zip(&self.expected).map(with_right_sign).collect();
        Some(Reference { tangents, is_exact })
    }

    /// The tangents of vertices, those near the recipe's with its bits.
    fn nearest(
        &self,
        reference: &Reference,
        directions: &[Direction],
        mut of_vertex: Vec<[f32; 4]>,
    ) -> Vec<[f32; 4]> {
        let tolerance = rounding(self.surface);
        let mut is_found = vec![false; of_vertex.len()];
        for (&vertex, made) in self.surface.vertex_of_corner.iter().zip(&reference.tangents) {
            let vertex = vertex as usize;
            if is_found[vertex] || !matches!(directions[vertex], Direction::Near(_)) {
                continue;
            }
            let difference = CornerDifference::between(of_vertex[vertex], *made);
            if difference.angle.is_some_and(|angle| angle <= tolerance) {
                let [x, y, z, _] = *made;
                of_vertex[vertex] = [x, y, z, of_vertex[vertex][3]];
                is_found[vertex] = true;
            }
        }
        of_vertex
    }

    /// Per vertex the first corner with the sign 1, and with -1, of those that tell.
    fn first_corners(&self) -> Vec<[Option<usize>; 2]> {
        let mut first = vec![[None; 2]; self.tangents.len()];
        for (corner, &vertex) in self.surface.vertex_of_corner.iter().enumerate() {
            if self.has_reliable_sign[corner / 3] {
                let is_negative = self.expected[corner][3] < 0.0;
                first[vertex as usize][usize::from(is_negative)].get_or_insert(corner);
            }
        }
        first
    }

    /// The tangent of a corner by the recipe. A corner without evidence takes the tangent of another corner
    /// of its vertex.
    fn made(&self, reference: &Reference, first: &[[Option<usize>; 2]], corner: usize) -> [f32; 4] {
        let [positive, negative] = first[self.surface.vertex_of_corner[corner] as usize];
        let is_negative = self.expected[corner][3] < 0.0;
        let other = match (self.has_reliable_sign[corner / 3], reference.is_exact) {
            (true, true) => None,
            (true, false) => [positive, negative][usize::from(is_negative)],
            (false, _) => positive.or(negative),
        };
        reference.tangents[other.unwrap_or(corner)]
    }
}

/// Per vertex whether a defect that is to be repaired is about its sign, which has a value, but may be the
/// wrong one.
fn with_named_signs(surface: &Surface, wrong: &WrongTangents) -> Vec<bool> {
    let has = |code: Code| wrong.codes.contains(&code);
    let count = surface.positions.len();
    if has(Code::TangentSignFlipped) || has(Code::TangentSignFlippedWhereMirrored) {
        return vec![true; count];
    }
    let mut is_named = vec![false; count];
    let triangles: Vec<[usize; 3]> = surface.triangles().collect();
    let mut name =
        |triangle: usize| triangles[triangle].into_iter().for_each(|vertex| is_named[vertex] = true);
    if has(Code::TangentSignMixed) {
        wrong.mixed.iter().for_each(&mut name);
    }
    if has(Code::TangentSignPartlyFlipped) {
        wrong.flipped.iter().for_each(&mut name);
    }
    is_named
}

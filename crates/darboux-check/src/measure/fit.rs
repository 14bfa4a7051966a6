//! Compares the tangents of a surface with those that MikkTSpace gives, and says in one word how they differ.
//!
//! The rules about tangents that follow other directions or signs exclude each other, so one measurement
//! decides among them.

use std::collections::BTreeSet;
use std::sync::Arc;

use darboux::CornerDifference;

use crate::measure::expected::{is_measured, on_mirrored_seams};
use crate::measure::reversal::{Reversal, Sides, Undecided};
use crate::measure::turned::{Turned, turned};
use crate::measure::values::MIN_SIGN;
use crate::model_area::area;
use crate::surface::{Surface, cross, dot, indices_where, xyz};

/// How the tangents of a file differ from MikkTSpace's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Difference {
    /// The signs of all corners are flipped.
    SignFlipped,
    /// The signs are flipped on mirrored parts only, or on unmirrored parts only.
    SignFlippedWhereMirrored,
    /// The signs of some triangles are flipped at all corners.
    SignPartlyFlipped,
    /// They point along the bitangents.
    Rotated,
    /// They point the opposite way.
    Negated,
    /// Some point the opposite way.
    PartlyNegated,
    /// Some point along the bitangents, or against them.
    PartlyRotated,
    /// They follow another UV set.
    OtherUvSet(usize),
}

/// The measurement.
pub struct Fit {
    /// None where they point the same way, up to the differences between methods, or in no known way.
    pub difference: Option<Difference>,
    /// What was measured: corners with usable tangents whose vertices do not lie on mirrored seams;
    /// triangles or vertices for a difference of a part of the surface.
    pub measured: usize,
    /// The corners that support the difference.
    pub supporting: usize,
    /// The numbers of these triangles or vertices.
    pub items: Vec<usize>,
    /// Where most tangents are negated, the vertices whose tangents are not, ascending.
    pub exceptions: Vec<usize>,
    /// By area, the part of what was measured whose signs are flipped, in percent.
    pub flipped_percent: f64,
}

/// The smallest share of the corners that decides.
const MIN_SHARE: f64 = 0.9;

/// The largest share of corners, and of their area, whose sign may contradict the others.
const MAX_SIGN_ERRORS: f64 = 0.01;

/// The largest number of other UV sets that tangents are compared with, which bounds the time.
const MAX_OTHER_SETS: usize = 16;

/// Corners by the direction that is nearest to the file's tangent, and by sign.
#[derive(Default)]
struct Counts {
    corners: usize,
    along: usize,
    against: usize,
    across: usize,
    /// Corners within one degree.
    near: usize,
    /// The supporting corners that have the same sign.
    close: usize,
    /// Per orientation (unmirrored, mirrored): corners whose sign can be judged.
    signs: [Signs; 2],
    /// Triangles with three of these, and the numbers of those whose three signs differ.
    of_triangles: Signs,
    flipped_triangles: Vec<usize>,
}

/// Corners or triangles, and those whose sign differs, by their number and by their area.
#[derive(Clone, Copy, Default)]
struct Signs {
    count: usize,
    flipped: usize,
    area: f64,
    flipped_area: f64,
}

impl Signs {
    fn add(&mut self, is_flipped: bool, area: f64) {
        self.count += 1;
        self.area += area;
        self.flipped += usize::from(is_flipped);
        self.flipped_area += if is_flipped { area } else { 0.0 };
    }

    fn with(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            flipped: self.flipped + other.flipped,
            area: self.area + other.area,
            flipped_area: self.flipped_area + other.flipped_area,
        }
    }

    /// By area, the flipped part in percent; by number where nothing has an area.
    fn flipped_percent(self) -> f64 {
        let by_area = 100.0 * self.flipped_area / self.area;
        if by_area.is_finite() { by_area } else { 100.0 * self.flipped as f64 / self.count.max(1) as f64 }
    }

    /// Whether these are no more than a part of others, by number and by area.
    fn are_few_of(self, all: Self, part: f64) -> bool {
        self.count as f64 <= part * all.count as f64 && self.area <= part * all.area
    }

    /// Whether all but a part are flipped.
    fn are_flipped_but(self, part: f64) -> bool {
        self.flipped as f64 >= (1.0 - part) * self.count as f64
            && self.flipped_area >= (1.0 - part) * self.area
    }

    /// Whether no more than a part is flipped.
    fn are_kept_but(self, part: f64) -> bool {
        self.flipped as f64 <= part * self.count as f64 && self.flipped_area <= part * self.area
    }
}

/// Measures: how the directions differ, and how the signs do where that is a difference of its own. Nothing
/// where the surface has no tangents, normals or UVs. `expected`: MikkTSpace's tangents of all corners.
/// `is_on_seam`: per vertex whether it lies on a mirrored UV seam.
pub fn measure(
    surface: &Surface,
    expected: &[[f32; 4]],
    is_on_seam: &[bool],
    winding: Winding<'_>,
) -> Vec<Fit> {
    let comparison = Comparison::new(surface, surface.uv_set, (expected, is_on_seam), winding);
    let Some(own) = comparison.map(|comparison| comparison.counts()) else { return Vec::new() };
    let share = |part: usize| part as f64 / own.corners.max(1) as f64;
    let fit = |difference, supporting| Fit {
        difference,
        measured: own.corners,
        supporting,
        items: Vec::new(),
        exceptions: Vec::new(),
        flipped_percent: 0.0,
    };
    let all_signs = own.signs[0].with(own.signs[1]);
    let flipped_percent = all_signs.flipped_percent();
    let signs = by_signs(&own);
    let of_signs = || signs.map(|signs| Fit { flipped_percent, ..fit(Some(signs), all_signs.flipped) });
    if own.corners == 0 {
        return vec![fit(None, 0)];
    }
    if let Some((set, other)) = other_uv_set(surface, &own, winding) {
        let of_signs = of_signs().filter(|_| by_signs(&other).is_some());
        return [fit(Some(Difference::OtherUvSet(set)), other.near)].into_iter().chain(of_signs).collect();
    }
    if share(own.along) >= MIN_SHARE {
        return match of_signs() {
            Some(signs) => [signs].into_iter().chain(partly_turned(surface, expected)).collect(),
            None => or_else(partly(surface, expected, &own), || fit(None, own.along)),
        };
    }
    let turned = if share(own.against) >= MIN_SHARE {
        let exceptions = along(surface, expected);
        Fit { exceptions, ..fit(Some(Difference::Negated), own.against) }
    } else if share(own.across) >= MIN_SHARE {
        fit(Some(Difference::Rotated), own.across)
    } else {
        return or_else(partly(surface, expected, &own), || fit(None, 0));
    };
    [turned].into_iter().chain(of_signs()).collect()
}

/// The fits, or another one where there are none.
fn or_else(fits: Vec<Fit>, other: impl FnOnce() -> Fit) -> Vec<Fit> {
    if fits.is_empty() { vec![other()] } else { fits }
}

/// The other UV set that the tangents follow, and how they do: with its signs, or else in their directions
/// alone.
fn other_uv_set(surface: &Surface, own: &Counts, winding: Winding<'_>) -> Option<(usize, Counts)> {
    let is_most = |part: usize, of: &Counts| part as f64 >= MIN_SHARE * of.corners.max(1) as f64;
    if is_most(own.close, own) {
        return None;
    }
    let counts = |&set: &usize| {
        let expected = surface.expected_tangents(set)?;
        let is_on_seam = on_mirrored_seams(surface, set, &expected);
        let counts = Comparison::new(surface, set, (&expected, &is_on_seam), winding)?.counts();
        Some((set, counts))
    };
    // Sets of one accessor are compared once.
    let mut seen: BTreeSet<*const Vec<[f32; 2]>> =
        surface.uv_sets.get(&surface.uv_set).map(Arc::as_ptr).into_iter().collect();
    let others = surface.uv_sets.iter().filter(|(_, uvs)| seen.insert(Arc::as_ptr(uvs)));
    let mut in_directions = None;
    for (set, other) in others.take(MAX_OTHER_SETS).filter_map(|(set, _)| counts(set)) {
        if is_most(other.close, &other) {
            return Some((set, other));
        }
        if in_directions.is_none() && !is_most(own.near, own) && is_most(other.near, &other) {
            in_directions = Some((set, other));
        }
    }
    in_directions
}

/// The differences of parts of the surface.
fn partly(surface: &Surface, expected: &[[f32; 4]], counts: &Counts) -> Vec<Fit> {
    let Counts { of_triangles, flipped_triangles, .. } = counts;
    let flipped = Fit::of_part(Difference::SignPartlyFlipped, flipped_triangles.clone(), of_triangles.count);
    let flipped = flipped.map(|fit| Fit { flipped_percent: of_triangles.flipped_percent(), ..fit });
    flipped.into_iter().chain(partly_turned(surface, expected)).collect()
}

/// Single tangents that point against u, and along v.
fn partly_turned(surface: &Surface, expected: &[[f32; 4]]) -> Vec<Fit> {
    let Turned { negated, rotated } = turned(surface, expected);
    let of = |difference, items| Fit::of_part(difference, surface.used(items), surface.used_count());
    let parts = [of(Difference::PartlyNegated, negated), of(Difference::PartlyRotated, rotated)];
    parts.into_iter().flatten().collect()
}

/// The vertices whose tangents point along MikkTSpace's at most of their corners in triangles with an area.
fn along(surface: &Surface, expected: &[[f32; 4]]) -> Vec<usize> {
    let (Some(tangents), Some(uvs)) = (&surface.tangents, surface.uv_sets.get(&surface.uv_set)) else {
        return Vec::new();
    };
    let mut sums = vec![0.0; tangents.len()];
    for (triangle, expected) in surface.triangles().zip(expected.as_chunks::<3>().0) {
        if is_measured(surface, uvs, triangle) {
            for (vertex, expected) in triangle.into_iter().zip(expected) {
                sums[vertex] += dot(xyz(*expected), xyz(tangents[vertex]));
            }
        }
    }
    indices_where(&sums, |sum| *sum > 0.0)
}

impl Fit {
    /// Whether the tangent of a vertex is one of those that are turned by a right angle, where most are not.
    pub fn is_rotated(&self, vertex: usize) -> bool {
        self.difference == Some(Difference::PartlyRotated) && self.items.binary_search(&vertex).is_ok()
    }

    /// Whether the tangent of a vertex is negated.
    pub fn is_negated(&self, vertex: usize) -> bool {
        match self.difference {
            Some(Difference::Negated) => self.exceptions.binary_search(&vertex).is_err(),
            Some(Difference::PartlyNegated) => self.items.binary_search(&vertex).is_ok(),
            _ => false,
        }
    }

    /// None without items.
    fn of_part(difference: Difference, items: Vec<usize>, measured: usize) -> Option<Self> {
        let (difference, supporting) = (Some(difference), items.len());
        let (exceptions, flipped_percent) = (Vec::new(), 0.0);
        let part = Self { difference, measured, supporting, items, exceptions, flipped_percent };
        (supporting > 0).then_some(part)
    }
}

fn by_signs(counts: &Counts) -> Option<Difference> {
    let [unmirrored, mirrored] = counts.signs;
    let all = unmirrored.with(mirrored);
    // An orientation with no more corners than may contradict the others decides nothing.
    let is_few = |of: Signs| of.are_few_of(all, MAX_SIGN_ERRORS);
    let is_flipped = |of: Signs| !is_few(of) && of.are_flipped_but(MAX_SIGN_ERRORS);
    let is_kept = |of: Signs| !is_few(of) && of.are_kept_but(MAX_SIGN_ERRORS);
    let is_flipped_or_few = |of: Signs| is_flipped(of) || is_few(of);
    if all.count == 0 {
        return None;
    }
    if is_flipped_or_few(unmirrored) && is_flipped_or_few(mirrored) {
        return Some(Difference::SignFlipped);
    }
    let is_flipped_on_one_side =
        is_kept(unmirrored) && is_flipped(mirrored) || is_flipped(unmirrored) && is_kept(mirrored);
    is_flipped_on_one_side.then_some(Difference::SignFlippedWhereMirrored)
}

/// Whether no more than a part of a surface is wound against its normals.
pub fn is_at_most_a_part(reversal: Option<Reversal>) -> bool {
    reversal.is_none_or(|reversal| reversal == Reversal::Unknown(Undecided::OnlyAPart))
}

/// Whether the right signs are the opposite of MikkTSpace's.
///
/// MikkTSpace's sign is the sign of the UV area, which changes with the order of the corners; light depends
/// on the normal alone. So signs are taken from faces that are wound along their normals, unless the normals
/// are known to be reversed.
pub fn flips_signs(reversal: Option<Reversal>) -> bool {
    !is_at_most_a_part(reversal) && reversal != Some(Reversal::Normals)
}

/// What is reversed, and the sides of the triangles.
#[derive(Clone, Copy)]
pub struct Winding<'a> {
    pub reversal: Option<Reversal>,
    pub sides: &'a Sides,
}

/// The tangents of the file beside MikkTSpace's for one UV set.
struct Comparison<'a> {
    surface: &'a Surface,
    tangents: &'a [[f32; 4]],
    normals: &'a [[f32; 3]],
    uvs: &'a [[f32; 2]],
    /// MikkTSpace's, per corner.
    expected: &'a [[f32; 4]],
    is_on_seam: &'a [bool],
    /// Whether the signs of `expected` are to be negated.
    flips: bool,
    /// Per triangle whether its sign can be judged.
    has_sign: Vec<bool>,
}

impl<'a> Comparison<'a> {
    /// None where the surface has no tangents, normals or UVs.
    fn new(
        surface: &'a Surface,
        uv_set: usize,
        (expected, is_on_seam): (&'a [[f32; 4]], &'a [bool]),
        Winding { reversal, sides }: Winding<'_>,
    ) -> Option<Self> {
        // Where a part of the surface is reversed, which sign is right depends on what is to be flipped.
        let mut has_sign = vec![true; expected.len() / 3];
        if is_at_most_a_part(reversal) {
            sides.against.iter().for_each(|&triangle| has_sign[triangle] = false);
        }
        Some(Self {
            surface,
            tangents: surface.tangents.as_ref()?,
            normals: surface.normals.as_ref()?,
            uvs: surface.uv_sets.get(&uv_set)?,
            expected,
            is_on_seam,
            flips: flips_signs(reversal),
            has_sign,
        })
    }

    fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for (number, triangle) in self.surface.triangles().enumerate() {
            if is_measured(self.surface, self.uvs, triangle) {
                self.add_triangle(&mut counts, number, triangle);
            }
        }
        counts
    }

    fn add_triangle(&self, counts: &mut Counts, number: usize, triangle: [usize; 3]) {
        // Corners whose sign can be judged, and those whose sign differs.
        let (mut judged, mut flipped) = (0, 0);
        let area = area(self.surface, triangle);
        for (corner, vertex) in
            triangle.into_iter().enumerate().filter(|(_, vertex)| !self.is_on_seam[*vertex])
        {
            let (mut ours, theirs) = (self.expected[3 * number + corner], self.tangents[vertex]);
            ours[3] = if self.flips { -ours[3] } else { ours[3] };
            let difference = CornerDifference::between(ours, theirs);
            let Some(angle) = difference.angle else { continue };
            counts.add_direction(self.normals[vertex], xyz(ours), xyz(theirs));
            counts.near += usize::from(angle < 1.0);
            counts.close += usize::from(angle < 1.0 && !difference.flips_sign);
            if theirs[3].abs() >= MIN_SIGN && self.has_sign[number] {
                counts.signs[usize::from(ours[3] < 0.0)].add(difference.flips_sign, area / 3.0);
                (judged, flipped) = (judged + 1, flipped + usize::from(difference.flips_sign));
            }
        }
        if judged == 3 {
            counts.of_triangles.add(flipped == 3, area);
        }
        if flipped == 3 {
            counts.flipped_triangles.push(number);
        }
    }
}

impl Counts {
    /// Counts a corner by the direction of its tangent.
    fn add_direction(&mut self, normal: [f32; 3], ours: [f32; 3], theirs: [f32; 3]) {
        self.corners += 1;
        let across = dot(cross(normal, ours), theirs).abs();
        let along = dot(ours, theirs);
        if across > along.abs() {
            self.across += 1;
        } else if along > 0.0 {
            self.along += 1;
        } else {
            self.against += 1;
        }
    }
}

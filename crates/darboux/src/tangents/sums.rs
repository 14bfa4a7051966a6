//! Sums over the triangles around each vertex, apart for the two UV orientations.
//!
//! What a triangle adds is a method's business ([`Weighting`]); what becomes of the sums is in sides.rs.

use crate::math::{V3, length, not_zero, scale, sub};

use super::flat::Flat;

/// Rows of four lanes, so that a sum is `N` vector additions. Row 0 is a tangent and a weight, row 1 begins with a bitangent.
pub(super) type Sum<const N: usize> = [[f32; 4]; N];

/// A method that sums what each triangle adds to all of its vertices alike.
pub(super) trait Weighting<const N: usize> {
    /// False: both orientations share one sum, and the sign is the one that the summed bitangent asks for.
    const SPLITS: bool = true;

    /// What a triangle adds. One without a weight above zero, or with a lane that is not finite, adds nothing.
    fn term(derivatives: &Derivatives) -> Sum<N>;

    /// What the lengths of the added tangents come to, to a factor of two: a sum that is much shorter cancelled.
    fn size(sum: &Sum<N>) -> f32;

    /// The lengths of dP/du and dP/dv that a sum stands for.
    fn magnitude(sum: &Sum<N>) -> [f32; 2];

    /// A normal to use where the mesh has none, as long as it may be.
    fn own_normal(_sum: &Sum<N>) -> V3 {
        [0.0; 3]
    }
}

/// A triangle's edges and the derivatives of position by UV, before the division by `area`.
///
/// With E = [e1 e2] and the UV edges as columns of U, the derivatives are the columns of E U^-1 (E. Lengyel, "Foundations of
/// Game Engine Development", vol. 2, 7.5; M. Mikkelsen 2008, equations 18 and 19).
#[derive(Clone, Copy)]
pub(super) struct Derivatives {
    /// From the first corner to the second and to the third, and between these.
    pub edges: [V3; 3],
    /// dP/du and dP/dv, times `area`.
    pub s: V3,
    pub t: V3,
    /// Twice the signed area in UV space: the determinant of U.
    pub area: f32,
}

impl Derivatives {
    #[inline(always)]
    pub fn new([a, b, c]: [&V3; 3], uvs: [&[f32; 2]; 3]) -> Self {
        let [e1, e2, e3] = [sub(*b, *a), sub(*c, *a), sub(*c, *b)];
        let [du1, dv1] = [uvs[1][0] - uvs[0][0], uvs[1][1] - uvs[0][1]];
        let [du2, dv2] = [uvs[2][0] - uvs[0][0], uvs[2][1] - uvs[0][1]];
        Self {
            edges: [e1, e2, e3],
            s: sub(scale(dv2, e1), scale(dv1, e2)),
            t: sub(scale(du1, e2), scale(du2, e1)),
            area: du1 * dv2 - dv1 * du2,
        }
    }

    /// True where neither derivative is zero and the triangle is not degenerate. No branches: it nearly always is.
    #[inline(always)]
    pub fn has_direction(&self) -> bool {
        let [a, b, c] = self.edges;
        let has_corners = (size(a) > 0.0) & (size(b) > 0.0) & (size(c) > 0.0);
        not_zero(self.area) & (size(self.s) > 0.0) & (size(self.t) > 0.0) & has_corners
    }

    /// The unit directions of dP/du and dP/dv, and their lengths.
    #[inline(always)]
    pub fn directions(&self) -> ([V3; 2], [f32; 2]) {
        let (s_length, t_length) = (length(self.s), length(self.t));
        let (sign, area) = (1f32.copysign(self.area), self.area.abs());
        let directions = [scale(sign / s_length, self.s), scale(sign / t_length, self.t)];
        (directions, [s_length / area, t_length / area])
    }

    /// Twice the triangle's area times its normal.
    #[inline(always)]
    pub fn doubled_area_vector(&self) -> V3 {
        let [a, b, _] = self.edges;
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }
}

/// The sum of the absolute coordinates: the cheapest norm.
#[inline(always)]
pub(super) fn size([x, y, z]: V3) -> f32 {
    x.abs() + y.abs() + z.abs()
}

/// True for two equal positions.
#[inline(always)]
pub(super) fn is_degenerate([a, b, c]: [V3; 3]) -> bool {
    a == b || b == c || a == c
}

/// What the UV map does with a face's orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Orientation {
    Keeps = 0,
    Mirrors = 1,
    /// No UV area, no area, values that are not finite, or a face of other than 3 or 4 corners.
    None = 2,
}

impl Orientation {
    pub fn of(area: f32) -> Self {
        if area > 0.0 { Self::Keeps } else { Self::Mirrors }
    }
}

/// The sums of all vertices and what was met on the way.
pub(super) struct Sums<const N: usize> {
    /// Per orientation and vertex; none of an orientation that no triangle has, but that the first is always there.
    pub of_side: [Vec<Sum<N>>; 2],
    pub orientation_of_face: Vec<Orientation>,
    pub degenerate_triangles: usize,
    pub uv_degenerate_triangles: usize,
}

/// What sums leave behind for the next run.
#[derive(Debug, Default)]
pub(super) struct Memory {
    of_two_rows: [Vec<Sum<2>>; 2],
    of_three_rows: [Vec<Sum<3>>; 2],
    orientation_of_face: Vec<Orientation>,
}

/// Where sums of `N` rows are kept.
pub(super) trait Keeps<const N: usize> {
    fn of_side(&mut self) -> &mut [Vec<Sum<N>>; 2];
}

impl Keeps<2> for Memory {
    fn of_side(&mut self) -> &mut [Vec<Sum<2>>; 2] {
        &mut self.of_two_rows
    }
}

impl Keeps<3> for Memory {
    fn of_side(&mut self) -> &mut [Vec<Sum<3>>; 2] {
        &mut self.of_three_rows
    }
}

impl<const N: usize> Sums<N> {
    /// Empty sums, in the memory of earlier ones.
    pub fn new(flat: &Flat<'_>, memory: &mut Memory) -> Self
    where
        Memory: Keeps<N>,
    {
        let mut of_side = std::mem::take(memory.of_side());
        let mut orientation_of_face = std::mem::take(&mut memory.orientation_of_face);
        of_side.iter_mut().for_each(Vec::clear);
        of_side[0].resize(flat.positions.len(), [[0.0; 4]; N]);
        orientation_of_face.clear();
        orientation_of_face.reserve(flat.face_count());
        Self { of_side, orientation_of_face, degenerate_triangles: 0, uv_degenerate_triangles: 0 }
    }

    /// Leaves the memory for others.
    pub fn keep(self, memory: &mut Memory)
    where
        Memory: Keeps<N>,
    {
        *memory.of_side() = self.of_side;
        memory.orientation_of_face = self.orientation_of_face;
    }

    /// The sums of one orientation, made when they are first asked for.
    #[inline(always)]
    pub fn side(&mut self, side: usize) -> &mut [Sum<N>] {
        if self.of_side[side].is_empty() {
            let count = self.of_side[0].len();
            self.of_side[side].resize(count, [[0.0; 4]; N]);
        }
        &mut self.of_side[side]
    }

    #[cold]
    fn count_flawed(&mut self, positions: [&V3; 3]) {
        if is_degenerate(positions.map(|position| *position)) {
            self.degenerate_triangles += 1;
        } else {
            self.uv_degenerate_triangles += 1;
        }
    }
}

/// Calls `add` with every triangle that has a direction: its number, its vertices, what it adds, and the side it adds to.
#[inline(always)]
pub(super) fn for_each_term<const N: usize, W: Weighting<N>>(
    flat: &Flat<'_>,
    sums: &mut Sums<N>,
    mut add: impl FnMut(&mut Sums<N>, (usize, [u32; 3]), &Sum<N>, usize),
) {
    let agreed = (!flat.is_triangles()).then(|| agreed_orientations::<N, W>(flat));
    let slices = flat.slices();
    let mut orientations = std::mem::take(&mut sums.orientation_of_face);
    orientations.resize(slices.triangles.len(), Orientation::None);
    for (t, (&triangle, slot)) in slices.triangles.iter().zip(&mut orientations).enumerate() {
        let (positions, uvs) = slices.refer(triangle);
        let derivatives = Derivatives::new(positions, uvs);
        let Some(term) = term::<N, W>(&derivatives) else {
            sums.count_flawed(positions);
            continue;
        };
        let own = Orientation::of(derivatives.area);
        *slot = agreed.as_ref().map_or(own, |agreed| agreed[flat.face(t)]);
        add(sums, (t, triangle), &term, if W::SPLITS { *slot as usize } else { 0 });
    }
    sums.orientation_of_face = agreed.unwrap_or(orientations);
}

/// Adds what all triangles add to sums that are empty.
pub(super) fn accumulate<const N: usize, W: Weighting<N>>(flat: &Flat<'_>, mut sums: Sums<N>) -> Sums<N> {
    for_each_term::<N, W>(flat, &mut sums, |sums, (_, [a, b, c]), term, side| {
        let sums = sums.side(side);
        accumulate_into(&mut sums[a as usize], term);
        accumulate_into(&mut sums[b as usize], term);
        accumulate_into(&mut sums[c as usize], term);
    });
    sums
}

#[inline(always)]
pub(super) fn accumulate_into<const N: usize>(sum: &mut Sum<N>, term: &Sum<N>) {
    for (sum, term) in sum.as_flattened_mut().iter_mut().zip(term.as_flattened()) {
        *sum += term;
    }
}

/// What a triangle adds; none when it adds nothing.
#[inline(always)]
fn term<const N: usize, W: Weighting<N>>(derivatives: &Derivatives) -> Option<Sum<N>> {
    let term = W::term(derivatives);
    // One test for all lanes: sizes do not cancel, so their sum is finite only where all are.
    let mut sizes = 0.0;
    for [a, b, c, d] in term {
        sizes += size([a, b, c]) + d.abs();
    }
    let is_finite = sizes < f32::INFINITY;
    let adds = derivatives.has_direction() & is_finite & (term[0][3] > 0.0);
    adds.then_some(term)
}

/// True for a triangle that adds something.
pub(super) fn adds<const N: usize, W: Weighting<N>>(flat: &Flat<'_>, t: usize) -> bool {
    let slices = flat.slices();
    let (positions, uvs) = slices.refer(slices.triangles[t]);
    term::<N, W>(&Derivatives::new(positions, uvs)).is_some()
}

/// One orientation for each face: of the halves of a quad that add something the one with the larger UV area decides, the first
/// on a tie.
fn agreed_orientations<const N: usize, W: Weighting<N>>(flat: &Flat<'_>) -> Vec<Orientation> {
    let mut deciding = vec![(Orientation::None, 0.0); flat.face_count()];
    let slices = flat.slices();
    for (t, &triangle) in slices.triangles.iter().enumerate() {
        let (positions, uvs) = slices.refer(triangle);
        let derivatives = Derivatives::new(positions, uvs);
        let slot = &mut deciding[flat.face(t)];
        let is_larger = slot.0 == Orientation::None || derivatives.area.abs() > slot.1;
        if is_larger && term::<N, W>(&derivatives).is_some() {
            *slot = (Orientation::of(derivatives.area), derivatives.area.abs());
        }
    }
    deciding.into_iter().map(|(orientation, _)| orientation).collect()
}

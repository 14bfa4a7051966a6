//! Position-independent arrays of a GPU plan: the sums that each corner has, in the layout of the plan
//! shaders.
//!
//! For `darboux-gpu` and the npm package. Not part of the API.

use std::collections::HashMap;

use crate::Context;
use crate::CornerTangents;
use crate::Error;
use crate::Faces;
use crate::Mesh;
use crate::Method;
use crate::Mode;
use crate::TangentOptions;
use crate::generate_tangents_with;

use crate::internal::stage_arrays::{CopySource, CornerCopy, NONE, Stages, Triangles};
use crate::math::distinct_bits;
use crate::tangents::mikktspace::derivatives::doubled_area;

/// Flags in the two highest bits of vertex numbers; see darboux-gpu/shaders/plan/triangle.wgsl.
const FIRST_FLAG: u32 = 1 << 31;
const SECOND_FLAG: u32 = 1 << 30;
/// The bits of the vertex number.
pub const VERTEX_MASK: u32 = SECOND_FLAG - 1;

/// Why a mesh has no GPU plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanRefusal {
    /// Some corners of quads have the average of two tangents, or copy a tangent from the other half of the
    /// quad by position.
    QuadHalvesDiffer {
        /// The number of these corners.
        corners: usize,
    },
    /// The method is not MikkTSpace.
    OtherMethod,
    /// The context's token was cancelled, or another error of the core.
    Failed(Error),
    /// A sum, or all sums together, has more members than the limit.
    TooManyMembers {
        /// A lower bound of the number of members.
        members: usize,
        /// The limit.
        limit: usize,
    },
}

impl From<Error> for PlanRefusal {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

/// The arrays of a plan, in the layout of the shaders.
#[derive(Debug, Default)]
pub struct PlanArrays {
    /// Five words per triangle: three vertices with flags, and two differences of v. Degenerate triangles
    /// come last.
    pub triangles: Vec<u32>,
    /// Two words per triangle: two differences of u.
    pub du: Vec<u32>,
    pub triangle_count: u32,
    pub degenerate_count: u32,
    /// The welded vertex of each vertex, or [`NONE`] for unused ones.
    pub representatives: Vec<u32>,
    /// The end of each sum in the member list, the vertex of each sum, and the member list.
    pub sums: Vec<u32>,
    pub sum_count: u32,
    /// The sum of each corner of the triangles that are not degenerate, with a flag where the corner's group
    /// has several sums.
    pub sum_of_place: Vec<u32>,
    /// Two words per vertex: the UVs, with -0 replaced by +0.
    pub uvs: Vec<u32>,
    /// The sum of each corner of the mesh, with a flag for sign -1.
    pub sum_of_corner: Vec<u32>,
    /// The tangents of the base.
    pub base: CornerTangents,
    /// True when unusable tangents are replaced.
    pub repairs: bool,
    /// True when the mesh has faces other than triangles. The diagonals of quads may depend on positions.
    pub has_quads: bool,
    pub threshold_cosine: f32,
}

impl PlanArrays {
    /// Computes the arrays. `most_members`: the limit of the members of one sum.
    pub fn new(
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
        most_members: usize,
    ) -> Result<Self, PlanRefusal> {
        let Method::MikkTSpace(mikkt) = options.method else { return Err(PlanRefusal::OtherMethod) };
        let limit = 8 * mesh.corner_count() + (1 << 20);
        let too_many = |members, limit| PlanRefusal::TooManyMembers { members, limit };
        let stages = Stages::new(mesh, &mikkt, context, limit)?.ok_or_else(|| too_many(limit + 1, limit))?;
        match corners_of_both_halves(&stages) {
            0 => {}
            corners => return Err(PlanRefusal::QuadHalvesDiffer { corners }),
        }
        let base = generate_tangents_with(mesh, options, context)?.corners;
        let repairs = mikkt.mode != Mode::Reference;
        let mut sums = PlanSums::new(mesh, &stages);
        let sum_of_corner = sums.of_corners(mesh, &stages, &base, repairs);
        if let Some(members) = sums.largest().filter(|&members| members > most_members) {
            return Err(too_many(members, most_members));
        }
        let (good, degenerate) = (&stages.triangulation.good, &stages.triangulation.degenerate);
        let mut triangles = Vec::new();
        good.corners.iter().enumerate().for_each(|(t, _)| triangles.extend(triangle(mesh, &stages, t)));
        degenerate.corners.iter().for_each(|corners| triangles.extend(degenerate_triangle(mesh, *corners)));
        let list = |list: &Triangles, axis| -> Vec<u32> {
            (0..list.face.len()).flat_map(|t| differences(mesh, list.vertices[t], axis)).collect()
        };
        Ok(Self {
            triangle_count: good.face.len() as u32,
            degenerate_count: degenerate.face.len() as u32,
            du: [list(good, 0), list(degenerate, 0)].concat(),
            triangles,
            representatives: representatives(mesh, [good, degenerate]),
            sum_of_place: sums_of_places(&stages, &sum_of_corner),
            uvs: (0..mesh.vertex_count())
                .flat_map(|v| mesh.uvs().get(v).map(|x| (x + 0.0).to_bits()))
                .collect(),
            sum_count: sums.ends.len() as u32,
            sums: [sums.ends, sums.vertices, sums.members].concat(),
            sum_of_corner,
            base,
            repairs,
            has_quads: !matches!(mesh.faces(), Faces::Triangles),
            threshold_cosine: stages.threshold_cosine,
        })
    }

    /// The sum of each vertex, which is that of its first corner, or [`NONE`] for unused vertices.
    ///
    /// Errors: the number of vertices whose corners have different tangents, if there are any.
    pub fn sum_of_vertex(&self, mesh: &Mesh<'_>) -> Result<Vec<u32>, usize> {
        let mut first = vec![NONE; mesh.vertex_count()];
        let mut has_several = vec![false; mesh.vertex_count()];
        let bits = |corner: usize| distinct_bits(self.base.per_corner()[corner]);
        for corner in 0..mesh.corner_count() {
            let vertex = mesh.vertex_of_corner(corner);
            match first[vertex] {
                NONE => first[vertex] = corner as u32,
                other => has_several[vertex] |= bits(other as usize) != bits(corner),
            }
        }
        match has_several.iter().filter(|&&several| several).count() {
            0 => Ok(first
                .iter()
                .map(|&corner| self.sum_of_corner.get(corner as usize).copied())
                .map(none)
                .collect()),
            vertices => Err(vertices),
        }
    }
}

/// The number of corners whose tangent is neither that of one sum nor a copy from the same vertex.
fn corners_of_both_halves(stages: &Stages) -> usize {
    let is_average = |sums: &&[u32; 2]| sums[1] != NONE && sums[1] != sums[0];
    let is_of_half = |copied: &&CornerCopy| matches!(copied.from, CopySource::Half(_));
    stages.sums.of_corner.iter().filter(is_average).count() + stages.copies.iter().filter(is_of_half).count()
}

fn none(sum: Option<u32>) -> u32 {
    sum.unwrap_or(NONE)
}

fn vertex(mesh: &Mesh<'_>, corner: u32) -> u32 {
    mesh.vertex_of_corner(corner as usize) as u32
}

/// The welded vertex of each vertex, or [`NONE`] for unused ones.
fn representatives(mesh: &Mesh<'_>, lists: [&Triangles; 2]) -> Vec<u32> {
    let mut of_vertex = vec![NONE; mesh.vertex_count()];
    for list in lists {
        for (&corner, &of) in list.corners.as_flattened().iter().zip(list.vertices.as_flattened()) {
            of_vertex[mesh.vertex_of_corner(corner as usize)] = vertex(mesh, of);
        }
    }
    of_vertex
}

/// The sum of each corner of the triangles that are not degenerate, flagged where the members of the group
/// have several sums.
fn sums_of_places(stages: &Stages, sum_of_corner: &[u32]) -> Vec<u32> {
    let corners = stages.triangulation.good.corners.as_flattened();
    let sum_of_place = |place: &u32| sum_of_corner[corners[*place as usize] as usize] & !FIRST_FLAG;
    let mut sums: Vec<u32> = (0..corners.len() as u32).map(|place| sum_of_place(&place)).collect();
    for group in 0..stages.groups.ends().len() {
        let members = stages.groups.members(group);
        if members.iter().any(|member| sum_of_place(member) != sum_of_place(&members[0])) {
            members.iter().for_each(|&member| sums[member as usize] |= FIRST_FLAG);
        }
    }
    sums
}

/// The words of good triangle `t`.
fn triangle(mesh: &Mesh<'_>, stages: &Stages, t: usize) -> [u32; 5] {
    let good = &stages.triangulation.good;
    let [mut a, mut b, mut c] = good.corners[t].map(|corner| vertex(mesh, corner));
    let names = good.vertices[t].map(|corner| vertex(mesh, corner));
    let has_copies = [a, b, c] != names;
    // The triangle's own orientation, before the halves of quads are unified.
    let preserves = doubled_area(names.map(|name| mesh.uvs().get(name as usize))) > 0.0;
    a |= if preserves { 0 } else { FIRST_FLAG };
    b |= if stages.derivatives[t].joins_any { FIRST_FLAG } else { 0 };
    c |= if has_copies { FIRST_FLAG } else { 0 };
    let [d, e] = differences(mesh, good.vertices[t], 1);
    [a, b, c, d, e]
}

/// The words of a degenerate triangle.
fn degenerate_triangle(mesh: &Mesh<'_>, corners: [u32; 3]) -> [u32; 5] {
    let [a, b, c] = corners.map(|corner| vertex(mesh, corner));
    [a, b | FIRST_FLAG | SECOND_FLAG, c, 0, 0]
}

/// The differences of u (`axis` 0) or v (1) along the two edges from corner 0, as bits.
fn differences(mesh: &Mesh<'_>, vertices: [u32; 3], axis: usize) -> [u32; 2] {
    let [a, b, c] = vertices.map(|corner| mesh.uvs().get(mesh.vertex_of_corner(corner as usize))[axis]);
    [b - a, c - a].map(f32::to_bits)
}

/// The sums of a plan: those with members, then those without.
struct PlanSums {
    ends: Vec<u32>,
    /// The vertex of each sum, which has the normal.
    vertices: Vec<u32>,
    members: Vec<u32>,
    /// The sign of each sum with members.
    signs: Vec<f32>,
    /// The sums without members, by vertex and by whether their tangent is always replaced.
    empty: HashMap<(u32, bool), u32>,
}

/// The sign of corners without a group.
const DEFAULT_SIGN: f32 = -1.0;

impl PlanSums {
    fn new(mesh: &Mesh<'_>, stages: &Stages) -> Self {
        let sums = &stages.sums;
        let starts = [0].into_iter().chain(sums.ends.iter().copied());
        let orientation = |start: u32| stages.preserves[sums.members[start as usize] as usize / 3];
        let sign = |start: u32| if orientation(start) { 1.0 } else { -1.0 };
        Self {
            signs: starts.take(sums.ends.len()).map(sign).collect(),
            ends: sums.ends.clone(),
            vertices: sums.vertices.iter().map(|&corner| vertex(mesh, corner)).collect(),
            members: sums.members.clone(),
            empty: HashMap::new(),
        }
    }

    fn largest(&self) -> Option<usize> {
        let starts = [0].into_iter().chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| (end - start) as usize).max()
    }

    /// The sum of every corner, with the sign of the base. Corners of unsupported faces have a sum that is
    /// always replaced, if `repairs`.
    fn of_corners(
        &mut self,
        mesh: &Mesh<'_>,
        stages: &Stages,
        base: &CornerTangents,
        repairs: bool,
    ) -> Vec<u32> {
        let mut sums: Vec<u32> = stages.sums.of_corner.iter().map(|sums| sums[0]).collect();
        for copied in &stages.copies {
            if let CopySource::Vertex(good) = copied.from {
                sums[copied.corner as usize] = sums[good as usize];
            }
        }
        let raw = |sum: u32| self.signs.get(sum as usize).copied().unwrap_or(DEFAULT_SIGN);
        let mut is_forced: Vec<bool> =
            sums.iter().zip(base.per_corner()).map(|(&sum, tangent)| raw(sum) != tangent[3]).collect();
        stages
            .triangulation
            .unsupported_corners
            .iter()
            .for_each(|&corner| is_forced[corner as usize] |= repairs);
        // Where the signs of a face were unified, a corner has the tangent of another group at its vertex.
        let first =
            if is_forced.contains(&true) { self.first_of_sign(stages, &sums) } else { HashMap::new() };
        let names = names(stages, sums.len());
        for (corner, sum) in sums.iter_mut().enumerate() {
            let sign = base.per_corner()[corner][3];
            if is_forced[corner] {
                *sum = none(first.get(&(names[corner], sign > 0.0)).copied());
            }
            if *sum == NONE {
                *sum = self.without_members(vertex(mesh, corner as u32), is_forced[corner]);
            }
            *sum |= if sign < 0.0 { FIRST_FLAG } else { 0 };
        }
        sums
    }

    /// The first sum of each welded vertex and sign.
    fn first_of_sign(&self, stages: &Stages, sums: &[u32]) -> HashMap<(u32, bool), u32> {
        let good = &stages.triangulation.good;
        let mut first = HashMap::new();
        for (&corner, &name) in good.corners.as_flattened().iter().zip(good.vertices.as_flattened()) {
            let sum = sums[corner as usize];
            if let Some(sign) = self.signs.get(sum as usize) {
                first.entry((name, *sign > 0.0)).or_insert(sum);
            }
        }
        first
    }

    fn without_members(&mut self, vertex: u32, is_forced: bool) -> u32 {
        let next = self.ends.len() as u32;
        let sum = *self.empty.entry((vertex, is_forced)).or_insert(next);
        if sum == next {
            self.ends.push(self.members.len() as u32);
            self.vertices.push(vertex | if is_forced { FIRST_FLAG } else { 0 });
        }
        sum
    }
}

/// The welded vertex of every corner, or [`NONE`].
fn names(stages: &Stages, corners: usize) -> Vec<u32> {
    let mut names = vec![NONE; corners];
    for list in [&stages.triangulation.good, &stages.triangulation.degenerate] {
        for (&corner, &name) in list.corners.as_flattened().iter().zip(list.vertices.as_flattened()) {
            names[corner as usize] = name;
        }
    }
    names
}

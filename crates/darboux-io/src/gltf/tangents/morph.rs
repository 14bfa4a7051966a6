//! Computes tangent offsets of morph targets: tangents of base + target in the groups of the base, minus the
//! tangents of the base.

use std::collections::HashMap;
use std::ops::Add;

use darboux::Context;

use super::compute::{JobResult, Vertices};
use super::groups::Group;
use super::options::AddTangentsOptions;
use super::select::TangentSelection;
use super::split::Split;
use crate::Error;
use crate::gltf::Document;
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::primitives::offsets::VertexOffsets;
use crate::gltf::schema::Attributes;

/// The accessors of position and normal offsets of a morph target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Movement {
    position: Option<usize>,
    normal: Option<usize>,
}

impl Movement {
    /// The accessors of offsets.
    pub fn accessors(self) -> impl Iterator<Item = usize> {
        self.position.into_iter().chain(self.normal)
    }

    /// The movement of a morph target; none if it gets no tangent offsets.
    ///
    /// Existing offsets are kept unless they are to be replaced. Targets without position and normal offsets
    /// need none.
    pub fn of(
        accessors: &CanonicalAccessors,
        target: &Attributes,
        options: &AddTangentsOptions,
    ) -> Option<Self> {
        let offsets = |semantic| target.get(semantic).map(|&accessor| accessors.of(accessor));
        let (position, normal) = (offsets("POSITION"), offsets("NORMAL"));
        let wanted = options.overwrite || !target.contains_key("TANGENT");
        (wanted && (position.is_some() || normal.is_some())).then_some(Self { position, normal })
    }
}

/// A movement and the jobs that it affects.
#[derive(Debug)]
pub struct Morph {
    pub movement: Movement,
    /// The accessor of tangent offsets of the first target with this movement, if any.
    pub old: Option<usize>,
    /// The JSON path of the first target with this movement.
    at: String,
    /// The jobs of primitives with this movement.
    pub jobs: Vec<usize>,
}

/// The different movements of a group, in the order of their first targets.
pub fn morphs(
    document: &Document,
    accessors: &CanonicalAccessors,
    group: &Group,
    selection: &TangentSelection,
    options: &AddTangentsOptions,
) -> Vec<Morph> {
    let mut morphs: Vec<Morph> = Vec::new();
    let mut place_of = HashMap::new();
    let mut moved = HashMap::new();
    for member in &group.members {
        let name = &selection.candidates[member.candidate].name;
        let primitive = &document.meshes()[name.mesh].primitives[name.primitive];
        for (place, target) in primitive.targets.iter().enumerate() {
            let Some(movement) = Movement::of(accessors, target, options) else { continue };
            let place = *place_of.entry(movement).or_insert_with(|| {
                let at = format!("{}.targets[{place}]", name.path());
                let old = target.get("TANGENT").copied();
                morphs.push(Morph { movement, old, at, jobs: Vec::new() });
                morphs.len() - 1
            });
            moved.entry((place, member.job)).or_insert_with(|| morphs[place].jobs.push(member.job));
        }
    }
    morphs
}

/// Tangent offsets of the vertices after splitting, and counts of corners that they do not fit.
#[derive(Debug)]
pub struct Offsets {
    pub of_vertices: VertexOffsets,
    /// Counts for each of [`Morph::jobs`].
    pub stale_corners: Vec<StaleCorners>,
}

/// Corners of a morphed job whose tangent differs from that of a fresh computation.
#[derive(Clone, Copy, Debug, Default)]
pub struct StaleCorners {
    /// Corners to which a computation without the groups of the base would give another tangent.
    pub regrouped: usize,
    /// Corners whose offset differs from that of their vertex, which corners with the same base tangent
    /// share.
    pub conflicting: usize,
}

impl Add for StaleCorners {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (regrouped, conflicting) =
            (self.regrouped + other.regrouped, self.conflicting + other.conflicting);
        Self { regrouped, conflicting }
    }
}

/// Evaluates a movement for its jobs.
///
/// Errors: the number of offsets is not that of vertices; with [`AddTangentsOptions::strict`], offsets that
/// are not finite.
pub fn offsets(
    document: &Document,
    morph: &Morph,
    group: &Group,
    vertices: &mut Vertices<'_>,
    (results, split): (&[JobResult<'_>], &Split),
    options: &AddTangentsOptions,
    context: &mut Context,
) -> Result<Offsets, Error> {
    let Movement { position, normal } = morph.movement;
    let moved = |base: &[_], by| moved(document, &morph.at, base, by, options.strict);
    let positions = moved(&vertices.positions, position)?;
    let normals = moved(&vertices.normals, normal)?;
    let base = vertices.replace(positions.into(), normals.into());
    let mut field = OffsetField::new(split.vertex_count());
    let mut stale_corners = Vec::with_capacity(morph.jobs.len());
    for &job in &morph.jobs {
        let result = &results[job];
        let quads = result.quads.as_ref();
        let mesh = vertices.mesh(document, &morph.at, &group.jobs[job], &result.corners, quads)?;
        let plan = result.plan.as_ref().expect("jobs with morph targets have a plan");
        let in_document = |error| document.mesh_error(&morph.at, error);
        let evaluated = plan.evaluate_with(&mesh, context).map_err(in_document)?;
        let regrouped = plan.count_regrouped_with(&mesh, context).map_err(in_document)?;
        let of_triangles = quads.map(|quads| quads.of_triangles(evaluated.per_corner()));
        let evaluated = of_triangles.as_deref().unwrap_or(evaluated.per_corner());
        let tangents = evaluated.iter().zip(result.tangents.iter());
        let corners = split.vertices(job, result).zip(tangents);
        let conflicting = corners.filter(|&(vertex, (moved, base))| !field.set(vertex, moved, base)).count();
        stale_corners.push(StaleCorners { regrouped, conflicting });
    }
    vertices.replace(base.0, base.1);
    Ok(Offsets { of_vertices: field.finish(), stale_corners })
}

/// The base plus the offsets of an accessor, if there is one. `at` is the JSON path of the target.
fn moved(
    document: &Document,
    at: &str,
    base: &[[f32; 3]],
    by: Option<usize>,
    strict: bool,
) -> Result<Vec<[f32; 3]>, Error> {
    let Some(accessor) = by else { return Ok(base.to_vec()) };
    let offsets = document.vectors::<3>(accessor)?;
    if offsets.len() != base.len() {
        let problem =
            format!("accessor {accessor} has {} elements for {} vertices", offsets.len(), base.len());
        return Err(document.invalid(at, format!("{problem}; export the file again")));
    }
    let infinite = offsets.iter().filter(|offset| !offset.iter().all(|x| x.is_finite())).count();
    if strict && infinite > 0 {
        let problem = format!("{infinite} offsets of accessor {accessor} are not finite");
        return Err(document.invalid(at, format!("{problem}; repair the model, or run without strict")));
    }
    Ok(base.iter().zip(&*offsets).map(|(base, by)| std::array::from_fn(|i| base[i] + by[i])).collect())
}

/// One offset per vertex, set by the first corner of the vertex.
struct OffsetField {
    offsets: Vec<[f32; 3]>,
    is_set: Vec<bool>,
}

impl OffsetField {
    fn new(vertex_count: usize) -> Self {
        Self { offsets: vec![[0.0; 3]; vertex_count], is_set: vec![false; vertex_count] }
    }

    /// Sets the offset of a vertex unless it is set. Returns whether the corner's offset is that of the
    /// vertex.
    fn set(&mut self, vertex: u32, moved: &[f32; 4], base: &[f32; 4]) -> bool {
        let vertex = vertex as usize;
        let offset = std::array::from_fn(|i| moved[i] - base[i]);
        if !self.is_set[vertex] {
            self.is_set[vertex] = true;
            self.offsets[vertex] = offset;
        }
        self.offsets[vertex] == offset
    }

    fn finish(self) -> VertexOffsets {
        let count = self.offsets.len();
        let set = self.is_set.iter().filter(|&&is_set| is_set).count();
        if set >= count / 2 {
            return VertexOffsets::All(self.offsets);
        }
        let of_vertex = (0..).zip(self.offsets).zip(self.is_set);
        VertexOffsets::new(count, of_vertex.filter_map(|(offset, is_set)| is_set.then_some(offset)).collect())
    }
}

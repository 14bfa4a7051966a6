//! Computes the normals of corners, mesh by mesh: at rest, and for every morph target.

use std::collections::HashMap;
use std::hash::Hash;

use darboux::{
    Context, Faces, Indices, NormalOptions, NormalReport, Shading, SmoothingSeams, generate_normals_with,
};

use super::select::{NormalInput, NormalSelection};
use crate::Error;
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::primitives::{element_count, limits};
use crate::gltf::schema::Attributes;
use crate::gltf::{Document, PrimitiveName, Progress};

/// A primitive and its new normals.
#[derive(Debug)]
pub struct ShadedPrimitive {
    /// The index in the selection.
    pub candidate: usize,
    pub name: PrimitiveName,
    /// The accessor of positions, canonical.
    pub position: usize,
    pub chosen: NormalInput,
    /// The vertices of all complete triangles, three per triangle.
    pub corners: Vec<u32>,
    /// The indices after the last complete triangle.
    pub rest: Vec<u32>,
    /// One normal per corner.
    pub normals: Vec<[f32; 3]>,
    /// The changes by each morph target.
    pub moves: Vec<Option<MovedNormals>>,
    /// The report of the whole mesh.
    pub report: NormalReport,
}

/// The change of normals by a morph target.
#[derive(Debug)]
pub struct MovedNormals {
    /// The accessor of position offsets, canonical.
    pub accessor: usize,
    /// The target's own accessor of normal offsets, if any.
    pub old: Option<usize>,
    /// The corners whose normal changes, with the offsets.
    pub offsets: Vec<(usize, [f32; 3])>,
}

/// The morph targets of a document may take this many times the work of the mesh at rest.
const MOVED_LIMIT: usize = 4;

/// Computes the normals of every chosen primitive; primitives of one mesh jointly.
///
/// Errors: indices out of range, accessors that cannot be read.
pub fn shade(
    document: &Document,
    accessors: &CanonicalAccessors,
    selection: &NormalSelection,
    (options, context): (&NormalOptions, &mut Context),
    progress: &mut dyn FnMut(Progress),
) -> Result<Vec<ShadedPrimitive>, Error> {
    let mut reader = Reader { document, last: None };
    let mut parts = Vec::new();
    for (candidate, chosen) in selection.chosen() {
        let name = selection.candidates[candidate].name.clone();
        parts.push(part(document, accessors, candidate, name, *chosen)?);
    }
    let moved =
        parts.iter().map(|part| part.moves.len().saturating_mul(part.corners.len() / 3) / MOVED_LIMIT);
    limits::check_triangles(document, moved)?;
    let total = parts.iter().map(|part| part.corners.len() / 3).sum();
    let mut at = Progress { done: 0, total };
    for mesh in parts.chunk_by_mut(|a, b| a.name.mesh == b.name.mesh) {
        shade_mesh(&mut reader, mesh, (options, &mut *context))?;
        at.done += mesh.iter().map(|part| part.corners.len() / 3).sum::<usize>();
        progress(at);
    }
    Ok(parts)
}

fn part(
    document: &Document,
    accessors: &CanonicalAccessors,
    candidate: usize,
    name: PrimitiveName,
    chosen: NormalInput,
) -> Result<ShadedPrimitive, Error> {
    let mut corners = match chosen.indices {
        Some(accessor) => document.indices(accessor)?.into_u32(),
        None => (0..chosen.index_count as u32).collect(),
    };
    let rest = corners.split_off(chosen.topology.whole(corners.len()));
    let corners = chosen.topology.corners(corners);
    let targets = &document.meshes()[name.mesh].primitives[name.primitive].targets;
    let moved = |target: &Attributes| {
        let accessor = accessors.of(*target.get("POSITION")?);
        Some(MovedNormals { accessor, old: target.get("NORMAL").copied(), offsets: Vec::new() })
    };
    let moves = targets.iter().map(moved);
    Ok(ShadedPrimitive {
        candidate,
        position: accessors.of(chosen.position),
        moves: moves.collect(),
        name,
        chosen,
        corners,
        rest,
        normals: Vec::new(),
        report: NormalReport::default(),
    })
}

/// Reads accessors and caches the last one, since consecutive primitives often share it.
struct Reader<'a> {
    document: &'a Document,
    last: Option<(usize, Vec<[f32; 3]>)>,
}

impl Reader<'_> {
    fn vectors(&mut self, accessor: usize) -> Result<&[[f32; 3]], Error> {
        if self.last.as_ref().is_none_or(|last| last.0 != accessor) {
            self.last = Some((accessor, self.document.vectors(accessor)?.into_owned()));
        }
        Ok(self.last.as_ref().map_or(&[], |last| &last.1))
    }

    /// Appends the vectors at the corners of a primitive to `out`. Errors: an index out of range.
    fn at_corners(
        &mut self,
        part: &ShadedPrimitive,
        accessor: usize,
        out: &mut Vec<[f32; 3]>,
    ) -> Result<(), Error> {
        let vertices = element_count(self.document, accessor)?;
        if let Some(at) = part.corners.iter().position(|&index| index as usize >= vertices) {
            let source = darboux::Error::IndexOutOfRange { at, index: part.corners[at], vertices };
            return Err(self.document.mesh_error(part.name.path(), source));
        }
        if vertices > part.corners.len() {
            out.extend(self.document.vectors_at::<3>(accessor, &part.corners)?);
        } else {
            let vectors = self.vectors(accessor)?;
            out.extend(part.corners.iter().map(|&index| vectors[index as usize]));
        }
        Ok(())
    }
}

/// Computes the normals of one mesh.
fn shade_mesh(
    reader: &mut Reader<'_>,
    parts: &mut [ShadedPrimitive],
    (options, context): (&NormalOptions, &mut Context),
) -> Result<(), Error> {
    let mut positions = Vec::new();
    for part in parts.iter() {
        reader.at_corners(part, part.position, &mut positions)?;
    }
    let vertex_of_corner = welded(parts, &positions, options.seams);
    let (normals, report) =
        normals(reader.document, parts, &positions, &vertex_of_corner, (options, &mut *context))?;
    let mut rest = normals.as_slice();
    for part in parts.iter_mut() {
        let (own, others) = rest.split_at(part.corners.len());
        (part.normals, part.report, rest) = (own.to_vec(), report, others);
    }
    if parts.iter().all(|part| part.moves.is_empty()) {
        return Ok(());
    }
    let fans = normals.iter().zip(&vertex_of_corner).map(|(normal, vertex)| (*vertex, bits(*normal)));
    move_mesh(reader, parts, &positions, &numbered(fans), (options, context))
}

/// The welded vertex of every corner, numbered from zero: one per position, or one per vertex of an accessor.
fn welded(parts: &[ShadedPrimitive], positions: &[[f32; 3]], seams: SmoothingSeams) -> Vec<u32> {
    let mut welded = Vec::with_capacity(positions.len());
    // Each vertex of an accessor is looked up once, however many corners it has.
    let mut number_of_vertex = numbers_of_vertices(parts);
    let mut at_position = HashMap::new();
    let mut count = 0;
    for part in parts {
        let numbers = number_of_vertex.entry(part.position).or_default();
        for &vertex in &part.corners {
            let number = *numbers.of(vertex).get_or_insert_with(|| match seams {
                SmoothingSeams::Ignored => {
                    *at_position.entry(bits(positions[welded.len()])).or_insert_with(|| next(&mut count))
                }
                _ => next(&mut count),
            });
            welded.push(number);
        }
    }
    welded
}

/// Numbers of some vertices of an accessor.
enum VertexNumbers {
    /// By the vertex.
    All(Vec<Option<u32>>),
    /// Where the accessor has many other vertices.
    Some(HashMap<u32, Option<u32>>),
}

impl Default for VertexNumbers {
    fn default() -> Self {
        Self::Some(HashMap::new())
    }
}

impl VertexNumbers {
    fn of(&mut self, vertex: u32) -> &mut Option<u32> {
        match self {
            Self::All(numbers) => &mut numbers[vertex as usize],
            Self::Some(numbers) => numbers.entry(vertex).or_default(),
        }
    }
}

/// No numbers yet, for the vertices of each accessor of positions.
fn numbers_of_vertices(parts: &[ShadedPrimitive]) -> HashMap<usize, VertexNumbers> {
    // The number of corners, and of vertices as far as they are used.
    let mut sizes: HashMap<usize, (usize, usize)> = HashMap::new();
    for part in parts {
        let (corners, vertices) = sizes.entry(part.position).or_default();
        *corners += part.corners.len();
        *vertices = part.corners.iter().fold(*vertices, |most, &vertex| most.max(vertex as usize + 1));
    }
    let numbers = |(corners, vertices): (usize, usize)| {
        if vertices <= 4 * corners {
            VertexNumbers::All(vec![None; vertices])
        } else {
            VertexNumbers::default()
        }
    };
    sizes.into_iter().map(|(position, sizes)| (position, numbers(sizes))).collect()
}

/// Returns a counter and increments it.
fn next(count: &mut u32) -> u32 {
    *count += 1;
    *count - 1
}

/// Evaluates every morph target. Corners that share a normal at rest share one when moved.
fn move_mesh(
    reader: &mut Reader<'_>,
    parts: &mut [ShadedPrimitive],
    positions: &[[f32; 3]],
    fan_of_corner: &[u32],
    (options, context): (&NormalOptions, &mut Context),
) -> Result<(), Error> {
    let in_fans = options.with_crease(180.0);
    let targets = parts.iter().map(|part| part.moves.len()).max().unwrap_or(0);
    for target in 0..targets {
        let accessor = |part: &ShadedPrimitive| {
            part.moves.get(target).and_then(Option::as_ref).map(|moved| moved.accessor)
        };
        let mut moved = Vec::with_capacity(positions.len());
        for part in parts.iter() {
            let first = moved.len();
            match accessor(part) {
                Some(offsets) => reader.at_corners(part, offsets, &mut moved)?,
                None => moved.resize(first + part.corners.len(), [0.0; 3]),
            }
        }
        for (moved, position) in moved.iter_mut().zip(positions) {
            *moved = std::array::from_fn(|i| position[i] + moved[i]);
        }
        let (normals, _) = normals(reader.document, parts, &moved, fan_of_corner, (&in_fans, &mut *context))?;
        let mut rest = normals.as_slice();
        for part in parts.iter_mut() {
            let (own, others) = rest.split_at(part.corners.len());
            rest = others;
            let pairs = own.iter().zip(&part.normals).enumerate();
            let offsets = pairs.map(|(corner, (moved, base))| {
                (corner, std::array::from_fn::<f32, 3, _>(|i| moved[i] - base[i]))
            });
            if let Some(Some(moved)) = part.moves.get_mut(target) {
                moved.offsets = offsets.filter(|(_, offset)| *offset != [0.0; 3]).collect();
            }
        }
    }
    Ok(())
}

/// The normals of corners at `positions`. Smooth normals are shared by the corners of a vertex.
fn normals(
    document: &Document,
    parts: &[ShadedPrimitive],
    positions: &[[f32; 3]],
    vertex_of_corner: &[u32],
    (options, context): (&NormalOptions, &mut Context),
) -> Result<(Vec<[f32; 3]>, NormalReport), Error> {
    let generated = match options.shading {
        Shading::Flat => {
            generate_normals_with(positions, Indices::Unindexed, Faces::Triangles, options, context)
        }
        _ => {
            let count = vertex_of_corner.iter().max().map_or(0, |&last| last as usize + 1);
            let mut of_vertex = vec![[0.0; 3]; count];
            for (&vertex, &position) in vertex_of_corner.iter().zip(positions).rev() {
                of_vertex[vertex as usize] = position;
            }
            // Corners were welded above, across primitives.
            let options = options.with_seams(SmoothingSeams::Respected);
            let indices = Indices::U32(vertex_of_corner);
            generate_normals_with(&of_vertex, indices, Faces::Triangles, &options, context)
        }
    };
    let path = parts.first().map_or_else(String::new, |part| part.name.path());
    generated
        .map(|normals| (normals.corners.into_per_corner(), normals.report))
        .map_err(|error| document.mesh_error(path, error))
}

/// Numbers keys from zero in the order of first occurrence.
fn numbered<K: Eq + Hash>(keys: impl Iterator<Item = K>) -> Vec<u32> {
    let mut numbers = HashMap::new();
    keys.map(|key| {
        let next = numbers.len() as u32;
        *numbers.entry(key).or_insert(next)
    })
    .collect()
}

/// The bits of a vector, equal for equal vectors: -0 becomes 0.
fn bits(vector: [f32; 3]) -> [u32; 3] {
    vector.map(|x| (x + 0.0).to_bits())
}

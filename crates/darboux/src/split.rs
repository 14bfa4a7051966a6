//! Corner tangents to an indexed mesh with the fewest vertices that correctness allows.

use std::collections::HashMap;

use crate::Context;
use crate::Convention;
use crate::CornerTangentsRef;
use crate::Indices;
use crate::Mesh;
use crate::MeshError;
use crate::cancel::Cancel;

/// An indexed mesh's vertices after splitting. The old vertices come first, in their old places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexSplit {
    /// One tangent per new vertex: unit xyz and sign w. Vertices that no corner uses get (1, 0, 0, 1).
    pub tangent_of_vertex: Vec<[f32; 4]>,
    /// The new index list, one per corner, in the old corner order.
    pub indices: Vec<u32>,
    /// The old vertex that each new vertex copies; `source_of_vertex[v] == v` for every old vertex. Gather any other attribute,
    /// skin weight or morph target with it: `new[v] = old[source_of_vertex[v]]`.
    pub source_of_vertex: Vec<u32>,
}

/// Splits the vertices whose corners need different tangents.
///
/// One vertex per distinct pair of old vertex and tangent (all four floats compared as bits). Old vertices keep their number;
/// further ones are appended in the order of the corners that ask for them. The index list keeps its length and order.
/// Errors: tangents of another number of corners.
pub fn split_vertices<'a>(
    mesh: &Mesh<'_>,
    corners: impl Into<CornerTangentsRef<'a>>,
) -> Result<VertexSplit, MeshError> {
    split_vertices_with(mesh, corners, &Context::new())
}

/// As [`split_vertices`], with a context. Further error: the context's token was cancelled.
pub fn split_vertices_with<'a>(
    mesh: &Mesh<'_>,
    corners: impl Into<CornerTangentsRef<'a>>,
    context: &Context,
) -> Result<VertexSplit, MeshError> {
    let mut splitter = Splitter::new_with(mesh.vertex_count(), context);
    let indices = splitter.add(mesh, corners)?;
    let (tangent_of_vertex, source_of_vertex) = splitter.finish();
    Ok(VertexSplit { tangent_of_vertex, indices, source_of_vertex })
}

/// Splits several meshes over one vertex buffer jointly, so that they go on sharing it.
///
/// [`Splitter::add`] each mesh, then [`Splitter::finish`]. Each `add` costs time in the mesh's corners, not in the buffer's size.
#[derive(Debug)]
pub struct Splitter {
    tangent_of_vertex: Vec<[f32; 4]>,
    source_of_vertex: Vec<u32>,
    /// The next vertex with the same source, or one of the two marks.
    next_of_vertex: Vec<u32>,
    /// Vertices at the ends of long lists, by source and tangent: a fan of a million tangents must not be walked again and again.
    far: HashMap<(u32, [u32; 4]), u32>,
    old_count: usize,
    cancel: Option<Cancel>,
}

/// In place of a next vertex: no corner uses this one yet.
const UNUSED: u32 = u32::MAX;
/// In place of a next vertex: this is the last.
const LAST: u32 = u32::MAX - 1;

/// Corners between two cancellation checks.
const CHUNK: usize = 1 << 12;

/// Vertices that are looked at one by one before the map of far ones is asked.
const NEAR: usize = if cfg!(small_limits) { 2 } else { 16 };

impl Splitter {
    /// Starts with `vertex_count` old vertices.
    pub fn new(vertex_count: usize) -> Self {
        Self::new_with(vertex_count, &Context::new())
    }

    /// As [`Splitter::new`], with a context, whose token cancels [`Splitter::add`] and [`Splitter::add_changes`].
    pub fn new_with(vertex_count: usize, context: &Context) -> Self {
        Self {
            cancel: context.limits().cancel.cloned(),
            tangent_of_vertex: vec![[1.0, 0.0, 0.0, 1.0]; vertex_count],
            source_of_vertex: (0..vertex_count as u32).collect(),
            next_of_vertex: vec![UNUSED; vertex_count],
            far: HashMap::new(),
            old_count: vertex_count,
        }
    }

    /// Gives every corner of `mesh` its vertex: the new index list.
    ///
    /// Errors: tangents of another number of corners, a mesh over another number of vertices.
    pub fn add<'a>(
        &mut self,
        mesh: &Mesh<'_>,
        corners: impl Into<CornerTangentsRef<'a>>,
    ) -> Result<Vec<u32>, MeshError> {
        let old = |corner| mesh.vertex_of_corner(corner) as u32;
        Ok(self.add_changes(mesh, corners)?.unwrap_or_else(|| (0..mesh.corner_count()).map(old).collect()))
    }

    /// As [`Splitter::add`], but none where the old index list serves.
    pub fn add_changes<'a>(
        &mut self,
        mesh: &Mesh<'_>,
        corners: impl Into<CornerTangentsRef<'a>>,
    ) -> Result<Option<Vec<u32>>, MeshError> {
        let CornerTangentsRef(tangents) = corners.into();
        expect("corners", mesh.corner_count(), tangents.len())?;
        expect("vertices", self.old_count, mesh.vertex_count())?;
        match mesh.indices() {
            Indices::Unindexed => self.changes(0..tangents.len() as u32, tangents),
            Indices::U16(list) => self.changes(list.iter().map(|&index| index.into()), tangents),
            Indices::U32(list) => self.changes(list.iter().copied(), tangents),
        }
    }

    /// The vertices of corners, from the old ones; none where they are the same.
    fn changes(
        &mut self,
        old: impl Iterator<Item = u32> + Clone,
        tangents: &[[f32; 4]],
    ) -> Result<Option<Vec<u32>>, MeshError> {
        let Some(first) = self.first_change(old.clone(), tangents)? else { return Ok(None) };
        let mut vertices = Vec::with_capacity(tangents.len());
        vertices.extend(old.clone().take(first));
        let mut corners = old.zip(tangents).skip(first);
        for _ in (first..tangents.len()).step_by(CHUNK) {
            self.check()?;
            vertices.extend(corners.by_ref().take(CHUNK).map(|(old, &tangent)| self.vertex(old, tangent)));
        }
        Ok(Some(vertices))
    }

    /// The first corner that needs another vertex than its old one.
    fn first_change(
        &mut self,
        old: impl Iterator<Item = u32>,
        tangents: &[[f32; 4]],
    ) -> Result<Option<usize>, MeshError> {
        let mut corners = old.zip(tangents);
        for start in (0..tangents.len()).step_by(CHUNK) {
            self.check()?;
            let mut chunk = corners.by_ref().take(CHUNK);
            if let Some(at) = chunk.position(|(old, &tangent)| !self.takes(old, tangent)) {
                return Ok(Some(start + at));
            }
        }
        Ok(None)
    }

    fn check(&self) -> Result<(), MeshError> {
        if self.cancel.as_ref().is_some_and(Cancel::is_cancelled) {
            Err(MeshError::Cancelled)
        } else {
            Ok(())
        }
    }

    /// The vertex for `old` with `tangent`: the old one if it can have it, else an appended one.
    fn vertex(&mut self, old: u32, tangent: [f32; 4]) -> u32 {
        if self.takes(old, tangent) { old } else { self.further(old, tangent) }
    }

    /// Whether `old` has `tangent`; it takes it if no corner uses it yet.
    #[inline]
    fn takes(&mut self, old: u32, tangent: [f32; 4]) -> bool {
        let next = &mut self.next_of_vertex[old as usize];
        if *next == UNUSED {
            *next = LAST;
            self.tangent_of_vertex[old as usize] = tangent;
            return true;
        }
        has_bits(&self.tangent_of_vertex[old as usize], &tangent)
    }

    /// The appended vertex for `old` with `tangent`, found or made.
    fn further(&mut self, old: u32, tangent: [f32; 4]) -> u32 {
        let mut last = old;
        for _ in 1..NEAR {
            match self.next_of_vertex[last as usize] {
                LAST => {
                    let appended = self.append(old, tangent);
                    self.next_of_vertex[last as usize] = appended;
                    return appended;
                }
                next if has_bits(&self.tangent_of_vertex[next as usize], &tangent) => return next,
                next => last = next,
            }
        }
        let key = (old, tangent.map(f32::to_bits));
        if let Some(&known) = self.far.get(&key) {
            return known;
        }
        let appended = self.append(old, tangent);
        self.far.insert(key, appended);
        appended
    }

    fn append(&mut self, old: u32, tangent: [f32; 4]) -> u32 {
        self.tangent_of_vertex.push(tangent);
        self.source_of_vertex.push(old);
        self.next_of_vertex.push(LAST);
        self.source_of_vertex.len() as u32 - 1
    }

    /// As [`Splitter::finish`], with the tangents written in another convention, but for those of unused vertices.
    pub fn finish_in(mut self, from: Convention, to: Convention) -> (Vec<[f32; 4]>, Vec<u32>) {
        let conversion = from.to(to);
        for (tangent, &next) in self.tangent_of_vertex.iter_mut().zip(&self.next_of_vertex) {
            if next != UNUSED {
                *tangent = conversion.tangent(*tangent);
            }
        }
        self.finish()
    }

    /// The tangent and the source of every new vertex, as in [`VertexSplit`].
    pub fn finish(self) -> (Vec<[f32; 4]>, Vec<u32>) {
        (self.tangent_of_vertex, self.source_of_vertex)
    }
}

fn has_bits(held: &[f32; 4], wanted: &[f32; 4]) -> bool {
    held.map(f32::to_bits) == wanted.map(f32::to_bits)
}

/// An error unless as many were found as expected.
pub(crate) fn expect(what: &'static str, expected: usize, found: usize) -> Result<(), MeshError> {
    if expected == found { Ok(()) } else { Err(MeshError::OtherMesh { what, expected, found }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CornerTangents;

    /// The shortest code for the same: the first tangent of a vertex stays, further ones are appended as they come.
    fn naive(old: &[u32], tangents: &[[f32; 4]], vertex_count: usize) -> (Vec<u32>, Vec<u32>) {
        let mut sources: Vec<u32> = (0..vertex_count as u32).collect();
        let mut held: Vec<Option<[u32; 4]>> = vec![None; vertex_count];
        let mut indices = Vec::new();
        for (&old, tangent) in old.iter().zip(tangents) {
            let bits = tangent.map(f32::to_bits);
            let fits = |v: usize| sources[v] == old && held[v].is_none_or(|held| held == bits);
            let found = (0..sources.len()).find(|&v| fits(v)).unwrap_or(sources.len());
            if found == sources.len() {
                sources.push(old);
                held.push(None);
            }
            held[found] = Some(bits);
            indices.push(found as u32);
        }
        (indices, sources)
    }

    #[test]
    fn vertices_are_those_of_the_naive_search() {
        let vertices = [[0.0; 3]; 4];
        let mesh = |old| Mesh::triangles(&vertices, &vertices, &[[0.0; 2]; 4], Indices::U32(old)).unwrap();
        // Zeros and NaNs of other bits are other tangents; one vertex has far more of them than are looked at one by one.
        let palette = |i: u32| match i % 50 {
            0 => [0.0; 4],
            1 => [-0.0, 0.0, 0.0, 0.0],
            2 => [f32::NAN; 4],
            3 => [-f32::NAN; 4],
            other => [other as f32, 0.0, 0.0, 1.0],
        };
        let random = |i: u32| (i.wrapping_mul(2_654_435_761) >> 7) ^ i;
        let old: Vec<u32> = (0..1200).map(|i| [0, 0, 0, 1, 2][random(i) as usize % 5]).collect();
        let tangents: Vec<_> = (0..1200)
            .map(|i| palette(random(i + 5000) / if old[i as usize] == 2 { 40 } else { 1 }))
            .collect();
        let (indices, sources) = naive(&old, &tangents, 4);
        assert!(sources.iter().filter(|&&source| source == 0).count() > 2 * NEAR);

        let mut splitter = Splitter::new(4);
        let (first, second) = tangents.split_at(600);
        let mut found = splitter.add(&mesh(&old[..600]), &CornerTangents(first.to_vec())).unwrap();
        found.extend(splitter.add(&mesh(&old[600..]), &CornerTangents(second.to_vec())).unwrap());
        assert_eq!(splitter.add_changes(&mesh(&[]), &CornerTangents(Vec::new())).unwrap(), None);
        let (tangent_of_vertex, source_of_vertex) = splitter.finish();
        assert_eq!(found, indices);
        assert_eq!(source_of_vertex, sources);
        for (&vertex, tangent) in found.iter().zip(&tangents) {
            assert!(has_bits(&tangent_of_vertex[vertex as usize], tangent));
        }
        assert_eq!(tangent_of_vertex[3], [1.0, 0.0, 0.0, 1.0], "unused");
    }
}

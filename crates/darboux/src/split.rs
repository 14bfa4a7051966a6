//! Splits vertices whose corners have different tangents: from corner tangents to an indexed mesh with the
//! fewest vertices.
//!
//! The vertices with one source form a linked list. A fan whose corners all differ has a long list, so
//! vertices beyond the first few go to a hash map.

use std::collections::HashMap;

use crate::Context;
use crate::Convention;
use crate::CornerTangentsRef;
use crate::Error;
use crate::Indices;
use crate::Mesh;
use crate::cancel::Cancel;
use crate::math::distinct_bits;

/// The vertices of an indexed mesh after splitting. The old vertices come first and keep their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexSplit {
    /// One tangent per new vertex: unit xyz and sign w. (1, 0, 0, 1) for vertices that no corner uses.
    pub tangent_of_vertex: Vec<[f32; 4]>,
    /// The new index list, one per corner, in the old corner order.
    pub indices: Vec<u32>,
    /// The old vertex that each new vertex copies; `source_of_vertex[v] == v` for every old vertex. All
    /// other attributes and morph targets follow from it: `new[v] = old[source_of_vertex[v]]`.
    pub source_of_vertex: Vec<u32>,
}

/// The vertices of a buffer after several meshes that share it were split. The old vertices come first and
/// keep their numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SplitBuffer {
    /// As [`VertexSplit::tangent_of_vertex`].
    pub tangent_of_vertex: Vec<[f32; 4]>,
    /// As [`VertexSplit::source_of_vertex`].
    pub source_of_vertex: Vec<u32>,
}

/// Splits the vertices whose corners have different tangents.
///
/// Each distinct pair of old vertex and tangent (four floats, compared as bits; NaN equals NaN) becomes one
/// vertex. Old vertices keep their numbers; new ones are appended in the order of their first corners. The
/// index list keeps its length and order. `corners`: one tangent per corner. Errors: another number of
/// tangents than corners.
pub fn split_vertices<'a>(
    mesh: &Mesh<'_>,
    corners: impl Into<CornerTangentsRef<'a>>,
) -> Result<VertexSplit, Error> {
    split_vertices_with(mesh, corners, &mut Context::new())
}

/// As [`split_vertices`], with a context. Further error: the context's token was cancelled.
pub fn split_vertices_with<'a>(
    mesh: &Mesh<'_>,
    corners: impl Into<CornerTangentsRef<'a>>,
    context: &mut Context,
) -> Result<VertexSplit, Error> {
    let mut splitter = Splitter::new_with(mesh.vertex_count(), context);
    let indices = splitter.add(mesh, corners)?;
    let SplitBuffer { tangent_of_vertex, source_of_vertex } = splitter.finish();
    Ok(VertexSplit { tangent_of_vertex, indices, source_of_vertex })
}

/// Splits several meshes that share one vertex buffer, so that they share the new one as well.
///
/// Call [`Splitter::add`] for each mesh, then [`Splitter::finish`]. The time of `add` depends on the mesh's
/// corners, not on the size of the vertex buffer.
#[derive(Debug)]
pub struct Splitter {
    tangent_of_vertex: Vec<[f32; 4]>,
    source_of_vertex: Vec<u32>,
    /// The next vertex with the same source, or [`UNUSED`] or [`LAST`].
    next_of_vertex: Vec<u32>,
    /// The vertices beyond the first [`LIST_LIMIT`] of their source, by source and tangent.
    overflow: HashMap<(u32, [u32; 4]), u32>,
    old_count: usize,
    cancel: Option<Cancel>,
}

/// Sentinel of `next_of_vertex`: no corner uses the vertex yet.
const UNUSED: u32 = u32::MAX;
/// Sentinel of `next_of_vertex`: the vertex is the last of its list.
const LAST: u32 = u32::MAX - 1;

/// The number of corners between two cancellation checks.
const CHUNK: usize = 1 << 12;

/// The number of vertices per source that are searched linearly before the hash map.
const LIST_LIMIT: usize = if cfg!(small_limits) { 2 } else { 16 };

impl Splitter {
    /// A splitter for a buffer of `vertex_count` vertices.
    pub fn new(vertex_count: usize) -> Self {
        Self::new_with(vertex_count, &mut Context::new())
    }

    /// As [`Splitter::new`], with the token of a context. The splitter keeps a clone of the token, which
    /// cancels [`Splitter::add`] and [`Splitter::add_or_keep`].
    pub fn new_with(vertex_count: usize, context: &mut Context) -> Self {
        Self {
            cancel: context.limits().cancel.cloned(),
            tangent_of_vertex: vec![[1.0, 0.0, 0.0, 1.0]; vertex_count],
            source_of_vertex: (0..vertex_count as u32).collect(),
            next_of_vertex: vec![UNUSED; vertex_count],
            overflow: HashMap::new(),
            old_count: vertex_count,
        }
    }

    /// Adds a mesh. Returns its new index list: one vertex per corner.
    ///
    /// `corners`: one tangent per corner. Errors: another number of tangents than corners; a mesh with
    /// another number of vertices.
    pub fn add<'a>(
        &mut self,
        mesh: &Mesh<'_>,
        corners: impl Into<CornerTangentsRef<'a>>,
    ) -> Result<Vec<u32>, Error> {
        let old = |corner| mesh.vertex_of_corner(corner) as u32;
        Ok(self.add_or_keep(mesh, corners)?.unwrap_or_else(|| (0..mesh.corner_count()).map(old).collect()))
    }

    /// As [`Splitter::add`]. `None` if the mesh keeps its index list.
    pub fn add_or_keep<'a>(
        &mut self,
        mesh: &Mesh<'_>,
        corners: impl Into<CornerTangentsRef<'a>>,
    ) -> Result<Option<Vec<u32>>, Error> {
        let CornerTangentsRef(tangents) = corners.into();
        Error::check_input("tangents", mesh.corner_count(), tangents.len())?;
        Error::check_mesh("vertices", self.old_count, mesh.vertex_count())?;
        match mesh.indices() {
            Indices::Unindexed => self.new_indices(0..tangents.len() as u32, tangents),
            Indices::U16(list) => self.new_indices(list.iter().map(|&index| index.into()), tangents),
            Indices::U32(list) => self.new_indices(list.iter().copied(), tangents),
        }
    }

    /// The vertices of corners with these old vertices. `None` if all corners keep theirs.
    fn new_indices(
        &mut self,
        old: impl Iterator<Item = u32> + Clone,
        tangents: &[[f32; 4]],
    ) -> Result<Option<Vec<u32>>, Error> {
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
    ) -> Result<Option<usize>, Error> {
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

    fn check(&self) -> Result<(), Error> {
        if self.cancel.as_ref().is_some_and(Cancel::is_cancelled) { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// The vertex with source `old` and this tangent: the old vertex, if it has the tangent or none yet; else
    /// an appended one.
    fn vertex(&mut self, old: u32, tangent: [f32; 4]) -> u32 {
        if self.takes(old, tangent) { old } else { self.appended(old, tangent) }
    }

    /// True when the old vertex has the tangent. A vertex that no corner uses yet takes it.
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

    /// The appended vertex with source `old` and this tangent, which is appended if it is absent.
    fn appended(&mut self, old: u32, tangent: [f32; 4]) -> u32 {
        let mut last = old;
        for _ in 1..LIST_LIMIT {
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
        let key = (old, distinct_bits(tangent));
        if let Some(&vertex) = self.overflow.get(&key) {
            return vertex;
        }
        let appended = self.append(old, tangent);
        self.overflow.insert(key, appended);
        appended
    }

    fn append(&mut self, old: u32, tangent: [f32; 4]) -> u32 {
        self.tangent_of_vertex.push(tangent);
        self.source_of_vertex.push(old);
        self.next_of_vertex.push(LAST);
        self.source_of_vertex.len() as u32 - 1
    }

    /// As [`Splitter::finish`], with the tangents converted from one convention to another. Tangents of
    /// unused vertices stay (1, 0, 0, 1).
    pub fn finish_in(mut self, from: Convention, to: Convention) -> SplitBuffer {
        let conversion = from.to(to);
        for (tangent, &next) in self.tangent_of_vertex.iter_mut().zip(&self.next_of_vertex) {
            if next != UNUSED {
                *tangent = conversion.tangent(*tangent);
            }
        }
        self.finish()
    }

    /// Returns the vertices of the split buffer.
    pub fn finish(self) -> SplitBuffer {
        SplitBuffer { tangent_of_vertex: self.tangent_of_vertex, source_of_vertex: self.source_of_vertex }
    }
}

/// Whether two tangents have the same bits. All NaNs count as the same.
fn has_bits(held: &[f32; 4], wanted: &[f32; 4]) -> bool {
    held.map(f32::to_bits) == wanted.map(f32::to_bits) || distinct_bits(*held) == distinct_bits(*wanted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CornerTangents;

    /// The same result by linear search: the first tangent of a vertex stays, others are appended in order.
    fn naive(old: &[u32], tangents: &[[f32; 4]], vertex_count: usize) -> (Vec<u32>, Vec<u32>) {
        let mut sources: Vec<u32> = (0..vertex_count as u32).collect();
        let mut held: Vec<Option<[u32; 4]>> = vec![None; vertex_count];
        let mut indices = Vec::new();
        for (&old, tangent) in old.iter().zip(tangents) {
            let bits = distinct_bits(*tangent);
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
        // Zeros of different signs are different tangents, NaNs are not. One vertex has more tangents than
        // the linear search covers.
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
        assert!(sources.iter().filter(|&&source| source == 0).count() > 2 * LIST_LIMIT);

        let mut splitter = Splitter::new(4);
        let (first, second) = tangents.split_at(600);
        let mut found = splitter.add(&mesh(&old[..600]), &CornerTangents(first.to_vec())).unwrap();
        found.extend(splitter.add(&mesh(&old[600..]), &CornerTangents(second.to_vec())).unwrap());
        assert_eq!(splitter.add_or_keep(&mesh(&[]), &CornerTangents(Vec::new())).unwrap(), None);
        let SplitBuffer { tangent_of_vertex, source_of_vertex } = splitter.finish();
        assert_eq!(found, indices);
        assert_eq!(source_of_vertex, sources);
        for (&vertex, tangent) in found.iter().zip(&tangents) {
            assert!(has_bits(&tangent_of_vertex[vertex as usize], tangent));
        }
        assert_eq!(tangent_of_vertex[3], [1.0, 0.0, 0.0, 1.0], "unused");
    }
}

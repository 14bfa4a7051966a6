//! Splits the vertices of one group: vertices whose corners have different tangents are duplicated.

use std::mem;

use darboux::{Convention, CornerTangentsRef, SplitBuffer, Splitter};

use super::compute::{JobResult, Vertices};
use super::groups::{Group, Job};
use crate::Error;
use crate::gltf::Document;

/// The vertices of a group after splitting: the old ones at their indices, then copies of some.
#[derive(Debug)]
pub struct Split {
    /// The tangent of every vertex.
    pub tangents: Vec<[f32; 4]>,
    /// The old vertex that each appended vertex is a copy of.
    pub copies: Vec<u32>,
    /// The vertices of each job's corners, unless they are the old ones. Empty after [`Split::take_lists`].
    corners: Vec<Option<Vec<u32>>>,
}

/// Splits the results of a group's jobs jointly.
///
/// `at` is the JSON path of the group's first primitive. Errors: more vertices than 32-bit indices can
/// address.
pub fn split(
    document: &Document,
    at: &str,
    group: &Group,
    vertices: &mut Vertices<'_>,
    results: &[JobResult<'_>],
) -> Result<Split, Error> {
    let corner_count: usize = results.iter().map(|result| result.corners.len()).sum();
    if vertices.positions.len().saturating_add(corner_count) >= u32::MAX as usize {
        return Err(document.invalid(at, "has too many vertices for 32-bit indices; divide the mesh"));
    }
    let mut splitter = Splitter::new(vertices.positions.len());
    let mut corners = Vec::with_capacity(results.len());
    for (job, result) in group.jobs.iter().zip(results) {
        let mesh = vertices.mesh(document, at, job, &result.corners, None)?;
        let added = splitter.add_or_keep(&mesh, CornerTangentsRef::from_per_corner(&result.tangents));
        corners.push(added.map_err(|error| document.mesh_error(at, error))?);
    }
    let SplitBuffer { tangent_of_vertex: tangents, source_of_vertex: mut copies } =
        splitter.finish_in(Convention::GLTF.generated(), Convention::GLTF);
    copies.drain(..vertices.positions.len());
    Ok(Split { tangents, copies, corners })
}

impl Split {
    /// The number of vertices after splitting.
    pub fn vertex_count(&self) -> usize {
        self.tangents.len()
    }

    /// The number of vertices before splitting.
    pub fn old_vertex_count(&self) -> usize {
        self.tangents.len() - self.copies.len()
    }

    /// The new index list of each job; none if the old one is kept.
    pub fn take_lists(&mut self, group: &Group, results: &[JobResult<'_>]) -> Vec<Option<Vec<u32>>> {
        let is_needed = self.is_needed();
        let unindexed = |job: &Job| is_needed && job.indices.is_none();
        let jobs = group.jobs.iter().zip(results).zip(mem::take(&mut self.corners));
        jobs.map(|((job, result), corners)| {
            let mut list = corners.or_else(|| unindexed(job).then(|| result.corners.iter().collect()))?;
            list.extend(&result.rest);
            Some(list)
        })
        .collect()
    }

    /// The vertices of the corners of a job.
    pub fn vertices<'a>(
        &'a self,
        job: usize,
        result: &'a JobResult<'_>,
    ) -> Box<dyn Iterator<Item = u32> + 'a> {
        match &self.corners[job] {
            Some(corners) => Box::new(corners.iter().copied()),
            None => result.corners.iter(),
        }
    }

    /// Whether any vertex was duplicated.
    pub fn is_needed(&self) -> bool {
        !self.copies.is_empty()
    }
}

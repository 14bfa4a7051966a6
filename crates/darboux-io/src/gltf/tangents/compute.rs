//! The tangents of one group: read its vertices once, then compute each job in time of its own corners.

use std::mem;

use darboux::{Convention, CornerTangents, Indices, Mesh, Report, generate_tangents};

use super::TangentsOptions;
use super::evaluator::Evaluator;
use super::share::{Group, Job};
use crate::Error;
use crate::gltf::Document;

/// The vertices of a group, and moved ones while morph targets are evaluated.
#[derive(Debug)]
pub struct Vertices {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    stored_uvs: Vec<[f32; 2]>,
    /// The UVs that the job at hand sees. Where it has no corner they may be another's.
    uvs: Vec<[f32; 2]>,
}

impl Vertices {
    /// Reads what the accessors of `group` hold.
    pub fn read(document: &Document, group: &Group) -> Result<Self, Error> {
        let uvs = document.read_vectors(group.uv)?;
        let transformed = group.jobs.iter().any(|job| job.transform.is_some());
        Ok(Self {
            positions: document.read_vectors(group.position)?,
            normals: document.read_vectors(group.normal)?,
            stored_uvs: if transformed { uvs.clone() } else { Vec::new() },
            uvs,
        })
    }

    /// Moves the vertices. Returns the positions and normals that they had.
    pub fn replace(
        &mut self,
        positions: Vec<[f32; 3]>,
        normals: Vec<[f32; 3]>,
    ) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
        (mem::replace(&mut self.positions, positions), mem::replace(&mut self.normals, normals))
    }

    /// The mesh of `job` over `corners`, its transform applied to the vertices that it uses, and to no other, so that many
    /// jobs on a large buffer stay cheap.
    pub fn mesh<'a>(
        &'a mut self,
        document: &Document,
        at: &str,
        job: &Job,
        corners: &'a [u32],
    ) -> Result<Mesh<'a>, Error> {
        for &corner in corners {
            let Some(&stored) = self.stored_uvs.get(corner as usize) else { continue };
            self.uvs[corner as usize] = job.transform.map_or(stored, |transform| transform.apply(stored));
        }
        Mesh::triangles(&self.positions, &self.normals, &self.uvs, Indices::U32(corners))
            .map_err(|error| document.mesh_error(at, error))
    }
}

/// The result of one job.
#[derive(Debug)]
pub struct Surface {
    /// The vertices of all whole triangles, three each.
    pub corners: Vec<u32>,
    /// Indices after the last whole triangle.
    pub rest: Vec<u32>,
    /// In glTF's convention.
    pub tangents: CornerTangents,
    pub report: Report,
    /// What evaluates morph targets, if there are any.
    pub evaluator: Option<Evaluator>,
}

/// Computes a job. `at` is the JSON path of a primitive that it belongs to; with `morphs` it is kept ready for morph targets.
///
/// Errors: indices out of range, attributes of different lengths; with [`TangentsOptions::strict`], unusable data.
pub fn surface(
    document: &Document,
    at: &str,
    vertices: &mut Vertices,
    job: &Job,
    morphs: bool,
    options: &TangentsOptions,
) -> Result<Surface, Error> {
    let mut corners = indices(document, job, vertices.positions.len())?;
    let rest = corners.split_off(job.topology.whole(corners.len()));
    let corners = job.topology.corners(corners);
    let mesh = vertices.mesh(document, at, job, &corners)?;
    let (tangents, evaluator) = if morphs {
        let (tangents, evaluator) = Evaluator::new(&mesh, &options.tangents);
        (tangents, Some(evaluator))
    } else {
        (generate_tangents(&mesh, &options.tangents), None)
    };
    if options.strict {
        refuse_unusable(document, at, &tangents.report)?;
    }
    let report = tangents.report;
    let tangents = tangents.corners.converted(Convention::GLTF.generated(), Convention::GLTF);
    let tangents = tangents.map(|tangent| options.encoding.rounded(tangent));
    Ok(Surface { corners, rest, tangents, report, evaluator })
}

fn indices(document: &Document, job: &Job, vertex_count: usize) -> Result<Vec<u32>, Error> {
    match job.indices {
        Some(accessor) => document.read_indices(accessor),
        None => Ok((0..vertex_count as u32).collect()),
    }
}

fn refuse_unusable(document: &Document, at: &str, report: &Report) -> Result<(), Error> {
    let refused = |count: usize, what: &str| {
        let advice = "mend the model, or run without strict";
        Err(document.invalid(at, format!("{count} corners have {what}; {advice}")))
    };
    match (report.non_finite_corners, report.repaired_corners) {
        (0, 0) => Ok(()),
        (0, repaired) => refused(repaired, "no usable tangent"),
        (non_finite, _) => refused(non_finite, "a position, normal or UV that is not finite"),
    }
}

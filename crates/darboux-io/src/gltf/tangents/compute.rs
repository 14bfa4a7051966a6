//! Computes the tangents of one group. Its vertices are read once; each job takes time proportional to its
//! corners.

use std::borrow::Cow;
use std::{fmt, mem};

use darboux::{Context, Faces, Mesh, Plan, Report, TangentOptions, Tangents, write_tangents};

use super::corner_memory::CornerMemory;
use super::encoding::TangentEncoding;
use super::groups::{Group, Job};
use super::options::AddTangentsOptions;
use crate::Error;
use crate::gltf::primitives::element_count;
use crate::gltf::primitives::quads::QuadFaces;
use crate::gltf::primitives::triangles::TriangleMode;
use crate::gltf::primitives::used_vertices::UsedVertices;
use crate::gltf::{Document, IndexList, PrimitiveName};

/// One vector per vertex.
type Vectors<'a> = Cow<'a, [[f32; 3]]>;

/// The vertices of a group. While a morph target is evaluated, they are the moved ones.
#[derive(Debug)]
pub struct Vertices<'a> {
    pub positions: Vectors<'a>,
    pub normals: Vectors<'a>,
    /// The UVs without a texture transform; none if no job has a transform.
    stored_uvs: Option<Cow<'a, [[f32; 2]]>>,
    /// The UVs of the current job. UVs of vertices outside the job are unspecified.
    uvs: Cow<'a, [[f32; 2]]>,
    /// The vertices that were read, ascending; none if all were.
    used: Option<Vec<u32>>,
}

impl<'a> Vertices<'a> {
    /// Reads the accessors of a group.
    pub fn read(document: &'a Document, group: &Group) -> Result<Self, Error> {
        let positions = document.vectors(group.position)?;
        let uvs = match group.uv {
            Some(uv) => document.vectors(uv)?,
            None => vec![[0.0; 2]; positions.len()].into(),
        };
        let transformed = group.jobs.iter().any(|job| job.transform.is_some());
        Ok(Self {
            positions,
            normals: document.vectors(group.normal)?,
            stored_uvs: transformed.then(|| uvs.clone()),
            uvs,
            used: None,
        })
    }

    /// Reads the vertices that the jobs of a group use, where there are many others. Its jobs are numbered by
    /// these vertices then.
    pub fn read_used(document: &'a Document, group: &Group) -> Result<Self, Error> {
        let count = element_count(document, group.position)?;
        let of_job =
            |job: &Job| job.indices.map_or(Some(count), |list| Some(document.accessors().get(list)?.count));
        let corners = group.jobs.iter().filter_map(of_job).fold(0, usize::saturating_add);
        if count <= corners {
            return Self::read(document, group);
        }
        let mut corners = Vec::new();
        for accessor in group.jobs.iter().filter_map(|job| job.indices) {
            corners.extend(document.indices(accessor)?.iter());
        }
        // The sentence about an index out of range names it, and the number of all vertices.
        if corners.iter().any(|&vertex| vertex as usize >= count) {
            return Self::read(document, group);
        }
        let Some(used) = UsedVertices::of(&corners, count) else { return Self::read(document, group) };
        let used = used.vertices;
        let uvs = match group.uv {
            Some(uv) => document.vectors_at(uv, &used)?,
            None => vec![[0.0; 2]; used.len()],
        };
        let transformed = group.jobs.iter().any(|job| job.transform.is_some());
        Ok(Self {
            positions: document.vectors_at(group.position, &used)?.into(),
            normals: document.vectors_at(group.normal, &used)?.into(),
            stored_uvs: transformed.then(|| uvs.clone().into()),
            uvs: uvs.into(),
            used: Some(used),
        })
    }

    /// Corners by the vertices that were read.
    fn numbered<'i>(&self, corners: IndexList<'i>) -> IndexList<'i> {
        let Some(used) = &self.used else { return corners };
        let place = |vertex: u32| used.partition_point(|used| *used < vertex) as u32;
        IndexList::U32(corners.iter().map(place).collect())
    }

    /// Replaces positions and normals. Returns the previous ones.
    pub fn replace(&mut self, positions: Vectors<'a>, normals: Vectors<'a>) -> (Vectors<'a>, Vectors<'a>) {
        (mem::replace(&mut self.positions, positions), mem::replace(&mut self.normals, normals))
    }

    /// The mesh of a job, of `quads` where its triangles were cut from these. Its texture transform is
    /// applied to the vertices that it uses only, so that many jobs over a large buffer take linear time.
    pub fn mesh<'m>(
        &'m mut self,
        document: &Document,
        at: &str,
        job: &Job,
        corners: &'m IndexList<'_>,
        quads: Option<&'m QuadFaces>,
    ) -> Result<Mesh<'m>, Error> {
        if let Some(stored) = &self.stored_uvs {
            let uvs = self.uvs.to_mut();
            for corner in corners.iter() {
                let Some(&stored) = stored.get(corner as usize) else { continue };
                uvs[corner as usize] = job.transform.map_or(stored, |transform| transform.apply(stored));
            }
        }
        let (positions, normals, uvs) = (&*self.positions, &*self.normals, &*self.uvs);
        let mesh = match quads {
            None => Mesh::triangles(positions, normals, uvs, corners.as_indices()),
            Some(QuadFaces { vertices, sizes, .. }) => {
                Mesh::with_faces(positions, normals, uvs, vertices, Faces::Mixed(sizes))
            }
        };
        mesh.map_err(|error| document.mesh_error(at, error))
    }
}

/// The result of one job.
#[derive(Debug)]
pub struct JobResult<'a> {
    /// The vertices of all complete triangles, three per triangle.
    pub corners: IndexList<'a>,
    /// The indices after the last complete triangle.
    pub rest: Vec<u32>,
    /// The tangents in the convention of generation.
    pub tangents: CornerMemory,
    pub report: Report,
    /// The plan that evaluates morph targets, if there are any.
    pub plan: Option<Plan>,
    /// The faces that the triangles were cut from, where some are quads; the plan is over these.
    pub quads: Option<QuadFaces>,
}

/// What computes the tangents of meshes without morph targets.
pub enum Generate<'a> {
    /// [`darboux::write_tangents`]. Threads share large meshes, and take small ones each for itself.
    OnCpu,
    /// Another function, one mesh after the other; a failure is one sentence.
    With(&'a mut GenerateFn<'a>),
}

/// A function that computes the tangents of a mesh, as [`darboux::generate_tangents_with`] does; a failure is
/// one sentence.
pub type GenerateFn<'a> =
    dyn FnMut(&Mesh<'_>, &TangentOptions, &mut Context) -> Result<Tangents, String> + 'a;

impl fmt::Debug for Generate<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OnCpu => "OnCpu",
            Self::With(_) => "With(..)",
        })
    }
}

impl Generate<'_> {
    fn call(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
    ) -> Result<(CornerMemory, Report), String> {
        match self {
            Self::OnCpu => {
                let mut tangents = CornerMemory::new(mesh.corner_count());
                let report = write_tangents(mesh, options, context, &mut tangents);
                Ok((tangents, report.map_err(|error| error.to_string())?))
            }
            Self::With(function) => {
                let Tangents { corners, report, .. } = function(mesh, options, context)?;
                Ok((CornerMemory::Vector(corners.into_per_corner()), report))
            }
        }
    }
}

/// Computes a job. `name`: of its first primitive. With `morphs`, the result has a plan for morph targets.
///
/// Errors: indices out of range, attributes of different lengths; with [`AddTangentsOptions::strict`],
/// unusable data.
pub fn compute_job<'a>(
    document: &'a Document,
    name: &PrimitiveName,
    vertices: &mut Vertices<'_>,
    job: &Job,
    morphs: bool,
    options: &AddTangentsOptions,
    (generate, context): (&mut Generate<'_>, &mut Context),
) -> Result<JobResult<'a>, Error> {
    let mut corners = indices(document, job, vertices.positions.len())?;
    let rest = corners.split_off(job.topology.whole(corners.len()));
    let corners = match job.topology {
        TriangleMode::Triangles => corners,
        other => IndexList::U32(other.corners(corners.into_u32()).into()),
    };
    let corners = vertices.numbered(corners);
    let at = &*name.path();
    // Given tangents belong to triangles.
    let quads = if job.given.is_none() { QuadFaces::of(document, name, &corners) } else { None };
    let mesh = vertices.mesh(document, at, job, &corners, quads.as_ref())?;
    let (mut tangents, report, plan) = if morphs {
        let plan = Plan::new_with(&mesh, &options.tangents, context)
            .map_err(|error| document.mesh_error(at, error))?;
        let Tangents { corners, report, .. } = plan.base().clone();
        (CornerMemory::Vector(corners.into_per_corner()), report, Some(plan))
    } else {
        let tangents = generate.call(&mesh, &options.tangents, context);
        let (tangents, report) = tangents.map_err(|sentence| document.invalid(at, sentence))?;
        (tangents, report, None)
    };
    if let Some(quads) = &quads {
        tangents = CornerMemory::Vector(quads.of_triangles(&tangents));
    }
    if options.strict {
        refuse_unusable(document, at, &report)?;
    }
    if options.encoding != TangentEncoding::F32x4 {
        tangents.iter_mut().for_each(|tangent| *tangent = options.encoding.rounded(*tangent));
    }
    Ok(JobResult { corners, rest, tangents, report, plan, quads })
}

fn indices<'a>(document: &'a Document, job: &Job, vertex_count: usize) -> Result<IndexList<'a>, Error> {
    match job.indices {
        Some(accessor) => document.indices(accessor),
        None => Ok(IndexList::U32((0..vertex_count as u32).collect())),
    }
}

fn refuse_unusable(document: &Document, at: &str, report: &Report) -> Result<(), Error> {
    let refused = |count: usize, what: &str| {
        let advice = "repair the model, or run without strict";
        Err(document.invalid(at, format!("{count} corners have {what}; {advice}")))
    };
    match (report.non_finite_corners, report.repaired_corners) {
        (0, 0) => Ok(()),
        (0, repaired) => refused(repaired, "no usable tangent"),
        (non_finite, _) => refused(non_finite, "a position, normal or UV that is not finite"),
    }
}

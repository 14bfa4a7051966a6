//! Generates normals from positions: flat, or smooth with creases.
//!
//! ```text
//! area vector of each face = 1/2 sum of cross(p_i, p_(i+1)) (M. Newell), which does not depend on a triangulation
//! fan = corners at a vertex that are connected by edges below the crease angle (union-find)
//! normal of each fan = sum of its faces' unit normals, weighted by angle, area or both
//! ```
//!
//! Weights by angle: G. Thürmer and C. A. Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998.
//! Weights by angle times area keep wide faces flat beside bevels ("weighted normals").

use std::collections::HashMap;

use crate::Context;
use crate::CornerNormals;
use crate::CornerNormalsRef;
use crate::CornerTangents;
use crate::Error;
use crate::Faces;
use crate::Indices;
use crate::Mesh;
use crate::SplitBuffer;
use crate::Splitter;
use crate::Strided;
use crate::choice;
use crate::exec::limits::RunLimits;
use crate::exec::threads;
use crate::math::angle;
use crate::math_f64::{D3, cross, dot, length, sub, unit};
use crate::util::union_find::DisjointSets;

/// Options of [`generate_normals`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NormalOptions {
    /// Flat or smooth shading.
    pub shading: Shading,
    /// The weight of each face at a vertex, for smooth shading.
    pub weight: NormalWeight,
    /// The crease angle in degrees: smooth shading stops at edges whose faces' normals differ by more.
    /// Default 180: no creases.
    pub crease: f32,
    /// Whether smooth shading crosses seams of the index list.
    pub seams: SmoothingSeams,
}

impl Default for NormalOptions {
    fn default() -> Self {
        Self {
            shading: Shading::Smooth,
            weight: NormalWeight::default(),
            crease: 180.0,
            seams: SmoothingSeams::default(),
        }
    }
}

impl NormalOptions {
    /// The defaults: smooth everywhere, weighted by angle, over vertices at equal positions.
    pub fn new() -> Self {
        Self::default()
    }

    /// These options with another shading.
    #[must_use]
    pub fn with_shading(self, shading: Shading) -> Self {
        Self { shading, ..self }
    }

    /// These options with another weight.
    #[must_use]
    pub fn with_weight(self, weight: NormalWeight) -> Self {
        Self { weight, ..self }
    }

    /// These options with another crease angle, in degrees.
    #[must_use]
    pub fn with_crease(self, degrees: f32) -> Self {
        Self { crease: degrees, ..self }
    }

    /// These options with other seams.
    #[must_use]
    pub fn with_seams(self, seams: SmoothingSeams) -> Self {
        Self { seams, ..self }
    }
}

/// Flat or smooth shading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Shading {
    /// Every corner has its face's normal, as glTF requires where normals are absent (2.0, section 3.7.2.1).
    Flat,
    /// Corners of a vertex share the weighted mean of their faces' normals, except across creases.
    #[default]
    Smooth,
}

/// The weight of a face at a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum NormalWeight {
    /// The angle of the face's corner. The result does not depend on the triangulation of flat surfaces.
    #[default]
    Angle,
    /// The area of the face.
    Area,
    /// Angle times area. Wide faces stay flat beside bevels.
    AngleArea,
}

/// The treatment of vertices at equal positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SmoothingSeams {
    /// Vertices at equal positions are merged, so that UV seams are not visible in the shading.
    #[default]
    Ignored,
    /// Distinct vertices have distinct normals.
    Respected,
}

choice! {
    Shading, "shading",
    Smooth => "smooth", "Corners of a vertex share the weighted mean of their faces' normals";
    Flat => "flat", "Every corner has its face's normal";
}

choice! {
    NormalWeight, "weight",
    Angle => "angle", "The angle of its corner: independent of the triangulation of flat surfaces";
    Area => "area", "Its area";
    AngleArea => "angle-area", "Angle times area: wide faces stay flat beside bevels";
}

choice! {
    SmoothingSeams, "seams",
    Ignored => "ignored", "Vertices at equal positions are merged";
    Respected => "respected", "Distinct vertices have distinct normals";
}

/// Normals of corners and the report of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Normals {
    /// One unit normal per corner. [`split_normals`] computes vertices from them.
    pub corners: CornerNormals,
    /// The counts of the run.
    pub report: NormalReport,
}

/// The counts of a run of [`generate_normals`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct NormalReport {
    /// The faces of the mesh, degenerate ones included.
    pub faces: usize,
    /// Faces without an area or with values that are not finite. They are skipped.
    pub degenerate_faces: usize,
    /// Corners whose faces' normals cancel or are missing. Their normal is that of their face, else the mean
    /// at their vertex, else (0, 0, 1).
    pub repaired_corners: usize,
    /// Edges at which smooth shading stops because of the crease angle.
    pub creased_edges: usize,
}

/// Computes a normal for every corner.
///
/// `positions`: V by 3, any values. `indices`: one per corner. `faces`: faces of 3 or more corners; smaller
/// ones are degenerate. Faces wind counter-clockwise, seen from the side that their normal points to.
/// Errors: an index out of range; corners that do not make whole faces; too many corners.
pub fn generate_normals<'a>(
    positions: impl Into<Strided<'a, 3>>,
    indices: impl Into<Indices<'a>>,
    faces: Faces<'a>,
    options: &NormalOptions,
) -> Result<Normals, Error> {
    generate_normals_with(positions, indices, faces, options, &mut Context::new())
}

/// As [`generate_normals`], with a context. Further error: the context's token was cancelled.
pub fn generate_normals_with<'a>(
    positions: impl Into<Strided<'a, 3>>,
    indices: impl Into<Indices<'a>>,
    faces: Faces<'a>,
    options: &NormalOptions,
    context: &mut Context,
) -> Result<Normals, Error> {
    let positions = positions.into();
    NormalPlan::new_with(positions, indices, faces, options, context)?.evaluate_with(positions, context)
}

/// The smoothed vertices and creases of one mesh, for computing its normals again after its vertices moved
/// (morph targets, skinning).
#[derive(Clone, Debug)]
pub struct NormalPlan {
    vertex_count: usize,
    indices: Vec<u32>,
    /// The corners per face. `None` where all faces are triangles.
    sizes: Option<Vec<u32>>,
    /// The smoothed vertex of each corner.
    vertex_of_corner: Vec<u32>,
    /// The fan of each corner. Corners of one fan share a normal.
    fan_of_corner: Vec<u32>,
    weight: NormalWeight,
    creased_edges: usize,
}

impl NormalPlan {
    /// Finds vertices and creases. Parameters and errors as for [`generate_normals`].
    pub fn new<'a>(
        positions: impl Into<Strided<'a, 3>>,
        indices: impl Into<Indices<'a>>,
        faces: Faces<'a>,
        options: &NormalOptions,
    ) -> Result<Self, Error> {
        Self::new_with(positions, indices, faces, options, &mut Context::new())
    }

    /// As [`NormalPlan::new`], with a context. Further error: the context's token was cancelled.
    pub fn new_with<'a>(
        positions: impl Into<Strided<'a, 3>>,
        indices: impl Into<Indices<'a>>,
        faces: Faces<'a>,
        options: &NormalOptions,
        context: &mut Context,
    ) -> Result<Self, Error> {
        let (mesh, limits) = (bare_mesh(positions.into(), indices.into(), faces)?, context.limits());
        let vertex_of_corner = vertices_of_corners(&mesh, options.seams, limits)?;
        let (fan_of_corner, creased_edges) = fans_of_corners(&mesh, &vertex_of_corner, options, limits)?;
        let is_flat = options.shading == Shading::Flat;
        Ok(Self {
            vertex_count: mesh.vertex_count(),
            indices: (0..mesh.corner_count()).map(|corner| mesh.vertex_of_corner(corner) as u32).collect(),
            sizes: match faces {
                Faces::Triangles => None,
                _ => Some(mesh.face_ranges().map(|corners| corners.len() as u32).collect()),
            },
            vertex_of_corner,
            fan_of_corner,
            weight: if is_flat { NormalWeight::Area } else { options.weight },
            creased_edges,
        })
    }

    /// Computes the normals of the mesh after its vertices moved, with the smoothed vertices and creases of
    /// the plan.
    ///
    /// The result equals that of [`generate_normals`] as long as equal positions stay equal, distinct ones
    /// stay distinct, and no edge crosses the crease angle. `positions`: as many as at planning. Errors:
    /// another number of positions.
    pub fn evaluate<'a>(&self, positions: impl Into<Strided<'a, 3>>) -> Result<Normals, Error> {
        self.evaluate_with(positions, &mut Context::new())
    }

    /// As [`NormalPlan::evaluate`], with a context. Further error: the context's token was cancelled.
    pub fn evaluate_with<'a>(
        &self,
        positions: impl Into<Strided<'a, 3>>,
        context: &mut Context,
    ) -> Result<Normals, Error> {
        let positions = positions.into();
        Error::check_mesh("vertices", self.vertex_count, positions.len())?;
        let faces = self.sizes.as_deref().map_or(Faces::Triangles, Faces::Mixed);
        let mesh = bare_mesh(positions, Indices::U32(&self.indices), faces)?;
        let limits = context.limits();
        let polygons = Polygons::new(&mesh, limits)?;
        let fans = polygons.sums(&mesh, &self.fan_of_corner, self.weight, limits);
        let mut repaired_corners = 0;
        let mut vertices = None;
        let mut normal = |corner: usize| {
            let found = fans[self.fan_of_corner[corner] as usize].direction();
            repaired_corners += usize::from(found.is_none());
            let own = || polygons.normal_of_face[polygons.face_of_corner[corner] as usize];
            let of_vertex = || {
                let sums = || polygons.sums(&mesh, &self.vertex_of_corner, self.weight, limits);
                vertices.get_or_insert_with(sums)[self.vertex_of_corner[corner] as usize].direction()
            };
            found.or_else(own).or_else(of_vertex).unwrap_or([0.0, 0.0, 1.0]).map(|x| x as f32)
        };
        let mut corners = Vec::with_capacity(mesh.corner_count());
        limits.parts(0..mesh.corner_count()).for_each(|part| corners.extend(part.map(&mut normal)));
        limits.check()?;
        let report = NormalReport {
            faces: mesh.face_count(),
            degenerate_faces: polygons.normal_of_face.iter().filter(|normal| normal.is_none()).count(),
            repaired_corners,
            creased_edges: self.creased_edges,
        };
        Ok(Normals { corners: CornerNormals(corners), report })
    }
}

/// The vertices of an indexed mesh, split by normals. See [`VertexSplit`](crate::VertexSplit) for tangents.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NormalSplit {
    /// One normal per new vertex. (0, 0, 1) for vertices that no corner uses.
    pub normal_of_vertex: Vec<[f32; 3]>,
    /// The new index list, one per corner, in the old corner order.
    pub indices: Vec<u32>,
    /// The old vertex that each new vertex copies; `source_of_vertex[v] == v` for every old vertex.
    pub source_of_vertex: Vec<u32>,
}

/// Splits the vertices whose corners have different normals.
///
/// Each distinct pair of old vertex and normal, compared as bits, becomes one vertex. `vertex_count`: the
/// number of old vertices. `indices`: one per corner. `corners`: one normal per corner. Errors: an index out
/// of range; another number of normals than corners.
pub fn split_normals<'a>(
    vertex_count: usize,
    indices: impl Into<Indices<'a>>,
    corners: impl Into<CornerNormalsRef<'a>>,
) -> Result<NormalSplit, Error> {
    split_normals_with(vertex_count, indices, corners, &mut Context::new())
}

/// As [`split_normals`], with a context. Further error: the context's token was cancelled.
pub fn split_normals_with<'a>(
    vertex_count: usize,
    indices: impl Into<Indices<'a>>,
    corners: impl Into<CornerNormalsRef<'a>>,
    context: &mut Context,
) -> Result<NormalSplit, Error> {
    let CornerNormalsRef(corners) = corners.into();
    let size = [corners.len() as u32];
    let positions = Strided::repeated(&[0.0; 3], vertex_count);
    let indices = indices.into();
    let corner_count = indices.corner_count(vertex_count);
    Error::check_input("normals", corner_count, corners.len())?;
    let mesh = bare_mesh(positions, indices, Faces::Mixed(&size))?;
    let mut splitter = Splitter::new_with(vertex_count, context);
    // The splitter takes tangents: w = 0 marks used vertices, because unused ones get w = 1.
    let tangents = CornerTangents(corners.iter().map(|&[x, y, z]| [x, y, z, 0.0]).collect());
    let indices = splitter.add(&mesh, &tangents)?;
    let SplitBuffer { tangent_of_vertex, source_of_vertex } = splitter.finish();
    let normal = |[x, y, z, used]: [f32; 4]| if used == 0.0 { [x, y, z] } else { [0.0, 0.0, 1.0] };
    Ok(NormalSplit {
        normal_of_vertex: tangent_of_vertex.into_iter().map(normal).collect(),
        indices,
        source_of_vertex,
    })
}

/// A mesh with positions only.
fn bare_mesh<'a>(
    positions: Strided<'a, 3>,
    indices: Indices<'a>,
    faces: Faces<'a>,
) -> Result<Mesh<'a>, Error> {
    let count = positions.len();
    let (normals, uvs) = (Strided::repeated(&[0.0; 3], count), Strided::repeated(&[0.0; 2], count));
    Mesh::with_faces(positions, normals, uvs, indices, faces)
}

/// The faces of a mesh with their normals and areas.
struct Polygons {
    face_of_corner: Vec<u32>,
    /// The end of each face's corners.
    ends: Vec<u32>,
    /// The unit normal of each face; `None` for degenerate faces.
    normal_of_face: Vec<Option<D3>>,
    area_of_face: Vec<f64>,
}

/// A sum of normals and of their weights.
#[derive(Clone, Copy, Default)]
struct WeightedNormal {
    normal: D3,
    weight: f64,
}

impl WeightedNormal {
    /// The unit normal. `None` where nothing was added, or the sum is rounding error.
    fn direction(&self) -> Option<D3> {
        (length(self.normal) > 1e-6 * self.weight).then(|| unit(self.normal)).flatten()
    }
}

impl Polygons {
    fn new(mesh: &Mesh<'_>, limits: RunLimits<'_>) -> Result<Self, Error> {
        let mut polygons = Self {
            face_of_corner: Vec::with_capacity(mesh.corner_count()),
            ends: Vec::with_capacity(mesh.face_count()),
            normal_of_face: Vec::with_capacity(mesh.face_count()),
            area_of_face: Vec::with_capacity(mesh.face_count()),
        };
        for (face, corners) in mesh.face_ranges().enumerate() {
            limits.check_at(face)?;
            polygons.face_of_corner.resize(corners.end, face as u32);
            polygons.ends.push(corners.end as u32);
            let area_vector = area_vector(mesh, corners);
            polygons.normal_of_face.push(unit(area_vector));
            polygons.area_of_face.push(length(area_vector));
        }
        Ok(polygons)
    }

    /// The previous and the next corner in a corner's face.
    fn around(&self, corner: usize) -> [usize; 2] {
        let face = self.face_of_corner[corner] as usize;
        let start = if face == 0 { 0 } else { self.ends[face - 1] as usize };
        let size = self.ends[face] as usize - start;
        [size - 1, 1].map(|step| start + (corner - start + step) % size)
    }

    /// The sum of the faces' normals for every group of corners. Unspecified after cancellation.
    fn sums(
        &self,
        mesh: &Mesh<'_>,
        group_of_corner: &[u32],
        weight: NormalWeight,
        limits: RunLimits<'_>,
    ) -> Vec<WeightedNormal> {
        let groups = group_of_corner.iter().max().map_or(0, |&last| last as usize + 1);
        let mut sums = vec![WeightedNormal::default(); groups];
        for (corner, &group) in group_of_corner.iter().enumerate() {
            if limits.check_at(corner).is_err() {
                break;
            }
            let face = self.face_of_corner[corner] as usize;
            let Some(normal) = self.normal_of_face[face] else { continue };
            let area = self.area_of_face[face];
            let weight = match weight {
                NormalWeight::Angle => self.angle(mesh, corner),
                NormalWeight::Area => area,
                NormalWeight::AngleArea => self.angle(mesh, corner) * area,
            };
            let sum = &mut sums[group as usize];
            sum.normal = [0, 1, 2].map(|i| sum.normal[i] + weight * normal[i]);
            sum.weight += weight;
        }
        sums
    }

    /// The angle at a corner. Zero beside an edge without length.
    fn angle(&self, mesh: &Mesh<'_>, corner: usize) -> f64 {
        let here = position(mesh, corner);
        let directions = self.around(corner).map(|other| unit(sub(position(mesh, other), here)));
        let [Some(a), Some(b)] = directions else { return 0.0 };
        f64::from(angle(dot(a, b) as f32))
    }
}

/// The area times the normal. Positions are taken relative to the first corner, so that far from the origin
/// digits do not cancel.
fn area_vector(mesh: &Mesh<'_>, corners: std::ops::Range<usize>) -> D3 {
    let first = corners.start;
    let edge = |corner: usize| sub(position(mesh, corner), position(mesh, first));
    let mut sum = [0.0; 3];
    for corner in corners.clone().skip(1).take(corners.len().saturating_sub(2)) {
        let part = cross(edge(corner), edge(corner + 1));
        sum = [0, 1, 2].map(|i| sum[i] + 0.5 * part[i]);
    }
    sum
}

/// The smoothed vertex of every corner: the first vertex at the same position, or the corner's vertex.
fn vertices_of_corners(
    mesh: &Mesh<'_>,
    seams: SmoothingSeams,
    limits: RunLimits<'_>,
) -> Result<Vec<u32>, Error> {
    let corners = 0..mesh.corner_count();
    if seams == SmoothingSeams::Respected {
        return Ok(corners.map(|corner| mesh.vertex_of_corner(corner) as u32).collect());
    }
    let mut first = HashMap::new();
    let vertex = |corner: usize| {
        limits.check_at(corner)?;
        let vertex = mesh.vertex_of_corner(corner);
        let position = mesh.positions().get(vertex);
        // Adding zero turns -0 into +0. NaN equals nothing.
        let key = position.map(|x| (x + 0.0).to_bits());
        let is_nan = position.iter().any(|x| x.is_nan());
        Ok(if is_nan { vertex as u32 } else { *first.entry(key).or_insert(vertex as u32) })
    };
    corners.map(vertex).collect()
}

/// The fan of each corner, and the number of creases.
fn fans_of_corners(
    mesh: &Mesh<'_>,
    vertex_of_corner: &[u32],
    options: &NormalOptions,
    limits: RunLimits<'_>,
) -> Result<(Vec<u32>, usize), Error> {
    match options.shading {
        Shading::Smooth if options.crease >= 180.0 => Ok((vertex_of_corner.to_vec(), 0)),
        Shading::Flat => Ok((Polygons::new(mesh, limits)?.face_of_corner, 0)),
        Shading::Smooth => fans(&Polygons::new(mesh, limits)?, vertex_of_corner, options.crease, limits),
    }
}

/// As [`fans_of_corners`], for smooth shading with creases. A fan is named by one of its corners.
///
/// On an edge of more than two faces, each face is compared with the next. Edges of degenerate faces are no
/// creases.
fn fans(
    polygons: &Polygons,
    vertex_of_corner: &[u32],
    crease: f32,
    limits: RunLimits<'_>,
) -> Result<(Vec<u32>, usize), Error> {
    let mut creased_edges = 0;
    let least_cosine = f64::from(crease.max(0.0)).to_radians().cos();
    let edge = |corner: usize| {
        let ends = [corner, polygons.around(corner)[1]].map(|corner| vertex_of_corner[corner]);
        ([ends[0].min(ends[1]), ends[0].max(ends[1])], corner as u32)
    };
    let mut edges: Vec<([u32; 2], u32)> = threads::map(limits, vertex_of_corner.len(), edge);
    limits.check()?;
    edges.sort_unstable();
    limits.check()?;
    let mut fans = DisjointSets::new(vertex_of_corner.len());
    for (at, [(ends, a), (others, b)]) in edges.array_windows().enumerate() {
        limits.check_at(at)?;
        if ends != others {
            continue;
        }
        let normals =
            [a, b].map(|&corner| polygons.normal_of_face[polygons.face_of_corner[corner as usize] as usize]);
        // The margin exceeds the rounding error of a cosine, so that equal normals never crease.
        let is_crease = matches!(normals, [Some(a), Some(b)] if dot(a, b) < least_cosine - 1e-12);
        creased_edges += usize::from(is_crease);
        if !is_crease {
            let corners = [a, b].map(|&corner| [corner as usize, polygons.around(corner as usize)[1]]);
            for a in corners[0] {
                let at_same_vertex = |b: &usize| vertex_of_corner[a] == vertex_of_corner[*b];
                if let Some(b) = corners[1].into_iter().find(at_same_vertex) {
                    fans.join(a, b);
                }
            }
        }
    }
    Ok((fans.into_names(), creased_edges))
}

fn position(mesh: &Mesh<'_>, corner: usize) -> D3 {
    mesh.positions().get(mesh.vertex_of_corner(corner)).map(f64::from)
}

//! [`Plan`]: welds and groups a mesh once, and evaluates its tangents again after its vertices moved.

use crate::Context;
use crate::CornerTangents;
use crate::Error;
use crate::Faces;
use crate::Indices;
use crate::Mesh;
use crate::TangentOptions;
use crate::Tangents;
use crate::generate_tangents_with;
use crate::math::distinct_bits;
use crate::tangents::MethodPlan;

/// The weld, groups and subgroups of one mesh, kept to evaluate tangents again after its vertices moved
/// (morph targets, skinning).
///
/// For MikkTSpace on faces of 3 and 4 corners the plan also keeps a copy of all vertices, 32 bytes each. They
/// are needed when the fast path does not apply to the moved mesh: welded vertices moved apart, or a tangent
/// became zero. Among the other methods, only [`Method::AngleArea`](crate::Method::AngleArea) and
/// [`Method::AngleEdge`](crate::Method::AngleEdge) have groups to keep; the rest compute everything again
/// except the signs.
#[derive(Debug)]
pub struct Plan {
    method_plan: MethodPlan,
    options: TangentOptions,
    vertex_count: usize,
    faces: FaceList,
    base: Tangents,
}

/// The faces of a mesh.
#[derive(Debug)]
struct FaceList {
    /// None where corners are vertices.
    indices: Option<Vec<u32>>,
    sizes: FaceSizes,
}

#[derive(Debug)]
enum FaceSizes {
    Three,
    Four,
    Mixed(Vec<u32>),
}

impl FaceList {
    fn new(mesh: &Mesh<'_>) -> Self {
        let indices = match mesh.indices() {
            Indices::Unindexed => None,
            Indices::U16(list) => Some(list.iter().map(|&vertex| u32::from(vertex)).collect()),
            Indices::U32(list) => Some(list.to_vec()),
        };
        let sizes = match mesh.faces() {
            Faces::Triangles => FaceSizes::Three,
            Faces::Quads => FaceSizes::Four,
            Faces::Mixed(sizes) => FaceSizes::Mixed(sizes.to_vec()),
        };
        Self { indices, sizes }
    }

    /// These faces over the vertices of a mesh.
    fn over<'a>(&'a self, mesh: &Mesh<'a>) -> Mesh<'a> {
        let faces = match &self.sizes {
            FaceSizes::Three => Faces::Triangles,
            FaceSizes::Four => Faces::Quads,
            FaceSizes::Mixed(sizes) => Faces::Mixed(sizes),
        };
        mesh.with_other_faces(self.indices.as_ref().map_or(Indices::Unindexed, Indices::from), faces)
    }
}

impl Plan {
    /// Computes the tangents of the base mesh and keeps its topology.
    pub fn new(mesh: &Mesh<'_>, options: &TangentOptions) -> Self {
        Self::make(mesh, options, &mut Context::new())
    }

    /// As [`Plan::new`], with the token and the thread limit of a context. Errors: the token was cancelled.
    pub fn new_with(mesh: &Mesh<'_>, options: &TangentOptions, context: &mut Context) -> Result<Self, Error> {
        let plan = Self::make(mesh, options, context);
        context.limits().check().map(|()| plan)
    }

    /// The plan is not usable after cancellation.
    fn make(mesh: &Mesh<'_>, options: &TangentOptions, context: &mut Context) -> Self {
        let (method_plan, base) = MethodPlan::new(mesh, options, context.limits());
        let faces = FaceList::new(mesh);
        Self { method_plan, options: *options, vertex_count: mesh.vertex_count(), faces, base }
    }

    /// The base's own tangents, as [`crate::generate_tangents`] gives them.
    pub fn base(&self) -> &Tangents {
        &self.base
    }

    /// Computes the tangents of the moved mesh in the base's groups and subgroups; signs stay the base's.
    ///
    /// `mesh`: the base's UVs, other positions and normals; faces and indices are taken from the base.
    /// Vertices that were welded and moved apart keep their common frame, but each triangle counts with
    /// the positions of its own vertices. Errors: another number of corners or vertices.
    pub fn evaluate(&self, mesh: &Mesh<'_>) -> Result<CornerTangents, Error> {
        self.evaluate_with(mesh, &mut Context::new())
    }

    /// As [`Plan::evaluate`], with a context. Further error: the context's token was cancelled.
    pub fn evaluate_with(&self, mesh: &Mesh<'_>, context: &mut Context) -> Result<CornerTangents, Error> {
        let mut corners = vec![[0.0; 4]; self.base.corners.len()];
        self.write_tangents(mesh, context, &mut corners)?;
        Ok(CornerTangents(corners))
    }

    /// As [`Plan::evaluate_with`], into the caller's array.
    ///
    /// Repeated calls on one thread allocate nothing where all vertices of a mesh of triangles and quads are
    /// plain (no mirrored or degenerate triangles, no collapsed ones); those of
    /// [`Method::AngleArea`](crate::Method::AngleArea) nothing for any mesh of triangles with packed
    /// arrays and 32-bit indices. `corners`: receives one tangent per corner; unspecified after
    /// cancellation. Further error: an array of another length.
    pub fn write_tangents(
        &self,
        mesh: &Mesh<'_>,
        context: &mut Context,
        corners: &mut [[f32; 4]],
    ) -> Result<(), Error> {
        let base = &self.base.corners.0;
        Error::check_mesh("corners", base.len(), mesh.corner_count())?;
        Error::check_output("tangents", base.len(), corners.len())?;
        Error::check_mesh("vertices", self.vertex_count, mesh.vertex_count())?;
        let (limits, memory) = context.limits_and_memory();
        self.method_plan.evaluate(&self.faces.over(mesh), (&self.options, base), limits, memory, corners);
        limits.check()
    }

    /// Counts the corners to which a fresh run on the moved mesh would give another tangent (other bits) than
    /// [`Plan::evaluate`].
    pub fn count_regrouped(&self, mesh: &Mesh<'_>) -> Result<usize, Error> {
        self.count_regrouped_with(mesh, &mut Context::new())
    }

    /// As [`Plan::count_regrouped`], with a context. Further error: the context's token was cancelled.
    pub fn count_regrouped_with(&self, mesh: &Mesh<'_>, context: &mut Context) -> Result<usize, Error> {
        let planned = self.evaluate_with(mesh, context)?;
        let fresh = generate_tangents_with(mesh, &self.options, context)?.corners;
        let pairs = planned.per_corner().iter().zip(fresh.per_corner());
        Ok(pairs.filter(|&(&planned, &fresh)| distinct_bits(planned) != distinct_bits(fresh)).count())
    }
}

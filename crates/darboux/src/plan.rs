//! Topology once, evaluate often.

use crate::CornerTangents;
use crate::Faces;
use crate::Indices;
use crate::Mesh;
use crate::MeshError;
use crate::Scratch;
use crate::TangentOptions;
use crate::Tangents;
use crate::cancel::Stop;
use crate::generate_tangents;
use crate::split::expect;
use crate::tangents::Planned;

/// The weld, groups and subgroups of one mesh, kept to evaluate tangents again after its vertices moved (morph targets, skinning).
///
/// For MikkTSpace on faces of 3 and 4 corners it also keeps a copy of all vertices, 32 bytes each, for when
/// what is decided fast needs every stage after all: vertices that were welded move apart, tangents collapse.
/// Of the other methods only [`Method::AngleArea`](crate::Method::AngleArea) has groups to keep; the rest run afresh, but for the signs.
#[derive(Debug)]
pub struct Plan {
    planned: Planned,
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
        mesh.on_faces(self.indices.as_ref().map_or(Indices::Unindexed, Indices::from), faces)
    }
}

impl Plan {
    /// Computes the base's tangents and keeps its topology. One that was [cancelled](crate::Cancel::run) is not complete.
    pub fn new(mesh: &Mesh<'_>, options: &TangentOptions) -> Self {
        let (planned, base) = Planned::new(mesh, options);
        let faces = FaceList::new(mesh);
        Self { planned, options: *options, vertex_count: mesh.vertex_count(), faces, base }
    }

    /// The base's own tangents, as [`crate::generate_tangents`] gives them.
    pub fn base(&self) -> &Tangents {
        &self.base
    }

    /// Tangents of the moved mesh in the base's groups and subgroups; signs stay the base's.
    ///
    /// `mesh`: same faces, indices and UVs as the base, other positions and normals; faces and indices are taken from the base. Vertices that were welded and moved apart keep
    /// their common frame, but each triangle counts with the positions of its own vertices. Errors: another number of corners
    /// or vertices.
    pub fn evaluate(&self, mesh: &Mesh<'_>) -> Result<CornerTangents, MeshError> {
        let mut out = CornerTangents::default();
        self.evaluate_into(mesh, &mut Scratch::new(), &mut out)?;
        Ok(out)
    }

    /// As [`Plan::evaluate`], into `out`, whose memory is used again, as is that of `scratch`: repeated calls allocate nothing where
    /// all vertices of a mesh of triangles and quads are plain (no mirrored or degenerate triangles, no collapsed ones); those of
    /// [`Method::AngleArea`](crate::Method::AngleArea) nothing for any mesh of triangles with packed arrays and 32-bit indices.
    pub fn evaluate_into(
        &self,
        mesh: &Mesh<'_>,
        scratch: &mut Scratch,
        out: &mut CornerTangents,
    ) -> Result<(), MeshError> {
        out.0.resize(self.base.corners.len(), [0.0; 4]);
        self.write_tangents(mesh, scratch, &mut out.0)
    }

    /// As [`Plan::evaluate_into`], into an array of the caller's: one tangent per corner. Errors: also an array of another length, and a run
    /// that was [cancelled](crate::Cancel::run).
    pub fn write_tangents(
        &self,
        mesh: &Mesh<'_>,
        scratch: &mut Scratch,
        corners: &mut [[f32; 4]],
    ) -> Result<(), MeshError> {
        let base = &self.base.corners.0;
        expect("corners", base.len(), mesh.corner_count())?;
        expect("corners", base.len(), corners.len())?;
        expect("vertices", self.vertex_count, mesh.vertex_count())?;
        self.planned.evaluate(&self.faces.over(mesh), (&self.options, base), scratch, corners);
        Stop::heard().check()
    }

    /// How many corners a fresh run on the moved mesh would give another tangent (other bits) than [`Plan::evaluate`].
    pub fn count_regrouped(&self, mesh: &Mesh<'_>) -> Result<usize, MeshError> {
        let planned = self.evaluate(mesh)?;
        let fresh = generate_tangents(mesh, &self.options).corners;
        Stop::heard().check()?;
        let pairs = planned.per_corner().iter().zip(fresh.per_corner());
        Ok(pairs.filter(|(planned, fresh)| planned.map(f32::to_bits) != fresh.map(f32::to_bits)).count())
    }
}

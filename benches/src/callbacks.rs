//! Implements the callback interface of mikktspace.c and its Rust ports for a mesh in memory.

use darboux_tests::{FaceSizes, OwnedMesh};

use crate::run::Tangent;

/// A mesh of triangles or of quads to read and a list to write: one tangent per corner.
pub struct Callbacks<'a> {
    mesh: &'a OwnedMesh,
    /// Corners per face.
    size: usize,
    tangents: &'a mut [Tangent],
}

impl<'a> Callbacks<'a> {
    /// Resizes `tangents` to one element per corner.
    pub fn new(mesh: &'a OwnedMesh, tangents: &'a mut Vec<Tangent>) -> Self {
        tangents.resize(mesh.corner_count(), [0.0; 4]);
        let size = if mesh.faces == FaceSizes::Quads { 4 } else { 3 };
        Self { mesh, size, tangents }
    }

    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.vertex_of_corner(self.size * face + corner)
    }
}

/// The callbacks that the three traits share, apart from their names.
macro_rules! read {
    ($faces:ident, $corners:ident, $position:ident, $normal:ident, $uv:ident) => {
        fn $faces(&self) -> usize {
            self.tangents.len() / self.size
        }

        fn $corners(&self, _face: usize) -> usize {
            self.size
        }

        fn $position(&self, face: usize, corner: usize) -> [f32; 3] {
            self.mesh.positions[self.vertex(face, corner)]
        }

        fn $normal(&self, face: usize, corner: usize) -> [f32; 3] {
            self.mesh.normals[self.vertex(face, corner)]
        }

        fn $uv(&self, face: usize, corner: usize) -> [f32; 2] {
            self.mesh.uvs[self.vertex(face, corner)]
        }
    };
}

impl mikktspace_sys::MikkTSpaceInterface for Callbacks<'_> {
    read!(get_num_faces, get_num_vertices_of_face, get_position, get_normal, get_tex_coord);

    fn set_tspace_basic(&mut self, [x, y, z]: [f32; 3], sign: f32, face: usize, corner: usize) {
        self.tangents[self.size * face + corner] = [x, y, z, sign];
    }
}

impl mikktspace::Geometry for Callbacks<'_> {
    read!(num_faces, num_vertices_of_face, position, normal, tex_coord);

    fn set_tangent_encoded(&mut self, tangent: Tangent, face: usize, corner: usize) {
        self.tangents[self.size * face + corner] = tangent;
    }
}

impl bevy_mikktspace::Geometry for Callbacks<'_> {
    read!(num_faces, num_vertices_of_face, position, normal, tex_coord);

    fn set_tangent(&mut self, space: Option<bevy_mikktspace::TangentSpace>, face: usize, corner: usize) {
        self.tangents[self.size * face + corner] = space.unwrap_or_default().tangent_encoded();
    }
}

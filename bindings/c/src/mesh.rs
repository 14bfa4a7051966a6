//! The mesh of the C interface: a struct of pointers, counts and strides, and its conversion to the core's
//! borrowed mesh.

use std::mem::offset_of;

use darboux::{Faces, Indices, Mesh, Strided};

use crate::codes::{self, FacesCode, darboux_faces};
use crate::pointers::{self, Versioned};
use crate::status::{Error, darboux_status};

/// A borrowed mesh: V vertices in strided arrays, and C corners (vertices of faces) in face order.
///
/// Fields that are zero are absent. No pointer is used after the call. Positions, normals and UVs may have
/// any values and any alignment; bytes between the elements are not read. Strides are in bytes; 0 for packed.
/// At most 2^30 - 1 vertices and 2^30 - 1 corners.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_mesh {
    /// sizeof(darboux_mesh). 0: the size in version 0.1.
    pub size: usize,
    /// V, the number of vertices.
    pub vertex_count: usize,
    /// V by 3 floats.
    pub positions: *const f32,
    /// Bytes from one position to the next.
    pub position_stride: usize,
    /// V by 3 floats, used as given: MikkTSpace expects unit length. Ignored by functions that generate or
    /// split normals.
    pub normals: *const f32,
    /// Bytes from one normal to the next.
    pub normal_stride: usize,
    /// V by 2 floats. Ignored by functions that generate or split normals.
    pub uvs: *const f32,
    /// Bytes from one UV to the next.
    pub uv_stride: usize,
    /// The vertex of each corner, 32 bits. NULL where `indices_u16` is set, and for an unindexed mesh, whose
    /// corner i is vertex i.
    pub indices_u32: *const u32,
    /// The vertex of each corner, 16 bits; or NULL. At most one of both index arrays may be set.
    pub indices_u16: *const u16,
    /// C, the number of indices. 0 for an unindexed mesh.
    pub index_count: usize,
    /// How corners are grouped into faces.
    pub faces: darboux_faces,
    /// The corner count of each face for DARBOUX_FACES_MIXED, otherwise ignored. Tangents of faces with
    /// other than 3 or 4 corners are perpendiculars of the normals.
    pub face_sizes: *const u32,
    /// The number of `face_sizes`. Ignored except for DARBOUX_FACES_MIXED.
    pub face_count: usize,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are integers or raw pointers.
unsafe impl Versioned for darboux_mesh {
    const NAME: &str = "darboux_mesh";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, face_count));
}

/// Checks a mesh and returns a borrowed view of it.
///
/// # Safety
///
/// `mesh` points to a valid [`darboux_mesh`], whose arrays do not change while the view is used.
pub(crate) unsafe fn view<'a>(mesh: *const darboux_mesh) -> Result<Mesh<'a>, Error> {
    // SAFETY: the caller's promise.
    unsafe {
        let mesh = read(mesh)?;
        let count = mesh.vertex_count;
        let normals = pointers::strided("normals", mesh.normals, count, mesh.normal_stride)?;
        let uvs = pointers::strided("uvs", mesh.uvs, count, mesh.uv_stride)?;
        Ok(Mesh::with_faces(mesh.positions()?, normals, uvs, mesh.indices()?, mesh.faces()?)?)
    }
}

/// As [`view`], of positions, indices and faces only; all normals and UVs are zero.
///
/// # Safety
///
/// As for [`view`].
pub(crate) unsafe fn bare<'a>(mesh: *const darboux_mesh) -> Result<Mesh<'a>, Error> {
    // SAFETY: the caller's promise.
    unsafe {
        let mesh = read(mesh)?;
        let count = mesh.vertex_count;
        let (normals, uvs) = (Strided::repeated(&[0.0; 3], count), Strided::repeated(&[0.0; 2], count));
        Ok(Mesh::with_faces(mesh.positions()?, normals, uvs, mesh.indices()?, mesh.faces()?)?)
    }
}

/// The largest number of vertices that the core accepts. It is checked before the array sizes, so that the
/// message is about the count.
const MAX_VERTICES: usize = (1 << 30) - 1;

/// Reads the struct and checks the number of vertices.
///
/// # Safety
///
/// As for [`view`].
unsafe fn read(mesh: *const darboux_mesh) -> Result<darboux_mesh, Error> {
    // SAFETY: the caller's promise.
    let mesh = unsafe { pointers::read(mesh) }?;
    if mesh.vertex_count > MAX_VERTICES {
        let message = format!(
            "{} vertices are too many: the limit is {MAX_VERTICES}; split the mesh",
            mesh.vertex_count
        );
        return Err(Error::new(darboux_status::TooLarge, message));
    }
    Ok(mesh)
}

impl darboux_mesh {
    /// # Safety
    ///
    /// As for [`view`].
    unsafe fn positions<'a>(&self) -> Result<Strided<'a, 3>, Error> {
        // SAFETY: the caller's promise.
        unsafe { pointers::strided("positions", self.positions, self.vertex_count, self.position_stride) }
    }

    /// # Safety
    ///
    /// As for [`view`].
    unsafe fn indices<'a>(&self) -> Result<Indices<'a>, Error> {
        let error = |status, message: &str| Err(Error::new(status, message.into()));
        // SAFETY: the caller's promise.
        unsafe {
            match (self.indices_u32.is_null(), self.indices_u16.is_null()) {
                (true, true) if self.index_count == 0 => Ok(Indices::Unindexed),
                (true, true) => error(darboux_status::NullPointer, "there is an index_count but no indices"),
                (false, true) => {
                    pointers::slice("indices_u32", self.indices_u32, self.index_count).map(Indices::U32)
                }
                (true, false) => {
                    pointers::slice("indices_u16", self.indices_u16, self.index_count).map(Indices::U16)
                }
                (false, false) => error(
                    darboux_status::UnknownValue,
                    "indices_u16 and indices_u32 are both set; set one of them",
                ),
            }
        }
    }

    /// # Safety
    ///
    /// As for [`view`].
    unsafe fn faces<'a>(&self) -> Result<Faces<'a>, Error> {
        match codes::faces(self.faces)? {
            FacesCode::Triangles => Ok(Faces::Triangles),
            FacesCode::Quads => Ok(Faces::Quads),
            FacesCode::Mixed => {
                // SAFETY: the caller's promise.
                unsafe { pointers::slice("face_sizes", self.face_sizes, self.face_count) }.map(Faces::Mixed)
            }
        }
    }
}

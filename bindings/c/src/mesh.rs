//! The mesh that callers describe.

use std::mem::offset_of;

use darboux::{Faces, Indices, Mesh, Strided};

use crate::codes::{self, FacesCode, darboux_faces};
use crate::pointers::{self, Versioned};
use crate::status::{Error, darboux_status};

/// A mesh in the caller's memory: V vertices in arrays of any stride, and C corners (vertices of faces) in face order.
///
/// Set `size` to sizeof(darboux_mesh), or to 0, which stands for version 0.1's size; all fields that are left zero are absent. Nothing
/// is kept after a call. Positions, normals and UVs may have any values and any alignment; what lies between the elements is not read.
/// Strides are in bytes; 0 stands for packed. At most 2^30 - 1 vertices and 2^30 - 1 corners.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_mesh {
    /// sizeof(darboux_mesh).
    pub size: usize,
    /// V.
    pub vertex_count: usize,
    /// V by 3.
    pub positions: *const f32,
    /// Bytes from one position to the next.
    pub position_stride: usize,
    /// V by 3, used as given: MikkTSpace expects unit length. Not read where normals are generated.
    pub normals: *const f32,
    /// Bytes from one normal to the next.
    pub normal_stride: usize,
    /// V by 2. Not read where normals are generated.
    pub uvs: *const f32,
    /// Bytes from one UV to the next.
    pub uv_stride: usize,
    /// The vertex of each corner, or null: then `indices_u16` has them, or corner i is vertex i.
    pub indices_u32: *const u32,
    /// The vertex of each corner in 16 bits, or null. Not both.
    pub indices_u16: *const u16,
    /// C, where there are indices; else 0.
    pub index_count: usize,
    /// How corners make faces.
    pub faces: darboux_faces,
    /// For DARBOUX_FACES_MIXED the corner count of each face; else null. Faces of other than 3 or 4 corners get tangents from their
    /// normals alone.
    pub face_sizes: *const u32,
    /// How many `face_sizes` there are; else 0.
    pub face_count: usize,
}

// SAFETY: `repr(C)`, the size first, null pointers and zeros.
unsafe impl Versioned for darboux_mesh {
    const NAME: &str = "darboux_mesh";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, face_count));
}

/// The mesh at `mesh`.
///
/// # Safety
///
/// `mesh` and the pointers in it are as [`darboux_mesh`] says; nobody changes what they point to while the view is used.
pub(crate) unsafe fn view<'a>(mesh: *const darboux_mesh) -> Result<Mesh<'a>, Error> {
    // SAFETY: as of this function.
    unsafe {
        let mesh = read(mesh)?;
        let count = mesh.vertex_count;
        let normals = pointers::strided("normals", mesh.normals, count, mesh.normal_stride)?;
        let uvs = pointers::strided("uvs", mesh.uvs, count, mesh.uv_stride)?;
        Ok(Mesh::with_faces(mesh.positions()?, normals, uvs, mesh.indices()?, mesh.faces()?)?)
    }
}

/// As [`view`], of positions, indices and faces alone; normals and UVs are zeros.
///
/// # Safety
///
/// As of [`view`].
pub(crate) unsafe fn bare<'a>(mesh: *const darboux_mesh) -> Result<Mesh<'a>, Error> {
    // SAFETY: as of this function.
    unsafe {
        let mesh = read(mesh)?;
        let count = mesh.vertex_count;
        let (normals, uvs) = (Strided::repeated(&[0.0; 3], count), Strided::repeated(&[0.0; 2], count));
        Ok(Mesh::with_faces(mesh.positions()?, normals, uvs, mesh.indices()?, mesh.faces()?)?)
    }
}

/// The largest number of vertices, as of the core; checked before the arrays are measured, for a message about the count.
const MAX_VERTICES: usize = (1 << 30) - 1;

/// # Safety
///
/// As of [`view`].
unsafe fn read(mesh: *const darboux_mesh) -> Result<darboux_mesh, Error> {
    // SAFETY: as of this function.
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
    /// As of [`view`].
    unsafe fn positions<'a>(&self) -> Result<Strided<'a, 3>, Error> {
        // SAFETY: as of this function.
        unsafe { pointers::strided("positions", self.positions, self.vertex_count, self.position_stride) }
    }

    /// # Safety
    ///
    /// As of [`view`].
    unsafe fn indices<'a>(&self) -> Result<Indices<'a>, Error> {
        let fault = |status, message: &str| Err(Error::new(status, message.into()));
        // SAFETY: as of this function.
        unsafe {
            match (self.indices_u32.is_null(), self.indices_u16.is_null()) {
                (true, true) if self.index_count == 0 => Ok(Indices::Unindexed),
                (true, true) => fault(darboux_status::NullPointer, "there is an index_count but no indices"),
                (false, true) => {
                    pointers::slice("indices_u32", self.indices_u32, self.index_count).map(Indices::U32)
                }
                (true, false) => {
                    pointers::slice("indices_u16", self.indices_u16, self.index_count).map(Indices::U16)
                }
                (false, false) => fault(
                    darboux_status::UnknownValue,
                    "indices_u16 and indices_u32 are both set; set one of them",
                ),
            }
        }
    }

    /// # Safety
    ///
    /// As of [`view`].
    unsafe fn faces<'a>(&self) -> Result<Faces<'a>, Error> {
        match codes::faces(self.faces)? {
            FacesCode::Triangles => Ok(Faces::Triangles),
            FacesCode::Quads => Ok(Faces::Quads),
            FacesCode::Mixed => {
                // SAFETY: as of this function.
                unsafe { pointers::slice("face_sizes", self.face_sizes, self.face_count) }.map(Faces::Mixed)
            }
        }
    }
}

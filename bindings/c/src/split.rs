//! Vertex splitting in C: turns tangents or normals of corners into an indexed mesh.

use darboux::{
    CornerNormalsRef, CornerTangentsRef, NormalSplit, VertexSplit, split_normals_with, split_vertices_with,
};

use crate::context::{self, darboux_context};
use crate::mesh::{self, darboux_mesh};
use crate::pointers::{gathered_of_corners, hand_out, take_back};
use crate::status::{call, darboux_status};

/// The vertices of an indexed mesh after splitting by tangents. The old vertices come first and keep their
/// numbers.
#[repr(C)]
pub struct darboux_vertex_split {
    /// The number of new vertices, old ones included.
    pub vertex_count: usize,
    /// One tangent per new vertex: unit xyz and sign w. (1, 0, 0, 1) for vertices that no corner uses.
    pub tangent_of_vertex: *const [f32; 4],
    /// The old vertex that each new vertex copies. All other attributes follow from it: new[v] =
    /// old[source_of_vertex[v]].
    pub source_of_vertex: *const u32,
    /// The number of corners.
    pub index_count: usize,
    /// The new index list, one per corner, in the old corner order.
    pub indices: *const u32,
}

/// The vertices of an indexed mesh after splitting by normals. The old vertices come first and keep their
/// numbers.
#[repr(C)]
pub struct darboux_normal_split {
    /// The number of new vertices, old ones included.
    pub vertex_count: usize,
    /// One normal per new vertex. (0, 0, 1) for vertices that no corner uses.
    pub normal_of_vertex: *const [f32; 3],
    /// The old vertex that each new vertex copies. All other attributes follow from it: new[v] =
    /// old[source_of_vertex[v]].
    pub source_of_vertex: *const u32,
    /// The number of corners.
    pub index_count: usize,
    /// The new index list, one per corner, in the old corner order.
    pub indices: *const u32,
}

/// The struct that the caller sees, followed by the arrays that its pointers refer to.
#[repr(C)]
struct Owned<View, Arrays> {
    view: View,
    arrays: Arrays,
}

/// Splits the vertices whose corners have different tangents.
///
/// Each distinct pair of old vertex and tangent (four floats, compared as bits; NaN equals NaN) becomes one
/// vertex. `mesh`: the mesh of the tangents. `tangents`: C by 4 floats, as darboux_generate_tangents writes
/// them. `tangent_count`: C. `tangent_stride`: bytes from one tangent to the next; 0 for packed. `context`:
/// threads and a cancellation flag; NULL for the calling thread alone. `split`: receives the result;
/// free it with darboux_vertex_split_free. Errors: those of the mesh; another number of tangents than
/// corners.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_split_vertices(
    mesh: *const darboux_mesh,
    tangents: *const f32,
    tangent_count: usize,
    tangent_stride: usize,
    context: *const darboux_context,
    split: *mut *mut darboux_vertex_split,
) -> darboux_status {
    let make = || {
        // SAFETY: the pointers are as documented above.
        let (mesh, context, tangents) = unsafe {
            let mesh = mesh::view(mesh)?;
            let corners = mesh.corner_count();
            let tangents =
                gathered_of_corners(corners, "tangents", tangents.cast(), tangent_count, tangent_stride)?;
            (mesh, context.as_ref(), tangents)
        };
        let split = context::run(context, mesh.corner_count(), |memory| {
            split_vertices_with(&mesh, CornerTangentsRef::from_per_corner(&tangents), &mut memory.context)
        })?;
        Ok(owned_vertices(split))
    };
    // SAFETY: `split` is null or writable; the view is the first field of the allocation.
    call(|| unsafe { hand_out("split", split.cast(), make) })
}

/// Frees a split. `split`: from darboux_split_vertices; may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_vertex_split_free(split: *mut darboux_vertex_split) {
    // SAFETY: `split` is null or from `darboux_split_vertices`, and no longer used.
    unsafe { take_back(split.cast::<Owned<darboux_vertex_split, VertexSplit>>()) }
}

/// Splits the vertices whose corners have different normals.
///
/// Each distinct pair of old vertex and normal (three floats, compared as bits) becomes one vertex. `mesh`:
/// as for darboux_generate_normals. `normals`: C by 3 floats, as darboux_generate_normals writes them.
/// `normal_count`: C. `normal_stride`: bytes from one normal to the next; 0 for packed. `context`: threads
/// and a cancellation flag; NULL for the calling thread alone. `split`: receives the result; free it with
/// darboux_normal_split_free. Errors: those of the mesh; another number of normals than corners.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_split_normals(
    mesh: *const darboux_mesh,
    normals: *const f32,
    normal_count: usize,
    normal_stride: usize,
    context: *const darboux_context,
    split: *mut *mut darboux_normal_split,
) -> darboux_status {
    let make = || {
        // SAFETY: the pointers are as documented above.
        let (mesh, context, normals) = unsafe {
            let mesh = mesh::bare(mesh)?;
            let corners = mesh.corner_count();
            let normals =
                gathered_of_corners(corners, "normals", normals.cast(), normal_count, normal_stride)?;
            (mesh, context.as_ref(), normals)
        };
        let split = context::run(context, mesh.corner_count(), |memory| {
            let normals = CornerNormalsRef::from_per_corner(&normals);
            split_normals_with(mesh.vertex_count(), mesh.indices(), normals, &mut memory.context)
        })?;
        Ok(owned_normals(split))
    };
    // SAFETY: `split` is null or writable; the view is the first field of the allocation.
    call(|| unsafe { hand_out("split", split.cast(), make) })
}

/// Frees a split. `split`: from darboux_split_normals; may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_normal_split_free(split: *mut darboux_normal_split) {
    // SAFETY: `split` is null or from `darboux_split_normals`, and no longer used.
    unsafe { take_back(split.cast::<Owned<darboux_normal_split, NormalSplit>>()) }
}

fn owned_vertices(arrays: VertexSplit) -> Owned<darboux_vertex_split, VertexSplit> {
    let view = darboux_vertex_split {
        vertex_count: arrays.tangent_of_vertex.len(),
        tangent_of_vertex: arrays.tangent_of_vertex.as_ptr(),
        source_of_vertex: arrays.source_of_vertex.as_ptr(),
        index_count: arrays.indices.len(),
        indices: arrays.indices.as_ptr(),
    };
    Owned { view, arrays }
}

fn owned_normals(arrays: NormalSplit) -> Owned<darboux_normal_split, NormalSplit> {
    let view = darboux_normal_split {
        vertex_count: arrays.normal_of_vertex.len(),
        normal_of_vertex: arrays.normal_of_vertex.as_ptr(),
        source_of_vertex: arrays.source_of_vertex.as_ptr(),
        index_count: arrays.indices.len(),
        indices: arrays.indices.as_ptr(),
    };
    Owned { view, arrays }
}

//! Inputs and outputs that only the functions of the full module have.

use darboux::{Plan, VertexSplit};

use crate::mesh_arrays::Surface;

#[derive(Default)]
pub struct Extras {
    /// Four floats per tangent.
    pub given_tangents: Vec<f32>,
    /// The tangents that the given ones are compared with.
    pub other_tangents: Vec<f32>,
    /// Encoded tangents, or texels.
    pub encoded_bytes: Vec<u8>,
    /// Two conventions, one behind the other.
    pub convention_texts: Vec<u8>,
    /// Nine floats per matrix.
    pub matrices: Vec<f32>,
    /// For each vertex, the matrices that move it.
    pub joints: Vec<u32>,
    /// The weight of each joint.
    pub weights: Vec<f32>,
    /// For each vertex, the first vertex that equals it.
    pub welded_vertices: Vec<u32>,
    /// The result of `generate_normals` (three per corner) and of `decode_tangents` (four per tangent).
    pub floats: Vec<f32>,
    pub split: VertexSplit,
    pub frames: FrameArrays,
    /// Plans by id. `None` is a free id.
    pub plans: Vec<Option<StoredPlan>>,
    /// The result of `measure_tangents` and of `report`.
    pub numbers: Vec<f64>,
    /// The arrays of a GPU plan, in the order of `lib/core/gpu-plan.ts`.
    pub gpu_plan_arrays: Vec<Vec<u32>>,
}

/// The parts of frames, one of each per corner.
#[derive(Default)]
pub struct FrameArrays {
    pub tangents: Vec<[f32; 4]>,
    pub bitangents: Vec<[f32; 3]>,
    pub magnitudes: Vec<[f32; 2]>,
}

/// A plan and the UVs and topology of its mesh, which every evaluation needs.
pub struct StoredPlan {
    pub plan: Plan,
    pub surface: Surface,
}

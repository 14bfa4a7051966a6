//! `planTopology`: the arrays with which the shaders of `darboux/webgpu` evaluate tangents wherever the
//! vertices are.

use darboux::Context;
use darboux::internal::gpu_plan::{PlanArrays, PlanRefusal};

use crate::arena::with_arena;
use crate::options::tangent_options;

/// Plans a mesh of triangles for shaders. Returns 0; or the number of members of the largest sum where that
/// exceeds `max_members`; or -1 where an index is out of range.
#[unsafe(no_mangle)]
pub extern "C" fn plan_topology(mode: u32, threshold: f32, max_members: usize) -> i32 {
    with_arena(|arena| {
        let Some(mesh) = arena.mesh() else { return -1 };
        let options = tangent_options(mode, threshold, 0);
        let topology = match PlanArrays::new(&mesh, &options, &mut Context::new(), max_members) {
            Ok(topology) => topology,
            Err(PlanRefusal::TooManyMembers { members, .. }) => return members as i32,
            Err(PlanRefusal::QuadHalvesDiffer { .. } | PlanRefusal::OtherMethod | PlanRefusal::Failed(_)) => {
                return -1;
            }
        };
        let (sum_of_vertex, split_vertices) = match topology.sum_of_vertex(&mesh) {
            Ok(sums) => (sums, 0),
            Err(vertices) => (Vec::new(), vertices as u32),
        };
        let PlanArrays { triangle_count, degenerate_count, sum_count, repairs, .. } = topology;
        let counts = vec![triangle_count, degenerate_count, sum_count, repairs.into(), split_vertices];
        let PlanArrays { triangles, representatives, sums, sum_of_corner, .. } = topology;
        arena.extras.gpu_plan_arrays =
            vec![counts, triangles, representatives, sums, sum_of_corner, sum_of_vertex];
        0
    })
}

/// The address of one array of the GPU plan. The arrays are numbered as in `lib/core/gpu-plan.ts`.
#[unsafe(no_mangle)]
pub extern "C" fn gpu_plan_array(array: usize) -> *const u32 {
    with_arena(|arena| arena.extras.gpu_plan_arrays[array].as_ptr())
}

/// The number of elements of one array of the GPU plan.
#[unsafe(no_mangle)]
pub extern "C" fn gpu_plan_array_len(array: usize) -> usize {
    with_arena(|arena| arena.extras.gpu_plan_arrays[array].len())
}

/// Frees the arrays of the GPU plan.
#[unsafe(no_mangle)]
pub extern "C" fn free_gpu_plan() {
    with_arena(|arena| arena.extras.gpu_plan_arrays = Vec::new());
}

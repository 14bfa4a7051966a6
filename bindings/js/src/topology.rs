//! What of a mesh does not move, for `darboux/webgpu`.

use darboux::internal::gpu_plan::{Topology, Unplanned};

use crate::room::with;
use crate::tangents::options;

/// Plans a mesh for shaders: 0, or how many members some sum has where these are more than `most`, or -1 where the mesh is not one. Its faces
/// are triangles.
#[unsafe(no_mangle)]
pub extern "C" fn plan_topology(mode: u32, threshold: f32, most: usize) -> i32 {
    with(|room| {
        let Some(mesh) = room.mesh() else { return -1 };
        let topology = match Topology::new(&mesh, &options(mode, threshold, 0), most) {
            Ok(topology) => topology,
            Err(Unplanned::TooManyMembers { members, .. }) => return members as i32,
            Err(Unplanned::HalvesDisagree { .. } | Unplanned::OtherMethod) => return -1,
        };
        let (of_vertices, split) = match topology.sum_of_vertex(&mesh) {
            Ok(of_vertices) => (of_vertices, 0),
            Err(vertices) => (Vec::new(), vertices as u32),
        };
        let Topology { triangle_count, degenerate_count, sum_count, repairs, .. } = topology;
        let counts = vec![triangle_count, degenerate_count, sum_count, repairs.into(), split];
        let Topology { triangles, representatives, sums, sum_of_corner, .. } = topology;
        room.values.topology = vec![counts, triangles, representatives, sums, sum_of_corner, of_vertices];
        0
    })
}

/// Where a list of the planned mesh lies, in the order of `planTopology` in `lib/topology.ts`.
#[unsafe(no_mangle)]
pub extern "C" fn topology_list(list: usize) -> *const u32 {
    with(|room| room.values.topology[list].as_ptr())
}

/// How long it is.
#[unsafe(no_mangle)]
pub extern "C" fn topology_length(list: usize) -> usize {
    with(|room| room.values.topology[list].len())
}

/// Frees the lists.
#[unsafe(no_mangle)]
pub extern "C" fn drop_topology() {
    with(|room| room.values.topology = Vec::new());
}

//! `Plan`: groups a mesh once, and evaluates its tangents again whenever its vertices have moved.

use std::mem::take;

use darboux::{Mesh, Plan};

use crate::arena::{Arena, with_arena};
use crate::extras::{Extras, StoredPlan};
use crate::mesh_arrays::Vertices;
use crate::options::tangent_options;

/// Plans the mesh in the arena and takes its surface arrays. Returns the plan's id, or -1 where an index is
/// out of range. Options are those of `generate_tangents`.
#[unsafe(no_mangle)]
pub extern "C" fn make_plan(mode: u32, threshold: f32, method: u32) -> i32 {
    with_arena(|arena| {
        let Some(mesh) = arena.mesh() else { return -1 };
        let plan = Plan::new(&mesh, &tangent_options(mode, threshold, method));
        arena.report = plan.base().report;
        let stored = StoredPlan { plan, surface: take(&mut arena.surface) };
        let plans = &mut arena.extras.plans;
        let free = plans.iter().position(Option::is_none).unwrap_or(plans.len());
        plans.resize_with(plans.len().max(free + 1), || None);
        plans[free] = Some(stored);
        free as i32
    })
}

/// The address of the tangents of the mesh that was planned.
#[unsafe(no_mangle)]
pub extern "C" fn plan_base(plan: usize) -> *const f32 {
    let base = |stored: &StoredPlan| stored.plan.base().corners.per_corner().as_ptr().cast();
    with_arena(|arena| arena.extras.plans[plan].as_ref().map_or(std::ptr::null(), base))
}

/// Evaluates a plan with the positions and normals in the arena, as many as the planned mesh has, and returns
/// the address of the tangents.
#[unsafe(no_mangle)]
pub extern "C" fn evaluate_plan(plan: usize) -> *const f32 {
    with_arena(|arena| {
        let Arena { vertices, tangents, context, extras, .. } = arena;
        if let Some((plan, mesh)) = moved_mesh(vertices, extras, plan) {
            // The TypeScript side has checked the number of vertices.
            tangents.resize(mesh.corner_count(), [0.0; 4]);
            _ = plan.write_tangents(&mesh, context, tangents);
        }
        tangents.as_ptr().cast()
    })
}

/// The number of corners whose tangent a fresh run on the moved mesh would compute differently from
/// [`evaluate_plan`].
#[unsafe(no_mangle)]
pub extern "C" fn count_regrouped(plan: usize) -> u32 {
    with_arena(|arena| {
        let (plan, mesh) = moved_mesh(&arena.vertices, &arena.extras, plan)?;
        plan.count_regrouped(&mesh).ok()
    })
    .unwrap_or_default() as u32
}

/// Frees a plan. Its id may be used again.
#[unsafe(no_mangle)]
pub extern "C" fn free_plan(plan: usize) {
    with_arena(|arena| arena.extras.plans[plan] = None);
}

/// A plan, and its mesh with the vertices in the arena.
fn moved_mesh<'a>(vertices: &'a Vertices, extras: &'a Extras, plan: usize) -> Option<(&'a Plan, Mesh<'a>)> {
    let stored = extras.plans[plan].as_ref()?;
    Some((&stored.plan, vertices.mesh(&stored.surface)?))
}

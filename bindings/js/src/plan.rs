//! Topology once, evaluate often.

use std::mem::take;

use darboux::{Mesh, Plan};

use crate::room::{Room, Surface, Vertices, with};
use crate::tangents::options;
use crate::values::Values;

/// A plan and the surface that it was made for.
pub struct Kept {
    plan: Plan,
    surface: Surface,
}

/// Makes a plan of the mesh, whose surface it takes: its number, or -1 where the mesh is not one. Choices come as those of
/// `generate_tangents`.
#[unsafe(no_mangle)]
pub extern "C" fn make_plan(mode: u32, threshold: f32, method: u32) -> i32 {
    with(|room| {
        let Some(mesh) = room.mesh() else { return -1 };
        let plan = Plan::new(&mesh, &options(mode, threshold, method));
        room.tangents.report = plan.base().report;
        let kept = Kept { plan, surface: take(&mut room.surface) };
        let plans = &mut room.values.plans;
        let free = plans.iter().position(Option::is_none).unwrap_or(plans.len());
        plans.resize_with(plans.len().max(free + 1), || None);
        plans[free] = Some(kept);
        free as i32
    })
}

/// Where the tangents of a plan's base lie.
#[unsafe(no_mangle)]
pub extern "C" fn plan_base(plan: usize) -> *const f32 {
    let base = |kept: &Kept| kept.plan.base().corners.per_corner().as_ptr().cast();
    with(|room| room.values.plans[plan].as_ref().map_or(std::ptr::null(), base))
}

/// Evaluates a plan with the positions and normals that have been written since: where the tangents lie.
#[unsafe(no_mangle)]
pub extern "C" fn evaluate_plan(plan: usize) -> *const f32 {
    with(|room| {
        let Room { vertices, tangents, scratch, values, .. } = room;
        if let Some((plan, mesh)) = moved(vertices, values, plan) {
            // The caller gives as many vertices as the plan's mesh has.
            _ = plan.evaluate_into(&mesh, scratch, &mut tangents.corners);
        }
        tangents.corners.per_corner().as_ptr().cast()
    })
}

/// How many corners a fresh run would give another tangent than [`evaluate_plan`].
#[unsafe(no_mangle)]
pub extern "C" fn count_regrouped(plan: usize) -> u32 {
    with(|room| {
        let (plan, mesh) = moved(&room.vertices, &room.values, plan)?;
        plan.count_regrouped(&mesh).ok()
    })
    .unwrap_or_default() as u32
}

/// Frees a plan, whose number another may have then.
#[unsafe(no_mangle)]
pub extern "C" fn drop_plan(plan: usize) {
    with(|room| room.values.plans[plan] = None);
}

/// A plan and its mesh, moved.
fn moved<'a>(vertices: &'a Vertices, values: &'a Values, plan: usize) -> Option<(&'a Plan, Mesh<'a>)> {
    let kept = values.plans[plan].as_ref()?;
    Some((&kept.plan, vertices.mesh(&kept.surface)?))
}

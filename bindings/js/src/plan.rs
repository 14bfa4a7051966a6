//! Topology once, evaluate often. One plan per instance of the module, so that it goes when the instance goes.

use std::mem::take;

use darboux::Plan;

use crate::room::with;
use crate::tangents::options;

/// Makes the plan of the mesh: where its tangents lie, or null where the mesh is not one. Choices come as those of
/// `generate_tangents`.
#[unsafe(no_mangle)]
pub extern "C" fn make_plan(mode: u32, threshold: f32, method: u32) -> *const f32 {
    with(|room| {
        let Some(mesh) = room.mesh() else { return std::ptr::null() };
        let plan = Plan::new(&mesh, &options(mode, threshold, method));
        room.tangents.report = plan.base().report;
        room.values.plan.insert(plan).base().corners.per_corner().as_ptr().cast()
    })
}

/// Evaluates the plan with the positions and normals that have been written since: where the tangents lie.
#[unsafe(no_mangle)]
pub extern "C" fn evaluate_plan() -> *const f32 {
    with(|room| {
        let (mut tangents, mut scratch) = (take(&mut room.tangents), take(&mut room.scratch));
        let (Some(mesh), Some(plan)) = (room.mesh(), &room.values.plan) else { return std::ptr::null() };
        let evaluated = plan.evaluate_into(&mesh, &mut scratch, &mut tangents.corners);
        (room.tangents, room.scratch) = (tangents, scratch);
        if evaluated.is_ok() { room.tangents.corners.per_corner().as_ptr().cast() } else { std::ptr::null() }
    })
}

/// How many corners a fresh run would give another tangent than [`evaluate_plan`].
#[unsafe(no_mangle)]
pub extern "C" fn count_regrouped() -> u32 {
    with(|room| {
        let plan = room.mesh().zip(room.values.plan.as_ref());
        plan.and_then(|(mesh, plan)| plan.count_regrouped(&mesh).ok()).unwrap_or_default() as u32
    })
}

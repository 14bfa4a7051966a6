//! Plans in C: the topology of a mesh is computed once, and tangents are evaluated for any number of deformed
//! copies.

use darboux::Plan;

use crate::context::{self, Memory, darboux_context};
use crate::mesh::{self, darboux_mesh};
use crate::pointers::{Output, Receiver, hand_out, held, take_back};
use crate::status::{call, darboux_status};
use crate::tangents::{darboux_report, darboux_tangent_options, options};

/// The weld, groups and subgroups of one mesh, for computing its tangents again after its vertices moved.
///
/// A plan holds copies of all that it needs from the mesh. Several threads may use one plan at the same time.
pub struct darboux_plan {
    plan: Plan,
}

/// Computes the tangents of a mesh and a plan for its deformed copies.
///
/// `mesh`, `options`: as for darboux_generate_tangents. `context`: threads and a cancellation flag; NULL for
/// the calling thread alone. `plan`: receives the plan; free it with darboux_plan_free. Errors: those of
/// darboux_generate_tangents.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_create(
    mesh: *const darboux_mesh,
    options: *const darboux_tangent_options,
    context: *const darboux_context,
    plan: *mut *mut darboux_plan,
) -> darboux_status {
    let make = || {
        // SAFETY: the pointers are as documented above.
        let (mesh, options, context) =
            unsafe { (mesh::view(mesh)?, self::options(options)?, context.as_ref()) };
        let plan = context::run(context, mesh.corner_count(), |memory| {
            Plan::new_with(&mesh, &options, &mut memory.context)
        })?;
        Ok(darboux_plan { plan })
    };
    // SAFETY: `plan` is null or writable.
    call(|| unsafe { hand_out("plan", plan, make) })
}

/// Frees a plan. `plan`: from darboux_plan_create; may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_free(plan: *mut darboux_plan) {
    // SAFETY: `plan` is null or from `darboux_plan_create`, and no longer used.
    unsafe { take_back(plan) }
}

/// Writes the tangents of the mesh that the plan was created from: the result of darboux_generate_tangents.
///
/// `tangents`, `tangent_count`, `tangent_stride`, `report`: as for darboux_generate_tangents. Errors: a null
/// pointer, another count than the mesh's corners.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_base(
    plan: *const darboux_plan,
    tangents: *mut f32,
    tangent_count: usize,
    tangent_stride: usize,
    report: *mut darboux_report,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above.
        let (base, report, out) = unsafe {
            let base = held("plan", plan)?.plan.base();
            let corners = base.corners.len();
            let out = Output::expecting(corners, "tangents", tangents.cast(), tangent_count, tangent_stride)?;
            (base, Receiver::optional(report)?, out)
        };
        out.copy(base.corners.per_corner());
        if let Some(report) = report {
            report.put(base.report.into());
        }
        Ok(())
    })
}

/// Computes the tangents of a deformed mesh, with the groups, subgroups and signs of the plan.
///
/// `mesh`: the plan's faces, indices and UVs, with other positions and normals. `context`: reused memory,
/// threads and a cancellation flag; NULL for the calling thread alone. `tangents`, `tangent_count`,
/// `tangent_stride`: as for darboux_generate_tangents. Errors: those of the mesh; another number of corners
/// or vertices than the plan's.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_evaluate(
    plan: *const darboux_plan,
    mesh: *const darboux_mesh,
    context: *const darboux_context,
    tangents: *mut f32,
    tangent_count: usize,
    tangent_stride: usize,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above.
        let (plan, mesh, context, out) = unsafe {
            let mesh = mesh::view(mesh)?;
            let corners = mesh.corner_count();
            let out = Output::expecting(corners, "tangents", tangents.cast(), tangent_count, tangent_stride)?;
            (held("plan", plan)?, mesh, context.as_ref(), out)
        };
        let run = |memory: &mut _, corners: &mut _| plan.plan.write_tangents(&mesh, memory, corners);
        context::fill(context, out, run)
    })
}

/// Counts the corners whose tangents from darboux_plan_evaluate and from darboux_generate_tangents on the
/// deformed mesh differ in bits.
///
/// `mesh`, `context`: as for darboux_plan_evaluate. `count`: receives the number of corners. Errors: those of
/// darboux_plan_evaluate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_count_regrouped(
    plan: *const darboux_plan,
    mesh: *const darboux_mesh,
    context: *const darboux_context,
    count: *mut usize,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above.
        let (plan, mesh, context, out) = unsafe {
            let out = Output::new("count", count.cast(), 1, 0)?;
            (held("plan", plan)?, mesh::view(mesh)?, context.as_ref(), out)
        };
        let count = |memory: &mut Memory| plan.plan.count_regrouped_with(&mesh, &mut memory.context);
        out.copy(&[context::run(context, mesh.corner_count(), count)?]);
        Ok(())
    })
}

//! Topology once, evaluate often.

use darboux::{Context, Plan};

use crate::context::{self, darboux_context};
use crate::mesh::{self, darboux_mesh};
use crate::pointers::{Output, Receiver, hand_out, held, take_back};
use crate::status::{call, darboux_status};
use crate::tangents::{darboux_report, darboux_tangent_options, options};

/// The weld, groups and subgroups of one mesh, kept to evaluate MikkTSpace tangents again after its vertices moved.
///
/// Nothing of the mesh's memory is kept. Several threads may use one plan at once.
pub struct darboux_plan {
    plan: Plan,
}

/// Computes a mesh's tangents and keeps its topology.
///
/// `mesh`, `options`: as for darboux_generate_tangents; of a context the threads alone are used. `plan`: receives the plan, for darboux_plan_free.
/// Errors: what darboux_status lists.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_create(
    mesh: *const darboux_mesh,
    options: *const darboux_tangent_options,
    plan: *mut *mut darboux_plan,
) -> darboux_status {
    let make = || {
        // SAFETY: every pointer is as the documentation above says.
        let (mesh, (options, context)) = unsafe { (mesh::view(mesh)?, self::options(options)?) };
        let plan = context::run(context, mesh.corner_count(), |memory| {
            Plan::new_with(&mesh, &options, &memory.context)
        })?;
        Ok(darboux_plan { plan })
    };
    // SAFETY: `plan` is null or may be written.
    call(|| unsafe { hand_out("plan", plan, make) })
}

/// Frees a plan; nothing where it is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_free(plan: *mut darboux_plan) {
    // SAFETY: `plan` is null or from `darboux_plan_create`, and no longer used.
    unsafe { take_back(plan) }
}

/// Writes the tangents of the mesh that the plan was made of, as darboux_generate_tangents does.
///
/// `tangents`, `tangent_count`, `tangent_stride`, `report`: as there. Errors: null; another number of corners.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_base(
    plan: *const darboux_plan,
    tangents: *mut f32,
    tangent_count: usize,
    tangent_stride: usize,
    report: *mut darboux_report,
) -> darboux_status {
    call(|| {
        // SAFETY: every pointer is as the documentation above says.
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

/// Computes the tangents of the moved mesh in the plan's groups and subgroups; signs stay the plan's.
///
/// `mesh`: same faces, indices and UVs as the plan's, other positions and normals. `context`: memory and threads of earlier calls to use
/// again, or null. `tangents`, `tangent_count`, `tangent_stride`: as for darboux_generate_tangents. Errors: those of the mesh; another number of corners or vertices than the plan's.
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
        // SAFETY: every pointer is as the documentation above says.
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

/// Counts the corners to which a fresh run on the moved mesh would give another tangent (other bits) than darboux_plan_evaluate.
///
/// `mesh`: as there. `count`: receives the number. Errors: as there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_plan_count_regrouped(
    plan: *const darboux_plan,
    mesh: *const darboux_mesh,
    count: *mut usize,
) -> darboux_status {
    call(|| {
        // SAFETY: every pointer is as the documentation above says.
        let (plan, mesh, out) =
            unsafe { (held("plan", plan)?, mesh::view(mesh)?, Output::new("count", count.cast(), 1, 0)?) };
        let context = &mut Context::new().with_max_threads(1);
        out.copy(&[plan.plan.count_regrouped_with(&mesh, context)?]);
        Ok(())
    })
}

//! Quality of tangents in C: comparison of two sets of tangents, and of tangents with the derivatives of the
//! UV map.

use std::mem::offset_of;

use darboux::{TangentDifference, UvFidelity, measure_tangents_with, measure_uv_fidelity_with};

use crate::context::{self, Memory, darboux_context};
use crate::mesh::{self, darboux_mesh};
use crate::pointers::{self, Receiver, Versioned, gathered, gathered_of_corners};
use crate::status::{call, darboux_status};

/// The number of bins of the histogram of angles.
pub const DARBOUX_HISTOGRAM_BINS: usize = 10;
/// The maximum number of corners that darboux_tangent_difference lists.
pub const DARBOUX_WORST_CORNERS: usize = 16;

const _: () = assert!(DARBOUX_HISTOGRAM_BINS == TangentDifference::HISTOGRAM_BIN_ENDS.len());

/// The difference of two sets of tangents of one mesh. Angles are in degrees, between the xyz of one corner
/// in both sets.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_tangent_difference {
    /// sizeof(darboux_tangent_difference), set by the caller. 0: the size in version 0.1.
    pub size: usize,
    /// The number of corners.
    pub corners: usize,
    /// Corners whose four floats have equal bits or are NaN in both sets.
    pub identical: usize,
    /// Corners whose signs differ: exactly one w is below zero.
    pub sign_flips: usize,
    /// Corners without an angle, because a tangent is zero or not finite. The fields below ignore them.
    pub without_angle: usize,
    /// The mean angle.
    pub mean: f64,
    /// The smallest angle.
    pub min: f64,
    /// The median angle.
    pub median: f64,
    /// The 95th percentile of the angles.
    pub p95: f64,
    /// The largest angle.
    pub max: f64,
    /// The number of corners per bin. The bins end at 0, 0.001, 0.01, 0.1, 1, 5, 15, 45, 90 and 180 degrees.
    pub histogram: [usize; DARBOUX_HISTOGRAM_BINS],
    /// The number of elements of `worst_corners` and `worst_angles` that are set.
    pub worst_count: usize,
    /// The corners with the largest angles above zero, in descending order of the angle.
    pub worst_corners: [usize; DARBOUX_WORST_CORNERS],
    /// The angles of `worst_corners`.
    pub worst_angles: [f64; DARBOUX_WORST_CORNERS],
}

// SAFETY: `repr(C)`, the size is the first field, all fields are numbers.
unsafe impl Versioned for darboux_tangent_difference {
    const NAME: &str = "darboux_tangent_difference";
    const FIRST_SIZE: usize =
        pointers::size_through::<Self, [f64; DARBOUX_WORST_CORNERS]>(offset_of!(Self, worst_angles));
}

impl From<TangentDifference> for darboux_tangent_difference {
    fn from(difference: TangentDifference) -> Self {
        let mut out = Self {
            size: size_of::<Self>(),
            corners: difference.corners,
            identical: difference.identical,
            sign_flips: difference.sign_flips,
            without_angle: difference.without_angle,
            mean: difference.mean,
            min: difference.min,
            median: difference.median,
            p95: difference.p95,
            max: difference.max,
            histogram: difference.histogram,
            worst_count: difference.worst.len().min(DARBOUX_WORST_CORNERS),
            worst_corners: [0; DARBOUX_WORST_CORNERS],
            worst_angles: [0.0; DARBOUX_WORST_CORNERS],
        };
        let places = out.worst_corners.iter_mut().zip(&mut out.worst_angles);
        for ((to_corner, to_angle), (corner, angle)) in places.zip(difference.worst) {
            (*to_corner, *to_angle) = (corner, angle);
        }
        out
    }
}

/// The angle between interpolated tangents and dP/du, over the surface.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_uv_fidelity {
    /// sizeof(darboux_uv_fidelity), set by the caller. 0: the size in version 0.1.
    pub size: usize,
    /// The mean angle over the surface, weighted by area, in degrees.
    pub mean: f64,
    /// The root of the mean square of the angle, in degrees.
    pub root_mean_square: f64,
    /// The area of the triangles that were measured.
    pub area: f64,
    /// The number of triangles that were not measured, because they have no area or no dP/du.
    pub unmeasured_triangles: usize,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are numbers.
unsafe impl Versioned for darboux_uv_fidelity {
    const NAME: &str = "darboux_uv_fidelity";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, unmeasured_triangles));
}

impl From<UvFidelity> for darboux_uv_fidelity {
    fn from(fidelity: UvFidelity) -> Self {
        let UvFidelity { mean, root_mean_square, area, unmeasured_triangles, .. } = fidelity;
        Self { size: size_of::<Self>(), mean, root_mean_square, area, unmeasured_triangles }
    }
}

/// Compares two sets of tangents, corner by corner.
///
/// `count`: the number of corners. `a`, `b`: `count` by 4 floats, of the corners of one mesh in the same
/// order. `a_stride`, `b_stride`: bytes from one tangent to the next; 0 for packed. `context`: threads and a
/// cancellation flag; NULL for the calling thread alone. `difference`: receives the result. Errors: a null
/// pointer, a stride smaller than an element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_measure_tangents(
    count: usize,
    a: *const f32,
    a_stride: usize,
    b: *const f32,
    b_stride: usize,
    context: *const darboux_context,
    difference: *mut darboux_tangent_difference,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above.
        let (out, context, a, b) = unsafe {
            let a = gathered("a", a.cast(), count, a_stride)?;
            let b = gathered("b", b.cast(), count, b_stride)?;
            (Receiver::new(difference)?, context.as_ref(), a, b)
        };
        let found =
            context::run(context, count, |memory| measure_tangents_with(&a, &b, &mut memory.context))?;
        out.put(found.into());
        Ok(())
    })
}

/// Measures tangents against the derivatives of the UV map, over the surface.
///
/// `mesh`: the mesh of the tangents. `tangents`: C by 4 floats. `tangent_count`: C. `tangent_stride`: bytes
/// from one tangent to the next; 0 for packed. `context`: threads and a cancellation flag; NULL for the
/// calling thread alone. `fidelity`: receives the result. Errors: those of the mesh; another number of
/// tangents than corners.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_measure_uv_fidelity(
    mesh: *const darboux_mesh,
    tangents: *const f32,
    tangent_count: usize,
    tangent_stride: usize,
    context: *const darboux_context,
    fidelity: *mut darboux_uv_fidelity,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above.
        let (mesh, out, context, tangents) = unsafe {
            let mesh = mesh::view(mesh)?;
            let corners = mesh.corner_count();
            let tangents =
                gathered_of_corners(corners, "tangents", tangents.cast(), tangent_count, tangent_stride)?;
            (mesh, Receiver::new(fidelity)?, context.as_ref(), tangents)
        };
        let measure = |memory: &mut Memory| measure_uv_fidelity_with(&mesh, &tangents, &mut memory.context);
        out.put(context::run(context, mesh.corner_count(), measure)?.into());
        Ok(())
    })
}

//! How far tangents are apart, and how well they follow the UVs.

use std::mem::offset_of;

use darboux::{HISTOGRAM_ENDS, TangentDifference, UvFidelity, measure_tangents, measure_uv_fidelity};

use crate::mesh::{self, darboux_mesh};
use crate::pointers::{self, Receiver, Versioned, gathered, gathered_of_corners};
use crate::status::{call, darboux_status};

/// How many bins a histogram of angles has.
pub const DARBOUX_HISTOGRAM_BINS: usize = 10;
/// How many corners darboux_tangent_difference lists at most.
pub const DARBOUX_WORST_CORNERS: usize = 16;

const _: () = assert!(DARBOUX_HISTOGRAM_BINS == HISTOGRAM_ENDS.len());

/// How two sets of tangents of one mesh differ. Angles are between the xyz of a corner in both, in degrees.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_tangent_difference {
    /// sizeof(darboux_tangent_difference), set by the caller, or 0, which stands for version 0.1's size.
    pub size: usize,
    /// The number of corners.
    pub corners: usize,
    /// Corners whose four floats are the same bits, or NaN in both.
    pub identical: usize,
    /// Corners whose signs differ.
    pub sign_flips: usize,
    /// Corners where a tangent is zero or not finite, so that there is no angle. They are in none of the numbers below.
    pub without_angle: usize,
    /// The mean angle.
    pub mean: f64,
    /// The smallest angle.
    pub min: f64,
    /// The angle that half of the corners do not exceed.
    pub median: f64,
    /// The angle that 95 corners in 100 do not exceed.
    pub p95: f64,
    /// The largest angle.
    pub max: f64,
    /// Corners per bin. The bins end at 0, 0.001, 0.01, 0.1, 1, 5, 15, 45, 90 and 180 degrees.
    pub histogram: [usize; DARBOUX_HISTOGRAM_BINS],
    /// How many of the next two arrays' elements are set.
    pub worst_count: usize,
    /// The corners with the largest angles, the largest first.
    pub worst_corners: [usize; DARBOUX_WORST_CORNERS],
    /// Their angles.
    pub worst_angles: [f64; DARBOUX_WORST_CORNERS],
}

// SAFETY: `repr(C)`, the size first, numbers.
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

/// How well tangents follow the UVs: the angle between the tangent as shaders interpolate it and the true dP/du.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_uv_fidelity {
    /// sizeof(darboux_uv_fidelity), set by the caller, or 0, which stands for version 0.1's size.
    pub size: usize,
    /// The mean angle over the surface, weighted by area, in degrees.
    pub mean: f64,
    /// The root of the mean square of the angle, in degrees.
    pub root_mean_square: f64,
    /// The area that was measured.
    pub area: f64,
    /// Triangles that were not: without area, or without a dP/du.
    pub left_out: usize,
}

// SAFETY: `repr(C)`, the size first, numbers.
unsafe impl Versioned for darboux_uv_fidelity {
    const NAME: &str = "darboux_uv_fidelity";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, left_out));
}

impl From<UvFidelity> for darboux_uv_fidelity {
    fn from(fidelity: UvFidelity) -> Self {
        let UvFidelity { mean, root_mean_square, area, left_out, .. } = fidelity;
        Self { size: size_of::<Self>(), mean, root_mean_square, area, left_out }
    }
}

/// Compares two sets of tangents, corner by corner.
///
/// `a`, `b`: `count` by 4, of corners of the same mesh in the same order. `a_stride`, `b_stride`: bytes from one tangent to the next,
/// 0 for packed. `difference`: receives the result. Errors: null, a stride that is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_measure_tangents(
    a: *const f32,
    a_stride: usize,
    b: *const f32,
    b_stride: usize,
    count: usize,
    difference: *mut darboux_tangent_difference,
) -> darboux_status {
    call(|| {
        // SAFETY: every pointer is as the documentation above says.
        let (out, a, b) = unsafe {
            let a = gathered("a", a.cast(), count, a_stride)?;
            let b = gathered("b", b.cast(), count, b_stride)?;
            (Receiver::new(difference)?, a, b)
        };
        out.put(measure_tangents(&a, &b)?.into());
        Ok(())
    })
}

/// Measures tangents against the derivatives of the UV map, over the surface.
///
/// `mesh`: the mesh that the tangents belong to. `tangents`: C by 4. `tangent_count`: C. `tangent_stride`: bytes from one tangent to the
/// next, 0 for packed. `fidelity`: receives the result. Errors: those of the mesh; another number of tangents.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_measure_uv_fidelity(
    mesh: *const darboux_mesh,
    tangents: *const f32,
    tangent_count: usize,
    tangent_stride: usize,
    fidelity: *mut darboux_uv_fidelity,
) -> darboux_status {
    call(|| {
        // SAFETY: every pointer is as the documentation above says.
        let (mesh, out, tangents) = unsafe {
            let mesh = mesh::view(mesh)?;
            let corners = mesh.corner_count();
            let tangents =
                gathered_of_corners(corners, "tangents", tangents.cast(), tangent_count, tangent_stride)?;
            (mesh, Receiver::new(fidelity)?, tangents)
        };
        out.put(measure_uv_fidelity(&mesh, &tangents)?.into());
        Ok(())
    })
}

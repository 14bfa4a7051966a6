//! Generated normals in C: flat, or smooth with creases, one per corner.

use std::mem::offset_of;

use darboux::{NormalOptions, NormalReport, generate_normals_with};

use crate::codes::{self, darboux_normal_weight, darboux_shading, darboux_smoothing_seams};
use crate::context::{self, darboux_context};
use crate::mesh::{self, darboux_mesh};
use crate::pointers::{self, Output, Receiver, Versioned};
use crate::status::{Error, call, darboux_status};

/// Options of darboux_generate_normals. All zeros: smooth everywhere, weighted by angle.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_normal_options {
    /// sizeof(darboux_normal_options). 0: the size in version 0.1.
    pub size: usize,
    /// Flat or smooth shading. Default: smooth.
    pub shading: darboux_shading,
    /// The weight of each face at a vertex, for smooth shading. Default: the angle of the face's corner.
    pub weight: darboux_normal_weight,
    /// The crease angle in degrees: smooth shading stops at edges whose faces' normals differ by more. 0
    /// stands for 180: no creases. With a negative value, smooth shading stops at every edge that is not
    /// flat.
    pub crease: f32,
    /// Whether vertices at equal positions are merged, for smooth shading. Default: they are merged.
    pub seams: darboux_smoothing_seams,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are numbers.
unsafe impl Versioned for darboux_normal_options {
    const NAME: &str = "darboux_normal_options";
    const FIRST_SIZE: usize =
        pointers::size_through::<Self, darboux_smoothing_seams>(offset_of!(Self, seams));
}

/// The counts of a run of darboux_generate_normals.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_normal_report {
    /// sizeof(darboux_normal_report), set by the caller. 0: the size in version 0.1.
    pub size: usize,
    /// The faces of the mesh, degenerate ones included.
    pub faces: usize,
    /// Faces without an area or with values that are not finite. They are skipped.
    pub degenerate_faces: usize,
    /// Corners whose faces' normals cancel or are missing. Their normal is that of their face, else the mean
    /// at their vertex, else (0, 0, 1).
    pub repaired_corners: usize,
    /// Edges between two faces at which smooth shading stops because of the crease angle.
    pub creased_edges: usize,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are integers.
unsafe impl Versioned for darboux_normal_report {
    const NAME: &str = "darboux_normal_report";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, creased_edges));
}

impl From<NormalReport> for darboux_normal_report {
    fn from(report: NormalReport) -> Self {
        Self {
            size: size_of::<Self>(),
            faces: report.faces,
            degenerate_faces: report.degenerate_faces,
            repaired_corners: report.repaired_corners,
            creased_edges: report.creased_edges,
        }
    }
}

/// Computes a unit normal for every corner. darboux_split_normals computes vertices from them.
///
/// `mesh`: positions, indices and faces of 3 or more corners, which wind counter-clockwise seen from the side
/// that their normal points to. `options`: NULL for the defaults. `context`: threads and a cancellation flag;
/// NULL for the calling thread alone. `normals`: receives C by 3 floats. `normal_count`: C. `normal_stride`:
/// bytes from one normal to the next; 0 for packed. `report`: receives the counts; may be NULL. Errors: those
/// of the mesh; another count than C; see darboux_status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_generate_normals(
    mesh: *const darboux_mesh,
    options: *const darboux_normal_options,
    context: *const darboux_context,
    normals: *mut f32,
    normal_count: usize,
    normal_stride: usize,
    report: *mut darboux_normal_report,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above. The mesh is read before the output is written.
        let (mesh, options, context, report, out) = unsafe {
            let mesh = mesh::bare(mesh)?;
            let corners = mesh.corner_count();
            let out = Output::expecting(corners, "normals", normals.cast(), normal_count, normal_stride)?;
            (mesh, self::options(options)?, context.as_ref(), Receiver::optional(report)?, out)
        };
        let made = context::run(context, mesh.corner_count(), |memory| {
            let (positions, indices) = (mesh.positions(), mesh.indices());
            generate_normals_with(positions, indices, mesh.faces(), &options, &mut memory.context)
        })?;
        out.copy(made.corners.per_corner());
        if let Some(report) = report {
            report.put(made.report.into());
        }
        Ok(())
    })
}

/// Reads the options.
///
/// # Safety
///
/// `options` is null or points to a valid [`darboux_normal_options`].
unsafe fn options(options: *const darboux_normal_options) -> Result<NormalOptions, Error> {
    // SAFETY: the caller's promise.
    let options = unsafe { pointers::read_or_zeros(options) }?;
    Ok(NormalOptions::new()
        .with_shading(codes::shading(options.shading)?)
        .with_weight(codes::normal_weight(options.weight)?)
        .with_crease(if options.crease == 0.0 { 180.0 } else { options.crease })
        .with_seams(codes::smoothing_seams(options.seams)?))
}

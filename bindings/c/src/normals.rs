//! Normals of corners.

use std::mem::offset_of;

use darboux::{NormalOptions, NormalReport, generate_normals};

use crate::codes::{self, darboux_normal_weight, darboux_shading, darboux_smoothing_seams};
use crate::mesh::{self, darboux_mesh};
use crate::pointers::{self, Output, Receiver, Versioned};
use crate::status::{Error, call, darboux_status};

/// How darboux_generate_normals makes normals. All zeros are the defaults: smooth everywhere, weighted by angle.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_normal_options {
    /// sizeof(darboux_normal_options), or 0, which stands for version 0.1's size.
    pub size: usize,
    /// Flat, or smooth. Default: smooth.
    pub shading: darboux_shading,
    /// How much each face counts at a vertex, where shading is smooth. Default: its angle there.
    pub weight: darboux_normal_weight,
    /// Smooth shading stops at edges whose faces' normals differ by more than this, in degrees. 0 stands for 180: it stops nowhere;
    /// a negative number stops it at every edge that is not flat.
    pub crease: f32,
    /// Which vertices are one, where shading is smooth. Default: those at equal positions.
    pub seams: darboux_smoothing_seams,
}

// SAFETY: `repr(C)`, the size first, numbers.
unsafe impl Versioned for darboux_normal_options {
    const NAME: &str = "darboux_normal_options";
    const FIRST_SIZE: usize =
        pointers::size_through::<Self, darboux_smoothing_seams>(offset_of!(Self, seams));
}

/// What was met on the way.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_normal_report {
    /// sizeof(darboux_normal_report), set by the caller, or 0, which stands for version 0.1's size.
    pub size: usize,
    /// Faces, degenerate ones included.
    pub faces: usize,
    /// Faces without an area, or with values that are not finite. They add nothing.
    pub degenerate_faces: usize,
    /// Corners whose faces' normals cancel or are missing.
    pub repaired_corners: usize,
    /// Edges between two faces at which smooth shading stops for their angle.
    pub creased_edges: usize,
}

// SAFETY: `repr(C)`, the size first, integers.
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

/// Computes a unit normal for every corner. darboux_split_normals gives vertices.
///
/// `mesh`: positions, indices and faces, of any size from 3 on, counter-clockwise seen from where their normal points. `options`: null
/// for the defaults. `normals`: room for C by 3 floats. `normal_count`: C. `normal_stride`: bytes from one normal to the next, 0 for
/// packed. `report`: what was met, or null. Errors: what darboux_status lists.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_generate_normals(
    mesh: *const darboux_mesh,
    options: *const darboux_normal_options,
    normals: *mut f32,
    normal_count: usize,
    normal_stride: usize,
    report: *mut darboux_normal_report,
) -> darboux_status {
    call(|| {
        // SAFETY: every pointer is as the documentation above says. The mesh is read before the output is written.
        let (mesh, options, report, out) = unsafe {
            let mesh = mesh::bare(mesh)?;
            let corners = mesh.corner_count();
            let out = Output::expecting(corners, "normals", normals.cast(), normal_count, normal_stride)?;
            (mesh, self::options(options)?, Receiver::optional(report)?, out)
        };
        let made = generate_normals(mesh.positions(), mesh.indices(), mesh.faces(), &options)?;
        out.copy(made.corners.per_corner());
        if let Some(report) = report {
            report.put(made.report.into());
        }
        Ok(())
    })
}

/// # Safety
///
/// `options` is as [`darboux_normal_options`] says, or null.
unsafe fn options(options: *const darboux_normal_options) -> Result<NormalOptions, Error> {
    // SAFETY: as of this function.
    let options = unsafe { pointers::read_or_zeros(options) }?;
    Ok(NormalOptions::new()
        .with_shading(codes::shading(options.shading)?)
        .with_weight(codes::normal_weight(options.weight)?)
        .with_crease(if options.crease == 0.0 { 180.0 } else { options.crease })
        .with_seams(codes::smoothing_seams(options.seams)?))
}

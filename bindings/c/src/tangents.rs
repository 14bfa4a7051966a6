//! Tangent generation in C: tangents or whole frames, one per corner, and a report of the run.

use std::mem::offset_of;

use darboux::{
    CompactFrames, Frame, Method, MikkTSpaceOptions, Report, TangentOptions, generate_compact_frames,
    write_tangents,
};

use crate::codes::{self, darboux_method, darboux_mode};
use crate::context::{self, darboux_context};
use crate::mesh::{self, darboux_mesh};
use crate::pointers::{self, Output, Receiver, Versioned};
use crate::status::{Error, call, darboux_status};

/// Options of darboux_generate_tangents. All zeros are the defaults, which are right for normal maps from
/// today's bakers.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_tangent_options {
    /// sizeof(darboux_tangent_options). 0: the size in version 0.1.
    pub size: usize,
    /// The method. Default: MikkTSpace.
    pub method: darboux_method,
    /// How faithfully defects of the reference are kept. Default: repaired. Must be 0 for all methods but
    /// MikkTSpace.
    pub mode: darboux_mode,
    /// The angular threshold of MikkTSpace in degrees: faces around a vertex share a tangent while their
    /// tangents and their bitangents differ by less. 0 stands for 180, which is what bakers use; for a
    /// threshold of zero, pass 0.001, which gives the same bits. Must be 0 for all other methods. Below
    /// 180 the faces around a vertex are compared in pairs: a vertex with 20,000 faces takes about 2 s, one
    /// with 100,000 about a minute.
    pub threshold: f32,
    /// Must be 0. It is space for an option of a later version.
    pub reserved: u32,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are numbers.
unsafe impl Versioned for darboux_tangent_options {
    const NAME: &str = "darboux_tangent_options";
    const FIRST_SIZE: usize = pointers::size_through::<Self, u32>(offset_of!(Self, reserved));
}

/// The counts of a run. Quads count as two triangles.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_report {
    /// sizeof(darboux_report), set by the caller. 0: the size in version 0.1.
    pub size: usize,
    /// The triangles of the mesh, halves of quads included.
    pub triangles: usize,
    /// Faces of other than 3 or 4 corners. Their tangents are perpendiculars of their normals.
    pub unsupported_faces: usize,
    /// Triangles with two equal positions.
    pub degenerate_triangles: usize,
    /// Triangles whose UVs span no area, or too little area for a direction. Degenerate and non-finite
    /// triangles are not counted.
    pub uv_degenerate_triangles: usize,
    /// Corners with NaN or infinity in the position, normal or UV.
    pub non_finite_corners: usize,
    /// Corners without a usable tangent. Their tangents are replaced, except in DARBOUX_MODE_REFERENCE.
    pub repaired_corners: usize,
    /// Faces whose corners have both signs.
    pub mixed_sign_faces: usize,
    /// Edges between two triangles of opposite UV orientation.
    pub mirrored_edges: usize,
    /// Vertices whose corners have different tangents. darboux_split_vertices splits them.
    pub split_vertices: usize,
    /// Vertices at which triangles of both UV orientations share one tangent. Zero for all methods but
    /// DARBOUX_METHOD_LENGYEL_PER_VERTEX.
    pub merged_vertices: usize,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are integers.
unsafe impl Versioned for darboux_report {
    const NAME: &str = "darboux_report";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, merged_vertices));
}

impl From<Report> for darboux_report {
    fn from(report: Report) -> Self {
        Self {
            size: size_of::<Self>(),
            triangles: report.triangles,
            unsupported_faces: report.unsupported_faces,
            degenerate_triangles: report.degenerate_triangles,
            uv_degenerate_triangles: report.uv_degenerate_triangles,
            non_finite_corners: report.non_finite_corners,
            repaired_corners: report.repaired_corners,
            mixed_sign_faces: report.mixed_sign_faces,
            mirrored_edges: report.mirrored_edges,
            split_vertices: report.split_vertices,
            merged_vertices: report.merged_vertices,
        }
    }
}

/// The whole frame of one corner.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct darboux_frame {
    /// The direction of increasing u, unit length, perpendicular to the normal.
    pub tangent: [f32; 3],
    /// The direction of increasing v, unit length, perpendicular to the normal but not always to the
    /// tangent.
    pub bitangent: [f32; 3],
    /// World units per unit of u and per unit of v.
    pub magnitude: [f32; 2],
    /// +1 where the UV map preserves orientation, -1 where it mirrors.
    pub sign: f32,
}

impl From<Frame> for darboux_frame {
    fn from(frame: Frame) -> Self {
        let Frame { tangent, bitangent, magnitude, sign } = frame;
        Self { tangent, bitangent, magnitude, sign }
    }
}

/// Reads the options.
///
/// # Safety
///
/// `options` is null or points to a valid [`darboux_tangent_options`].
pub(crate) unsafe fn options(options: *const darboux_tangent_options) -> Result<TangentOptions, Error> {
    // SAFETY: the caller's promise.
    let options = unsafe { pointers::read_or_zeros(options) }?;
    if options.reserved != 0 {
        let message = "reserved of darboux_tangent_options is not 0; set it to 0, or use a later version of \
             the library";
        return Err(Error::new(darboux_status::StructSize, message.into()));
    }
    let mut mikkt = MikkTSpaceOptions::new().with_mode(codes::mode(options.mode)?);
    if options.threshold != 0.0 {
        mikkt = mikkt.with_threshold(options.threshold);
    }
    match codes::method(options.method)? {
        Method::MikkTSpace(_) => Ok(mikkt.into()),
        other if mikkt == MikkTSpaceOptions::new() => Ok(other.into()),
        _ => {
            let message =
                "mode and threshold belong to DARBOUX_METHOD_MIKKTSPACE; leave them 0 with other methods";
            Err(Error::new(darboux_status::UnknownValue, message.into()))
        }
    }
}

/// Computes the tangent of every corner.
///
/// These are not vertex tangents: corners of one vertex can have different tangents, so do not write them
/// through the mesh's index list. darboux_split_vertices computes vertices and new indices. In an unindexed
/// mesh, corner i is vertex i, so the tangents can be written into the vertices. `mesh`: normals and UVs are
/// required. `options`: NULL for the defaults. `context`: reused memory, threads and a cancellation flag;
/// NULL for the calling thread alone, with memory of its own. `tangents`: receives C by 4 floats, unit xyz
/// and the sign w, where bitangent = w * cross(normal, xyz). It must not overlap the mesh's elements, but may
/// lie between them. `tangent_count`: C. `tangent_stride`: bytes from one tangent to the next; 0 for packed.
/// `report`: receives the counts; may be NULL. Errors: those of the mesh; another count than C; see
/// darboux_status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_generate_tangents(
    mesh: *const darboux_mesh,
    options: *const darboux_tangent_options,
    context: *const darboux_context,
    tangents: *mut f32,
    tangent_count: usize,
    tangent_stride: usize,
    report: *mut darboux_report,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above. The mesh is read before the output is written.
        let (mesh, options, context, report, out) = unsafe {
            let mesh = mesh::view(mesh)?;
            let corners = mesh.corner_count();
            let out = Output::expecting(corners, "tangents", tangents.cast(), tangent_count, tangent_stride)?;
            (mesh, self::options(options)?, context.as_ref(), Receiver::optional(report)?, out)
        };
        let run = |memory: &mut _, corners: &mut _| write_tangents(&mesh, &options, memory, corners);
        let report_of_run = context::fill(context, out, run)?;
        if let Some(report) = report {
            report.put(report_of_run.into());
        }
        Ok(())
    })
}

/// Computes the whole frame of every corner: tangent, bitangent, magnitudes and sign. Slower than
/// darboux_generate_tangents.
///
/// `frames`: receives C frames. `frame_count`: C. `frame_stride`: bytes from one frame to the next; 0 for
/// packed. `mesh`, `options`, `context`, `report` and errors: as for darboux_generate_tangents.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_generate_frames(
    mesh: *const darboux_mesh,
    options: *const darboux_tangent_options,
    context: *const darboux_context,
    frames: *mut darboux_frame,
    frame_count: usize,
    frame_stride: usize,
    report: *mut darboux_report,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above. The mesh is read before the output is written.
        let (mesh, options, context, report, out) = unsafe {
            let mesh = mesh::view(mesh)?;
            let corners = mesh.corner_count();
            let out = Output::expecting(corners, "frames", frames.cast(), frame_count, frame_stride)?;
            (mesh, self::options(options)?, context.as_ref(), Receiver::optional(report)?, out)
        };
        let report_of_run = context::run(context, mesh.corner_count(), move |memory| {
            let frames = generate_compact_frames(&mesh, &options, &mut memory.context)?;
            write(&frames, &out);
            Ok::<_, darboux::Error>(frames.report())
        })?;
        if let Some(report) = report {
            report.put(report_of_run.into());
        }
        Ok(())
    })
}

/// Frames per block of [`write`].
const BLOCK: usize = 64;

/// Converts the frames block by block.
fn write(frames: &CompactFrames<'_>, out: &Output<darboux_frame>) {
    let mut block = [Frame::default(); BLOCK];
    for first in (0..frames.len()).step_by(BLOCK) {
        let block = &mut block[..(frames.len() - first).min(BLOCK)];
        frames.read(first, block);
        (first..).zip(&*block).for_each(|(at, &frame)| out.set(at, frame.into()));
    }
}

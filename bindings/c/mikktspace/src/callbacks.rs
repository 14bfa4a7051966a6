//! The structs of `include/mikktspace.h`, and safe calls of their callbacks.
//!
//! The callbacks are `extern "C-unwind"`, so that C++ exceptions can pass through them.

use std::ffi::{c_int, c_void};

use darboux::Frame;

type GetCount = unsafe extern "C-unwind" fn(*const Context) -> c_int;
type GetFaceSize = unsafe extern "C-unwind" fn(*const Context, c_int) -> c_int;
type GetFloats = unsafe extern "C-unwind" fn(*const Context, *mut f32, c_int, c_int);
type SetTangent = unsafe extern "C-unwind" fn(*const Context, *const f32, f32, c_int, c_int);
type SetFrame =
    unsafe extern "C-unwind" fn(*const Context, *const f32, *const f32, f32, f32, c_int, c_int, c_int);

/// `SMikkTSpaceInterface`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Interface {
    get_num_faces: Option<GetCount>,
    get_num_vertices_of_face: Option<GetFaceSize>,
    get_position: Option<GetFloats>,
    get_normal: Option<GetFloats>,
    get_tex_coord: Option<GetFloats>,
    set_tspace_basic: Option<SetTangent>,
    set_tspace: Option<SetFrame>,
}

/// `SMikkTSpaceContext`.
#[repr(C)]
pub struct Context {
    interface: *mut Interface,
    user_data: *mut c_void,
}

/// The callbacks and the context that is passed to them. The callbacks that read the mesh are present.
pub(crate) struct Caller {
    context: *const Context,
    get_num_faces: GetCount,
    get_num_vertices_of_face: GetFaceSize,
    get_position: GetFloats,
    get_normal: GetFloats,
    get_tex_coord: GetFloats,
    set_tspace_basic: Option<SetTangent>,
    set_tspace: Option<SetFrame>,
}

impl Caller {
    /// `None` where `context`, its interface or a callback that reads the mesh is null.
    ///
    /// # Safety
    ///
    /// `context` and its interface are as the header documents, and stay valid until the caller is dropped.
    pub unsafe fn new(context: *const Context) -> Option<Self> {
        // SAFETY: the caller's promise.
        let interface = unsafe { context.as_ref()?.interface.as_ref()? };
        Some(Self {
            context,
            get_num_faces: interface.get_num_faces?,
            get_num_vertices_of_face: interface.get_num_vertices_of_face?,
            get_position: interface.get_position?,
            get_normal: interface.get_normal?,
            get_tex_coord: interface.get_tex_coord?,
            set_tspace_basic: interface.set_tspace_basic,
            set_tspace: interface.set_tspace,
        })
    }

    /// True when whole frames are requested, and not only tangents and signs.
    pub fn wants_frames(&self) -> bool {
        self.set_tspace.is_some()
    }

    pub fn face_count(&self) -> c_int {
        // SAFETY: the promise of `new`.
        unsafe { (self.get_num_faces)(self.context) }
    }

    pub fn face_size(&self, face: c_int) -> c_int {
        // SAFETY: the promise of `new`.
        unsafe { (self.get_num_vertices_of_face)(self.context, face) }
    }

    /// Reads the position, the normal and the UV of a corner into `out`.
    pub fn read_vertex(&self, face: c_int, corner: c_int, out: &mut [f32; 8]) {
        let position = out.as_mut_ptr();
        // SAFETY: the promise of `new`; `out` has space for all that the callbacks write.
        unsafe {
            (self.get_position)(self.context, position, face, corner);
            (self.get_normal)(self.context, position.add(3), face, corner);
            (self.get_tex_coord)(self.context, position.add(6), face, corner);
        }
    }

    /// The position of corner 0 of face 0, with zeros as normal and UV.
    pub fn first_vertex(&self) -> [f32; 8] {
        let mut out = [0.0; 8];
        // SAFETY: the promise of `new`; `out` has space for what the callback writes.
        unsafe { (self.get_position)(self.context, out.as_mut_ptr(), 0, 0) };
        out
    }

    /// Passes a frame to `m_setTSpace`, then its tangent and sign to `m_setTSpaceBasic`.
    pub fn write(&self, face: c_int, corner: c_int, frame: &Frame) {
        if let Some(set) = self.set_tspace {
            let Frame { tangent, bitangent, magnitude: [s, t], sign } = frame;
            let preserves = c_int::from(*sign > 0.0);
            // SAFETY: the promise of `new`; the arrays outlive the call.
            unsafe {
                set(self.context, tangent.as_ptr(), bitangent.as_ptr(), *s, *t, preserves, face, corner)
            };
        }
        self.write_tangent(face, corner, &frame.tangent_and_sign());
    }

    /// Passes a tangent and its sign to `m_setTSpaceBasic`.
    pub fn write_tangent(&self, face: c_int, corner: c_int, tangent: &[f32; 4]) {
        if let Some(set) = self.set_tspace_basic {
            // SAFETY: the promise of `new`; the array outlives the call.
            unsafe { set(self.context, tangent.as_ptr(), tangent[3], face, corner) };
        }
    }
}

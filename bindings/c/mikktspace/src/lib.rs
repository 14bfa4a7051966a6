//! The functions of `include/mikktspace.h`: the results of mikktspace.c bit for bit, through the same
//! callbacks.
//!
//! A call reads the mesh, computes, and writes. Only reading and writing call back; they cannot panic, and a
//! C++ exception that passes through them frees the arrays. Only the computation can panic; the panic is
//! caught and becomes a result of 0.

#![allow(unsafe_code, reason = "C passes pointers")]
#![allow(non_snake_case, reason = "functions are called as C calls them")]
#![allow(clippy::missing_safety_doc, reason = "the contract stands in the header")]
#![deny(clippy::undocumented_unsafe_blocks)]

mod callbacks;
mod corners;

use std::ffi::c_int;
use std::panic::{AssertUnwindSafe, catch_unwind};

use darboux::{MikkTSpaceOptions, Mode, TangentOptions, generate_compact_frames, generate_tangents};

use callbacks::{Caller, Context};
use corners::Corners;

/// As documented in the header.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn genTangSpaceDefault(context: *const Context) -> c_int {
    // SAFETY: the caller's promise, as documented in the header.
    unsafe { genTangSpace(context, 180.0) }
}

/// As documented in the header.
#[unsafe(no_mangle)]
pub unsafe extern "C-unwind" fn genTangSpace(context: *const Context, threshold: f32) -> c_int {
    // SAFETY: the caller's promise, as documented in the header.
    let caller = unsafe { Caller::new(context) };
    c_int::from(caller.is_some_and(|caller| run(&caller, threshold).is_some()))
}

/// `None` where no face has 3 or 4 corners, memory runs out, or there are too many corners.
fn run(caller: &Caller, threshold: f32) -> Option<()> {
    let corners = Corners::read(caller)?;
    let options =
        TangentOptions::from(MikkTSpaceOptions::new().with_mode(Mode::Reference).with_threshold(threshold));
    let mesh = corners.mesh()?;
    if caller.wants_frames() {
        let mut memory = darboux::Context::new();
        let frames = contained(|| generate_compact_frames(&mesh, &options, &mut memory).ok())?;
        let read = |first, out: &mut [_]| {
            contained(|| {
                frames.read(first, out);
                Some(())
            })
        };
        corners.hand_out(read, |face, corner, frame| caller.write(face, corner, frame))
    } else {
        let tangents = contained(|| Some(generate_tangents(&mesh, &options).corners.into_per_corner()))?;
        let write = |face, corner, tangent: &_| caller.write_tangent(face, corner, tangent);
        let read = |first, out: &mut [_]| {
            out.copy_from_slice(tangents.get(first..first + out.len())?);
            Some(())
        };
        corners.hand_out(read, write)
    }
}

/// `None` where `compute` panics or returns `None`.
fn contained<R>(compute: impl FnOnce() -> Option<R>) -> Option<R> {
    catch_unwind(AssertUnwindSafe(compute)).ok()?
}

//! Invalid input returns an error with a message, writes nothing, and does not crash.

use std::ffi::CStr;
use std::ptr::{dangling, null, null_mut};

use darboux_c::*;
use darboux_tests::{Dice, OwnedMesh, families};

use crate::agreement::{default_options, empty_mesh, packed};

fn message() -> String {
    // SAFETY: the message is a valid string until the next error.
    unsafe { CStr::from_ptr(darboux_last_error()) }.to_string_lossy().into_owned()
}

/// Passes an invalid mesh to every function that takes a mesh. All must return the same status and write
/// nothing.
#[track_caller]
fn refused(mesh: &darboux_mesh, status: darboux_status, part: &str) {
    const FILL: u32 = 0x7fc0_1234;
    let corners = if mesh.index_count > 0 { mesh.index_count } else { mesh.vertex_count };
    let mut out = [f32::from_bits(FILL); 64];
    let to = out.as_mut_ptr();
    let (mut plan, mut split) = (null_mut(), null_mut());
    let found = [
        // SAFETY: every call rejects the mesh, so the output is not accessed.
        unsafe { darboux_generate_tangents(mesh, null(), null(), to, corners, 0, null_mut()) },
        // SAFETY: as above.
        unsafe { darboux_generate_frames(mesh, null(), null(), to.cast(), corners, 0, null_mut()) },
        // SAFETY: as above.
        unsafe { darboux_split_vertices(mesh, to, corners, 0, null(), &mut split) },
        // SAFETY: as above.
        unsafe { darboux_plan_create(mesh, null(), null(), &mut plan) },
    ];
    assert_eq!(found, [status; 4], "{}", message());
    assert!(message().contains(part), "{}", message());
    assert!(split.is_null() && plan.is_null());
    assert!(out.iter().all(|float| float.to_bits() == FILL));
}

fn grid() -> OwnedMesh {
    families::grid(3, 3, false, false)
}

#[test]
fn broken_meshes_are_refused() {
    use darboux_status::{
        Alignment, Faces, Index, Length, NullPointer, Stride, StructSize, TooLarge, UnknownValue,
    };
    let mesh = grid();
    let good = packed(&mesh);
    let count = good.index_count;
    refused(&darboux_mesh { positions: null(), ..good }, NullPointer, "positions is null");
    refused(&darboux_mesh { normals: null(), ..good }, NullPointer, "normals is null");
    refused(&darboux_mesh { uvs: null(), ..good }, NullPointer, "uvs is null");
    refused(&darboux_mesh { indices_u32: null(), ..good }, NullPointer, "no indices");
    refused(&darboux_mesh { size: 8, ..good }, StructSize, "set it to sizeof(darboux_mesh)");
    refused(&darboux_mesh { position_stride: 11, ..good }, Stride, "stride of positions is 11 bytes");
    refused(&darboux_mesh { normal_stride: 1, ..good }, Stride, "stride of normals is 1 bytes");
    refused(&darboux_mesh { uv_stride: 7, ..good }, Stride, "stride of uvs is 7 bytes");
    refused(&darboux_mesh { faces: 3, ..good }, UnknownValue, "3 is not a value of darboux_faces");
    refused(&darboux_mesh { indices_u16: dangling(), ..good }, UnknownValue, "both set");
    let odd = good.indices_u32.cast::<u8>().wrapping_add(1).cast();
    refused(&darboux_mesh { indices_u32: odd, ..good }, Alignment, "multiple of 4");
    refused(&darboux_mesh { index_count: count - 1, ..good }, Faces, "whole faces of 3");
    refused(&darboux_mesh { faces: 2, ..good }, Faces, "add up to 0");
    refused(&darboux_mesh { faces: 2, face_count: 1, ..good }, NullPointer, "face_sizes is null");
    refused(&darboux_mesh { vertex_count: 15, ..good }, Index, "there are 15 vertices");
    for huge in [usize::MAX, usize::MAX / 2, usize::MAX / 12, (1 << 31) + 1] {
        refused(&darboux_mesh { vertex_count: huge, ..good }, TooLarge, "vertices are too many");
    }
    for huge in [usize::MAX, usize::MAX / 2, usize::MAX / 12] {
        refused(&darboux_mesh { position_stride: huge, ..good }, TooLarge, "more than memory can hold");
        refused(&darboux_mesh { uv_stride: huge, ..good }, TooLarge, "more than memory can hold");
    }
    for huge in [usize::MAX, usize::MAX / 2, usize::MAX / 4] {
        refused(&darboux_mesh { index_count: huge, ..good }, TooLarge, "indices_u32");
        refused(
            &darboux_mesh { faces: 2, face_sizes: good.indices_u32, face_count: huge, ..good },
            TooLarge,
            "face_sizes",
        );
    }
    // SAFETY: null pointers are rejected.
    let of_null = unsafe { darboux_generate_tangents(null(), null(), null(), null_mut(), 0, 0, null_mut()) };
    assert_eq!((of_null, message()), (NullPointer, "darboux_mesh is null".into()));
    // SAFETY: a count other than the mesh's is rejected.
    let few =
        unsafe { darboux_generate_tangents(&good, null(), null(), [0.0; 4].as_mut_ptr(), 1, 0, null_mut()) };
    assert_eq!(few, Length);
    // SAFETY: a null output is rejected.
    let none = unsafe { darboux_generate_tangents(&good, null(), null(), null_mut(), count, 0, null_mut()) };
    assert_eq!((none, message()), (NullPointer, "tangents is null".into()));
}

#[test]
fn handles_and_results_may_be_null() {
    let mesh = grid();
    let view = packed(&mesh);
    let mut float = 0.0;
    let found = [
        // SAFETY: null pointers are rejected.
        unsafe { darboux_split_vertices(&view, &float, 1, 0, null(), null_mut()) },
        // SAFETY: as above.
        unsafe { darboux_plan_create(&view, null(), null(), null_mut()) },
        // SAFETY: as above.
        unsafe { darboux_context_create(1, null_mut()) },
        // SAFETY: as above.
        unsafe { darboux_plan_base(null(), &mut float, 1, 0, null_mut()) },
        // SAFETY: as above.
        unsafe { darboux_measure_tangents(0, null(), 0, null(), 0, null(), null_mut()) },
        // SAFETY: as above.
        unsafe { darboux_encode_tangents(0, 1, null(), 0, null(), 0, null_mut(), 0) },
        // SAFETY: as above.
        unsafe { darboux_decode_frames(1, null(), 0, null_mut(), 0, null_mut(), 0) },
        // SAFETY: as above.
        unsafe { darboux_set_allocator(None, None, null_mut()) },
    ];
    assert_eq!(found, [darboux_status::NullPointer; 8]);
    // SAFETY: freeing a null pointer does nothing.
    unsafe {
        darboux_plan_free(null_mut());
        darboux_context_free(null_mut());
        darboux_vertex_split_free(null_mut());
        darboux_normal_split_free(null_mut());
    }
}

/// Structs of other versions: smaller ones are rejected; larger ones are accepted where their additional
/// bytes are zero.
#[test]
fn struct_sizes() {
    #[repr(C)]
    struct LaterVersion<T> {
        known: T,
        new: usize,
    }
    let mesh = grid();
    let view = packed(&mesh);
    let count = view.index_count;
    let mut out = vec![[0.0f32; 4]; count];
    let mut run = |options: *const darboux_tangent_options, report: *mut darboux_report| {
        // SAFETY: all pointers refer to structs of the given sizes.
        unsafe {
            darboux_generate_tangents(&view, options, null(), out.as_mut_ptr().cast(), count, 0, report)
        }
    };
    let size = size_of::<LaterVersion<darboux_tangent_options>>();
    let mut later = LaterVersion { known: darboux_tangent_options { size, ..default_options() }, new: 0 };
    assert_eq!(run((&raw const later).cast(), null_mut()), darboux_status::Ok);
    later.new = 1;
    assert_eq!(run((&raw const later).cast(), null_mut()), darboux_status::StructSize);
    assert!(message().contains("does not know"), "{}", message());
    for size in [1, 8, size_of::<darboux_tangent_options>() - 1] {
        assert_eq!(
            run(&darboux_tangent_options { size, ..default_options() }, null_mut()),
            darboux_status::StructSize
        );
    }
    // SAFETY: all fields are numbers or raw pointers, for which zeros are valid.
    let mut report: LaterVersion<darboux_report> = unsafe { std::mem::zeroed() };
    (report.known.size, report.new) = (size_of::<LaterVersion<darboux_report>>(), 77);
    assert_eq!(run(null(), (&raw mut report).cast()), darboux_status::Ok);
    assert_eq!((report.known.triangles, report.new), (count / 3, 77));
    assert_eq!(report.known.size, size_of::<LaterVersion<darboux_report>>());
}

/// A random mesh struct over one buffer. `None` where an array would exceed the buffer, which the library
/// cannot detect.
fn random_mesh(dice: &mut Dice<'_>, buffer: &[u32]) -> Option<darboux_mesh> {
    let counts = [0, 1, 3, 4, 5, 12, usize::MAX, usize::MAX / 2, usize::MAX / 3, 1 << 62, (1 << 31) + 1];
    let strides = [0, 1, 7, 8, 11, 12, 13, 16, 48, usize::MAX, usize::MAX / 2, usize::MAX - 11, 1 << 61];
    let (room, mut claims_too_much) = (size_of_val(buffer), false);
    let mut pointer = |dice: &mut Dice<'_>, count: usize, stride: usize, element: usize| {
        let (is_null, shift) = (dice.one_in(8), dice.pick(&[0, 0, 0, 1, 2, 4]));
        let stride = if stride == 0 { element } else { stride };
        let last =
            count.saturating_sub(1).checked_mul(stride).and_then(|start| start.checked_add(element + shift));
        let start = buffer.as_ptr().cast::<u8>().addr();
        let is_possible =
            last.is_some_and(|len| isize::try_from(len).is_ok() && start.checked_add(len).is_some());
        claims_too_much |= stride >= element && count > 0 && is_possible && last > Some(room);
        if is_null { null() } else { buffer.as_ptr().cast::<u8>().wrapping_add(shift) }
    };
    let vertex_count = dice.pick(&counts);
    let index_count = dice.pick(&counts);
    let face_count = dice.pick(&counts);
    let [position_stride, normal_stride, uv_stride] = [(); 3].map(|()| dice.pick(&strides));
    let mesh = darboux_mesh {
        size: dice.pick(&[size_of::<darboux_mesh>(), size_of::<darboux_mesh>(), 0, 1, 16]),
        vertex_count,
        positions: pointer(dice, vertex_count, position_stride, 12).cast(),
        position_stride,
        normals: pointer(dice, vertex_count, normal_stride, 12).cast(),
        normal_stride,
        uvs: pointer(dice, vertex_count, uv_stride, 8).cast(),
        uv_stride,
        indices_u32: if dice.one_in(2) { pointer(dice, index_count, 4, 4).cast() } else { null() },
        indices_u16: if dice.one_in(3) { pointer(dice, index_count, 2, 2).cast() } else { null() },
        index_count,
        faces: dice.below(4) as u32,
        face_sizes: pointer(dice, face_count, 4, 4).cast(),
        face_count,
    };
    (!claims_too_much).then_some(mesh)
}

#[test]
fn random_structs_do_no_harm() {
    let mut dice = Dice::from_seed(11);
    // Small integers: often in range as indices, and subnormal as floats.
    let buffer: Vec<u32> = (0..4096).map(|_| dice.below(6) as u32).collect();
    let mut counts = [0usize; 2];
    for _ in 0..300_000 {
        let Some(mesh) = random_mesh(&mut dice, &buffer) else { continue };
        let corners = if mesh.indices_u32.is_null() && mesh.indices_u16.is_null() {
            mesh.vertex_count
        } else {
            mesh.index_count
        };
        let count = if dice.one_in(8) { dice.below(13) } else { corners };
        let mut out = [0.0f32; 64];
        let options = darboux_tangent_options {
            // Other methods reject most modes and thresholds.
            method: if dice.one_in(3) { dice.below(9) as u32 } else { 0 },
            mode: dice.below(4) as u32,
            threshold: dice.any_float(),
            ..default_options()
        };
        // SAFETY: a mesh that is accepted lies in the buffer, and has at most 12 corners.
        let status = unsafe {
            darboux_generate_tangents(&mesh, &options, null(), out.as_mut_ptr(), count, 0, null_mut())
        };
        assert_ne!(status, darboux_status::Internal);
        assert!(status == darboux_status::Ok || !message().is_empty());
        counts[usize::from(status == darboux_status::Ok)] += 1;
    }
    assert!(counts[0] > 10_000 && counts[1] > 100, "{counts:?}");
}

#[test]
fn empty_meshes_are_fine() {
    let mesh = empty_mesh();
    // SAFETY: all counts are zero, so nothing is read or written.
    let found = unsafe { darboux_generate_tangents(&mesh, null(), null(), null_mut(), 0, 0, null_mut()) };
    assert_eq!(found, darboux_status::Ok);
    let mut split = null_mut();
    // SAFETY: as above.
    let found = unsafe { darboux_split_vertices(&mesh, null(), 0, 0, null(), &mut split) };
    assert_eq!(found, darboux_status::Ok);
    // SAFETY: the object was created above, and is no longer used.
    unsafe { darboux_vertex_split_free(split) };
}

//! Fuzz target: arbitrary bytes select a function of the C interface and its arguments. The call must return
//! a status without a crash, must read and write only the memory that its arguments describe, and must write
//! nothing after an error.

#![no_main]

use std::ptr::{dangling_mut, null, null_mut};

use darboux_c::*;
use darboux_tests::Dice;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut caller = Caller { dice: Dice::from_bytes(bytes), blocks: Vec::new(), claims_too_much: false };
    let call = CALLS[caller.dice.below(CALLS.len())];
    // Every array has the size that the arguments describe, or `check` skips the call.
    call(&mut caller);
});

/// Every function except darboux_set_allocator, after which AddressSanitizer could not check the library's
/// memory.
const CALLS: &[fn(&mut Caller<'_>)] = &[
    tangents,
    tangents,
    frames,
    splits,
    normals,
    normal_splits,
    plans,
    differences,
    fidelities,
    tangent_codes,
    normal_codes,
    frame_codes,
    vectors,
    faces,
    programs,
    matrices,
    skins,
    contexts,
];

/// The largest array that is allocated, in bytes.
const ROOM: usize = 1 << 14;
const FILL: u8 = 0xa5;

struct Caller<'a> {
    dice: Dice<'a>,
    blocks: Vec<Box<[u8]>>,
    /// True when an array would exceed [`ROOM`]. Such a call is skipped, because the library cannot check
    /// the true size of memory.
    claims_too_much: bool,
}

/// A caller's strided array.
#[derive(Clone, Copy)]
struct Array<T> {
    data: *mut T,
    count: usize,
    stride: usize,
}

impl<'a> Caller<'a> {
    fn count(&mut self) -> usize {
        self.dice.pick(&[0, 1, 3, 3, 4, 6, 6, 12, 12, 24, 1 << 31, 1 << 62, usize::MAX / 2, usize::MAX])
    }

    /// Allocates exactly the bytes of `count` elements of `element` bytes, `stride` apart. Sometimes returns
    /// null or an odd address.
    fn block(&mut self, count: usize, stride: usize, element: usize) -> *mut u8 {
        if self.dice.one_in(24) {
            return null_mut();
        }
        let stride = if stride == 0 { element } else { stride };
        let shift = self.dice.pick(&[0, 0, 0, 0, 1, 4]);
        let len = count.saturating_sub(1).checked_mul(stride).and_then(|start| start.checked_add(element));
        match len {
            _ if count == 0 || stride < element => dangling_mut(),
            None => dangling_mut(),
            Some(len) if isize::try_from(len).is_err() => dangling_mut(),
            Some(len) if len > ROOM => {
                self.claims_too_much = true;
                dangling_mut()
            }
            Some(len) => {
                self.blocks.push(vec![FILL; len + shift].into());
                let block = self.blocks.last_mut().expect("just pushed");
                block[shift..].as_mut_ptr()
            }
        }
    }

    /// As [`Caller::block`], filled with values: floats of every kind, or small integers.
    fn values<T>(&mut self, count: usize, stride: usize, element: usize, are_floats: bool) -> *mut T {
        let data = self.block(count, stride, element);
        let filled = self.blocks.last_mut().filter(|block| block.as_ptr_range().contains(&data.cast_const()));
        if let Some(block) = filled {
            let shift = data.addr() - block.as_ptr().addr();
            for word in block[shift..].chunks_mut(if are_floats { 4 } else { size_of::<T>() }) {
                let small = self.dice.below(7) as u32;
                let bits = if are_floats { self.dice.any_float().to_bits() } else { small };
                word.copy_from_slice(&bits.to_ne_bytes()[..word.len()]);
            }
        }
        data.cast()
    }

    fn stride(&mut self, element: usize) -> usize {
        let odd = [1, element - 1, usize::MAX, usize::MAX / 2, 1 << 61];
        if self.dice.one_in(16) {
            self.dice.pick(&odd)
        } else {
            self.dice.pick(&[0, 0, element, element.saturating_add(1), element.saturating_add(8)])
        }
    }

    /// An input array: `count` elements of `width` floats.
    fn floats(&mut self, count: usize, width: usize) -> Array<f32> {
        let stride = self.stride(4 * width);
        Array { data: self.values(count, stride, 4 * width, true), count, stride }
    }

    /// An output array: `count` elements of `element` bytes.
    fn out<T>(&mut self, count: usize, element: usize) -> Array<T> {
        let stride = self.stride(element);
        Array { data: self.block(count, stride, element).cast(), count, stride }
    }

    /// The value of a struct's size field, at most the true size.
    fn size<T>(&mut self) -> usize {
        if self.dice.one_in(16) {
            self.dice.below(size_of::<T>())
        } else {
            self.dice.pick(&[0, size_of::<T>()])
        }
    }

    /// A value of an enumeration, most often the default.
    fn code(&mut self, end: usize) -> u32 {
        if self.dice.one_in(2) { 0 } else { self.dice.below(end + 1) as u32 }
    }

    /// A mesh, and its number of corners as the library counts them.
    fn mesh(&mut self) -> (darboux_mesh, usize) {
        let vertex_count = self.count();
        let (positions, normals) = (self.floats(vertex_count, 3), self.floats(vertex_count, 3));
        let uvs = self.floats(vertex_count, 2);
        let index_count = if self.dice.one_in(4) { 0 } else { self.count() };
        let (mut indices_u32, mut indices_u16) = (null(), null());
        if index_count > 0 && self.dice.one_in(2) {
            indices_u32 = self.values::<u32>(index_count, 0, 4, false).cast_const();
        }
        if index_count > 0 && (indices_u32.is_null() || self.dice.one_in(16)) {
            indices_u16 = self.values::<u16>(index_count, 0, 2, false).cast_const();
        }
        let faces = self.code(3);
        let face_count = if faces == 2 { self.dice.pick(&[0, 1, 2, 3, 4, usize::MAX]) } else { 0 };
        let mesh = darboux_mesh {
            size: self.size::<darboux_mesh>(),
            vertex_count,
            positions: positions.data,
            position_stride: positions.stride,
            normals: normals.data,
            normal_stride: normals.stride,
            uvs: uvs.data,
            uv_stride: uvs.stride,
            indices_u32,
            indices_u16,
            index_count,
            faces,
            face_sizes: self.values::<u32>(face_count, 0, 4, false),
            face_count,
        };
        let is_indexed = !(indices_u32.is_null() && indices_u16.is_null());
        (mesh, if is_indexed { index_count } else { vertex_count })
    }

    /// The number of elements for a mesh of so many corners; sometimes another number.
    fn matching(&mut self, corners: usize) -> usize {
        if self.dice.one_in(16) { self.count() } else { corners }
    }

    fn options(&mut self) -> darboux_tangent_options {
        darboux_tangent_options {
            size: self.size::<darboux_tangent_options>(),
            method: self.code(8),
            mode: self.code(3),
            threshold: if self.dice.one_in(4) { self.dice.any_float() } else { 0.0 },
            reserved: u32::from(self.dice.one_in(16)),
        }
    }

    fn convention(&mut self) -> darboux_convention {
        darboux_convention {
            size: self.size::<darboux_convention>(),
            right: self.code(7),
            up: self.code(7),
            front: self.code(7),
            winding: self.code(2),
            uv_origin: self.code(2),
            tangent: self.code(2),
            bitangent: self.code(2),
            sign: self.code(2),
        }
    }

    /// Makes the call unless an array exceeds [`ROOM`], and checks its result. `out`: the output array.
    fn check<T>(&self, out: Array<T>, call: impl FnOnce() -> darboux_status) {
        if self.claims_too_much {
            return;
        }
        let status = call();
        assert_ne!(status, darboux_status::Internal);
        if status == darboux_status::Ok {
            return;
        }
        // SAFETY: the message is a valid string until the next error.
        assert!(!unsafe { std::ffi::CStr::from_ptr(darboux_last_error()) }.is_empty());
        let written =
            self.blocks.iter().find(|block| block.as_ptr_range().contains(&out.data.cast_const().cast()));
        assert!(
            written.is_none_or(|block| block.iter().all(|&byte| byte == FILL)),
            "written after {status:?}"
        );
    }
}

fn tangents(caller: &mut Caller<'_>) {
    let (mesh, corners) = caller.mesh();
    let options = caller.options();
    let count = caller.matching(corners);
    let out = caller.out::<f32>(count, 16);
    let mut report = darboux_report { size: caller.size::<darboux_report>(), ..zeroed() };
    // SAFETY: all memory is as large as the arguments describe, or `check` skips the call.
    caller.check(out, || unsafe {
        darboux_generate_tangents(&mesh, &options, null(), out.data, out.count, out.stride, &mut report)
    });
}

fn frames(caller: &mut Caller<'_>) {
    let (mesh, corners) = caller.mesh();
    let options = caller.options();
    let count = caller.matching(corners);
    let out = caller.out::<darboux_frame>(count, size_of::<darboux_frame>());
    // SAFETY: as above.
    caller.check(out, || unsafe {
        darboux_generate_frames(&mesh, &options, null(), out.data, out.count, out.stride, null_mut())
    });
}

fn splits(caller: &mut Caller<'_>) {
    let (mesh, corners) = caller.mesh();
    let count = caller.matching(corners);
    let tangents = caller.floats(count, 4);
    let mut split = null_mut();
    // SAFETY: as above; the result's arrays have the lengths that it gives, until it is freed.
    caller.check(NOTHING, || unsafe {
        let status = darboux_split_vertices(&mesh, tangents.data, count, tangents.stride, null(), &mut split);
        if let Some(made) = split.as_ref() {
            let sources = std::slice::from_raw_parts(made.source_of_vertex, made.vertex_count);
            assert!(sources.iter().all(|&source| (source as usize) < mesh.vertex_count));
            let indices = std::slice::from_raw_parts(made.indices, made.index_count);
            assert!(indices.iter().all(|&index| (index as usize) < made.vertex_count));
        }
        darboux_vertex_split_free(split);
        status
    });
}

fn normals(caller: &mut Caller<'_>) {
    let (mesh, corners) = caller.mesh();
    let options = darboux_normal_options {
        size: caller.size::<darboux_normal_options>(),
        shading: caller.code(2),
        weight: caller.code(3),
        crease: caller.dice.any_float(),
        seams: caller.code(2),
    };
    let count = caller.matching(corners);
    let out = caller.out::<f32>(count, 12);
    // SAFETY: as above.
    caller.check(out, || unsafe {
        darboux_generate_normals(&mesh, &options, null(), out.data, out.count, out.stride, null_mut())
    });
}

fn normal_splits(caller: &mut Caller<'_>) {
    let (mesh, corners) = caller.mesh();
    let count = caller.matching(corners);
    let normals = caller.floats(count, 3);
    let mut split = null_mut();
    // SAFETY: as above.
    caller.check(NOTHING, || unsafe {
        let status = darboux_split_normals(&mesh, normals.data, count, normals.stride, null(), &mut split);
        darboux_normal_split_free(split);
        status
    });
}

/// Creates a plan, and evaluates it for the same mesh or for another.
fn plans(caller: &mut Caller<'_>) {
    let (mesh, corners) = caller.mesh();
    let options = caller.options();
    let (moved, moved_corners) = if caller.dice.one_in(4) { caller.mesh() } else { (mesh, corners) };
    let (count, moved_count) = (caller.matching(corners), caller.matching(moved_corners));
    let (base, out) = (caller.out::<f32>(count, 16), caller.out::<f32>(moved_count, 16));
    let (mut plan, mut regrouped) = (null_mut(), 0);
    // SAFETY: as above; the plan is freed last.
    unsafe {
        caller.check(NOTHING, || darboux_plan_create(&mesh, &options, null(), &mut plan));
        caller.check(base, || darboux_plan_base(plan, base.data, base.count, base.stride, null_mut()));
        caller.check(out, || darboux_plan_evaluate(plan, &moved, null(), out.data, out.count, out.stride));
        caller.check(NOTHING, || darboux_plan_count_regrouped(plan, &moved, null(), &mut regrouped));
        darboux_plan_free(plan);
    }
}

fn differences(caller: &mut Caller<'_>) {
    let count = caller.count();
    let (a, b) = (caller.floats(count, 4), caller.floats(count, 4));
    let size = caller.size::<darboux_tangent_difference>();
    let mut difference = darboux_tangent_difference { size, ..zeroed() };
    // SAFETY: as above.
    caller.check(NOTHING, || unsafe {
        darboux_measure_tangents(count, a.data, a.stride, b.data, b.stride, null(), &mut difference)
    });
}

fn fidelities(caller: &mut Caller<'_>) {
    let (mesh, corners) = caller.mesh();
    let count = caller.matching(corners);
    let tangents = caller.floats(count, 4);
    let mut fidelity = darboux_uv_fidelity { size: caller.size::<darboux_uv_fidelity>(), ..zeroed() };
    // SAFETY: as above.
    caller.check(NOTHING, || unsafe {
        darboux_measure_uv_fidelity(&mesh, tangents.data, count, tangents.stride, null(), &mut fidelity)
    });
}

fn tangent_codes(caller: &mut Caller<'_>) {
    let count = caller.count();
    let encoding = caller.code(5);
    let size = [4, 4, 8, 4, 2].get(encoding as usize).copied().unwrap_or(8);
    let (normals, tangents) = (caller.floats(count, 3), caller.floats(count, 4));
    let (codes, back) = (caller.out::<u8>(count, size), caller.out::<f32>(count, 16));
    let (n, t) = ((normals.data, normals.stride), (tangents.data, tangents.stride));
    // SAFETY: as above.
    unsafe {
        let to = codes.data.cast();
        caller
            .check(codes, || darboux_encode_tangents(encoding, count, n.0, n.1, t.0, t.1, to, codes.stride));
        let stride = codes.stride;
        caller.check(back, || {
            darboux_decode_tangents(encoding, count, n.0, n.1, to, stride, back.data, back.stride)
        });
    }
}

fn normal_codes(caller: &mut Caller<'_>) {
    let count = caller.count();
    let normals = caller.floats(count, 3);
    let (codes, back) = (caller.out::<i16>(count, 4), caller.out::<f32>(count, 12));
    let stride = codes.stride;
    // SAFETY: as above.
    unsafe {
        caller
            .check(codes, || darboux_encode_normals(count, normals.data, normals.stride, codes.data, stride));
        caller.check(back, || darboux_decode_normals(count, codes.data, stride, back.data, back.stride));
    }
}

fn frame_codes(caller: &mut Caller<'_>) {
    let count = caller.count();
    let (normals, tangents) = (caller.floats(count, 3), caller.floats(count, 4));
    let codes = caller.out::<i16>(count, 8);
    let (n, t) = (caller.out::<f32>(count, 12), caller.out::<f32>(count, 16));
    let (from, stride) = (codes.data, codes.stride);
    // SAFETY: as above.
    unsafe {
        caller.check(codes, || {
            darboux_encode_frames(
                count,
                normals.data,
                normals.stride,
                tangents.data,
                tangents.stride,
                from,
                stride,
            )
        });
        caller.check(n, || darboux_decode_frames(count, from, stride, n.data, n.stride, t.data, t.stride));
    }
}

fn vectors(caller: &mut Caller<'_>) {
    let (from, to) = (caller.convention(), caller.convention());
    let count = caller.count();
    let convert = caller.dice.pick(&[
        (darboux_convert_vectors as unsafe extern "C" fn(_, _, _, _, _, _, _) -> _, 3),
        (darboux_convert_tangents, 4),
        (darboux_convert_uvs, 2),
    ]);
    let (values, out) = (caller.floats(count, convert.1), caller.out::<f32>(count, 4 * convert.1));
    // SAFETY: as above.
    caller.check(out, || unsafe {
        convert.0(&from, &to, count, values.data.cast_const(), values.stride, out.data, out.stride)
    });
}

fn faces(caller: &mut Caller<'_>) {
    let (from, to) = (caller.convention(), caller.convention());
    let (faces, face_count) = (caller.code(3), caller.dice.pick(&[0, 1, 2, 3, usize::MAX]));
    let sizes = caller.values::<u32>(face_count, 0, 4, false);
    let (count, size) = (caller.count(), caller.dice.pick(&[2, 4, 16, 0, usize::MAX, 1 << 60]));
    let corners = Array::<u8> { data: caller.block(count, size, size), count, stride: size };
    let data = corners.data.cast();
    // SAFETY: as above.
    caller.check(corners, || unsafe {
        darboux_convert_faces(&from, &to, faces, sizes, face_count, data, corners.count, corners.stride)
    });
}

fn programs(caller: &mut Caller<'_>) {
    let convention = caller.convention();
    let program = caller.code(10);
    let (mut out, mut red, mut green) = (convention, 0, 0);
    // SAFETY: as above.
    unsafe {
        caller.check(NOTHING, || darboux_convention_of(program, &mut out));
        caller.check(NOTHING, || darboux_convention_generated(&convention, &mut out));
        caller.check(NOTHING, || darboux_convert_channels(&convention, &out, &mut red, &mut green));
    }
}

/// Input and output arrays of normals and tangents.
fn frame_arrays(caller: &mut Caller<'_>, count: usize) -> (darboux_frame_arrays, Array<f32>) {
    let (normals, tangents) = (caller.floats(count, 3), caller.floats(count, 4));
    let (out_normals, out_tangents) = (caller.out::<f32>(count, 12), caller.out::<f32>(count, 16));
    let arrays = darboux_frame_arrays {
        size: caller.size::<darboux_frame_arrays>(),
        count,
        normals: normals.data,
        normal_stride: normals.stride,
        tangents: tangents.data,
        tangent_stride: tangents.stride,
        out_normals: out_normals.data,
        out_normal_stride: out_normals.stride,
        out_tangents: out_tangents.data,
        out_tangent_stride: out_tangents.stride,
    };
    (arrays, out_normals)
}

fn matrices(caller: &mut Caller<'_>) {
    let count = caller.count();
    let (arrays, out) = frame_arrays(caller, count);
    let matrix = caller.floats(3, 3);
    let mut orientation = 0.0;
    // SAFETY: as above.
    caller.check(out, || unsafe {
        darboux_transform_frames(matrix.data, matrix.stride, &arrays, &mut orientation)
    });
}

fn skins(caller: &mut Caller<'_>) {
    let count = caller.count();
    let (arrays, out) = frame_arrays(caller, count);
    let influence_count = caller.dice.pick(&[4, 1, 2, 0, usize::MAX, 1 << 62]);
    let element = |size: usize| influence_count.saturating_mul(size).max(1);
    let (joint_stride, weight_stride) = (caller.stride(element(2)), caller.stride(element(4)));
    let (bone_count, column_stride) =
        (caller.count(), caller.dice.pick(&[0, 12, 13, 16, 11, usize::MAX / 2]));
    let bone_stride = caller.dice.pick(&[0, 64, 36, 48, 11, usize::MAX]);
    let or = |stride, default| if stride == 0 { default } else { stride };
    let (columns, bones) = (or(column_stride, 16), or(bone_stride, 64));
    let skin = darboux_skin {
        size: caller.size::<darboux_skin>(),
        bones: caller.values(bone_count, bones, columns.saturating_mul(2).saturating_add(12), true),
        bone_count,
        bone_stride,
        column_stride,
        influence_count,
        joints: caller.values::<u16>(count, joint_stride, element(2), false),
        joint_stride,
        weights: caller.values(count, weight_stride, element(4), true),
        weight_stride,
    };
    // SAFETY: as above.
    caller.check(out, || unsafe { darboux_skin_frames(&skin, &arrays) });
}

/// Uses one context for several meshes.
fn contexts(caller: &mut Caller<'_>) {
    let mut context = null_mut();
    // SAFETY: `context` is writable, and is freed last.
    caller.check(NOTHING, || unsafe { darboux_context_create(1, &mut context) });
    for _ in 0..3 {
        let (mesh, corners) = caller.mesh();
        let options = caller.options();
        let count = caller.matching(corners);
        let out = caller.out::<f32>(count, 16);
        // SAFETY: as above.
        caller.check(out, || unsafe {
            darboux_generate_tangents(&mesh, &options, context, out.data, out.count, out.stride, null_mut())
        });
    }
    // SAFETY: the context is from `darboux_context_create`.
    unsafe { darboux_context_free(context) };
}

const NOTHING: Array<u8> = Array { data: null_mut(), count: 0, stride: 0 };

fn zeroed<T>() -> T {
    // SAFETY: used only for structs of numbers, for which zeros are valid.
    unsafe { std::mem::zeroed() }
}

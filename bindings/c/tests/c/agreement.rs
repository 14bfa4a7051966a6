//! Differential tests: the functions of `darboux.h` return the core's results, bit for bit, for every memory
//! layout.

use std::ffi::CStr;
use std::ptr::{null, null_mut};

use darboux::encode;
use darboux::{
    CornerTangents, Method, Mode, NormalOptions, NormalWeight, Plan, Shading, SmoothingSeams, Splitter,
    TangentOptions, generate_frames, generate_normals, generate_tangents, measure_tangents,
    measure_uv_fidelity, split_normals, split_vertices,
};
use darboux_c::*;
use darboux_tests::{Case, Dice, FaceSizes, METHODS, OwnedMesh, corpus, families};

pub fn empty_mesh() -> darboux_mesh {
    darboux_mesh {
        size: size_of::<darboux_mesh>(),
        vertex_count: 0,
        positions: null(),
        position_stride: 0,
        normals: null(),
        normal_stride: 0,
        uvs: null(),
        uv_stride: 0,
        indices_u32: null(),
        indices_u16: null(),
        index_count: 0,
        faces: 0,
        face_sizes: null(),
        face_count: 0,
    }
}

pub fn default_options() -> darboux_tangent_options {
    darboux_tangent_options { size: 0, method: 0, mode: 0, threshold: 0.0, reserved: 0 }
}

/// The mesh as a C struct with packed arrays.
pub fn packed(mesh: &OwnedMesh) -> darboux_mesh {
    let mut out = darboux_mesh {
        vertex_count: mesh.positions.len(),
        positions: mesh.positions.as_ptr().cast(),
        normals: mesh.normals.as_ptr().cast(),
        uvs: mesh.uvs.as_ptr().cast(),
        faces: match mesh.faces {
            FaceSizes::Triangles => FacesCode::Triangles as u32,
            FaceSizes::Quads => FacesCode::Quads as u32,
            FaceSizes::Mixed(_) => FacesCode::Mixed as u32,
        },
        ..empty_mesh()
    };
    if let Some(indices) = &mesh.indices {
        (out.indices_u32, out.index_count) = (indices.as_ptr(), indices.len());
    }
    if let FaceSizes::Mixed(sizes) = &mesh.faces {
        (out.face_sizes, out.face_count) = (sizes.as_ptr(), sizes.len());
    }
    out
}

#[track_caller]
pub fn ok(status: darboux_status) {
    // SAFETY: the message is a valid string until the next error.
    assert_eq!(status, darboux_status::Ok, "{:?}", unsafe { CStr::from_ptr(darboux_last_error()) });
}

pub fn bits<const N: usize>(list: &[[f32; N]]) -> Vec<[u32; N]> {
    list.iter().map(|element| element.map(f32::to_bits)).collect()
}

pub fn zeroed<T>() -> T {
    // SAFETY: used only for structs of numbers, for which zeros are valid.
    unsafe { std::mem::zeroed() }
}

fn tangents(
    mesh: &darboux_mesh,
    options: &darboux_tangent_options,
    corners: usize,
) -> (Vec<[f32; 4]>, darboux_report) {
    let mut out = vec![[0.0; 4]; corners];
    let mut report: darboux_report = zeroed();
    // SAFETY: all pointers refer to arrays of the given lengths.
    ok(unsafe {
        darboux_generate_tangents(mesh, options, null(), out.as_mut_ptr().cast(), corners, 0, &mut report)
    });
    (out, report)
}

/// The corpus and `random` random meshes.
fn meshes(random: u64) -> Vec<OwnedMesh> {
    let mut meshes: Vec<_> = corpus::corpus().into_iter().map(|corpus_case| corpus_case.mesh).collect();
    meshes.extend((0..random).map(|seed| Case::from_seed(seed).mesh));
    meshes
}

/// The modes in the order of their values in C.
const MODES: [Mode; 3] = [Mode::Repaired, Mode::Reference, Mode::Corrected];

#[test]
fn tangents_in_all_methods_and_modes() {
    for mesh in meshes(300) {
        let (view, count) = (mesh.view(), mesh.corner_count());
        for (method_code, &method) in (0..).zip(METHODS) {
            for (mode_code, mode) in (0..).zip(MODES) {
                for (threshold_code, threshold) in [(0.0, 180.0), (30.0, 30.0), (0.001, 0.0)] {
                    let method = match method {
                        Method::MikkTSpace(options) => {
                            options.with_mode(mode).with_threshold(threshold).into()
                        }
                        _ if mode_code != 0 || threshold_code != 0.0 => continue,
                        other => other,
                    };
                    let expected = generate_tangents(&view, &method.into());
                    let options = darboux_tangent_options {
                        method: method_code,
                        mode: mode_code,
                        threshold: threshold_code,
                        ..default_options()
                    };
                    let (found, report) = tangents(&packed(&mesh), &options, count);
                    assert_eq!(
                        bits(&found),
                        bits(expected.corners.per_corner()),
                        "{method:?} {mode:?} {threshold}"
                    );
                    assert_eq!(report.size, 0);
                    let expected = expected.report;
                    assert_eq!(report.triangles, expected.triangles);
                    assert_eq!(report.unsupported_faces, expected.unsupported_faces);
                    assert_eq!(report.degenerate_triangles, expected.degenerate_triangles);
                    assert_eq!(report.uv_degenerate_triangles, expected.uv_degenerate_triangles);
                    assert_eq!(report.non_finite_corners, expected.non_finite_corners);
                    assert_eq!(report.repaired_corners, expected.repaired_corners);
                    assert_eq!(report.mixed_sign_faces, expected.mixed_sign_faces);
                    assert_eq!(report.mirrored_edges, expected.mirrored_edges);
                    assert_eq!(report.split_vertices, expected.split_vertices);
                    assert_eq!(report.merged_vertices, expected.merged_vertices);
                }
            }
        }
    }
}

/// A vertex buffer of position, normal, UV and tangent: vertices are `stride` bytes apart, and `shift` bytes
/// off alignment.
struct Interleaved {
    bytes: Vec<u8>,
    start: usize,
    stride: usize,
}

const POSITION: usize = 0;
const NORMAL: usize = 12;
const UV: usize = 24;
const TANGENT: usize = 32;
const VERTEX: usize = 48;

impl Interleaved {
    fn new(mesh: &OwnedMesh, stride: usize, shift: usize) -> Self {
        let mut bytes = vec![0xa5; mesh.positions.len() * stride + 64];
        let start = bytes.as_ptr().align_offset(16) + shift;
        for v in 0..mesh.positions.len() {
            let (position, normal, uv) = mesh.vertex(v);
            let floats = [&position[..], &normal, &uv].concat();
            for (at, float) in floats.iter().enumerate() {
                let place = start + v * stride + 4 * at;
                bytes[place..place + 4].copy_from_slice(&float.to_ne_bytes());
            }
        }
        Self { bytes, start, stride }
    }

    fn view(&self, mesh: &OwnedMesh) -> darboux_mesh {
        let at = |offset: usize| self.bytes[self.start + offset..].as_ptr().cast();
        darboux_mesh {
            positions: at(POSITION),
            normals: at(NORMAL),
            uvs: at(UV),
            position_stride: self.stride,
            normal_stride: self.stride,
            uv_stride: self.stride,
            ..packed(mesh)
        }
    }

    fn tangent(&self, vertex: usize) -> [f32; 4] {
        let place = self.start + vertex * self.stride + TANGENT;
        std::array::from_fn(|i| {
            let bytes = &self.bytes[place + 4 * i..place + 4 * i + 4];
            f32::from_ne_bytes(bytes.try_into().expect("four bytes"))
        })
    }
}

#[test]
fn layouts_do_not_show() {
    for mesh in meshes(100) {
        let expected = generate_tangents(&mesh.view(), &TangentOptions::default());
        for (stride, shift) in [(VERTEX, 0), (VERTEX + 4, 0), (VERTEX + 1, 0), (VERTEX, 1), (VERTEX + 3, 2)] {
            let buffer = Interleaved::new(&mesh, stride, shift);
            let view = buffer.view(&mesh);
            let (found, _) = tangents(&view, &default_options(), mesh.corner_count());
            assert_eq!(bits(&found), bits(expected.corners.per_corner()), "stride {stride}, shift {shift}");
        }
    }
}

#[test]
fn short_indices_are_the_same() {
    for mesh in meshes(100) {
        let Some(indices) = &mesh.indices else { continue };
        let short: Vec<u16> = indices.iter().map(|&index| index as u16).collect();
        let expected = tangents(&packed(&mesh), &default_options(), indices.len()).0;
        let view = darboux_mesh { indices_u32: null(), indices_u16: short.as_ptr(), ..packed(&mesh) };
        assert_eq!(bits(&tangents(&view, &default_options(), indices.len()).0), bits(&expected));
    }
}

/// Tangents can be written between the other attributes of the vertices. No other byte changes.
#[test]
fn tangents_go_into_the_vertices() {
    for mesh in meshes(100) {
        let soup = mesh.unindexed();
        let expected = generate_tangents(&soup.view(), &TangentOptions::default());
        let corners = soup.corner_count();
        let mut buffer = Interleaved::new(&soup, VERTEX + 4, 0);
        let before = buffer.bytes.clone();
        let view = buffer.view(&soup);
        let out = buffer.bytes[buffer.start + TANGENT..].as_mut_ptr().cast();
        // SAFETY: the buffer holds the mesh, and has space for a tangent in each vertex.
        ok(unsafe { darboux_generate_tangents(&view, null(), null(), out, corners, VERTEX + 4, null_mut()) });
        let found: Vec<[f32; 4]> = (0..corners).map(|corner| buffer.tangent(corner)).collect();
        assert_eq!(bits(&found), bits(expected.corners.per_corner()));
        let is_tangent = |at: usize| {
            at >= buffer.start && (TANGENT..VERTEX).contains(&((at - buffer.start) % (VERTEX + 4)))
        };
        let changed = (0..before.len()).filter(|&at| before[at] != buffer.bytes[at]);
        assert!(changed.into_iter().all(is_tangent));
    }
}

#[test]
fn memory_of_a_context_does_not_change_results() {
    let mut context = null_mut();
    // SAFETY: `context` is writable.
    ok(unsafe { darboux_context_create(1, &mut context) });
    for mesh in meshes(200) {
        let count = mesh.corner_count();
        let view = packed(&mesh);
        let expected = tangents(&view, &default_options(), count).0;
        let mut found = vec![[0.0f32; 4]; count];
        let out = found.as_mut_ptr().cast();
        // SAFETY: all pointers refer to arrays of the given lengths.
        ok(unsafe { darboux_generate_tangents(&view, null(), context, out, count, 0, null_mut()) });
        assert_eq!(bits(&found), bits(&expected));
    }
    // SAFETY: `context` is from `darboux_context_create`.
    unsafe { darboux_context_free(context) };
}

#[test]
fn frames() {
    for mesh in meshes(200) {
        let count = mesh.corner_count();
        let expected = generate_frames(&mesh.view(), &TangentOptions::default());
        let mut found: Vec<darboux_frame> = vec![zeroed(); count];
        let (view, mut report): (_, darboux_report) = (packed(&mesh), zeroed());
        // SAFETY: all pointers refer to arrays of the given lengths.
        ok(unsafe {
            darboux_generate_frames(&view, null(), null(), found.as_mut_ptr(), count, 0, &mut report)
        });
        assert_eq!(report.repaired_corners, expected.report.repaired_corners);
        for (found, expected) in found.iter().zip(expected.corners.per_corner()) {
            let flat = |t: [f32; 3], b: [f32; 3], m: [f32; 2], s| {
                [t[0], t[1], t[2], b[0], b[1], b[2], m[0], m[1], s].map(f32::to_bits)
            };
            let found = flat(found.tangent, found.bitangent, found.magnitude, found.sign);
            assert_eq!(found, flat(expected.tangent, expected.bitangent, expected.magnitude, expected.sign));
        }
    }
}

#[test]
fn splits() {
    for mesh in meshes(200) {
        let corners = generate_tangents(&mesh.view(), &TangentOptions::default()).corners;
        let expected = split_vertices(&mesh.view(), &corners).expect("its tangents");
        let (view, data, count) = (packed(&mesh), corners.per_corner().as_ptr().cast(), corners.len());
        let mut split = null_mut();
        // SAFETY: all pointers refer to arrays of the given lengths; the result's arrays have the lengths
        // that it gives, until it is freed.
        unsafe {
            ok(darboux_split_vertices(&view, data, count, 0, null(), &mut split));
            let (found, vertices) = (&*split, (*split).vertex_count);
            let tangents = std::slice::from_raw_parts(found.tangent_of_vertex, vertices);
            assert_eq!(bits(tangents), bits(&expected.tangent_of_vertex));
            assert_eq!(
                std::slice::from_raw_parts(found.source_of_vertex, vertices),
                expected.source_of_vertex
            );
            assert_eq!(std::slice::from_raw_parts(found.indices, found.index_count), expected.indices);
            darboux_vertex_split_free(split);
        }
    }
}

/// One call with the corners of all submeshes of a vertex buffer splits them as the core's `Splitter` does,
/// submesh by submesh.
#[test]
fn submeshes_split_together() {
    let mut count = 0;
    for mesh in meshes(100) {
        let OwnedMesh { indices: Some(indices), faces: FaceSizes::Triangles, .. } = &mesh else { continue };
        count += 1;
        let middle = indices.len() / 6 * 3;
        let mut splitter = Splitter::new(mesh.positions.len());
        let (mut expected, mut tangents) = (Vec::new(), Vec::new());
        for part in [&indices[..middle], &indices[middle..]] {
            let part = OwnedMesh { indices: Some(part.to_vec()), ..mesh.clone() };
            let corners = generate_tangents(&part.view(), &TangentOptions::default()).corners;
            expected.extend(splitter.add(&part.view(), &corners).expect("its tangents"));
            tangents.extend(corners.into_per_corner());
        }
        let sources = splitter.finish().source_of_vertex;
        let (view, mut split) = (packed(&mesh), null_mut());
        // SAFETY: all pointers refer to arrays of the given lengths; the result's arrays have the lengths
        // that it gives, until it is freed.
        unsafe {
            ok(darboux_split_vertices(
                &view,
                tangents.as_ptr().cast(),
                tangents.len(),
                0,
                null(),
                &mut split,
            ));
            let found = &*split;
            assert_eq!(std::slice::from_raw_parts(found.source_of_vertex, found.vertex_count), sources);
            assert_eq!(std::slice::from_raw_parts(found.indices, found.index_count), expected);
            darboux_vertex_split_free(split);
        }
    }
    assert!(count > 20, "{count} meshes");
}

#[test]
fn normals_and_their_splits() {
    let all = |seed: usize| {
        let mut dice = Dice::from_seed(seed as u64);
        let shading = dice.pick(&[(0, Shading::Smooth), (1, Shading::Flat)]);
        let weight =
            dice.pick(&[(0, NormalWeight::Angle), (1, NormalWeight::Area), (2, NormalWeight::AngleArea)]);
        let crease = dice.pick(&[(0.0, 180.0), (30.0, 30.0), (-1.0, 0.0)]);
        let seams = dice.pick(&[(0, SmoothingSeams::Ignored), (1, SmoothingSeams::Respected)]);
        let ours = NormalOptions::new()
            .with_shading(shading.1)
            .with_weight(weight.1)
            .with_crease(crease.1)
            .with_seams(seams.1);
        let theirs = darboux_normal_options {
            size: size_of::<darboux_normal_options>(),
            shading: shading.0,
            weight: weight.0,
            crease: crease.0,
            seams: seams.0,
        };
        (ours, theirs)
    };
    for (seed, mesh) in meshes(300).iter().enumerate() {
        let (ours, theirs) = all(seed);
        let view = mesh.view();
        let expected =
            generate_normals(view.positions(), view.indices(), view.faces(), &ours).expect("a mesh");
        let count = mesh.corner_count();
        let mut found = vec![[0.0f32; 3]; count];
        let bare = darboux_mesh { normals: null(), uvs: null(), ..packed(mesh) };
        let mut report: darboux_normal_report = zeroed();
        let mut split = null_mut();
        let split_expected =
            split_normals(view.vertex_count(), view.indices(), &expected.corners).expect("its normals");
        // SAFETY: all pointers refer to arrays of the given lengths; the result's arrays have the lengths
        // that it gives, until it is freed.
        unsafe {
            ok(darboux_generate_normals(
                &bare,
                &theirs,
                null(),
                found.as_mut_ptr().cast(),
                count,
                0,
                &mut report,
            ));
            ok(darboux_split_normals(&bare, found.as_ptr().cast(), count, 0, null(), &mut split));
            let vertices = (*split).vertex_count;
            let normals = std::slice::from_raw_parts((*split).normal_of_vertex, vertices);
            assert_eq!(bits(normals), bits(&split_expected.normal_of_vertex));
            let sources = std::slice::from_raw_parts((*split).source_of_vertex, vertices);
            assert_eq!(sources, split_expected.source_of_vertex);
            let indices = std::slice::from_raw_parts((*split).indices, (*split).index_count);
            assert_eq!(indices, split_expected.indices);
            darboux_normal_split_free(split);
        }
        assert_eq!(bits(&found), bits(expected.corners.per_corner()));
        assert_eq!(report.faces, expected.report.faces);
        assert_eq!(report.degenerate_faces, expected.report.degenerate_faces);
        assert_eq!(report.repaired_corners, expected.report.repaired_corners);
        assert_eq!(report.creased_edges, expected.report.creased_edges);
    }
}

#[test]
fn plans() {
    for mesh in meshes(100) {
        let mut moved = mesh.clone();
        moved.positions.iter_mut().for_each(|[x, y, z]| (*x, *y, *z) = (*x + 0.25 * *y, *y, *z - 0.5 * *x));
        let expected = Plan::new(&mesh.view(), &TangentOptions::default());
        let count = mesh.corner_count();
        let (mut base, mut evaluated) = (vec![[0.0f32; 4]; count], vec![[0.0f32; 4]; count]);
        let (view, moved_view) = (packed(&mesh), packed(&moved));
        let (mut plan, mut regrouped) = (null_mut(), 0);
        // SAFETY: all pointers refer to arrays of the given lengths; the plan is freed last.
        unsafe {
            ok(darboux_plan_create(&view, null(), null(), &mut plan));
            ok(darboux_plan_base(plan, base.as_mut_ptr().cast(), count, 0, null_mut()));
            ok(darboux_plan_evaluate(plan, &moved_view, null_mut(), evaluated.as_mut_ptr().cast(), count, 0));
            ok(darboux_plan_count_regrouped(plan, &moved_view, null(), &mut regrouped));
            darboux_plan_free(plan);
        }
        assert_eq!(bits(&base), bits(expected.base().corners.per_corner()));
        let expected_moved = expected.evaluate(&moved.view()).expect("the same topology");
        assert_eq!(bits(&evaluated), bits(expected_moved.per_corner()));
        assert_eq!(regrouped, expected.count_regrouped(&moved.view()).expect("the same topology"));
    }
}

#[test]
fn measures() {
    for mesh in meshes(200) {
        let by = |method| {
            let options = TangentOptions::from(method);
            generate_tangents(&mesh.view(), &options).corners.into_per_corner()
        };
        let (a, b) = (by(Method::default()), by(Method::Area));
        let expected = measure_tangents(&a, &b).expect("equal lengths");
        let (mut found, mut fidelity): (darboux_tangent_difference, darboux_uv_fidelity) =
            (zeroed(), zeroed());
        let view = packed(&mesh);
        // SAFETY: all pointers refer to arrays of the given lengths.
        unsafe {
            ok(darboux_measure_tangents(
                a.len(),
                a.as_ptr().cast(),
                0,
                b.as_ptr().cast(),
                16,
                null(),
                &mut found,
            ));
            ok(darboux_measure_uv_fidelity(&view, a.as_ptr().cast(), a.len(), 0, null(), &mut fidelity));
        }
        assert_eq!(
            (found.corners, found.identical, found.sign_flips, found.without_angle, found.histogram),
            (
                expected.corners,
                expected.identical,
                expected.sign_flips,
                expected.without_angle,
                expected.histogram
            )
        );
        let numbers =
            [(found.mean, expected.mean), (found.median, expected.median), (found.p95, expected.p95)];
        assert_eq!(found.min.to_bits(), expected.min.to_bits());
        assert!(numbers.iter().all(|(found, expected)| found.to_bits() == expected.to_bits()));
        assert_eq!(found.max.to_bits(), expected.max.to_bits());
        let worst = found.worst_corners.into_iter().zip(found.worst_angles).take(found.worst_count);
        assert_eq!(worst.collect::<Vec<_>>(), expected.worst);
        let expected = measure_uv_fidelity(&mesh.view(), &a).expect("its tangents");
        assert_eq!(
            (fidelity.unmeasured_triangles, fidelity.mean.to_bits()),
            (expected.unmeasured_triangles, expected.mean.to_bits())
        );
        assert_eq!(fidelity.root_mean_square.to_bits(), expected.root_mean_square.to_bits());
        assert_eq!(fidelity.area.to_bits(), expected.area.to_bits());
    }
}

/// Unit normals and perpendicular unit tangents.
fn unit_frames() -> (Vec<[f32; 3]>, Vec<[f32; 4]>) {
    let sphere = families::sphere(20, 20, false);
    let corners = generate_tangents(&sphere.view(), &TangentOptions::default()).corners;
    let split = split_vertices(&sphere.view(), &corners).expect("its tangents");
    let normals = split.source_of_vertex.iter().map(|&old| sphere.normals[old as usize]).collect();
    (normals, split.tangent_of_vertex)
}

/// Compares encoding and decoding through C, with gaps between the codes, with the core.
fn check_encoding<Code: Copy + PartialEq + std::fmt::Debug>(
    encoding: TangentEncodingCode,
    to: impl Fn([f32; 3], [f32; 4]) -> Code,
    from: impl Fn([f32; 3], Code) -> [f32; 4],
) {
    let (normals, tangents) = unit_frames();
    let (count, stride) = (normals.len(), size_of::<Code>() + 3);
    let mut codes = vec![0u8; count * stride];
    let mut back = vec![[0.0f32; 4]; count];
    let (n, t) = (normals.as_ptr().cast(), tangents.as_ptr().cast());
    // SAFETY: all pointers refer to arrays of the given lengths.
    unsafe {
        ok(darboux_encode_tangents(encoding as u32, count, n, 0, t, 0, codes.as_mut_ptr().cast(), stride));
        let read = codes.as_ptr().cast();
        ok(darboux_decode_tangents(encoding as u32, count, n, 0, read, stride, back.as_mut_ptr().cast(), 0));
    }
    for (at, (&normal, &tangent)) in normals.iter().zip(&tangents).enumerate() {
        // SAFETY: a code was written at this offset.
        let code = unsafe { codes[at * stride..].as_ptr().cast::<Code>().read_unaligned() };
        assert_eq!(code, to(normal, tangent));
        assert_eq!(back[at].map(f32::to_bits), from(normal, code).map(f32::to_bits));
    }
}

#[test]
fn encodings() {
    use TangentEncodingCode::{Diamond, Octahedral, Snorm8, Snorm10, Snorm16};
    check_encoding(Snorm8, |_, t| encode::tangent_to_snorm8(t), |_, code| encode::tangent_from_snorm8(code));
    check_encoding(
        Snorm10,
        |_, t| encode::tangent_to_snorm10(t),
        |_, code| encode::tangent_from_snorm10(code),
    );
    check_encoding(
        Snorm16,
        |_, t| encode::tangent_to_snorm16(t),
        |_, code| encode::tangent_from_snorm16(code),
    );
    check_encoding(
        Octahedral,
        |_, t| encode::tangent_to_octahedral(t),
        |_, code| encode::tangent_from_octahedral(code),
    );
    check_encoding(Diamond, encode::tangent_to_diamond, encode::tangent_from_diamond);
    let (normals, tangents) = unit_frames();
    let count = normals.len();
    let (mut short, mut long) = (vec![[0i16; 2]; count], vec![[0i16; 4]; count]);
    let (mut normals_back, mut tangents_back) = (vec![[0.0f32; 3]; count], vec![[0.0f32; 4]; count]);
    let (n, t) = (normals.as_ptr().cast(), tangents.as_ptr().cast());
    // SAFETY: all pointers refer to arrays of the given lengths.
    unsafe {
        ok(darboux_encode_normals(count, n, 0, short.as_mut_ptr().cast(), 0));
        ok(darboux_decode_normals(count, short.as_ptr().cast(), 0, normals_back.as_mut_ptr().cast(), 0));
    }
    let expected: Vec<[i16; 2]> =
        normals.iter().map(|&normal| encode::normal_to_octahedral(normal)).collect();
    assert_eq!(short, expected);
    let expected: Vec<[f32; 3]> = short.iter().map(|&code| encode::normal_from_octahedral(code)).collect();
    assert_eq!(bits(&normals_back), bits(&expected));
    // SAFETY: as above.
    unsafe {
        ok(darboux_encode_frames(count, n, 0, t, 0, long.as_mut_ptr().cast(), 0));
        let to = (normals_back.as_mut_ptr().cast(), tangents_back.as_mut_ptr().cast());
        ok(darboux_decode_frames(count, long.as_ptr().cast(), 0, to.0, 0, to.1, 0));
    }
    for (at, code) in long.iter().enumerate() {
        assert_eq!(*code, encode::frame_to_quaternion(normals[at], tangents[at]));
        assert_eq!((normals_back[at], tangents_back[at]), encode::frame_from_quaternion(*code));
    }
}

#[test]
fn corner_tangents_come_from_anywhere() {
    let tangents = vec![[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, -1.0]];
    assert_eq!(CornerTangents::from_per_corner(tangents.clone()).per_corner(), tangents);
}

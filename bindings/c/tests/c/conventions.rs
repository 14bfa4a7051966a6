//! Differential tests: conversions of conventions, node matrices and skins through C equal the core's
//! results.

use std::ptr::{null, null_mut};

use darboux::{Convention, SignRule, TangentDirection, Transform};
use darboux_c::*;
use darboux_tests::Dice;

use crate::agreement::{bits, ok, zeroed};

/// The preset of each program, and the preset with every choice but the axes inverted, so that every value of
/// every choice occurs.
fn conventions() -> Vec<(Convention, darboux_convention)> {
    let mut all = Vec::new();
    for (program, (_, preset)) in (0..).zip(Convention::PRESETS) {
        let mut c: darboux_convention = zeroed();
        // SAFETY: `c` is writable.
        ok(unsafe { darboux_convention_of(program, &mut c) });
        all.push((preset, c));
        let odd = Convention {
            tangent: TangentDirection::Left,
            sign: SignRule::TangentCrossNormal,
            ..preset.generated()
        };
        (c.tangent, c.sign) = (1, 1);
        let mut generated: darboux_convention = zeroed();
        // SAFETY: `c` is readable, and `generated` is writable.
        ok(unsafe { darboux_convention_generated(&c, &mut generated) });
        assert_eq!((generated.tangent, generated.sign), (0, 0));
        c.bitangent = generated.bitangent;
        all.push((odd, c));
    }
    all
}

#[test]
fn conversions() {
    let mut dice = Dice::from_seed(3);
    let mut floats = || -> Vec<f32> { (0..60).map(|_| dice.any_float()).collect() };
    let (vectors, tangents, uvs) = (floats(), floats(), floats());
    for (from, c_from) in conventions() {
        for (to, c_to) in conventions() {
            let conversion = from.to(to);
            let mut found = [[0.0f32; 60]; 3];
            let [v, t, u] = found.each_mut().map(|out| out.as_mut_ptr());
            let (mut red, mut green) = (7, 7);
            // SAFETY: all pointers refer to arrays of the given lengths.
            unsafe {
                ok(darboux_convert_vectors(&c_from, &c_to, 20, vectors.as_ptr(), 0, v, 0));
                ok(darboux_convert_tangents(&c_from, &c_to, 15, tangents.as_ptr(), 16, t, 0));
                ok(darboux_convert_uvs(&c_from, &c_to, 30, uvs.as_ptr(), 0, u, 8));
                ok(darboux_convert_channels(&c_from, &c_to, &mut red, &mut green));
            }
            let expected: Vec<_> = vectors.as_chunks().0.iter().map(|&v| conversion.vector(v)).collect();
            assert_eq!(bits(found[0].as_chunks().0), bits(&expected));
            let expected: Vec<_> = tangents.as_chunks().0.iter().map(|&t| conversion.tangent(t)).collect();
            assert_eq!(bits(found[1].as_chunks().0), bits(&expected));
            let expected: Vec<_> = uvs.as_chunks().0.iter().map(|&u| conversion.uv(u)).collect();
            assert_eq!(bits(found[2].as_chunks().0), bits(&expected));
            assert_eq!((red == 1, green == 1), (conversion.inverts_red(), conversion.inverts_green()));
        }
    }
}

#[test]
fn faces_are_reversed() {
    let sizes = [3u32, 0, 5, 4, 1];
    for (from, c_from) in conventions() {
        for (to, c_to) in conventions() {
            let conversion = from.to(to);
            let (mut expected, mut found): (Vec<u16>, Vec<u16>) = ((0..13).collect(), (0..13).collect());
            let mut rest = &mut expected[..];
            for size in sizes {
                let (face, others) = rest.split_at_mut(size as usize);
                conversion.face(face);
                rest = others;
            }
            let (each, corners) = (sizes.as_ptr(), found.as_mut_ptr().cast());
            // SAFETY: all pointers refer to arrays of the given lengths.
            ok(unsafe { darboux_convert_faces(&c_from, &c_to, 2, each, sizes.len(), corners, 13, 2) });
            assert_eq!(found, expected);
            let mut tangents: Vec<[f32; 4]> = (0..6).map(|corner| [corner as f32; 4]).collect();
            let corners = tangents.as_mut_ptr().cast();
            // SAFETY: as above.
            ok(unsafe { darboux_convert_faces(&c_from, &c_to, 0, null(), 0, corners, 6, 16) });
            let order: [usize; 6] =
                if from.winding == to.winding { [0, 1, 2, 3, 4, 5] } else { [0, 2, 1, 3, 5, 4] };
            assert_eq!(tangents, order.map(|corner| [corner as f32; 4]));
        }
    }
}

/// A null pointer, a struct of zeros and the glTF preset are the same convention.
#[test]
fn zeros_are_gltf() {
    let mut gltf: darboux_convention = zeroed();
    let zeros: darboux_convention = zeroed();
    // SAFETY: `gltf` is writable.
    ok(unsafe { darboux_convention_of(ProgramCode::Gltf as u32, &mut gltf) });
    for from in [&raw const zeros, null()] {
        let mut tangent = [0.25f32, 0.5, -0.75, -1.0];
        let (t, change) = (tangent.as_mut_ptr(), [0.25f32, 0.5, -0.75, -1.0]);
        // SAFETY: all pointers refer to arrays of the given lengths.
        ok(unsafe { darboux_convert_tangents(from, &gltf, 1, t, 0, t, 0) });
        assert_eq!(tangent, change);
    }
}

#[test]
fn odd_conventions_are_refused() {
    let zeros: darboux_convention = zeroed();
    let odd = [
        (darboux_convention { right: 7, ..zeros }, darboux_status::UnknownValue),
        (darboux_convention { winding: 2, ..zeros }, darboux_status::UnknownValue),
        (darboux_convention { uv_origin: 2, ..zeros }, darboux_status::UnknownValue),
        (darboux_convention { tangent: 2, ..zeros }, darboux_status::UnknownValue),
        (darboux_convention { bitangent: 2, ..zeros }, darboux_status::UnknownValue),
        (darboux_convention { sign: 2, ..zeros }, darboux_status::UnknownValue),
        (darboux_convention { right: AxisCode::MinusY as u32, ..zeros }, darboux_status::Axes),
        (darboux_convention { size: 4, ..zeros }, darboux_status::StructSize),
    ];
    for (convention, status) in odd {
        let mut vector = [1.0f32, 2.0, 3.0];
        let v = vector.as_mut_ptr();
        // SAFETY: all pointers refer to arrays of the given lengths.
        assert_eq!(unsafe { darboux_convert_vectors(&convention, null(), 1, v, 0, v, 0) }, status);
        assert_eq!(vector, [1.0, 2.0, 3.0]);
    }
    let mut corners = [0u32; 4];
    let c = corners.as_mut_ptr().cast();
    // SAFETY: all pointers refer to arrays of the given lengths.
    let found = unsafe {
        [
            darboux_convert_faces(null(), null(), 0, null(), 0, c, 4, 4),
            darboux_convert_faces(null(), null(), 2, &3, 1, c, 4, 4),
            darboux_convert_faces(null(), null(), 1, null(), 0, c, 4, 0),
            darboux_convert_faces(null(), null(), 1, null(), 0, null_mut(), 4, 4),
            darboux_convention_of(10, &mut zeroed()),
            // Without corners, their size cannot overflow.
            darboux_convert_faces(null(), null(), 0, null(), 0, null_mut(), 0, usize::MAX),
        ]
    };
    use darboux_status::{Faces, NullPointer, Ok, Stride, UnknownValue};
    assert_eq!(found, [Faces, Faces, Stride, NullPointer, UnknownValue, Ok]);
}

fn arrays(normals: &mut [[f32; 3]], tangents: &mut [[f32; 4]]) -> darboux_frame_arrays {
    darboux_frame_arrays {
        count: normals.len(),
        normals: normals.as_ptr().cast(),
        tangents: tangents.as_ptr().cast(),
        out_normals: normals.as_mut_ptr().cast(),
        out_tangents: tangents.as_mut_ptr().cast(),
        ..zeroed()
    }
}

fn frames(dice: &mut Dice<'_>) -> (Vec<[f32; 3]>, Vec<[f32; 4]>) {
    let mut float = || dice.any_float();
    let normals = (0..40).map(|_| [float(), float(), float()]).collect();
    let tangents = (0..40).map(|_| [float(), float(), float(), float()]).collect();
    (normals, tangents)
}

#[test]
fn matrices() {
    let mut dice = Dice::from_seed(5);
    for _ in 0..200 {
        let matrix: [f32; 16] = std::array::from_fn(|_| dice.any_float());
        let transform = Transform::new([0, 4, 8].map(|at| [matrix[at], matrix[at + 1], matrix[at + 2]]));
        let (mut normals, mut tangents) = frames(&mut dice);
        let expected: Vec<_> = normals.iter().zip(&tangents).map(|(&n, &t)| transform.frame(n, t)).collect();
        let (arrays, mut orientation) = (arrays(&mut normals, &mut tangents), 0.0);
        // SAFETY: all pointers refer to arrays of the given lengths.
        ok(unsafe { darboux_transform_frames(matrix.as_ptr(), 16, &arrays, &mut orientation) });
        assert_eq!(orientation, transform.orientation());
        let (expected_normals, expected_tangents): (Vec<_>, Vec<_>) = expected.into_iter().unzip();
        assert_eq!((bits(&normals), bits(&tangents)), (bits(&expected_normals), bits(&expected_tangents)));
    }
}

/// An invalid `orientation` pointer is rejected before anything is written.
#[test]
fn a_refused_orientation_leaves_the_arrays() {
    let (mut normals, mut tangents) = (vec![[0.0, 0.0, 1.0]], vec![[1.0, 0.0, 0.0, 1.0]]);
    let arrays = arrays(&mut normals, &mut tangents);
    let matrix = [0.0f32, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0];
    let nowhere = std::ptr::without_provenance_mut(usize::MAX - 1);
    // SAFETY: all pointers refer to arrays of the given lengths, except for one that is rejected.
    let status = unsafe { darboux_transform_frames(matrix.as_ptr(), 0, &arrays, nowhere) };
    assert_eq!(status, darboux_status::TooLarge);
    assert_eq!((normals, tangents), (vec![[0.0, 0.0, 1.0]], vec![[1.0, 0.0, 0.0, 1.0]]));
}

#[test]
fn skins() {
    let mut dice = Dice::from_seed(6);
    for influences in [0, 1, 4] {
        let bones: Vec<[f32; 16]> = (0..3).map(|_| std::array::from_fn(|_| dice.any_float())).collect();
        let (mut normals, mut tangents) = frames(&mut dice);
        let mut joints: Vec<u16> = (0..40 * influences).map(|_| dice.below(3) as u16).collect();
        let weights: Vec<f32> = (0..40 * influences).map(|_| dice.any_float()).collect();
        let skin = darboux_skin {
            bones: bones.as_ptr().cast(),
            bone_count: 3,
            influence_count: influences,
            joints: joints.as_ptr(),
            weights: weights.as_ptr(),
            ..zeroed()
        };
        let expected = |vertex: usize| {
            let columns = |bone: usize| [0, 4, 8].map(|at| [0, 1, 2].map(|i| bones[bone][at + i]));
            let range = vertex * influences..(vertex + 1) * influences;
            let pairs = range.map(|at| (columns(usize::from(joints[at])), weights[at]));
            Transform::blended(pairs).frame(normals[vertex], tangents[vertex])
        };
        let (expected_normals, expected_tangents): (Vec<_>, Vec<_>) = (0..40).map(expected).unzip();
        let arrays = arrays(&mut normals, &mut tangents);
        // SAFETY: all pointers refer to arrays of the given lengths.
        ok(unsafe { darboux_skin_frames(&skin, &arrays) });
        assert_eq!((bits(&normals), bits(&tangents)), (bits(&expected_normals), bits(&expected_tangents)));
        let Some(last) = joints.last_mut() else { continue };
        *last = 3;
        // SAFETY: as above.
        unsafe {
            assert_eq!(darboux_skin_frames(&skin, &arrays), darboux_status::Index);
            let narrow = darboux_skin { column_stride: 11, ..skin };
            assert_eq!(darboux_skin_frames(&narrow, &arrays), darboux_status::Stride);
            let huge = darboux_skin { column_stride: usize::MAX / 2, bone_stride: usize::MAX, ..skin };
            assert_eq!(darboux_skin_frames(&huge, &arrays), darboux_status::Stride);
        }
        assert_eq!(bits(&normals), bits(&expected_normals));
    }
}

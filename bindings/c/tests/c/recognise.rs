//! Verdicts in C are those of the core.

use std::ptr::{null, null_mut};

use darboux::{Method, TangentOptions, TexelLayout, generate_tangents, judge_normal_map, recognise_recipe};
use darboux_c::*;
use darboux_tests::families;
use darboux_tests::maps::MapCase;

use crate::agreement::packed;

const NO_JUDGEMENT: darboux_map_judgement = darboux_map_judgement {
    size: 0,
    verdict: 0,
    confidence: 0.0,
    correlation: 0.0,
    z_score: 0.0,
    log_energy_ratio: 0.0,
    mean_length: 0.0,
    texels: 0,
    background: 0,
    not_unit: 0,
    negative_z: 0,
    grey: 0,
    not_normal: 0,
};

/// Judges rows of bytes.
fn judged(
    texels: &[u8],
    kind: (u32, u32),
    size: [usize; 2],
    stride: usize,
) -> (darboux_status, darboux_map_judgement) {
    let mut out = NO_JUDGEMENT;
    // SAFETY: the texels have as many bytes, and the struct is writable.
    let status = unsafe {
        darboux_judge_normal_map(texels.as_ptr(), kind.0, kind.1, size[0], size[1], stride, &mut out)
    };
    (status, out)
}

#[test]
fn maps_are_judged_as_in_rust() {
    for number in 0..6 {
        let case = MapCase::new(number, 256);
        let texels = case.texels(number % 2 == 1);
        let size = [case.side, texels.len() / case.side];
        let expected: darboux_map_judgement =
            judge_normal_map(&texels, size, TexelLayout::RGB).expect("a whole map").into();
        let same = |(status, found): (darboux_status, darboux_map_judgement)| {
            assert_eq!(status, darboux_status::Ok);
            assert_eq!(
                (found.verdict, found.z_score.to_bits(), found.not_unit),
                (expected.verdict, expected.z_score.to_bits(), expected.not_unit)
            );
        };
        same(judged(texels.as_flattened(), (8, 3), size, 0));
        let padded: Vec<u8> =
            texels.chunks(size[0]).flat_map(|row| row.as_flattened().iter().copied().chain([7; 5])).collect();
        same(judged(&padded, (8, 3), size, 3 * size[0] + 5));
        let with_alpha: Vec<u8> = texels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 9]).collect();
        same(judged(&with_alpha, (8, 4), size, 0));
    }
}

#[test]
fn wrong_maps_are_refused() {
    let texels = [128u8; 64];
    assert_eq!(judged(&texels, (8, 3), [0, 0], 0).0, darboux_status::Ok);
    assert_eq!(judged(&texels, (8, 5), [2, 2], 0).0, darboux_status::UnknownValue);
    assert_eq!(judged(&texels, (12, 3), [2, 2], 0).0, darboux_status::UnknownValue);
    assert_eq!(judged(&texels, (8, 3), [4, 4], 11).0, darboux_status::Stride);
    assert_eq!(judged(&texels, (8, 3), [usize::MAX, 4], 0).0, darboux_status::TooLarge);
    let odd = usize::from(texels.as_ptr().addr().is_multiple_of(2));
    assert_eq!(judged(&texels[odd..], (16, 2), [2, 2], 0).0, darboux_status::Alignment);
    let mut out = NO_JUDGEMENT;
    // SAFETY: null pointers are refused.
    unsafe {
        assert_eq!(darboux_judge_normal_map(null(), 8, 3, 2, 2, 0, &mut out), darboux_status::NullPointer);
        let texels = texels.as_ptr();
        assert_eq!(darboux_judge_normal_map(texels, 8, 3, 2, 2, 0, null_mut()), darboux_status::NullPointer);
    }
}

#[test]
fn recipes_are_recognised_as_in_rust() {
    let mesh = families::grid(12, 9, false, true);
    for method in [Method::default(), Method::AngleEdge, Method::Lengyel, Method::Face] {
        let tangents = generate_tangents(&mesh.view(), &TangentOptions::from(method)).corners;
        let tangents = tangents.per_corner();
        let expected = recognise_recipe(&mesh.view(), tangents).expect("one per corner");
        let (mut matches, mut count) = ([darboux_recipe_match::from(&expected[0]); 40], 0);
        matches.iter_mut().for_each(|found| found.corners = 0);
        // SAFETY: all pointers refer to arrays of the given lengths.
        let status = unsafe {
            let (view, from) = (packed(&mesh), tangents.as_ptr().cast());
            let to = matches.as_mut_ptr();
            darboux_recognise_recipe(&view, from, tangents.len(), 0, null(), to, matches.len(), &mut count)
        };
        assert_eq!((status, count), (darboux_status::Ok, expected.len()));
        for (found, expected) in matches.iter().zip(&expected).take(count.min(40)) {
            let expected = darboux_recipe_match::from(expected);
            assert_eq!(
                (found.method, found.from_quads, found.writing, found.identical, found.worst.to_bits()),
                (
                    expected.method,
                    expected.from_quads,
                    expected.writing,
                    expected.identical,
                    expected.worst.to_bits()
                )
            );
        }
        // SAFETY: as above; the number of tangents is wrong, and nothing is written.
        let status = unsafe {
            let (view, from) = (packed(&mesh), tangents.as_ptr().cast());
            darboux_recognise_recipe(&view, from, 3, 0, null(), null_mut(), 0, null_mut())
        };
        assert_eq!(status, darboux_status::Length);
    }
}

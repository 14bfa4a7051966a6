//! The same bits on every processor: hashes of what all methods give, as recorded on x86-64.
//!
//! Run this on another one to see whether the promise holds there. A change that is meant to change tangents records new ones.

use darboux::{Frame, Method, Mode, TangentOptions, generate_frames, generate_tangents};
use darboux_tests::corpus::corpus;
use darboux_tests::{Case, METHODS, OwnedMesh, compare};

/// FNV-1a of 64 bits, word by word.
struct Hash(u64);

impl Hash {
    fn take(&mut self, word: u32) {
        self.0 = (self.0 ^ u64::from(word)).wrapping_mul(0x0100_0000_01b3);
    }

    /// Which NaN it is differs from processor to processor.
    fn take_float(&mut self, float: f32) {
        self.take(if float.is_nan() { f32::NAN.to_bits() } else { float.to_bits() });
    }

    fn take_frame(&mut self, frame: &Frame) {
        compare::bits(frame).into_iter().for_each(|bits| self.take_float(f32::from_bits(bits)));
    }
}

/// The corpus, and meshes from seeds.
fn meshes() -> Vec<(OwnedMesh, f32)> {
    let collected = corpus().into_iter().map(|specimen| (specimen.mesh, specimen.thresholds[0]));
    let made = (0..SEEDS).map(Case::from_seed).map(|case| (case.mesh, case.threshold));
    collected.chain(made).collect()
}

const SEEDS: u64 = 2000;

fn hash(meshes: &[(OwnedMesh, f32)], take: impl Fn(&OwnedMesh, f32, &mut Hash)) -> u64 {
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    meshes.iter().for_each(|(mesh, threshold)| take(mesh, *threshold, &mut hash));
    hash.0
}

fn options(method: Method, mode: Mode, threshold: f32) -> TangentOptions {
    TangentOptions { method, mode, threshold }
}

#[test]
fn meshes_are_the_same() {
    let found = hash(&meshes(), |mesh, threshold, hash| {
        hash.take_float(threshold);
        for vertex in (0..mesh.view().vertex_count()).map(|vertex| mesh.vertex(vertex)) {
            let (position, normal, uv) = vertex;
            position.into_iter().chain(normal).chain(uv).for_each(|float| hash.take_float(float));
        }
    });
    assert_eq!(found, 0x16b6_af17_1196_abb6, "{found:#x}");
}

#[test]
fn frames_of_mikktspace_are_the_same() {
    let meshes = meshes();
    let found = [Mode::Reference, Mode::Repaired, Mode::Corrected].map(|mode| {
        hash(&meshes, |mesh, threshold, hash| {
            let frames = generate_frames(&mesh.view(), &options(Method::MikkTSpace, mode, threshold));
            frames.corners.per_corner().iter().for_each(|frame| hash.take_frame(frame));
        })
    });
    let recorded = [0x73e2_8dd8_6b3f_21d1, 0x8e53_584f_f8fd_298f, 0x0e8e_7488_df78_ab35];
    assert_eq!(found, recorded, "{found:#x?}");
}

#[test]
fn tangents_of_every_method_are_the_same() {
    let meshes = meshes();
    let found = METHODS.map(|method| {
        hash(&meshes, |mesh, threshold, hash| {
            let tangents = generate_tangents(&mesh.view(), &options(method, Mode::Repaired, threshold));
            tangents.corners.per_corner().as_flattened().iter().for_each(|float| hash.take_float(*float));
        })
    });
    let recorded = [
        0x5d3f_bb2c_6987_8219,
        0x23b7_226d_fcd6_7349,
        0x4833_39c4_7845_139d,
        0x4133_0975_ba8a_7183,
        0x9e56_0a28_643f_6a4f,
        0x81d6_b114_1250_c5f2,
        0x7297_64bf_e0e0_be5b,
        0xfdfb_d1d9_54fb_bd6e,
    ];
    assert_eq!(found, recorded, "{found:#x?}");
}

//! The same bits on every processor: hashes of the results of all methods, recorded on x86-64.
//!
//! Run this on another processor to check it. A change that is meant to change tangents must record new hashes.

use darboux::{Frame, Method, MikkTSpaceOptions, Mode, generate_frames, generate_tangents};
use darboux_tests::{Case, METHODS, OwnedMesh, compare};

/// FNV-1a of 64 bits, word by word.
struct Hash(u64);

impl Hash {
    fn take(&mut self, word: u32) {
        self.0 = (self.0 ^ u64::from(word)).wrapping_mul(0x0100_0000_01b3);
    }

    /// Every NaN hashes alike, because the bits of NaN differ between processors.
    fn take_float(&mut self, float: f32) {
        self.take(if float.is_nan() { f32::NAN.to_bits() } else { float.to_bits() });
    }

    fn take_frame(&mut self, frame: &Frame) {
        compare::bits(frame).into_iter().for_each(|bits| self.take_float(f32::from_bits(bits)));
    }
}

fn meshes() -> Vec<(OwnedMesh, f32)> {
    (0..3000).map(Case::from_seed).map(|case| (case.mesh, case.threshold)).collect()
}

fn hash(meshes: &[(OwnedMesh, f32)], take: impl Fn(&OwnedMesh, f32, &mut Hash)) -> u64 {
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    meshes.iter().for_each(|(mesh, threshold)| take(mesh, *threshold, &mut hash));
    hash.0
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
    assert_eq!(found, 0xa051_d5c1_9e6c_d260, "{found:#x}");
}

#[test]
fn frames_of_mikktspace_are_the_same() {
    let meshes = meshes();
    let found = [Mode::Reference, Mode::Repaired, Mode::Corrected].map(|mode| {
        hash(&meshes, |mesh, threshold, hash| {
            let options = MikkTSpaceOptions::new().with_mode(mode).with_threshold(threshold);
            let frames = generate_frames(&mesh.view(), &options.into());
            frames.corners.per_corner().iter().for_each(|frame| hash.take_frame(frame));
        })
    });
    let recorded = [0x628d_eff3_4eb8_6058, 0xdde4_0c5c_aa0e_fee8, 0x095b_00d9_e12a_6e3d];
    assert_eq!(found, recorded, "{found:#x?}");
}

#[test]
fn tangents_of_every_method_are_the_same() {
    let meshes = meshes();
    let found = METHODS.iter().map(|&method| {
        hash(&meshes, |mesh, threshold, hash| {
            let method = match method {
                Method::MikkTSpace(options) => options.with_threshold(threshold).into(),
                other => other,
            };
            let tangents = generate_tangents(&mesh.view(), &method.into());
            tangents.corners.per_corner().as_flattened().iter().for_each(|float| hash.take_float(*float));
        })
    });
    let found: Vec<u64> = found.collect();
    let recorded = [
        0xa8c0_af09_4510_12a9,
        0xa229_a664_6a71_2657,
        0x493d_b6fc_812e_e615,
        0xc1f0_8455_cd76_897f,
        0x5f2b_280c_f564_e206,
        0x0e4d_c130_4346_876a,
        0x6ef5_db72_d1f6_7928,
        0x9aa6_bb5b_dbb5_aaba,
        0x4f0f_9813_512e_ae49,
    ];
    assert_eq!(found, recorded, "{found:#x?}");
}

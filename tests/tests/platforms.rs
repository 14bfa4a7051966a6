//! The same bits on every processor: hashes of the results of all methods, recorded on x86-64.
//!
//! Run this on another processor to check it. A change that is meant to change tangents must record new
//! hashes.

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
    assert_eq!(found, 0x7e68_7476_86c8_6d61, "{found:#x}");
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
    let recorded = [0x17ab_08ff_be2e_803d, 0x04ba_89d0_d25e_cd9b, 0xfd9a_0756_5a62_0d29];
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
        0x7922_f029_3bd0_5a7f,
        0x1977_c306_bc5a_4909,
        0x9e55_d9d4_281b_9a29,
        0xa7cd_7806_6c95_13b1,
        0xd44c_3bb1_24f4_83e1,
        0x9019_19b0_6b37_77df,
        0x6850_645c_b5ee_04f4,
        0xa0c3_7caf_c94d_08be,
        0xcda3_4ee7_4dbe_73ac,
    ];
    assert_eq!(found, recorded, "{found:#x?}");
}

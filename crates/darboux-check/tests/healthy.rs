//! Published models, and those of this repository, have no finding of severity error, but for those that are
//! really wrong.
//!
//! Each exception was verified without Darboux: by reading the file, or with a few lines of numpy over its
//! accessors.

use std::path::{Path, PathBuf};

use darboux_check::{CheckOptions, Code, Severity, check_document};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use darboux_tests::models::{further_models, models};

/// A model with errors, the codes, and why they are true.
struct Wrong {
    /// The end of the path.
    model: &'static str,
    codes: &'static [Code],
    /// Why it is really so.
    reason: &'static str,
}

const WRONG: &[Wrong] = &[
    Wrong {
        model: "TwoSidedPlane/TwoSidedPlane.gltf",
        codes: &[Code::TangentSignFlipped],
        reason: "w cross(n, t) points down the image at all 6 corners; glTF wants it to point up",
    },
    Wrong {
        model: "made/shield.glb",
        codes: &[Code::TangentSharedAcrossMirror],
        reason: "25 vertices on the middle line have triangles of both UV orientations, and one tangent",
    },
    Wrong {
        model: "made/degenerate.gltf",
        codes: &[Code::NormalNotUnit],
        reason: "made with a normal of length zero",
    },
    Wrong {
        model: "assimp_bad/BoxBadNormals.glb",
        codes: &[Code::NormalNotUnit],
        reason: "a file of bad input: 8 normals are zero",
    },
    Wrong {
        model: "assimp_bad/BoxWithInfinites.glb",
        codes: &[Code::PositionNotFinite],
        reason: "a file of bad input: its positions are infinite",
    },
    Wrong {
        model: "Material_DoubleSided/Material_DoubleSided_02.gltf",
        codes: &[Code::MapUnreadable],
        reason: "its folder Textures is missing here",
    },
    Wrong {
        model: "Material_DoubleSided/Material_DoubleSided_03.gltf",
        codes: &[Code::MapUnreadable],
        reason: "its folder Textures is missing here",
    },
    Wrong {
        model: "Mesh_PrimitiveAttribute/Mesh_PrimitiveAttribute_04.gltf",
        codes: &[Code::MapUnreadable],
        reason: "its folder Textures is missing here",
    },
    Wrong {
        model: "Mesh_PrimitiveAttribute/Mesh_PrimitiveAttribute_05.gltf",
        codes: &[Code::MapUnreadable],
        reason: "its folder Textures is missing here",
    },
    Wrong {
        model: "Mesh_PrimitiveAttribute/Mesh_PrimitiveAttribute_06.gltf",
        codes: &[Code::MapUnreadable],
        reason: "its folder Textures is missing here",
    },
    Wrong {
        model: "glTF-Validator_tests/base_mesh_primitive_generated_tangent_space.gltf",
        codes: &[Code::NormalNotUnit, Code::TangentZero, Code::TangentSignNotOne],
        reason: "a test of JSON: its accessors have no data, so that all numbers are zero",
    },
    Wrong {
        model: "glTF-Validator_tests/ext_KHR_materials_clearcoat_material_valid_with_tangent.gltf",
        codes: &[Code::NormalNotUnit, Code::TangentZero, Code::TangentSignNotOne],
        reason: "a test of JSON: its accessors have no data, so that all numbers are zero",
    },
];

/// Files that lack a part, so that they do not open.
const INCOMPLETE: &[&str] = &[
    "glTF-Validator_tests/base_mesh_data_index_buffer_degenerate_triangle.gltf",
    "glTF-Validator_tests/base_mesh_data_normals_tangents_non_unit_invalid_sign.gltf",
];

/// The codes of severity error, each once; none for a file that does not open.
fn errors(path: &Path) -> Option<Vec<Code>> {
    let document = Document::open(path, &LoadOptions::default()).ok()?;
    let findings = check_document(&document, &CheckOptions::default()).ok()?;
    let is_error = |severity| severity == Severity::Error;
    let found = findings.iter().filter(|finding| is_error(finding.severity)).map(|finding| finding.code);
    let mut codes: Vec<Code> = found.collect();
    codes.sort();
    codes.dedup();
    Some(codes)
}

/// Every model below a folder has the errors of the list and no others; and no entry is about a model without
/// errors.
fn verify(folder: &Path) {
    let paths = models(folder);
    assert!(!paths.is_empty(), "{} has models", folder.display());
    for path in paths {
        let expected = WRONG.iter().find(|wrong| path.ends_with(wrong.model));
        let codes = expected.map_or(&[][..], |wrong| wrong.codes);
        let mut sorted = codes.to_vec();
        sorted.sort();
        match errors(&path) {
            Some(found) => {
                let why = expected.map_or("should be healthy", |wrong| wrong.reason);
                assert_eq!(found, sorted, "{}: {why}", path.display());
            }
            None => {
                let is_known = INCOMPLETE.iter().any(|known| path.ends_with(known));
                assert!(is_known, "{} does not open", path.display());
            }
        }
    }
}

#[test]
fn models_of_the_repository_have_no_false_errors() {
    verify(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets"));
}

#[test]
#[ignore = "checks maps of 20 million texels: cargo xtask ci --full runs it"]
fn further_models_have_no_false_errors() {
    if let Some(folder) = further_models() {
        verify(&folder);
    }
}

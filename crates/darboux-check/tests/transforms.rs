//! Texture transforms that mirror or turn the normal map: what is right after the transform is not called
//! wrong before it, and nothing is repaired that would then be wrong.

mod support;

use std::f32::consts::{FRAC_PI_2, PI};

use darboux_check::{AssumedMap, CheckOptions, Code, FixOptions, Severity, check_document, fix_document};
use support::models::{Model, healthy_models};

/// Scales and rotations that mirror an axis or turn it by a right angle or more.
const TRANSFORMS: [([f32; 2], f32); 6] = [
    ([1.0, -1.0], 0.0),
    ([-1.0, 1.0], 0.0),
    ([-1.0, -1.0], 0.0),
    ([1.0, 1.0], PI),
    ([2.0, 2.0], FRAC_PI_2),
    ([1.0, -1.0], -FRAC_PI_2),
];

fn with_transform(number: usize, (scale, rotation): ([f32; 2], f32)) -> Model {
    Model { transform: Some(scale), rotation, ..healthy_models().swap_remove(number) }
}

#[test]
fn tangents_of_the_transformed_uvs_are_right_and_kept() {
    for transform in TRANSFORMS {
        // A wavy grid, a sphere and a mirrored grid.
        for number in [9, 6, 18] {
            let mut model = with_transform(number, transform);
            let set = model.uv_set;
            let texture = model.document().materials().expect("materials")[0].normal_texture.clone();
            let texture = texture.expect("a normal texture");
            let before = model.uvs[set].clone();
            model.uvs[set] = before.iter().map(|uv| texture.transform_uv(*uv)).collect();
            model.tangents = Some(model.computed(Default::default(), set));
            model.uvs[set] = before;
            let mut document = model.document();
            let findings = check_document(&document, &CheckOptions::default()).expect("a valid document");
            let about_tangents: Vec<_> = findings
                .iter()
                .filter(|finding| {
                    finding.code.name().starts_with("tangent") && finding.severity > Severity::Info
                })
                .collect();
            assert!(about_tangents.is_empty(), "{transform:?} on {}: {about_tangents:#?}", model.name);
            assert!(findings.iter().any(|finding| finding.code == Code::TransformMirrors), "{findings:#?}");
            let fixed = fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
            assert!(!fixed.is_changed, "{transform:?} on {}: {fixed:#?}", model.name);
        }
    }
}

/// Other flips than those of the transform are still named.
#[test]
fn tangents_that_follow_neither_uvs_are_wrong() {
    let mut model = with_transform(9, ([1.0, -1.0], 0.0));
    model.tangents().iter_mut().for_each(|tangent| (0..3).for_each(|i| tangent[i] = -tangent[i]));
    let findings = check_document(&model.document(), &CheckOptions::default()).expect("a valid document");
    assert!(findings.iter().any(|finding| finding.code == Code::TangentNegated), "{findings:#?}");
}

#[test]
fn inverted_channels_under_a_transform_that_turns_them_are_left() {
    let options = |assumed| CheckOptions::default().with_assumed_map(Some(assumed));
    for transform in TRANSFORMS {
        for (assumed, turn) in [
            (AssumedMap::DirectX, (|[r, g, b]| [r, 1.0 - g, b]) as fn([f32; 3]) -> [f32; 3]),
            (AssumedMap::RedInverted, |[r, g, b]| [1.0 - r, g, b]),
        ] {
            let mut model = with_transform(9, transform);
            model.map = model.map.through(turn);
            let mut document = model.document();
            let findings = check_document(&document, &options(assumed)).expect("a valid document");
            let codes = [Code::MapGreenFlipped, Code::MapRedFlipped];
            let named =
                findings.iter().find(|finding| codes.contains(&finding.code)).expect("an inverted channel");
            assert_eq!(named.severity, Severity::Warning, "{named:#?}");
            let reason = named.left_because.clone().unwrap_or_default();
            assert!(reason.contains("texture transform"), "{reason}");
            let fixing = FixOptions::default().with_check(options(assumed));
            fix_document(&mut document, findings, &fixing).expect("a repair");
            let image = document.image_bytes(0).expect("an image");
            assert!(*image == *model.map.file, "{transform:?}, {assumed:?}: the image was changed");
        }
    }
}

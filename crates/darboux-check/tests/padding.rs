//! Charts whose borders take in a background that is no normal are named, and those with padding are not.

mod support;

use darboux_check::{CheckOptions, Code, Finding, check_document};
use support::models::{Model, healthy_models};
use support::texels::texels_inside;

/// A sheet whose UVs leave an edge of a twentieth of its map free. `times`: how many times each texel of the
/// map is there along both axes.
fn sheet(times: usize) -> Model {
    let mut models = healthy_models().into_iter();
    let mut model = models.find(|model| model.name == "large wavy grid").expect("a model of this name");
    let side = model.map.texels.len().isqrt() * times;
    let at = |i: usize| i / side / times * (side / times) + i % side / times;
    model.map = model.map.with_texels((0..side * side).map(|i| model.map.texels[at(i)]).collect());
    let uvs = &mut model.uvs[model.uv_set];
    // No border lies on a border of blocks.
    uvs.iter_mut().for_each(|uv| *uv = uv.map(|x| 0.0547 + 0.86 * x.clamp(0.0, 1.0)));
    model
}

/// The sheet with another colour around its charts, from a distance in texels on.
fn around(model: &Model, padding: i32, colour: [u8; 3]) -> Model {
    let side = model.map.texels.len().isqrt();
    let uvs = &model.uvs[model.uv_set];
    let mut is_kept = vec![false; side * side];
    for triangle in model.indices.as_chunks::<3>().0 {
        let corners = triangle.map(|vertex| uvs[vertex as usize].map(|x| x * side as f32 - 0.5));
        for (x, y, _) in texels_inside(corners) {
            for (x, y) in (-padding..=padding).flat_map(|i| (-padding..=padding).map(move |j| (x + i, y + j)))
            {
                is_kept[y as usize * side + x as usize] = true;
            }
        }
    }
    let texels = model.map.texels.iter().zip(is_kept);
    let texels = texels.map(|(texel, is_kept)| if is_kept { *texel } else { colour }).collect();
    Model { map: model.map.with_texels(texels), ..model.clone() }
}

fn found(model: &Model) -> Option<Finding> {
    let findings = check_document(&model.document(), &CheckOptions::default()).expect("a valid document");
    findings.into_iter().find(|finding| finding.code == Code::MapPadding)
}

const BLACK: [u8; 3] = [0, 0, 0];

#[test]
fn black_backgrounds_need_padding() {
    let sheet = sheet(1);
    assert_eq!(found(&sheet), None);
    assert!(found(&around(&sheet, 0, BLACK)).is_some());
    assert_eq!(found(&around(&sheet, 3, BLACK)), None);
    // A flat background costs no more than padding does.
    assert_eq!(found(&around(&sheet, 0, [128, 128, 255])), None);
}

#[test]
fn padding_is_compared_with_the_size_of_the_map() {
    let sheet = sheet(8);
    let text = |padding: i32| found(&around(&sheet, padding, BLACK)).map(|finding| finding.text);
    let has = |text: Option<String>, end: &str| text.is_some_and(|text| text.ends_with(end));
    assert!(has(text(0), "they want 4 texels of padding and have fewer than 2"), "{:?}", text(0));
    assert!(has(text(1), "they want 4 texels of padding and have fewer than 4"), "{:?}", text(1));
    assert_eq!(text(5), None);
}

/// UVs that leave the image repeat it, and have no background.
#[test]
fn tiling_maps_have_no_padding() {
    let mut model = around(&sheet(1), 0, BLACK);
    let set = model.uv_set;
    model.uvs[set].iter_mut().for_each(|uv| uv[0] += 0.5);
    assert_eq!(found(&model), None);
}

//! What is said of maps that are no normal maps, or whose channels are in another order, and of mistakes that
//! cancel.

mod support;

use darboux::BitangentDirection;
use darboux_check::{
    CheckOptions, Code, Finding, FixOptions, ReportedFinding, Severity, check_document, check_map, diagnosis,
    fix_map,
};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use support::baked::baked_models;
use support::container::with_json;
use support::maps::{MAP_MISTAKES, Map, healthy_map, png};
use support::models::{Model, healthy_models};

/// A change of a texel.
type Change = fn([u8; 3]) -> [u8; 3];

/// Findings, each with its severity.
type Expected<'a> = &'a [(Code, Severity)];

/// The findings on a map alone that are worth a warning.
fn found(file: &[u8]) -> Vec<Finding> {
    let findings = check_map(file, &CheckOptions::default()).findings;
    findings.into_iter().filter(|finding| finding.severity > Severity::Info).collect()
}

fn codes(findings: &[Finding]) -> Vec<(Code, Severity)> {
    findings.iter().map(|finding| (finding.code, finding.severity)).collect()
}

fn through(map: &Map, change: Change) -> Vec<u8> {
    map.with_texels(map.texels.iter().map(|texel| change(*texel)).collect()).file
}

/// A map whose left half or one island has green inverted: which part contradicts the rest, and no repair of
/// the whole.
#[test]
fn parts_that_contradict_each_other_are_named() {
    for number in 0..2 {
        let mut healthy = healthy_map(number);
        (healthy.case.side, healthy.case.feature) = (512, 30.0);
        let texels = healthy.case.texels(false);
        let codes_of = |is_inverted: &dyn Fn(usize, usize) -> bool| {
            let texel = |(i, &[r, g, b]): (usize, &[u8; 3])| {
                [r, if is_inverted(i % 512, i / 512) { 255 - g } else { g }, b]
            };
            let file = png(&texels.iter().enumerate().map(texel).collect::<Vec<_>>());
            let mut found = found(&file);
            found.retain(|finding| [Code::MapGreenFlipped, Code::MapRedFlipped].contains(&finding.code));
            let fixed = fix_map("map", &file, &LoadOptions::default(), &FixOptions::default());
            assert!(fixed.expect("a map").image.is_none());
            let texts: Vec<String> = found.iter().map(|finding| finding.text.clone()).collect();
            (codes(&found), texts.concat())
        };
        let warning = vec![(Code::MapGreenFlipped, Severity::Warning)];
        assert_eq!(codes_of(&|_, _| false).0, []);
        let (half, text) = codes_of(&|x, _| x < 256);
        assert_eq!(half, warning, "{number}: {text}");
        assert!(text.contains("contradict each other") && text.contains("x 0 to 255, y 0 to 511"), "{text}");
        let (island, text) = codes_of(&|x, y| (256..384).contains(&x) && (128..256).contains(&y));
        assert_eq!(island, warning, "{number}: {text}");
        assert!(
            text.contains("1 is with green down") && text.contains("x 256 to 383, y 128 to 255"),
            "{text}"
        );
        let (rest, text) = codes_of(&|x, y| x >= 128 || y >= 128);
        assert_eq!(rest, warning, "{number}: {text}");
        assert!(text.contains("x 0 to 127, y 0 to 127"), "{text}");
    }
}

/// With half of its contrast, every map has vectors of half the length, whatever else its texels show, and
/// gets them back.
#[test]
fn maps_of_half_the_contrast_are_scaled() {
    for map in (0..6).map(healthy_map) {
        let halved = map.through(|texel| texel.map(|x| 0.5 + 0.5 * (x - 0.5)));
        let findings = found(&halved.file);
        assert_eq!(codes(&findings), [(Code::MapNotUnit, Severity::Warning)], "{findings:#?}");
        let fixed = fix_map("map", &halved.file, &LoadOptions::default(), &FixOptions::default());
        let fixed = fixed.expect("a map").image.expect("a repaired map").to_bytes().expect("a PNG");
        // The code 128 of a flat texel becomes 129: half of the contrast leaves half of the codes.
        assert!(found(&fixed).iter().all(|finding| finding.code == Code::MapFlatOff));
    }
}

/// Of a map without flat parts that leans on purpose, the lengths of the vectors show what was encoded or
/// decoded.
#[test]
fn lengths_show_what_was_encoded_as_srgb() {
    let texel = |i: usize| {
        let (x, y) = ((i % 256) as f32 / 7.0, (i / 256) as f32 / 9.0);
        let vector = [0.14 + 0.35 * x.cos() * y.sin(), 0.1 - 0.35 * x.sin() * y.cos(), 0.9];
        let length = vector.iter().map(|x| x * x).sum::<f32>().sqrt();
        vector.map(|x| ((x / length + 1.0) * 127.5).round() as u8)
    };
    let map = healthy_map(0).with_texels((0..256 * 256).map(texel).collect());
    assert_eq!(codes(&found(&map.file)), []);
    for power in [2.2f32, 1.0 / 2.2] {
        let damaged = map.through(|texel| texel.map(|x| x.powf(power)));
        let findings = found(&damaged.file);
        assert_eq!(codes(&findings), [(Code::MapSrgb, Severity::Error)], "{power}: {findings:#?}");
        let fixed = fix_map("map", &damaged.file, &LoadOptions::default(), &FixOptions::default());
        let fixed = fixed.expect("a map").image.expect("a repaired map").to_bytes().expect("a PNG");
        assert_eq!(codes(&found(&fixed)), []);
    }
}

/// One colour is harmless only where it is that of a flat map.
#[test]
fn maps_of_one_colour_are_wrong_unless_they_are_flat() {
    let not_normal = [(Code::MapNotNormal, Severity::Error)];
    let tilted = [(Code::MapFlatOff, Severity::Error)];
    let cases: [([u8; 3], Expected<'_>); 11] = [
        ([128, 128, 255], &[]),
        ([127, 127, 255], &[]),
        ([127, 128, 254], &[]),
        ([255, 0, 0], &not_normal),
        ([0, 0, 0], &not_normal),
        ([255, 255, 255], &not_normal),
        ([128, 128, 128], &not_normal),
        ([128, 128, 0], &not_normal),
        ([200, 128, 220], &tilted),
        ([128, 190, 240], &tilted),
        ([124, 128, 255], &[(Code::MapFlatOff, Severity::Warning)]),
    ];
    for (texel, expected) in cases {
        let findings = found(&png(&[texel; 64 * 64]));
        assert_eq!(codes(&findings), expected, "{texel:?}: {findings:#?}");
        let names_flat = |finding: &Finding| finding.text.contains("128, 128, 255");
        assert!(findings.iter().all(names_flat), "{texel:?}: {findings:#?}");
    }
}

/// Maps whose blue is elsewhere point along another axis; no one order of the channels is certain, and
/// nothing is repaired.
#[test]
fn channels_in_another_order_are_no_object_space() {
    let orders: [(Change, &str); 4] = [
        (|[r, g, b]| [b, g, r], "--layout bgr"),
        (|[r, g, b]| [b, r, g], "--layout gbr"),
        (|[r, g, b]| [r, b, g], "--layout rbg"),
        (|[r, g, b]| [g, b, r], "--layout brg"),
    ];
    for map in (0..6).map(healthy_map) {
        for (order, cure) in orders {
            let findings = found(&through(&map, order));
            assert_eq!(codes(&findings), [(Code::MapChannelsSwapped, Severity::Error)], "{findings:#?}");
            assert!(findings[0].cure.contains(cure) && !findings[0].is_fixable(), "{cure}: {findings:#?}");
        }
        for invert in [|[r, g, b]: [u8; 3]| [r, g, 255 - b], |texel: [u8; 3]| texel.map(|code| 255 - code)] {
            let findings = found(&through(&map, invert));
            assert_eq!(codes(&findings), [(Code::MapNegativeZ, Severity::Error)], "{findings:#?}");
            assert!(findings[0].text.contains("inverted") && !findings[0].is_fixable(), "{findings:#?}");
        }
    }
}

/// A bluish picture: brightness changes all channels together.
#[test]
fn blue_pictures_are_no_normal_maps() {
    for (scale, seed) in [(9.0f32, 1u32), (17.0, 2), (31.0, 3)] {
        let texel = |i: usize| {
            let (x, y) = ((i % 128) as f32 / scale, (i / 128) as f32 / scale);
            let grain = (i as u32).wrapping_mul(2_654_435_761).wrapping_add(seed) >> 29;
            let light = (x + 0.3 * y).sin() + (1.7 * y - x).sin() + 0.1 * grain as f32;
            [(90.0, 18.0), (125.0, 17.0), (200.0, 20.0)].map(|(mean, gain)| (mean + gain * light) as u8)
        };
        let findings = found(&png(&(0..128 * 128).map(texel).collect::<Vec<_>>()));
        assert_eq!(codes(&findings), [(Code::MapNotNormal, Severity::Error)], "{scale}: {findings:#?}");
    }
}

/// Scaled vectors keep their direction, so those of a darkened map would still lean.
#[test]
fn darkened_maps_are_not_scaled() {
    for map in (0..6).map(healthy_map) {
        let findings = found(&through(&map, |texel| texel.map(|code| code / 4 * 3)));
        let not_unit = findings.iter().find(|finding| finding.code == Code::MapNotUnit);
        let not_unit = not_unit.unwrap_or_else(|| panic!("no finding among {findings:#?}"));
        assert!(!not_unit.is_fixable() && not_unit.text.contains("lean to one side"), "{not_unit:#?}");
        assert!(not_unit.cure.contains("brightness"), "{not_unit:#?}");
    }
}

/// The cure is that of the convention asked for.
#[test]
fn the_cure_is_that_of_the_wanted_convention() {
    let map = healthy_map(0);
    let directx = CheckOptions::default().with_green(BitangentDirection::Down);
    let inverted = through(&map, |[r, g, b]| [r, 255 - g, b]);
    for (file, options, cure) in [
        (&map.file, directx, "--convention directx --fix --assume map=opengl"),
        (&inverted, CheckOptions::default(), "--fix --assume map=directx"),
    ] {
        let findings = check_map(file, &options).findings;
        let green = findings.iter().find(|finding| finding.code == Code::MapGreenFlipped);
        assert!(green.is_some_and(|green| green.cure.contains(cure)), "{cure}: {findings:#?}");
    }
    assert!(check_map(&inverted, &directx).findings.iter().all(|finding| finding.severity == Severity::Info));
}

/// Mistakes that cancel are one finding, and findings that nothing cancels are not.
#[test]
fn mistakes_that_cancel_are_repaired_together_or_not() {
    let check = |model: &support::models::Model| {
        check_document(&model.document(), &CheckOptions::default()).expect("a valid document")
    };
    let says_so = |findings: &[Finding]| -> Vec<Code> {
        let severe = findings.iter().filter(|finding| finding.severity > Severity::Info);
        severe.map(|finding| finding.code).filter(|code| *code == Code::ConventionsCancel).collect()
    };
    let mut model = healthy_models().remove(9);
    model.map = model.map.through(|[r, g, b]| [r, 1.0 - g, b]);
    assert_eq!(says_so(&check(&model)), []);
    model.negate_signs();
    assert_eq!(says_so(&check(&model)), [Code::ConventionsCancel]);

    let mut model = baked_models().remove(0);
    model.map = model.map.through(|[r, g, b]| [1.0 - r, g, b]);
    model.tangents().iter_mut().for_each(|tangent| (0..4).for_each(|i| tangent[i] = -tangent[i]));
    assert_eq!(says_so(&check(&model)), [Code::ConventionsCancel], "{:#?}", check(&model));
    model.map = model.map.through(|[r, g, b]| [r, 1.0 - g, b]);
    assert_eq!(says_so(&check(&model)), []);
    model.negate_signs();
    assert_eq!(says_so(&check(&model)), [Code::ConventionsCancel]);
}

/// An eighth of a map has relief, and the rest faint detail with green inverted: the verdict is that of the
/// relief, and nothing is repaired.
#[test]
fn detail_of_another_convention_is_named() {
    const SIDE: usize = 512;
    let texel = |i: usize| {
        let (column, row) = ((i % SIDE) as f32, (i / SIDE) as f32);
        let is_relief = row >= (SIDE / 8 * 7) as f32;
        let (scale, slope, green) = if is_relief { (6.0, 0.5, 1.0) } else { (1.9, 0.02, -1.0) };
        let (x, y) = (column / scale, row / scale);
        let vector = [-slope * x.cos() * y.sin(), green * slope * x.sin() * y.cos(), 1.0];
        let length = vector.iter().map(|x| x * x).sum::<f32>().sqrt();
        vector.map(|x| ((x / length + 1.0) * 127.5).round() as u8)
    };
    let file = png(&(0..SIDE * SIDE).map(texel).collect::<Vec<_>>());
    let findings = check_map(&file, &CheckOptions::default()).findings;
    let detail = findings.iter().find(|finding| finding.code == Code::MapDetailFlipped);
    assert!(
        detail.is_some_and(|detail| detail.text.contains("its relief is with green up")),
        "{findings:#?}"
    );
    let fixed = fix_map("map", &file, &LoadOptions::default(), &FixOptions::default());
    assert!(fixed.expect("a map").image.is_none());
}

/// A map in WebP, which the texture names in EXT_texture_webp only: its texels are judged as those of a PNG
/// are.
#[test]
fn maps_of_the_extension_for_webp_are_judged() {
    let mut model = healthy_models().remove(9);
    let named = |model: &Model, is_inverted: bool| {
        let texel = |&[r, g, b]: &[u8; 3]| [r, if is_inverted { 255 - g } else { g }, b];
        let texels: Vec<[u8; 3]> = model.map.texels.iter().map(texel).collect();
        let side = texels.len().isqrt() as u32;
        let mut file = Vec::new();
        let encoder = image_webp::WebPEncoder::new(&mut file);
        encoder.encode(texels.as_flattened(), side, side, image_webp::ColorType::Rgb8).expect("an image");
        let model = Model { map: Map { file, ..model.map.clone() }, ..model.clone() };
        let glb = with_json(&model.glb(), |json| {
            json["images"][0]["mimeType"] = "image/webp".into();
            json["extensionsUsed"] = serde_json::json!(["EXT_texture_webp"]);
            json["textures"][0] = serde_json::json!({"extensions": {"EXT_texture_webp": {"source": 0}}});
        });
        let document = Document::from_bytes("webp", glb, None, &LoadOptions::default()).expect("a valid GLB");
        let findings = check_document(&document, &CheckOptions::default()).expect("a valid document");
        codes(&findings.into_iter().filter(|found| found.severity > Severity::Info).collect::<Vec<_>>())
    };
    assert_eq!(named(&model, false), []);
    assert_eq!(named(&model, true), [(Code::MapGreenFlipped, Severity::Error)]);
    model.map = model.map.through(|[r, ..]| [r; 3]);
    assert_eq!(named(&model, false), [(Code::MapHeight, Severity::Error)]);
}

/// A map of steep diagonal grooves, resized without normalising: each vector is the mean of four, most are
/// shorter than 0.9, and red and green are light and dark together, as in pictures. All can be normals.
#[test]
fn shortened_vectors_are_no_picture() {
    let side = 256;
    let vector = |x: usize, y: usize| {
        let (along, across) = (x as f32 - y as f32, (x + y) as f32);
        let lean = 1.5 * ((1.5 * along).sin() + (0.43 * along).sin());
        let across = 0.35 * (0.9 * across).sin();
        let vector = [lean + across, lean - across, 1.0];
        let length = vector.iter().map(|x| x * x).sum::<f32>().sqrt();
        vector.map(|x| x / length)
    };
    let texel = |i: usize| {
        let (x, y) = (i % side * 2, i / side * 2);
        let four = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(x, y)| vector(x, y));
        [0, 1, 2].map(|c| (127.5 + 127.5 * four.iter().map(|v| v[c]).sum::<f32>() / 4.0).round() as u8)
    };
    let texels: Vec<[u8; 3]> = (0..side * side).map(texel).collect();
    let [red, green] = [0, 1].map(|c| texels.iter().map(|texel| f64::from(texel[c])).collect::<Vec<_>>());
    assert!(correlation(&red, &green) > 0.8);
    let found = found(&png(&texels));
    assert!(found.iter().any(|finding| finding.code == Code::MapNotUnit), "{found:#?}");
    assert!(!found.iter().any(|finding| finding.code == Code::MapNotNormal), "{found:#?}");
    // With half the brightness of blue, as a photograph of the grooves has, they are none.
    let picture: Vec<[u8; 3]> = texels.iter().map(|[r, g, b]| [*r, *g, b / 3]).collect();
    let found = self::found(&png(&picture));
    assert!(found.iter().any(|finding| finding.code == Code::MapNotNormal), "{found:#?}");
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let product =
        |a: &[f64], b: &[f64], [x, y]: [f64; 2]| a.iter().zip(b).map(|(a, b)| (a - x) * (b - y)).sum::<f64>();
    let squares = product(a, a, [mean_a; 2]) * product(b, b, [mean_b; 2]);
    product(a, b, [mean_a, mean_b]) / squares.sqrt()
}

/// Without z, a map whose blue is 255 is read as gentler slopes: hardly gentler, visibly, or much. One whose
/// blue is 0 or 128 is wrong everywhere.
#[test]
fn maps_without_z_are_as_severe_as_their_error() {
    let map = |slope: f32, blue: u8| {
        let mut healthy = healthy_map(0);
        healthy.case.slope = slope;
        let texels: Vec<[u8; 3]> =
            healthy.case.texels(false).iter().map(|[r, g, _]| [*r, *g, blue]).collect();
        let findings = check_map(&png(&texels), &CheckOptions::default()).findings;
        let found = findings.into_iter().find(|finding| finding.code == Code::MapTwoChannel);
        let found = found.unwrap_or_else(|| panic!("slope {slope}, blue {blue}"));
        let degrees = found.evidence.iter().find(|number| number.unit == "degrees").expect("an angle").value;
        (found.severity, degrees)
    };
    let (gentle, degrees) = map(0.15, 255);
    assert!(gentle == Severity::Info && degrees < 1.5, "{gentle} {degrees}");
    let (visible, degrees) = map(0.4, 255);
    assert!(visible == Severity::Warning && (1.5..8.0).contains(&degrees), "{visible} {degrees}");
    let (steep, degrees) = map(2.0, 255);
    assert!(steep == Severity::Error && degrees > 8.0, "{steep} {degrees}");
    for blue in [0, 128] {
        let (severity, degrees) = map(0.15, blue);
        assert!(severity == Severity::Error && degrees > 30.0, "{severity} {degrees}");
    }
}

/// A strong compression moves flat texels, too: it comes first in the diagnosis.
#[test]
fn compression_leads_the_diagnosis() {
    let mistake = MAP_MISTAKES.iter().find(|mistake| mistake.code == Code::MapBlocks).expect("blocks");
    let map = (mistake.make)(&healthy_map(0));
    let mut texels = map.texels.clone();
    let length = texels.len();
    texels[..length / 4].fill([123, 124, 255]);
    let findings = check_map(&png(&texels), &CheckOptions::default()).findings;
    let has = |code: Code, severity: Severity| {
        findings.iter().any(|finding| (finding.code, finding.severity) == (code, severity))
    };
    let warning = Severity::Warning;
    assert!(has(Code::MapBlocks, warning) && has(Code::MapFlatOff, warning), "{findings:#?}");
    let reported: Vec<ReportedFinding> = findings.into_iter().map(Into::into).collect();
    let sentence = diagnosis(&reported, &CheckOptions::default());
    assert!(sentence.starts_with("the image: a compression in blocks of 8 x 8 texels"), "{sentence}");
}

/// Where DirectX's convention is expected, an OpenGL map is the other one, in every sentence.
#[test]
fn the_diagnosis_is_about_the_wanted_convention() {
    let options = CheckOptions::default().with_green(BitangentDirection::Down);
    let findings = check_map(&healthy_map(0).file, &options).findings;
    let reasons: Vec<&str> = findings.iter().filter_map(|finding| finding.left_because.as_deref()).collect();
    assert!(reasons.iter().any(|reason| reason.contains("`--assume map=both-inverted`")), "{reasons:?}");
    let reported: Vec<ReportedFinding> = findings.into_iter().map(Into::into).collect();
    let sentence = diagnosis(&reported, &options);
    for part in [
        "it is in the convention of OpenGL",
        "an OpenGL map was put into a project that wants DirectX's",
        "`darboux check FILE --convention directx --fix --assume map=opengl`",
        "Green of normal maps was expected to point down (DirectX).",
    ] {
        assert!(sentence.contains(part), "{part}: {sentence}");
    }
}

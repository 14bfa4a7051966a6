//! Conventions: conversion between every pair of presets, compared with a triangle that is defined in each of
//! them.

use darboux::internal::vectors::single::{cross, dot};
use darboux::{
    Axes, Axis, BitangentDirection, Convention, ConventionError, Handedness, Mesh, SignRule,
    TangentDirection, TangentOptions, UvOrigin, Winding, generate_tangents,
};

/// A triangle's corners as a viewer in front of the model sees it: to the model's right, up, to the front;
/// and in the picture: to the right, up, from the lower left.
struct Corner {
    place: [f32; 3],
    picture: [f32; 2],
}

/// Counter-clockwise to a viewer in front. That viewer sees the model's right on the left.
const TRIANGLE: [Corner; 3] = [
    Corner { place: [0.5, 1.0, 2.0], picture: [0.25, 0.125] },
    Corner { place: [-1.5, 1.0, 2.0], picture: [0.75, 0.125] },
    Corner { place: [0.5, 3.0, 2.0], picture: [0.25, 0.875] },
];

/// The triangle, and the same with its picture mirrored.
fn triangles() -> [Vec<Corner>; 2] {
    let mirrored = |&Corner { place, picture: [u, v] }: &Corner| Corner { place, picture: [1.0 - u, v] };
    let plain = |&Corner { place, picture }: &Corner| Corner { place, picture };
    [TRIANGLE.iter().map(plain).collect(), TRIANGLE.iter().map(mirrored).collect()]
}

/// The values of a triangle in a file of one convention.
#[derive(Clone, Debug, PartialEq)]
struct Written {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    tangents: Vec<[f32; 4]>,
    indices: Vec<u32>,
}

fn component(axis: Axis) -> (usize, f32) {
    match axis {
        Axis::X => (0, 1.0),
        Axis::MinusX => (0, -1.0),
        Axis::Y => (1, 1.0),
        Axis::MinusY => (1, -1.0),
        Axis::Z => (2, 1.0),
        Axis::MinusZ => (2, -1.0),
    }
}

/// The coordinates of a point at given distances to the model's right, up and front.
fn coordinates(axes: Axes, place: [f32; 3]) -> [f32; 3] {
    let mut out = [0.0; 3];
    for (axis, length) in [axes.right(), axes.up(), axes.front()].into_iter().zip(place) {
        let (index, sign) = component(axis);
        out[index] = sign * length;
    }
    out
}

fn rebuilt(convention: Convention, normal: [f32; 3], [x, y, z, w]: [f32; 4]) -> [f32; 3] {
    let across = match convention.sign {
        SignRule::NormalCrossTangent => cross(normal, [x, y, z]),
        SignRule::TangentCrossNormal => cross([x, y, z], normal),
    };
    across.map(|component| w * component)
}

/// The triangle in `convention`, from the definitions alone.
fn written(convention: Convention, triangle: &[Corner]) -> Written {
    let in_space = |place| coordinates(convention.axes, place);
    let normal = in_space([0.0, 0.0, 1.0]);
    let right_in_picture =
        if triangle[1].picture[0] > triangle[0].picture[0] { [-1.0, 0.0, 0.0] } else { [1.0, 0.0, 0.0] };
    let tangent = in_space(match convention.tangent {
        TangentDirection::Right => right_in_picture,
        TangentDirection::Left => right_in_picture.map(|x: f32| -x),
    });
    let bitangent = in_space(match convention.bitangent {
        BitangentDirection::Up => [0.0, 1.0, 0.0],
        BitangentDirection::Down => [0.0, -1.0, 0.0],
    });
    let [x, y, z] = tangent;
    let w = dot(bitangent, rebuilt(convention, normal, [x, y, z, 1.0]));
    Written {
        positions: triangle.iter().map(|corner| in_space(corner.place)).collect(),
        normals: vec![normal; 3],
        uvs: triangle
            .iter()
            .map(|&Corner { picture: [u, v], .. }| match convention.uv_origin {
                UvOrigin::BottomLeft => [u, v],
                UvOrigin::TopLeft => [u, 1.0 - v],
            })
            .collect(),
        tangents: vec![[x, y, z, w]; 3],
        indices: match convention.winding {
            Winding::CounterClockwise => vec![0, 1, 2],
            Winding::Clockwise => vec![0, 2, 1],
        },
    }
}

fn converted(written: &Written, from: Convention, to: Convention) -> Written {
    let conversion = from.to(to);
    let mut indices = written.indices.clone();
    indices.chunks_exact_mut(3).for_each(|face| conversion.face(face));
    Written {
        positions: written.positions.iter().map(|&p| conversion.vector(p)).collect(),
        normals: written.normals.iter().map(|&n| conversion.vector(n)).collect(),
        uvs: written.uvs.iter().map(|&uv| conversion.uv(uv)).collect(),
        tangents: written.tangents.iter().map(|&t| conversion.tangent(t)).collect(),
        indices,
    }
}

/// The presets, and conventions that differ from all of them.
fn conventions() -> Vec<(String, Convention)> {
    let mut conventions: Vec<_> =
        Convention::PRESETS.into_iter().map(|(name, convention)| (name.to_owned(), convention)).collect();
    for (name, preset) in Convention::PRESETS {
        let left = Convention { tangent: TangentDirection::Left, ..preset };
        conventions.push((format!("{name}, red to the left"), left));
        let other = Convention { sign: SignRule::TangentCrossNormal, ..preset };
        conventions.push((format!("{name}, the other sign"), other));
    }
    conventions
}

#[test]
fn every_conversion_gives_what_the_other_convention_would_have_written() {
    for triangle in triangles() {
        for (from_name, from) in conventions() {
            for (to_name, to) in conventions() {
                let result = converted(&written(from, &triangle), from, to);
                assert_eq!(result, written(to, &triangle), "{from_name} to {to_name}");
            }
        }
    }
}

#[test]
fn there_and_back_keeps_the_bits() {
    let value = |i: u32| f32::from_bits(i.wrapping_mul(0x9E37_79B9) & 0xBFFF_FFFF);
    let uv = |i: u32| [value(i), (i.wrapping_mul(0x9E37_79B9) >> 8) as f32 / 16_777_216.0];
    for (from_name, from) in conventions() {
        for (to_name, to) in conventions() {
            let (there, back) = (from.to(to), to.to(from));
            for i in 0..1000 {
                let tangent = [value(4 * i), value(4 * i + 1), value(4 * i + 2), value(4 * i + 3)];
                let bits = |tangent: [f32; 4]| tangent.map(f32::to_bits);
                let returned = back.tangent(there.tangent(tangent));
                assert_eq!(bits(returned), bits(tangent), "{from_name} to {to_name}");
                let [x, y, z, _] = tangent;
                let returned = back.vector(there.vector([x, y, z]));
                assert_eq!(returned.map(f32::to_bits), [x, y, z].map(f32::to_bits));
                assert_eq!(back.uv(there.uv(uv(i))), uv(i), "{from_name} to {to_name}");
            }
            let mut face = [7, 8, 9, 10, 11];
            there.face(&mut face);
            assert_eq!(face[0], 7);
            back.face(&mut face);
            assert_eq!(face, [7, 8, 9, 10, 11]);
        }
    }
}

#[test]
fn generated_tangents_mean_what_their_convention_says() {
    for triangle in triangles() {
        for (name, convention) in conventions() {
            let file = written(convention, &triangle);
            let mesh = Mesh::triangles(&file.positions, &file.normals, &file.uvs, &file.indices).unwrap();
            let tangents = generate_tangents(&mesh, &TangentOptions::default()).corners;
            let tangents = tangents.converted(convention.generated(), convention);
            assert_eq!(tangents.per_corner(), file.tangents, "{name}");
        }
    }
}

#[test]
fn presets_stand_as_their_sources_say() {
    let stands = |convention: Convention| (convention.axes.handedness(), convention.axes.up());
    for (name, convention) in Convention::PRESETS {
        let expected = match name {
            "unity" | "directx" => (Handedness::Left, Axis::Y),
            "unreal" => (Handedness::Left, Axis::Z),
            "blender" | "3dsmax" => (Handedness::Right, Axis::Z),
            _ => (Handedness::Right, Axis::Y),
        };
        assert_eq!(stands(convention), expected, "{name}");
    }
}

#[test]
fn well_known_conversions() {
    let point = [1.0, 2.0, 3.0];
    let to = |to: Convention| Convention::GLTF.to(to);
    // Importers of glTF: Unity's negate x and reverse faces; Blender's swap y and z and negate one.
    assert_eq!(to(Convention::UNITY).vector(point), [-1.0, 2.0, 3.0]);
    assert_eq!(to(Convention::UNITY).tangent([0.0, 0.0, 1.0, 1.0]), [0.0, 0.0, 1.0, -1.0]);
    assert_eq!(to(Convention::BLENDER).vector(point), [1.0, -3.0, 2.0]);
    assert_eq!(to(Convention::BLENDER).tangent([1.0, 0.0, 0.0, 1.0]), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(to(Convention::UNREAL).vector(point), [3.0, -1.0, 2.0]);
    assert!(to(Convention::UNREAL).inverts_green() && !to(Convention::UNREAL).inverts_red());
    // glTF's signs are those of MikkTSpace negated.
    let from_generated = Convention::GLTF.generated().to(Convention::GLTF);
    assert_eq!(from_generated.tangent([1.0, 0.0, 0.0, 1.0]), [1.0, 0.0, 0.0, -1.0]);
    assert_eq!(Convention::BLENDER.generated(), Convention::BLENDER);
}

#[test]
fn axes_must_differ() {
    assert_eq!(Axes::new(Axis::X, Axis::MinusX, Axis::Z), None);
    assert_eq!(Axes::new(Axis::X, Axis::Y, Axis::Y), None);
    assert_eq!(Axes::new(Axis::Z, Axis::Y, Axis::MinusZ), None);
}

/// Every convention: 48 systems of axes, and both values of every other choice.
fn all_conventions() -> Vec<Convention> {
    let axes = [Axis::X, Axis::MinusX, Axis::Y, Axis::MinusY, Axis::Z, Axis::MinusZ];
    let triples = axes.into_iter().flat_map(|a| axes.into_iter().flat_map(move |b| axes.map(|c| [a, b, c])));
    let stands: Vec<Axes> = triples.filter_map(|[right, up, front]| Axes::new(right, up, front)).collect();
    let choose = |bits: usize, axes: Axes| Convention {
        axes,
        winding: [Winding::CounterClockwise, Winding::Clockwise][bits & 1],
        uv_origin: [UvOrigin::BottomLeft, UvOrigin::TopLeft][bits >> 1 & 1],
        tangent: [TangentDirection::Right, TangentDirection::Left][bits >> 2 & 1],
        bitangent: [BitangentDirection::Up, BitangentDirection::Down][bits >> 3 & 1],
        sign: [SignRule::NormalCrossTangent, SignRule::TangentCrossNormal][bits >> 4],
    };
    (0..32).flat_map(|bits| stands.iter().map(move |&axes| choose(bits, axes))).collect()
}

#[test]
fn every_convention_can_be_written_and_read() {
    let all = all_conventions();
    assert_eq!(all.len(), 48 * 32);
    for convention in all {
        let text = convention.to_string();
        assert_eq!(text.parse(), Ok(convention), "{text}");
    }
    for (name, preset) in Convention::PRESETS {
        assert_eq!(name.parse(), Ok(preset));
        assert!(preset.names().any(|other| other == name));
    }
    let green_down = Convention { bitangent: BitangentDirection::Down, ..Convention::GLTF };
    assert_eq!(green_down.to_string(), "gltf,green=down");
    assert_eq!("directx,green=up,axes=x/z/y".parse().map(|it: Convention| it.axes.up()), Ok(Axis::Z));
}

#[test]
fn invalid_conventions_have_clear_errors() {
    let sentence =
        |text: &str| text.parse::<Convention>().map_err(|error: ConventionError| error.to_string());
    let cases = [
        ("quake", "\"quake\" is not a convention; begin with one of gltf, "),
        ("", "\"\" is not a convention"),
        ("gltf,blue=up", "\"blue=up\" is not a change; write CHOICE=VALUE with one of axes, fronts, "),
        ("gltf,", "\"\" is not a change"),
        ("gltf,green=left", "green cannot be \"left\"; write up or down"),
        ("gltf,axes=x/-x/z", "axes cannot be \"x/-x/z\"; write right, up and front as in -x/y/z"),
        ("gltf,axes=x/y/z/z", "axes cannot be"),
    ];
    for (text, start) in cases {
        let found = sentence(text).expect_err("no convention");
        assert!(found.starts_with(start), "{found}");
    }
}

//! Maps with a relief of their own on every face: studs, rivets and dents on boxes and spheres, which no face
//! of the mesh was baked into. Their texels lean with the faces or against them, and that must invert
//! nothing.

mod support;

use darboux::{BitangentDirection, Choice};
use darboux_check::{AssumedMap, CheckOptions, Code, FixOptions, Severity, check_document, fix_document};
use darboux_tests::{OwnedMesh, families};
use support::maps::{Map, healthy_map};
use support::models::Model;
use support::table::rgb;

/// Texels per row and column.
const SIDE: usize = 240;

/// Cells along each side of the map, with one face each.
const CELLS: usize = 15;

/// A face: its corners in order, and their normals.
type Quad = [([f32; 3], [f32; 3]); 4];

/// Boxes of different sizes with rounded normals, as beveled crates have them.
fn boxes() -> Vec<Quad> {
    let mut quads = Vec::new();
    for number in 0..CELLS * CELLS / 6 {
        let part = |of: usize| 0.4 + 0.6 * ((number * of) % 7) as f32 / 7.0;
        let size = [part(1), part(2), part(4)];
        let place = [3.0 * (number % 6) as f32, 3.0 * (number / 6) as f32, 0.0];
        for axis in 0..3 {
            for side in [-1.0f32, 1.0] {
                let corner = |a: f32, b: f32| {
                    let mut sign = [side; 3];
                    (sign[(axis + 1) % 3], sign[(axis + 2) % 3]) = (a * side, b);
                    let position = [0, 1, 2].map(|i| place[i] + size[i] * sign[i]);
                    (position, sign.map(|x| x / 3f32.sqrt()))
                };
                quads.push([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
            }
        }
    }
    quads
}

/// The quads of a closed strip around the z axis. `ring`: the distance from the axis and the height at a part
/// of the way from top to bottom, and their changes on the way.
fn lathe(ring: impl Fn(f32) -> [[f32; 2]; 2]) -> Vec<Quad> {
    let corner = |row: usize, column: usize| {
        let around = std::f32::consts::TAU * (column % CELLS) as f32 / CELLS as f32;
        let [[radius, height], [wider, higher]] = ring(row as f32 / CELLS as f32);
        let at = |radius: f32, height: f32| [radius * around.cos(), radius * around.sin(), height];
        let length = wider.hypot(higher);
        (at(radius, height), at(-higher / length, wider / length))
    };
    let quad = |number: usize| {
        let (row, column) = (number / CELLS, number % CELLS);
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| corner(row + i, column + j))
    };
    (0..CELLS * CELLS).map(quad).collect()
}

/// Most of an ellipsoid without its poles.
fn ball(height: f32) -> Vec<Quad> {
    lathe(|part| {
        let (sin, cos) = (0.2 + 2.7 * part).sin_cos();
        [[sin, height * cos], [cos, -height * sin]]
    })
}

/// A mesh of quads, each with a cell of the map of its own.
fn mesh(quads: &[Quad]) -> OwnedMesh {
    let mut mesh = families::sphere(4, 4, false);
    (mesh.positions, mesh.normals, mesh.uvs) = (Vec::new(), Vec::new(), Vec::new());
    let mut indices = Vec::new();
    for (number, quad) in quads.iter().enumerate() {
        let first = mesh.positions.len() as u32;
        for ((position, normal), [i, j]) in quad.iter().zip([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        {
            let cell = [number % CELLS, number / CELLS];
            mesh.positions.push(*position);
            mesh.normals.push(*normal);
            mesh.uvs.push([0, 1].map(|axis| (cell[axis] as f32 + 0.03 + 0.94 * [i, j][axis]) / CELLS as f32));
        }
        indices.extend([0, 2, 1, 0, 3, 2].map(|corner| first + corner));
    }
    mesh.indices = Some(indices);
    mesh
}

/// The shape of what lies in the middle of a face: the slope away from the middle, where 1 is the border of
/// the cell.
type Profile = fn(f32) -> f32;

const PROFILES: [(&str, Profile); 2] = [
    ("studs", |r| if (0.5..0.75).contains(&r) { 1.2 } else { 0.0 }),
    ("low domes", |r| if r < 0.9 { 0.35 * r } else { 0.0 }),
];

/// A map with one bump per cell; `height` is negative for dents.
fn relief(map: &Map, profile: Profile, height: f32) -> Map {
    let texel = |at: usize| {
        let own = |place: usize| {
            let here = (place as f32 + 0.5) * CELLS as f32 / SIDE as f32;
            2.0 * here.fract() - 1.0
        };
        let [x, y] = [own(at % SIDE), own(at / SIDE)];
        let r = x.hypot(y);
        let slope = height * profile(r) / r.max(1e-3);
        // Outwards of a bump; rows go down, and green goes up.
        let vector = [slope * x, -slope * y, 1.0];
        let length = vector.iter().map(|x| x * x).sum::<f32>().sqrt();
        vector.map(|x| (127.5 + 127.5 * x / length).round() as u8)
    };
    map.with_texels((0..SIDE * SIDE).map(texel).collect())
}

#[test]
fn reliefs_that_lie_on_faces_are_never_turned_over() {
    let turns: [fn([u8; 3]) -> [u8; 3]; 4] = [
        |texel| texel,
        |[r, g, b]| [r, 255 - g, b],
        |[r, g, b]| [255 - r, g, b],
        |[r, g, b]| [255 - r, 255 - g, b],
    ];
    let mut failures = Vec::new();
    let shapes = [("boxes", boxes()), ("a ball", ball(1.0)), ("a lens", ball(0.4))];
    for (shape, quads) in shapes {
        let mut model = Model::new(0, shape, mesh(&quads));
        for (name, profile) in PROFILES {
            for (kind, height) in [("raised", 1.0), ("sunken", -1.0)] {
                let healthy = relief(&healthy_map(0), profile, height);
                for (number, turn) in turns.iter().enumerate() {
                    let made: Vec<[u8; 3]> = healthy.texels.iter().copied().map(turn).collect();
                    model.map = healthy.with_texels(made.clone());
                    let what = format!("{kind} {name} on {shape}, turn {number}");
                    let mut document = model.document();
                    let findings =
                        check_document(&document, &CheckOptions::default()).expect("a valid document");
                    let about_channels =
                        [Code::MapGreenFlipped, Code::MapRedFlipped, Code::MapChannelsSwapped];
                    let named = findings.iter().find(|finding| {
                        finding.severity > Severity::Info && about_channels.contains(&finding.code)
                    });
                    if let (0, Some(finding)) = (number, named) {
                        failures.push(format!("{what}: {}: {}", finding.code, finding.text));
                    }
                    // A map that leans against the faces is named as what it may be.
                    let may_be_dents = findings.iter().any(|finding| finding.code == Code::MapMayBeDents);
                    let should = (kind, number) == ("raised", 0) || (kind, number) == ("sunken", 3);
                    if name == "low domes" && may_be_dents != should {
                        failures.push(format!("{what}: map-may-be-dents: {may_be_dents}"));
                    }
                    fix_document(&mut document, findings, &FixOptions::default()).expect("a repair");
                    let after = rgb(&document.image_bytes(0).expect("an image"));
                    if after != made && after != healthy.texels {
                        failures.push(format!("{what}: a wrong repair"));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// A map that may be one of dents names what the user can say so that it fits the convention that is wanted.
#[test]
fn what_may_be_dents_is_turned_over_on_request() {
    let healthy = relief(&healthy_map(0), PROFILES[1].1, 1.0);
    let mut model = Model::new(0, "boxes", mesh(&boxes()));
    for (wanted, both, right) in [
        (BitangentDirection::Up, AssumedMap::BothInverted, AssumedMap::OpenGl),
        (BitangentDirection::Down, AssumedMap::RedInverted, AssumedMap::DirectX),
    ] {
        let is_down = wanted == BitangentDirection::Down;
        let turn = |[r, g, b]: [u8; 3]| [r, if is_down { 255 - g } else { g }, b];
        let texels: Vec<[u8; 3]> = healthy.texels.iter().copied().map(turn).collect();
        model.map = healthy.with_texels(texels.clone());
        let options = CheckOptions::default().with_green(wanted);
        let findings = check_document(&model.document(), &options).expect("a valid document");
        let found = findings.iter().find(|finding| finding.code == Code::MapMayBeDents).expect("dents");
        let reason = found.left_because.as_deref().expect("a reason");
        let [say_both, say_right] = [both, right].map(|assumed| format!("--assume map={}`", assumed.name()));
        assert!(reason.contains(&say_both) && reason.contains(&say_right), "{reason}");
        assert!(found.cure.contains(&say_both), "{}", found.cure);
        assert_eq!(found.cure.contains("--convention directx"), is_down, "{}", found.cure);
        for assumed in [both, right] {
            let mut document = model.document();
            let options = FixOptions::default().with_check(options.with_assumed_map(Some(assumed)));
            let findings = check_document(&document, &options.check).expect("a valid document");
            fix_document(&mut document, findings, &options).expect("a repair");
            let after = rgb(&document.image_bytes(0).expect("an image"));
            let turned_over = texels.iter().map(|[r, g, b]| [255 - r, 255 - g, *b]).collect();
            assert!(after == if assumed == both { turned_over } else { texels.clone() }, "{assumed:?}");
        }
    }
}

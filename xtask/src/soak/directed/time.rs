//! Small files that ask for much time.

use std::f32::consts::PI;

use crate::soak::case::{Case, Make};
use crate::soak::inputs::model::Mesh;
use crate::soak::random::Random;

pub const CASES: &[(&str, Make)] = &[
    ("a fan with random turns", |random| Ok(fan(random, 200_000, "180"))),
    // Below 180 degrees the time grows with the square of the size, as docs/security.md says.
    ("a fan with a threshold", |random| Ok(fan(random, 20_000, "90"))),
];

pub const OF_PICTURES: &[(&str, Make)] = &[
    ("an OBJ that names one library often", |random| Ok(libraries(random))),
    ("many repetitions of a texture", |random| Ok(repetitions(random))),
];

/// Triangles around one vertex whose directions of U turn at random.
fn fan(random: &mut Random, count: u32, threshold: &'static str) -> Case {
    let mut mesh = Mesh { positions: vec![[0.0; 3]], uvs: vec![[0.0; 2]], ..Mesh::default() };
    let mut turn = 0.0f32;
    for i in 0..count {
        let angle = 2.0 * PI * i as f32 / count as f32;
        mesh.positions.push([angle.cos(), angle.sin(), 0.0]);
        mesh.uvs.push([turn.cos(), turn.sin()]);
        turn += random.fraction() * PI * 0.94;
    }
    mesh.normals = vec![[0.0, 0.0, 1.0]; mesh.positions.len()];
    mesh.indices = (1..count).flat_map(|i| [0, i, i + 1]).collect();
    Case::new(["tangents", "fan.glb", "--threshold", threshold]).file("fan.glb", mesh.glb()).expects(&[0], "")
}

fn libraries(random: &mut Random) -> Case {
    let model = format!(
        "{}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "mtllib a.mtl\n".repeat(10_000 + random.below(10_000))
    );
    let library = format!("newmtl a\n{}", "map_Kd x.png\n".repeat(1000));
    Case::new(["render", "a.obj", "-o", "picture.png", "--size", "64x48"])
        .file("a.obj", model)
        .file("a.mtl", library)
}

fn repetitions(random: &mut Random) -> Case {
    let size = random.pick(&[100.0, 10_000.0, 65_535.0]);
    Case::new(["render", "square.glb", "-o", "picture.png", "--size", "256x256"])
        .file("square.glb", Mesh::square(size).glb())
        .expects(&[0], "")
}

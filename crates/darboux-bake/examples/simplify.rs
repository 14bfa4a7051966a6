//! Makes a low model of a high one by meshoptimizer: `cargo run --release --package darboux-bake --example
//! simplify -- HIGH SHARE LOW.glb`.
//!
//! SHARE is the part of the triangles that stays, such as 0.05. The vertices, UVs and materials stay as they
//! are, so that the low model shares the high one's textures; its tangents are made again, and the normal map
//! is left out, because it was made for other triangles.

use std::path::Path;

use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use darboux_io::{LoadOptions, SaveOptions};
use meshopt::{SimplifyOptions, simplify_decoder};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [high, share, low] = &arguments[..] else { return Err("usage: simplify HIGH SHARE LOW.glb".into()) };
    let share: f64 = share.parse()?;
    let mut document = Document::open(Path::new(high), &LoadOptions::default())?;
    let mut simplified = Vec::new();
    for corners in document.corners()?.iter().filter(|corners| !corners.is_empty()) {
        let name = corners.name().clone();
        let attributes = &document.meshes()[name.mesh].primitives[name.primitive].attributes;
        let positions = document.vectors::<3>(attributes["POSITION"])?;
        let target = 3 * (share * (corners.len() / 3) as f64) as usize;
        let options = SimplifyOptions::empty();
        let indices = simplify_decoder(corners.vertices(), &positions, target, 0.1, options, None);
        println!("{}: {} triangles of {}", name.path(), indices.len() / 3, corners.len() / 3);
        simplified.push((name, indices));
    }
    for (name, indices) in simplified {
        document.set_triangles(name.mesh, name.primitive, indices)?;
    }
    let flat = darboux_io::image::PngImage::from_rgb("flat", [1, 1], &[[128u8, 128, 255]])?.to_bytes()?;
    let primitives: Vec<_> = document.corners()?.iter().map(|corners| (corners.name().clone(), 0)).collect();
    document.set_normal_map(flat, "flat", &primitives)?;
    add_tangents(&mut document, &AddTangentsOptions::default().with_overwrite(true), &mut |_| {})?;
    document.save(Path::new(low), &SaveOptions::default().with_force(true))?;
    Ok(())
}

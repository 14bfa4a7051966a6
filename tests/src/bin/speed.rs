//! Times the core on grids of two to a million triangles, for comparison with the bindings to other
//! languages.
//!
//! Writes each grid's arrays into a folder of its number of triangles below the folder that is its argument,
//! and prints the least time of each call in milliseconds as JSON. `RAYON_NUM_THREADS` sets the number of
//! threads.

use std::fs;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use darboux::{
    Context, CornerTangentsRef, TangentOptions, generate_tangents, split_vertices, write_tangents,
};
use darboux_tests::{OwnedMesh, families};

/// Quads along an edge.
const EDGES: [usize; 4] = [1, 10, 100, 707];

fn main() {
    let folder = std::env::args().nth(1).expect("a folder for the grids' arrays");
    let times = EDGES.map(|edge| {
        let mesh = families::grid(edge, edge, false, false);
        let triangles = 2 * edge * edge;
        write(&Path::new(&folder).join(triangles.to_string()), &mesh);
        format!("\"{triangles}\": {}", times(&mesh, triangles))
    });
    println!("{{{}}}", times.join(", "));
}

fn write(folder: &Path, mesh: &OwnedMesh) {
    fs::create_dir_all(folder).expect("a folder that can be made");
    let put = |name: &str, bytes: Vec<u8>| fs::write(folder.join(name), bytes).expect("a file");
    put("positions", mesh.positions.as_flattened().iter().flat_map(|x| x.to_ne_bytes()).collect());
    put("normals", mesh.normals.as_flattened().iter().flat_map(|x| x.to_ne_bytes()).collect());
    put("uvs", mesh.uvs.as_flattened().iter().flat_map(|x| x.to_ne_bytes()).collect());
    let indices = mesh.indices.as_deref().expect("an indexed grid");
    put("indices", indices.iter().flat_map(|index| index.to_ne_bytes()).collect());
}

fn times(mesh: &OwnedMesh, triangles: usize) -> String {
    let (view, options) = (mesh.view(), TangentOptions::default());
    let (mut context, mut kept) = (Context::new(), vec![[0.0; 4]; mesh.corner_count()]);
    let calls = (100_000 / triangles).clamp(1, 1000);
    let fresh = least(calls, || drop(black_box(generate_tangents(&view, &options))));
    let into = least(calls, || {
        _ = write_tangents(&view, &options, &mut context, &mut kept).expect("one tangent per corner");
    });
    let split =
        least(calls, || drop(black_box(split_vertices(&view, CornerTangentsRef::from_per_corner(&kept)))));
    format!("{{\"fresh\": {fresh}, \"into\": {into}, \"split\": {split}}}")
}

/// The minimum of 15 times, in milliseconds per call.
fn least(calls: usize, mut call: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        (0..calls).for_each(|_| call());
        start.elapsed().as_secs_f64() * 1000.0 / calls as f64
    };
    (0..15).map(time).fold(f64::INFINITY, f64::min)
}

//! Times the core on a grid of a million triangles, for bindings to other languages to be compared with.
//!
//! Writes the grid's arrays into the folder that is its argument, and prints the least time of each call in milliseconds as JSON.
//! `RAYON_NUM_THREADS` sets the number of threads.

use std::fs;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use darboux::{Scratch, TangentOptions, Tangents, generate_tangents, generate_tangents_into, split_vertices};
use darboux_tests::families;

fn main() {
    let folder = std::env::args().nth(1).expect("a folder for the grid's arrays");
    let mesh = families::grid(707, 707, false, false);
    let indices = mesh.indices.as_deref().expect("an indexed grid");
    put(&folder, "positions", mesh.positions.as_flattened().iter().map(|x| x.to_bits()));
    put(&folder, "normals", mesh.normals.as_flattened().iter().map(|x| x.to_bits()));
    put(&folder, "uvs", mesh.uvs.as_flattened().iter().map(|x| x.to_bits()));
    put(&folder, "indices", indices.iter().copied());
    let (view, options) = (mesh.view(), TangentOptions::default());
    let (mut scratch, mut kept) = (Scratch::new(), Tangents::default());
    let fresh = least(|| drop(black_box(generate_tangents(&view, &options))));
    let into = least(|| generate_tangents_into(&view, &options, &mut scratch, &mut kept));
    let split = least(|| drop(black_box(split_vertices(&view, &kept.corners))));
    println!("{{\"fresh\": {fresh}, \"into\": {into}, \"split\": {split}}}");
}

fn put(folder: &str, name: &str, words: impl Iterator<Item = u32>) {
    let bytes: Vec<u8> = words.flat_map(u32::to_ne_bytes).collect();
    fs::write(Path::new(folder).join(name), bytes).expect("a folder that can be written");
}

/// The least of 15 times, in milliseconds.
fn least(mut call: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        call();
        start.elapsed().as_secs_f64() * 1000.0
    };
    (0..15).map(time).fold(f64::INFINITY, f64::min)
}

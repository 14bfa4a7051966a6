//! Measures a bake: a wavy sphere of about two million triangles onto one of twenty thousand.
//!
//! `cargo run --release --package darboux-bake --all-features --example measure -- SIZE THREADS CELLS LOW`
//! prints wall and processor time, rays per second, the peak of memory (Linux) and a checksum of the map,
//! which tells whether a change keeps its bits. The high sphere has 2 * CELLS * CELLS triangles, the low one
//! 2 * LOW * LOW.

use std::f64::consts::{PI, TAU};
use std::time::Instant;

use darboux::{Context, Mesh, TangentOptions, generate_tangents};
use darboux_bake::{BakeOptions, HighSurface, Images, LowSurface, MapKind, bake};

type Arrays = (Vec<[f32; 3]>, Vec<[f32; 2]>, Vec<u32>);

/// A sphere without its poles, of `cells` by `cells` cells, with waves of this height.
fn sphere(cells: usize, height: f64) -> Arrays {
    let side = cells + 1;
    let mut arrays = Arrays::default();
    for index in 0..side * side {
        let [u, v] = [index % side, index / side].map(|i| i as f64 / cells as f64);
        let (a, b) = (TAU * u, PI * (0.1 + 0.8 * v));
        let radius = 1.0 + height * (40.0 * a).sin() * (30.0 * b).sin();
        arrays.0.push([b.sin() * a.sin(), b.cos(), b.sin() * a.cos()].map(|x| (radius * x) as f32));
        arrays.1.push([u as f32, v as f32]);
    }
    for cell in 0..cells * cells {
        let corner = (cell / cells * side + cell % cells) as u32;
        let below = corner + side as u32;
        arrays.2.extend([corner, below, below + 1, corner, below + 1, corner + 1]);
    }
    arrays
}

/// The seconds of processor time of this process, and its peak of memory in bytes; zeros where the system
/// does not say.
fn usage() -> (f64, u64) {
    let text = |name: &str| std::fs::read_to_string(format!("/proc/self/{name}")).unwrap_or_default();
    let ticks: f64 =
        text("stat").split_whitespace().skip(13).take(2).filter_map(|x| x.parse::<f64>().ok()).sum();
    let status = text("status");
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let peak = peak.and_then(|line| line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok());
    (ticks / 100.0, peak.unwrap_or(0) << 10)
}

/// FNV-1a over the bits of the normal map.
fn checksum(images: &Images) -> u64 {
    let numbers = images.numbers(MapKind::Normal).unwrap_or_default();
    let start = 0xcbf2_9ce4_8422_2325;
    numbers.iter().fold(start, |sum, x| (sum ^ u64::from(x.to_bits())).wrapping_mul(0x100_0000_01b3))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let numbers: Vec<usize> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let number = |at: usize, default| numbers.get(at).copied().unwrap_or(default);
    let (size, threads, cells) = (number(0, 4096) as u32, number(1, 2), number(2, 1000));
    let (low, high) = (sphere(number(3, 100), 0.0), sphere(cells, 0.01));
    let mesh = Mesh::triangles(&low.0, &low.0, &low.1, &low.2)?;
    let tangents = generate_tangents(&mesh, &TangentOptions::default()).corners;
    let surfaces = [LowSurface::new(mesh, tangents.per_corner())?];
    let highs = [HighSurface::new(&high.0, Some((&high.0).into()), &high.2)?];
    let options = BakeOptions::new([size, size], [0.05, 0.05]);
    let mut context = Context::new().with_max_threads(threads);
    let (before, start) = (usage(), Instant::now());
    let mut built = None;
    let baked = bake(&surfaces, &highs, &options, &mut context, &mut |_| {
        built.get_or_insert_with(|| (start.elapsed().as_secs_f64(), usage().0));
    })?;
    let (wall, after) = (start.elapsed().as_secs_f64(), usage());
    let triangles = baked.report.high_triangles;
    let images = u64::from(size) * u64::from(size) * (12 + 1 + 8);
    let (built_wall, built_cpu) = built.unwrap_or_default();
    println!(
        "{triangles} triangles, {size} x {size}, {threads} threads: {wall:.2} s, processor {:.2} s",
        after.0 - before.0
    );
    println!("first row after {built_wall:.2} s, processor {:.2} s", built_cpu - before.0);
    let rays = baked.report.rays as f64 / (after.0 - built_cpu) / 1e6;
    println!("{rays:.2} million rays per second of processor time, all that follows the first row included");
    let above = after.1.saturating_sub(before.1).saturating_sub(images);
    println!("{} bytes per high triangle besides images and meshes", above / triangles);
    println!("checksum of the map {:016x}", checksum(&baked.images));
    Ok(())
}
